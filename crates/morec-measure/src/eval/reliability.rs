//! Reliability of scores: the share of right detections at each score.

use serde::Serialize;

use super::EvaluatedStream;
use super::events::right_in;

/// Scores are counted in this many equal bins.
pub const SCORE_BINS: usize = 10;

/// Detections of about one score.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct ScoreBin {
    /// Number of detections.
    pub count: usize,
    /// Mean score of these detections.
    pub mean_score: f64,
    /// The share of them that is right, as [`EventScore`](super::EventScore) counts it.
    pub right: f64,
}

/// Scores against the share of right detections: the reliability diagram (Niculescu-Mizil and Caruana, *Predicting good
/// probabilities with supervised learning*, 2005, Sec. 4).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reliability {
    /// From score 0 to 1 in [`SCORE_BINS`] equal steps; those without a detection are left at 0.
    pub bins: Vec<ScoreBin>,
    /// Mean difference of mean score and share of right detections, weighted by the detections of a bin; `None` without
    /// a scored detection.
    pub error: Option<f64>,
}

impl Reliability {
    /// Counts over known and unknown streams. O(samples × detections) within each stream.
    pub(super) fn count<'s, 'a: 's>(
        streams: impl Iterator<Item = &'s EvaluatedStream<'a>>,
    ) -> Self {
        let mut sums = [(0usize, 0.0, 0usize); SCORE_BINS];
        for stream in streams {
            for (found, right) in stream.founds.iter().zip(right_in(stream)) {
                let Some(score) = found.score.filter(|s| s.is_finite()) else {
                    continue;
                };
                let bin = (score * SCORE_BINS as f64).clamp(0.0, SCORE_BINS as f64 - 1.0);
                let (count, total, rights) = &mut sums[bin as usize];
                *count += 1;
                *total += score;
                *rights += usize::from(right);
            }
        }
        let all: usize = sums.iter().map(|s| s.0).sum();
        let apart: f64 = sums
            .iter()
            .map(|(_, total, rights)| (total - *rights as f64).abs())
            .sum();
        let bin = |(count, total, rights): (usize, f64, usize)| {
            let share = 1.0 / count.max(1) as f64;
            ScoreBin {
                count,
                mean_score: total * share,
                right: rights as f64 * share,
            }
        };
        Self {
            bins: sums.map(bin).to_vec(),
            error: (all > 0).then(|| apart / all as f64),
        }
    }
}
