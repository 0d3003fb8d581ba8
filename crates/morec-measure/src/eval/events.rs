//! Measures of detections as events: a detection is right if its middle lies within a sample of its class.

use morec::TimeSpan;
use serde::Serialize;

use super::figures::share;
use super::{ClipDetection, EvaluatedStream, GroundTruth};

/// Largest distance of the middle of a detection from its sample, in seconds: eight frames at 30 Hz.
pub const EVENT_TOLERANCE_SECS: f64 = 8.0 / 30.0;

/// Precision, recall and F1 of events. A detection is right if its middle lies within a sample of its class,
/// [`EVENT_TOLERANCE_SECS`] more on each side; each sample counts once, further detections are false.
///
/// For samples whose labels are loose at the ends, as those of whole clips are; a measure of overlap would then
/// judge the labels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EventScore {
    /// Samples with a right detection: true positives.
    pub matched: usize,
    /// Samples without one.
    pub missed: usize,
    /// Detections that are not right, or one too many.
    pub spurious: usize,
    /// Share of the detections that are right.
    pub precision: Option<f64>,
    /// Share of the samples found.
    pub recall: Option<f64>,
    /// 2·matched / (samples + detections).
    pub f1: Option<f64>,
}

impl EventScore {
    /// Counts over `streams`. O(samples × detections) within each stream.
    pub(super) fn count(streams: &[EvaluatedStream<'_>]) -> Self {
        let (mut matched, mut samples, mut detections) = (0, 0, 0);
        for stream in streams {
            matched += right_in(stream).into_iter().filter(|right| *right).count();
            samples += stream.truths.len();
            detections += stream.founds.len();
        }
        Self {
            matched,
            missed: samples - matched,
            spurious: detections - matched,
            precision: share(matched, detections),
            recall: share(matched, samples),
            f1: share(2 * matched, samples + detections),
        }
    }
}

/// Marks the detections of a stream that are right.
pub(super) fn right_in(stream: &EvaluatedStream<'_>) -> Vec<bool> {
    let mut right = vec![false; stream.founds.len()];
    for found in event_pairs(&stream.truths, &stream.founds)
        .into_iter()
        .flatten()
    {
        right[found] = true;
    }
    right
}

/// For each sample of one stream the detection that is its event, as a place in `founds`, if there is one. Samples in
/// order of their stops each take the earliest detection that is left: for intervals that is the largest pairing there
/// is. O(samples × detections).
pub fn event_pairs(truths: &[&GroundTruth], founds: &[&ClipDetection]) -> Vec<Option<usize>> {
    let mut in_order: Vec<usize> = (0..truths.len()).collect();
    let stop = |t: usize| truths[t].span.stop_secs;
    in_order.sort_by(|a, b| stop(*a).total_cmp(&stop(*b)));
    let middle = |f: usize| founds[f].span.middle_secs();
    let mut earliest: Vec<usize> = (0..founds.len()).collect();
    earliest.sort_by(|a, b| middle(*a).total_cmp(&middle(*b)));
    let mut taken = vec![false; founds.len()];
    let mut pairs = vec![None; truths.len()];
    for truth in in_order {
        let free = earliest
            .iter()
            .copied()
            .find(|&f| !taken[f] && is_event_of(truths[truth], founds[f]));
        if let Some(f) = free {
            taken[f] = true;
            pairs[truth] = Some(f);
        }
    }
    pairs
}

/// True if a detection is of the sample's class and its middle lies within the sample, [`EVENT_TOLERANCE_SECS`] more on
/// each side.
fn is_event_of(truth: &GroundTruth, found: &ClipDetection) -> bool {
    let TimeSpan {
        start_secs,
        stop_secs,
    } = truth.span;
    let near = start_secs - EVENT_TOLERANCE_SECS..=stop_secs + EVENT_TOLERANCE_SECS;
    found.class == truth.class && near.contains(&found.span.middle_secs())
}
