//! Classes and samples, and every change of them with a way back.
//!
//! A sample is a stretch of a clip said to show a class: accepted, proposed (by a program, to be looked at) or rejected
//! (looked at, and not it). Each call that changes something is one step of the database's history, done wholly or not at
//! all; [`MotionDb::undo`](crate::MotionDb::undo) takes it back.

mod classes;
mod plan;
mod samples;

pub use classes::ClassCount;
pub use plan::{ChangedLabel, LabelChange, LabelOptions, Labelled};
pub use samples::{Added, DbSample, NewSample, SampleFilter, SampleId};

/// Who says what `morec group` proposes: that stretches are alike, under a name of its own making.
pub const GROUPED_BY: &str = "group";

/// What is thought of a sample.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum SampleState {
    /// It shows its class.
    Accepted,
    /// It may show its class; nobody has looked yet.
    Proposed,
    /// It does not show its class.
    Rejected,
}

impl SampleState {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            SampleState::Accepted => "accepted",
            SampleState::Proposed => "proposed",
            SampleState::Rejected => "rejected",
        }
    }

    /// The state of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Accepted, Self::Proposed, Self::Rejected]
            .into_iter()
            .find(|s| s.name() == name)
    }
}

#[cfg(test)]
mod tests;
