//! What is compared when recognition is measured: labelled samples, detections and the streams that hold them.

use crate::TimeSpan;
use crate::live::Detection;

/// A labelled sample.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct GroundTruth {
    /// The stream's name.
    pub clip: String,
    /// Class of the motion.
    pub class: String,
    /// When it happens, from the stream's beginning.
    #[serde(flatten)]
    pub span: TimeSpan,
}

/// What was recognised in a stream, as a table of detections has it.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ClipDetection {
    /// The stream's name.
    pub clip: String,
    /// Name of the class.
    pub class: String,
    /// When it happens, from the stream's beginning.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// Score, if the recogniser gives one; larger is surer.
    pub score: Option<f64>,
    /// When it was reported, in seconds of the stream, if known.
    pub reported_secs: Option<f64>,
    /// Repetitions that were counted, of an activity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repetitions: Option<u32>,
}

/// A stream that was searched.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StreamInfo {
    /// Name of the clip.
    pub clip: String,
    /// Length, seconds.
    pub duration_secs: f64,
    /// True if it is known to hold none of the classes.
    pub unknown: bool,
}

impl From<&GroundTruth> for ClipDetection {
    /// A label in the place of a detection: what another annotator found.
    fn from(label: &GroundTruth) -> Self {
        Self {
            clip: label.clip.clone(),
            class: label.class.clone(),
            span: label.span,
            score: None,
            reported_secs: None,
            repetitions: None,
        }
    }
}

impl ClipDetection {
    /// What a recogniser `found` in the stream of that name.
    pub fn new(clip: &str, found: Detection<&str>) -> Self {
        Self {
            clip: clip.to_owned(),
            class: found.class.to_owned(),
            span: found.span,
            score: Some(found.score),
            reported_secs: Some(found.reported_secs),
            repetitions: found.repetitions.map(|r| r.count),
        }
    }
}
