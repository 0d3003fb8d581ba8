//! A class at a span of time, without a clip.

use super::ground_truth::GroundTruth;
use crate::TimeSpan;

/// A stretch of a clip with the name of what happens there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark<C = String> {
    /// Class of the motion.
    pub class: C,
    /// When it happens, from the clip's beginning.
    pub span: TimeSpan,
}

impl<C> Mark<C> {
    /// A mark of `class` over `span`, seconds from the clip's beginning.
    pub fn new(class: impl Into<C>, span: TimeSpan) -> Self {
        let class = class.into();
        Self { class, span }
    }
}

impl<'a> From<&'a GroundTruth> for Mark<&'a str> {
    fn from(truth: &'a GroundTruth) -> Self {
        Mark::new(truth.class.as_str(), truth.span)
    }
}
