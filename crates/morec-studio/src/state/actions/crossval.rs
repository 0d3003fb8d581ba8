//! The result of a cross-validation: cells and moments chosen, compared, played.

use crate::jobs::judge::Moment;
use crate::state::{LibraryCommand, State};
use crate::stretch::Stretch;

/// A loop around a moment begins so long before it and ends so long after it, seconds.
const AROUND_SECS: f64 = 0.3;

impl State {
    /// The moment of the list that was chosen.
    pub fn chosen_moment(&self) -> Option<&Moment> {
        self.train.judged.as_ref()?.moments.get(self.train.moment?)
    }

    /// Lists the moments of a cell and goes to the first; `None` lists the mistakes.
    pub(in crate::state) fn show_cell(&mut self, cell: Option<(usize, usize)>) {
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

    /// Moments of the list that is shown, by place.
    pub fn listed_moments(&self) -> Vec<usize> {
        let judged = self.train.judged.as_ref();
        judged.map_or_else(Vec::new, |judged| match self.train.cell {
            Some((row, column)) => judged.of_cell(row, column),
            None => judged.mistakes(),
        })
    }

    pub(in crate::state) fn step_moment(&mut self, by: i64) {
        let listed = self.listed_moments();
        let from = self.train.moment;
        let from = from.and_then(|from| listed.iter().position(|at| *at == from));
        let last = listed.len().saturating_sub(1);
        let to = from.map_or(0, |from| from.saturating_add_signed(by as isize).min(last));
        if let Some(&at) = listed.get(to) {
            self.go_to_moment(at);
        }
    }

    /// Plays a moment in a loop, and offers to compare it.
    pub(in crate::state) fn go_to_moment(&mut self, at: usize) {
        let Some(judged) = &self.train.judged else {
            return;
        };
        let Some(moment) = judged.moments.get(at) else {
            return;
        };
        let clip = moment.clip.clone();
        let span = moment.span;
        self.train.moment = Some(at);
        self.companions.all.clear();
        let Some((id, end)) = self.clip_called(&clip) else {
            self.say(format!("{clip} is no longer in the database"));
            return;
        };
        let from = (span.start_secs - AROUND_SECS).max(0.0);
        let to = (span.stop_secs + AROUND_SECS).min(end);
        self.apply_library(LibraryCommand::GoTo(Stretch::new(id, from..to)));
    }

    /// Compares the chosen moment with the nearest label of a class; of the first that is worth it, if none is named.
    pub(in crate::state) fn compare_moment(&mut self, class: Option<String>) {
        let Some(moment) = self.chosen_moment() else {
            self.say("choose an entry of the list first");
            return;
        };
        let first = moment
            .compared_with()
            .first()
            .map(|class| (*class).to_owned());
        let Some(class) = class.or(first) else { return };
        let span = moment.span;
        let Some((clip, _)) = self.clip_called(&moment.clip) else {
            return;
        };
        let of = Stretch::new(clip, span);
        // A label that the fold left out explains nothing of what was found.
        let judged = self.train.judged.as_ref();
        let unlearned = judged.and_then(|judged| judged.unlearned.get(&moment.clip));
        let but = unlearned.cloned().unwrap_or_default();
        self.compare_with_nearest(of, class, but);
    }

    /// Number and length in seconds of a clip by name.
    fn clip_called(&self, name: &str) -> Option<(morec_db::ClipId, f64)> {
        let clips = &self.store.as_ref()?.snapshot.clips;
        let clip = clips.iter().find(|clip| clip.name == name)?;
        Some((clip.id, clip.duration_secs()))
    }
}
