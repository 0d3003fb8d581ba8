//! Classes and samples, and every change of them with a way back.
//!
//! A sample is a stretch of a clip said to show a class: accepted, proposed (by a program, to be looked at) or rejected
//! (looked at, and not it). Each call that changes something is one step of the database's history, done wholly or not at
//! all; [`MotionDb::undo`](crate::MotionDb::undo) takes it back.

mod classes;
mod plan;
mod read;
mod sample;
mod samples;
mod whole;
mod write;

pub use classes::ClassCount;
pub use plan::{ChangedLabel, LabelChange, LabelOptions, Labelled};
pub(crate) use read::list;
pub use sample::{
    Added, DbSample, GROUPED_BY, JudgedCounts, NewSample, SampleFilter, SampleId, SampleState,
};
pub use whole::WholeClip;

#[cfg(test)]
mod tests;
