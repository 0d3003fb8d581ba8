//! State of time budgets and of annotators: whose labels are shown, and where two annotators differ.

use std::collections::BTreeSet;

use morec::labels::TimeBudget;
use morec_db::labels::DbSample;
use morec_ops::ComparedAnnotators;

use crate::store::Snapshot;

/// Annotator name of labels that were kept when a difference of two annotators was decided.
pub const AGREED: &str = "agreed";
/// Length of the unit of time by which annotators are compared, seconds: that of `morec agree`.
pub const UNIT_SECS: f64 = 0.1;

/// What is shown in place of the classes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StudyView {
    Budget,
    Annotators,
}

/// What becomes of a place where two annotators differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LabelDecision {
    A,
    B,
    Both,
}

/// Commands for time budgets and annotators.
#[derive(Debug, Clone, PartialEq)]
pub enum StudyCommand {
    /// Shows the time budget or the annotators in place of the classes; `None`: the classes again.
    Show(Option<StudyView>),
    /// Shows the labels of this annotator alone; `None`: of all.
    ShowLabelsOf(Option<String>),
    /// Sets the annotator of new labels; `None`: new labels have no annotator.
    Annotator(Option<String>),
    /// Compares two annotators.
    Compare([String; 2]),
    /// Goes to the difference of this place in the list.
    GoTo(usize),
    /// Decides on the difference of this place; `None`: on the one that was gone to.
    Decide(Option<usize>, LabelDecision),
}

/// The state of time budgets and annotators.
#[derive(Default)]
pub struct StudyState {
    pub view: Option<StudyView>,
    /// The time budget, and the version of the database that it is of.
    pub budget: Option<(u64, TimeBudget)>,
    /// Annotators of the labels that are there, by name.
    pub annotators: Vec<String>,
    /// The annotator of new labels.
    pub annotator: Option<String>,
    /// The annotator whose labels alone are shown.
    pub shown: Option<String>,
    /// The annotators that are compared.
    pub pair: Option<[String; 2]>,
    pub compared: Option<ComparedAnnotators>,
    /// The comparison that was begun last.
    pub(super) asked: Option<(u64, [String; 2])>,
    /// The difference that was gone to.
    pub chosen: Option<usize>,
}

impl StudyState {
    /// True if a label is shown.
    pub fn shows(&self, sample: &DbSample) -> bool {
        let shown = self.shown.as_ref();
        shown.is_none_or(|name| sample.annotators.contains(name))
    }

    /// Takes the annotators that are there.
    pub(super) fn follow(&mut self, snapshot: &Snapshot) {
        let names = snapshot.samples.iter().flat_map(|s| &s.annotators);
        let names: BTreeSet<&String> = names.collect();
        self.annotators = names.into_iter().cloned().collect();
        let there = |name: &String| self.annotators.contains(name);
        self.shown = self.shown.take().filter(there);
        self.pair = self.pair.take().filter(|pair| pair.iter().all(there));
        if self.pair.is_none() {
            self.compared = None;
            let mut first = self.annotators.iter().filter(|name| *name != AGREED);
            let pair = (first.next(), first.next());
            self.pair = match pair {
                (Some(a), Some(b)) => Some([a.clone(), b.clone()]),
                _ => None,
            };
        }
    }

    /// Places of the differences that nobody has decided on.
    pub fn undecided(&self) -> Vec<usize> {
        let Some(compared) = &self.compared else {
            return Vec::new();
        };
        let agreed = |s: &&DbSample| s.annotators.iter().any(|name| name == AGREED);
        let is_open = |at: &usize| !samples_of(compared, *at).iter().flatten().all(agreed);
        (0..compared.differences.len()).filter(is_open).collect()
    }
}

/// The samples of a difference, of A and of B.
pub fn samples_of(compared: &ComparedAnnotators, at: usize) -> [Option<&DbSample>; 2] {
    let Some(difference) = compared.differences.get(at) else {
        return [None, None];
    };
    let [a, b] = &compared.samples;
    [
        difference.a.and_then(|at| a.get(at)),
        difference.b.and_then(|at| b.get(at)),
    ]
}
