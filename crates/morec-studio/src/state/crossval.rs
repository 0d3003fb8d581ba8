//! A cross-validation as it is shown: the confusion matrix, the list of mistakes, the moment that was chosen.

use morec::eval::Evaluation;

use super::{CompareCommand, LibraryCommand, State};
use crate::jobs::judge::{CrossvalResult, LeftOut, Moment};
use crate::stretch::Stretch;

/// A loop around a moment begins so long before it and ends so long after it, seconds.
const AROUND_SECS: f64 = 0.3;

/// A cross-validation, ready to be shown.
///
/// Matrix, list and figures count the same moments: each label once, each false detection once.
pub struct CrossvalView {
    pub evaluation: Evaluation,
    pub moments: Vec<Moment>,
    pub by: LeftOut,
    /// Classes of the rows; the row of false detections follows them.
    pub rows: Vec<String>,
    /// Classes of the columns; the column of missed labels follows them.
    pub columns: Vec<String>,
    /// Numbers of moments, `counts[row][column]`.
    pub counts: Vec<Vec<usize>>,
}

impl From<CrossvalResult> for CrossvalView {
    fn from(judged: CrossvalResult) -> Self {
        let moments = judged.moments();
        let confusion = &judged.evaluation.confusion;
        let mut view = Self {
            rows: confusion.rows.clone(),
            columns: confusion.columns.clone(),
            counts: Vec::new(),
            moments,
            by: judged.by,
            evaluation: judged.evaluation,
        };
        let count = |row, column| view.of_cell(row, column).len();
        let row = |row| (0..=view.columns.len()).map(|k| count(row, k)).collect();
        view.counts = (0..=view.rows.len()).map(row).collect();
        view
    }
}

impl CrossvalView {
    /// Places of the moments of a cell.
    pub fn of_cell(&self, row: usize, column: usize) -> Vec<usize> {
        let (truth, found) = (self.rows.get(row), self.columns.get(column));
        self.places(|m| m.truth.as_ref() == truth && m.found.as_ref() == found)
    }

    /// Places of the moments that are not right: labels that were missed or taken for another class, false detections.
    pub fn mistakes(&self) -> Vec<usize> {
        self.places(|m| !m.is_right())
    }

    /// Number of labels that were recognised.
    pub fn recognised(&self) -> usize {
        self.places(|m| m.truth.is_some() && m.is_right()).len()
    }

    /// Number of labels that no detection matched.
    pub fn missed(&self) -> usize {
        self.places(|m| m.found.is_none()).len()
    }

    /// Number of detections that match no label.
    pub fn false_detections(&self) -> usize {
        self.places(|m| m.truth.is_none()).len()
    }

    fn places(&self, wanted: impl Fn(&Moment) -> bool) -> Vec<usize> {
        let moments = self.moments.iter().enumerate();
        moments
            .filter(|(_, m)| wanted(m))
            .map(|(at, _)| at)
            .collect()
    }
}

impl State {
    /// The moment of the list that was chosen.
    pub fn chosen_moment(&self) -> Option<&Moment> {
        self.train.judged.as_ref()?.moments.get(self.train.moment?)
    }

    /// Lists the moments of a cell and goes to the first; `None` lists the mistakes.
    pub(super) fn show_cell(&mut self, cell: Option<(usize, usize)>) {
        self.train.cell = cell;
        self.train.moment = None;
        let Some(judged) = &self.train.judged else {
            return;
        };
        let places = cell.map(|(row, column)| judged.of_cell(row, column));
        if let Some(first) = places.and_then(|places| places.first().copied()) {
            self.go_to_moment(first);
        }
    }

    /// Plays a moment in a loop, and offers to compare it.
    pub(super) fn go_to_moment(&mut self, at: usize) {
        let Some(judged) = &self.train.judged else {
            return;
        };
        let Some(moment) = judged.moments.get(at) else {
            return;
        };
        let clip = moment.clip.clone();
        let (start, stop) = (moment.start_secs, moment.stop_secs);
        self.train.moment = Some(at);
        self.companions.all.clear();
        let Some((id, end)) = self.clip_called(&clip) else {
            self.say(format!("{clip} is not in the database any more"));
            return;
        };
        self.apply_library(LibraryCommand::GoTo {
            clip: id,
            start_secs: (start - AROUND_SECS).max(0.0),
            stop_secs: (stop + AROUND_SECS).min(end),
        });
    }

    /// Compares the chosen moment with the nearest label of a class; of the first that is worth it, if none is named.
    pub(super) fn compare_moment(&mut self, class: Option<String>) {
        let Some(moment) = self.chosen_moment() else {
            self.say("choose a line of the list first");
            return;
        };
        let first = moment
            .compared_with()
            .first()
            .map(|class| (*class).to_owned());
        let Some(class) = class.or(first) else { return };
        let (start_secs, stop_secs) = (moment.start_secs, moment.stop_secs);
        let Some((clip, _)) = self.clip_called(&moment.clip) else {
            return;
        };
        let of = Stretch {
            clip,
            start_secs,
            stop_secs,
        };
        self.apply_compare(CompareCommand::NearestOf { of, class });
    }

    /// Number and length in seconds of a clip by name.
    fn clip_called(&self, name: &str) -> Option<(morec_db::ClipId, f64)> {
        let clips = &self.store.as_ref()?.snapshot.clips;
        let clip = clips.iter().find(|clip| clip.name == name)?;
        Some((clip.id, clip.duration_secs()))
    }
}
