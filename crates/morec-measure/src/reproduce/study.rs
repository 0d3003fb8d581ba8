//! Data and settings of the study, and what its parts share.

use std::ops::Range;

use crate::crossval::CrossvalError;
use crate::eval::EvalError;
use morec::features::Rows;
use morec::index::IndexError;
use morec::labels::Sample;
use morec::pivots::{NoPivots, PivotMap, PivotSet, PoseParams, pose_rows_of_clip};
use morec::segment::SegmentError;
use morec::train::thesis::{Setting, SvrdmOptions};
use morec::train::{TrainClip, TrainError};

/// Data of the study.
#[derive(Debug, Clone)]
pub struct Study<'a> {
    /// Labelled clips; clips named as background too.
    pub clips: &'a [TrainClip],
    /// Labels of these clips.
    pub samples: &'a [Sample],
    /// Names of the classes; a `ClassId` is an index into this.
    pub classes: &'a [String],
    /// Clips that hold none of them.
    pub unknown: &'a [TrainClip],
    /// Seeds of the half splits.
    pub seeds: &'a [u64],
    /// Options of training, by setting.
    pub settings: &'a [(Setting, SvrdmOptions)],
}

/// A picture to be kept beside the page.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Name of its file, without ending.
    pub name: String,
    /// Caption of the picture.
    pub caption: String,
    /// The picture as an SVG element.
    pub svg: String,
    /// Data of the picture, as tab-separated text with a header, where that is not in [`Reproduction`](super::Reproduction).
    pub table: Option<String>,
}

/// Why it cannot be done.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // The messages say it all.
pub enum ReproduceError {
    #[error("cancelled")]
    Cancelled,
    #[error("clip {clip}: {source}")]
    Pivots { clip: String, source: NoPivots },
    #[error("clip {clip}: {source}")]
    Segment { clip: String, source: SegmentError },
    #[error(transparent)]
    Train(#[from] TrainError),
    #[error(transparent)]
    Crossval(#[from] CrossvalError),
    #[error(transparent)]
    Eval(#[from] EvalError),
    #[error(transparent)]
    Index(#[from] IndexError),
    #[error("{0}")]
    Other(String),
}

/// The pose rows of a clip.
pub(super) fn rows_of(
    clip: &TrainClip,
    set: &PivotSet,
    params: &PoseParams,
) -> Result<Rows, ReproduceError> {
    let map = PivotMap::of_clip(set, &clip.clip, &clip.roles).map_err(|source| {
        ReproduceError::Pivots {
            clip: clip.name.clone(),
            source,
        }
    })?;
    Ok(pose_rows_of_clip(&clip.clip, set, &map, &clip.rest, params))
}

/// The frames of a sample among `count` rows at `rate_hz`.
pub(super) fn frames_of(sample: &Sample, rate_hz: f64, count: usize) -> Range<usize> {
    sample.span.frames_among(count, rate_hz)
}
