//! Verdict on each sample and each detection, stream by stream, for reports.

use serde::Serialize;

use super::alarms::are_false_alarms;
use super::decisions::decisions;
use super::pairs::pair;
use super::{
    ClipDetection, EvalError, EvaluatedStream, GroundTruth, MEASURED_OVERLAP, StreamInfo, streams,
};

/// Verdict on a sample, as in [`ThesisAccuracy`](super::ThesisAccuracy).
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum GroundTruthVerdict {
    /// Recognised.
    Right,
    /// Taken for this class.
    Mistaken(String),
    /// No detection matches it.
    Missed,
}

/// Whether a detection is right, and why not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DetectionVerdict {
    /// Paired with a sample of its class at an intersection over union of at least [`MEASURED_OVERLAP`].
    Right,
    /// Shares more than half of the shorter one with a sample of its class, but is badly placed or a repetition.
    Loose,
    /// Lies on samples, of other classes.
    WrongClass,
    /// Less than half of it lies in labelled samples, and it is none of the above.
    FalseAlarm,
}

/// One stream, its samples and its detections in order of time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Timeline {
    /// Name and length of the stream.
    pub stream: StreamInfo,
    /// Its samples and what became of them.
    pub truths: Vec<(GroundTruth, GroundTruthVerdict)>,
    /// Its detections and what they are worth.
    pub founds: Vec<(ClipDetection, DetectionVerdict)>,
}

/// The timelines of all streams, by name. Fails and costs as [`Evaluation::of`](super::Evaluation::of).
///
/// # Errors
/// As [`Evaluation::of`](super::Evaluation::of).
pub fn timelines(
    infos: &[StreamInfo],
    truths: &[GroundTruth],
    founds: &[ClipDetection],
) -> Result<Vec<Timeline>, EvalError> {
    Ok(streams(infos, truths, founds)?
        .iter()
        .map(timeline)
        .collect())
}

fn timeline(stream: &EvaluatedStream<'_>) -> Timeline {
    // Decisions come in the order of the samples; those of unlabelled stretches follow and are cut off here.
    let truths = stream
        .truths
        .iter()
        .zip(decisions(stream))
        .map(|(truth, decision)| {
            let verdict = match decision.found {
                Some(class) if class == truth.class => GroundTruthVerdict::Right,
                Some(class) => GroundTruthVerdict::Mistaken(class.to_owned()),
                None => GroundTruthVerdict::Missed,
            };
            ((*truth).clone(), verdict)
        });
    let mut right = vec![false; stream.founds.len()];
    pair(stream, MEASURED_OVERLAP)
        .into_iter()
        .for_each(|(_, f)| right[f] = true);
    let founds = stream
        .founds
        .iter()
        .zip(right)
        .zip(are_false_alarms(stream))
        .map(|((found, right), alarm)| {
            let mut samples = stream.truths.iter();
            let verdict = if right {
                DetectionVerdict::Right
            } else if samples.any(|t| t.class == found.class && t.span.matches(found.span)) {
                DetectionVerdict::Loose
            } else if alarm {
                DetectionVerdict::FalseAlarm
            } else {
                DetectionVerdict::WrongClass
            };
            ((*found).clone(), verdict)
        });
    Timeline {
        stream: stream.info.clone(),
        truths: truths.collect(),
        founds: founds.collect(),
    }
}
