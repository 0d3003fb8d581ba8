//! A cross-validation as it is shown: the confusion matrix, the list of mistakes, the moment that was chosen.

use std::collections::BTreeMap;

use morec_measure::eval::Evaluation;
use morec_ops::{LeftOut, Unlearned};

use crate::jobs::judge::{CrossvalResult, Moment};

/// A cross-validation, ready to be shown.
///
/// Matrix, list and figures count the same moments: each label once, each false detection once.
pub struct CrossvalView {
    pub evaluation: Evaluation,
    pub moments: Vec<Moment>,
    pub by: LeftOut,
    /// See [`KeptCrossval::thesis`](morec_ops::KeptCrossval::thesis).
    pub thesis: bool,
    /// See [`KeptCrossval::untested`](morec_ops::KeptCrossval::untested).
    pub untested: Vec<String>,
    /// See [`CrossvalResult::unlearned`].
    pub unlearned: BTreeMap<String, Unlearned>,
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
            by: judged.kept.by,
            thesis: judged.kept.thesis,
            untested: judged.kept.untested,
            unlearned: judged.unlearned,
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
