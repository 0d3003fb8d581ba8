//! False alarms: detections in unlabelled motion and in clips without classes.

use morec::TimeSpan;
use serde::Serialize;

use super::EvaluatedStream;
use super::figures::share;
use super::spans::mostly_outside;

/// Detections of which less than half lies in labelled samples, of whatever class, in known streams.
///
/// Samples are taken together: a detection that spans two repetitions, half in each, is badly placed but no
/// false alarm.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct FalseAlarms {
    /// Number of false alarms.
    pub count: usize,
    /// Length of the known streams.
    pub minutes: f64,
    /// Number in a minute.
    pub per_minute: Option<f64>,
}

/// Detections in streams that hold none of the classes. Every detection there is a false alarm.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct UnknownFigures {
    /// Number of unknown streams.
    pub clips: usize,
    /// Number of them with at least one detection.
    pub clips_accepted: usize,
    /// Share of the unknown streams with at least one detection; `None` without such streams.
    pub unknown_accepted: Option<f64>,
    /// Number of detections.
    pub detections: usize,
    /// Length of the unknown streams.
    pub minutes: f64,
    /// Detections in a minute.
    pub per_minute: Option<f64>,
}

/// Marks the detections of a stream that are false alarms. O(samples × detections).
pub(super) fn are_false_alarms(stream: &EvaluatedStream<'_>) -> Vec<bool> {
    let labelled = TimeSpan::union(stream.truths.iter().map(|t| t.span));
    stream
        .founds
        .iter()
        .map(|f| mostly_outside(f.span, &labelled))
        .collect()
}

fn per_minute(count: usize, minutes: f64) -> Option<f64> {
    (minutes > 0.0).then(|| count as f64 / minutes)
}

fn minutes(streams: &[EvaluatedStream<'_>]) -> f64 {
    streams.iter().map(|s| s.info.duration_secs).sum::<f64>() / 60.0
}

impl FalseAlarms {
    /// In known streams, those of one class or of all.
    pub(super) fn count(known: &[EvaluatedStream<'_>], class: Option<&str>) -> Self {
        let of_stream = |stream: &EvaluatedStream<'_>| {
            let founds = stream.founds.iter().zip(are_false_alarms(stream));
            founds
                .filter(|(found, alarm)| *alarm && class.is_none_or(|c| c == found.class))
                .count()
        };
        let count = known.iter().map(of_stream).sum();
        let minutes = minutes(known);
        Self {
            count,
            minutes,
            per_minute: per_minute(count, minutes),
        }
    }
}

impl UnknownFigures {
    pub(super) fn count(unknown: &[EvaluatedStream<'_>]) -> Self {
        let clips_accepted = unknown.iter().filter(|s| !s.founds.is_empty()).count();
        let detections = unknown.iter().map(|s| s.founds.len()).sum();
        let minutes = minutes(unknown);
        Self {
            clips: unknown.len(),
            clips_accepted,
            unknown_accepted: share(clips_accepted, unknown.len()),
            detections,
            minutes,
            per_minute: per_minute(detections, minutes),
        }
    }
}
