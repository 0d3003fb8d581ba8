//! The thesis's measures: one decision for every stretch of the ground truth (§5.4), and the three rates of a
//! classifier of cut-out samples (§5.3).

use serde::Serialize;

use super::spans::gaps;
use super::{ClipDetection, EvaluatedStream, UNLABELLED_MIN_SECS};
use morec::TimeSpan;

/// The thesis's accuracy of segmentation and recognition (§5.4, Eq. 5.2) and its four counts.
///
/// Every sample, and every unlabelled stretch of at least [`UNLABELLED_MIN_SECS`], is one decision. A detection
/// matches a stretch when the two share more than half of the shorter one. Where several match, the best one
/// decides: the one that shares most time with the stretch, then the one of greater intersection over union,
/// then the earlier. One detection may match, and decide, several stretches: the thesis looks from the ground
/// truth only. Being lenient that way, the measure stands beside [`OverlapScore`](super::OverlapScore), which is
/// strict.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ThesisAccuracy {
    /// Samples whose match has their class.
    pub true_positives: usize,
    /// Samples whose match has another class, and unlabelled stretches that have a match.
    pub false_positives: usize,
    /// Samples without a match.
    pub false_negatives: usize,
    /// Unlabelled stretches without a match.
    pub true_negatives: usize,
    /// (TP + TN) / all; nothing if there is nothing to decide.
    pub accuracy: Option<f64>,
}

/// P_C, P_E and P_R (§5.3, Eq. 5.1): what becomes of samples, each taken for itself.
///
/// Of the detections that match a sample (as in [`ThesisAccuracy`]) the one of highest score decides; among equal
/// scores, or without any, the one that shares most time with it. Right class: right; another: wrong; none:
/// rejected.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Classification {
    /// Samples given their class.
    pub right: usize,
    /// Samples given another class.
    pub wrong: usize,
    /// Samples given none.
    pub rejected: usize,
    /// Share given their class.
    pub p_c: Option<f64>,
    /// Share given another class.
    pub p_e: Option<f64>,
    /// Share given none.
    pub p_r: Option<f64>,
}

/// One stretch of the ground truth and the class of the detection that decides it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Decision<'a> {
    /// `None` for an unlabelled stretch.
    pub truth: Option<&'a str>,
    /// `None` if no detection matches.
    pub found: Option<&'a str>,
}

/// The decisions of a stream: its samples in order, then its unlabelled stretches.
/// O(samples × detections).
pub(super) fn decisions<'a>(stream: &EvaluatedStream<'a>) -> Vec<Decision<'a>> {
    let labelled = TimeSpan::union(stream.truths.iter().map(|t| t.span));
    let unlabelled = gaps(&labelled, stream.info.duration_secs, UNLABELLED_MIN_SECS);
    let samples = stream
        .truths
        .iter()
        .map(|t| (Some(t.class.as_str()), t.span));
    let rest = unlabelled.into_iter().map(|gap| (None, gap));
    samples
        .chain(rest)
        .map(|(truth, at)| Decision {
            truth,
            found: best_match(at, stream).map(|f| f.class.as_str()),
        })
        .collect()
}

fn best_match<'a>(at: TimeSpan, stream: &EvaluatedStream<'a>) -> Option<&'a ClipDetection> {
    best_by(at, stream, |found| {
        (at.overlap_secs(found.span), at.iou(found.span))
    })
}

/// The matching detection of the highest key; the earliest of equals.
fn best_by<'a>(
    at: TimeSpan,
    stream: &EvaluatedStream<'a>,
    key: impl Fn(&ClipDetection) -> (f64, f64),
) -> Option<&'a ClipDetection> {
    let mut best: Option<(&ClipDetection, (f64, f64))> = None;
    for found in stream.founds.iter().filter(|f| at.matches(f.span)) {
        let key = key(found);
        if best.is_none_or(|(_, (a, b))| key.0.total_cmp(&a).then(key.1.total_cmp(&b)).is_gt()) {
            best = Some((found, key));
        }
    }
    best.map(|(found, _)| found)
}

impl ThesisAccuracy {
    pub(super) fn count<'a>(decisions: impl IntoIterator<Item = &'a Decision<'a>>) -> Self {
        let mut counts = Self::default();
        for decision in decisions {
            *match decision {
                Decision {
                    truth: None,
                    found: None,
                } => &mut counts.true_negatives,
                Decision { found: None, .. } => &mut counts.false_negatives,
                Decision { truth, found } if truth == found => &mut counts.true_positives,
                _ => &mut counts.false_positives,
            } += 1;
        }
        let right = counts.true_positives + counts.true_negatives;
        counts.accuracy = super::figures::share(
            right,
            right + counts.false_positives + counts.false_negatives,
        );
        counts
    }
}

impl Classification {
    /// Over the samples of a class, or of every class.
    pub(super) fn count(streams: &[EvaluatedStream<'_>], class: Option<&str>) -> Self {
        let mut counts = Self::default();
        for stream in streams {
            for truth in stream
                .truths
                .iter()
                .filter(|t| class.is_none_or(|c| c == t.class))
            {
                let at = truth.span;
                let score = |found: &ClipDetection| found.score.unwrap_or(f64::NEG_INFINITY);
                let best = best_by(at, stream, |found| {
                    (score(found), at.overlap_secs(found.span))
                });
                *match best {
                    Some(found) if found.class == truth.class => &mut counts.right,
                    Some(_) => &mut counts.wrong,
                    None => &mut counts.rejected,
                } += 1;
            }
        }
        let share =
            |count| super::figures::share(count, counts.right + counts.wrong + counts.rejected);
        (counts.p_c, counts.p_e, counts.p_r) = (
            share(counts.right),
            share(counts.wrong),
            share(counts.rejected),
        );
        counts
    }
}
