//! Measures of reports: delay, and the errors of starts and stops.

use serde::Serialize;

use super::figures::quantile;
use super::pairs::pair;
use super::{ClipDetection, EvaluatedStream, GroundTruth, MEASURED_OVERLAP};

/// From a sample's stop to the moment its detection is reported, over detections paired with a sample of their
/// class at an intersection over union of at least [`MEASURED_OVERLAP`], if it is known when they were reported.
/// Negative if reported before the sample ended.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Delay {
    /// Number of measured pairs.
    pub count: usize,
    /// Median, seconds; `None` without pairs.
    pub median_secs: Option<f64>,
    /// Nine in ten are no later (linear interpolation between neighbours).
    pub p90_secs: Option<f64>,
}

/// Errors of detected starts and stops, over the same pairs as [`Delay`]: detected minus labelled time, so
/// positive is late.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Boundaries {
    /// Number of pairs.
    pub count: usize,
    /// Median error of the start: its bias.
    pub start_median_secs: Option<f64>,
    /// Median size of the start's error.
    pub start_median_abs_secs: Option<f64>,
    /// Median error of the stop: its bias.
    pub stop_median_secs: Option<f64>,
    /// Median size of the stop's error.
    pub stop_median_abs_secs: Option<f64>,
}

/// The pairs that are measured, of every stream.
pub(super) fn measured_pairs<'a>(
    streams: &[EvaluatedStream<'a>],
) -> Vec<(&'a GroundTruth, &'a ClipDetection)> {
    let pairs_of = |stream: &EvaluatedStream<'a>| {
        let pairs = pair(stream, MEASURED_OVERLAP);
        pairs
            .into_iter()
            .map(|(t, f)| (stream.truths[t], stream.founds[f]))
            .collect::<Vec<_>>()
    };
    streams.iter().flat_map(pairs_of).collect()
}

impl Delay {
    pub(super) fn of(pairs: &[(&GroundTruth, &ClipDetection)]) -> Self {
        let mut delays: Vec<f64> = pairs
            .iter()
            .filter_map(|(truth, found)| Some(found.reported_secs? - truth.span.stop_secs))
            .collect();
        Self {
            count: delays.len(),
            median_secs: quantile(&mut delays, 0.5),
            p90_secs: quantile(&mut delays, 0.9),
        }
    }
}

impl Boundaries {
    pub(super) fn of(pairs: &[(&GroundTruth, &ClipDetection)]) -> Self {
        let starts: Vec<f64> = pairs
            .iter()
            .map(|(t, f)| f.span.start_secs - t.span.start_secs)
            .collect();
        let stops: Vec<f64> = pairs
            .iter()
            .map(|(t, f)| f.span.stop_secs - t.span.stop_secs)
            .collect();
        let median = |values: &[f64]| quantile(&mut values.to_vec(), 0.5);
        let median_abs =
            |values: &[f64]| quantile(&mut values.iter().map(|v| v.abs()).collect::<Vec<_>>(), 0.5);
        Self {
            count: pairs.len(),
            start_median_secs: median(&starts),
            start_median_abs_secs: median_abs(&starts),
            stop_median_secs: median(&stops),
            stop_median_abs_secs: median_abs(&stops),
        }
    }
}
