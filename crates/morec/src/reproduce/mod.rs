//! The thesis's evaluation (Bucur 2009, ch. 5) on clips and labels of today: segmentation (§5.1), clusters (§5.2),
//! classification of cut-out samples (§5.3) and of streams (§5.4), once with the thesis's own figures and once tuned;
//! its figures beside ours.

mod classification;
mod clustering;
mod page;
mod segmentation;
mod streams;
mod thesis;

use std::ops::Range;

use serde::Serialize;

use crate::crossval::CrossvalError;
use crate::eval::EvalError;
use crate::features::Rows;
use crate::index::IndexError;
use crate::labels::Sample;
use crate::pivots::{NoPivots, PivotMap, PivotSet, PoseParams, pose_rows_of_clip};
use crate::progress::Progress;
use crate::segment::SegmentError;
use crate::train::thesis::{SvrdmOptions, SvrdmTrainParams};
use crate::train::{TrainClip, TrainError};

pub use classification::SplitResult;
pub use clustering::Clustering;
pub use page::page;
pub use segmentation::Segmented;
pub use streams::Streamed;

/// What to work on.
#[derive(Debug, Clone)]
pub struct Study<'a> {
    /// Labelled clips; clips named as background too.
    pub clips: &'a [TrainClip],
    /// Their samples.
    pub samples: &'a [Sample],
    /// The classes.
    pub classes: &'a [String],
    /// Clips that hold none of them.
    pub unknown: &'a [TrainClip],
    /// Seeds of the half splits.
    pub seeds: &'a [u64],
    /// How to train.
    pub settings: &'a [(Setting, SvrdmOptions)],
}

/// The two settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Setting {
    /// The thesis's own figures.
    Faithful,
    /// Made to accept what was not seen.
    Tuned,
}

impl Setting {
    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Setting::Faithful => "faithful",
            Setting::Tuned => "tuned",
        }
    }

    /// The figures of training.
    pub fn params(self) -> SvrdmTrainParams {
        match self {
            Setting::Faithful => SvrdmTrainParams::faithful(),
            Setting::Tuned => SvrdmTrainParams::tuned(),
        }
    }
}

/// A picture to be kept beside the page.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// What its file is called, without ending.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// The picture.
    pub svg: String,
    /// What it is drawn from, as tab-separated text with a header, where that is not in [`Reproduction`].
    pub table: Option<String>,
}

/// Everything that came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reproduction {
    /// §5.1, clip by clip.
    pub segmentation: Vec<Segmented>,
    /// §5.2, τ by τ, centred and not.
    pub clustering: Vec<Clustering>,
    /// §5.3, for each setting and seed.
    pub classification: Vec<SplitResult>,
    /// §5.4, for each setting and seed.
    pub streams: Vec<Streamed>,
    /// All pictures.
    #[serde(skip)]
    pub pictures: Vec<Picture>,
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
fn rows_of(clip: &TrainClip, set: &PivotSet, params: &PoseParams) -> Result<Rows, ReproduceError> {
    let map = PivotMap::of_clip(set, &clip.clip, &clip.roles).map_err(|source| {
        ReproduceError::Pivots {
            clip: clip.name.clone(),
            source,
        }
    })?;
    Ok(pose_rows_of_clip(&clip.clip, set, &map, &clip.rest, params))
}

/// The frames of a sample among `count` rows at `rate_hz`.
fn frames_of(sample: &Sample, rate_hz: f64, count: usize) -> Range<usize> {
    let frame = |secs: f64| ((secs * rate_hz).round() as usize).min(count);
    frame(sample.start_secs)..frame(sample.stop_secs)
}

/// Runs the whole evaluation. Trains twice for each setting and seed.
pub fn reproduce(
    study: &Study<'_>,
    progress: &dyn Progress,
) -> Result<Reproduction, ReproduceError> {
    let steps = 2 + study.settings.len() * study.seeds.len();
    let at = |step: usize| {
        progress.report("evaluation", step, steps);
        if progress.cancelled() {
            Err(ReproduceError::Cancelled)
        } else {
            Ok(())
        }
    };
    let mut pictures = vec![];
    at(0)?;
    let segmentation = segmentation::run(study, &mut pictures)?;
    at(1)?;
    let clustering = clustering::run(study)?;
    let (mut classification, mut streams) = (vec![], vec![]);
    for setting in study.settings {
        for (turn, seed) in study.seeds.iter().enumerate() {
            at(2 + classification.len())?;
            // Pictures of the first seed; the others look alike.
            let mut shown = vec![];
            classification.push(classification::run(study, setting, *seed, &mut shown)?);
            streams.push(streams::run(study, setting, *seed, &mut shown)?);
            if turn == 0 {
                pictures.append(&mut shown);
            }
        }
    }
    at(steps)?;
    Ok(Reproduction {
        segmentation,
        clustering,
        classification,
        streams,
        pictures,
    })
}
