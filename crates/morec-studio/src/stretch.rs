//! A stretch of a clip: what is searched for, compared, labelled.

use morec::TimeSpan;
use morec_db::ClipId;
use morec_db::labels::DbSample;
use morec_db::search::Hit;

/// From one moment of a clip to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    pub clip: ClipId,
    pub span: TimeSpan,
}

impl Stretch {
    pub fn new(clip: ClipId, span: impl Into<TimeSpan>) -> Self {
        let span = span.into();
        Self { clip, span }
    }
}

impl From<&DbSample> for Stretch {
    fn from(sample: &DbSample) -> Self {
        Self::new(sample.clip, sample.span())
    }
}

impl From<&Hit> for Stretch {
    fn from(hit: &Hit) -> Self {
        Self::new(hit.clip, hit.span)
    }
}
