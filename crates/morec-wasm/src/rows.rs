//! Results as JavaScript objects, with the same fields as the command's JSON lines.

use morec::TimeSpan;
use morec::decode::Repetitions;
use morec::live::{Detection, Event, Model};
use morec::templates::Deviation;
use serde::Serialize;

/// A detection; times in seconds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DetectionRow<'a> {
    class: &'a str,
    #[serde(flatten)]
    span: TimeSpan,
    score: f64,
    reported_secs: f64,
    #[serde(flatten)]
    repetitions: Option<Repetitions>,
}

impl<'a> From<&Detection<&'a str>> for DetectionRow<'a> {
    fn from(d: &Detection<&'a str>) -> Self {
        Self {
            class: d.class,
            span: d.span,
            score: d.score,
            reported_secs: d.reported_secs,
            repetitions: d.repetitions,
        }
    }
}

/// An event; times in seconds of the stream's clock.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EventRow<'a> {
    phase: &'a str,
    motion: u64,
    sequence: u64,
    actor: u16,
    class: &'a str,
    score: f64,
    progress: f64,
    #[serde(flatten)]
    span: TimeSpan,
    reported_secs: f64,
    wall_secs: f64,
    #[serde(flatten)]
    repetitions: Option<Repetitions>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pace: Option<f64>,
    #[serde(flatten)]
    deviation: Option<Deviation>,
}

impl<'a> EventRow<'a> {
    /// `event` with the name that its class has in `model`.
    pub fn new(event: &Event, model: &'a Model) -> Self {
        Self {
            phase: event.phase.name(),
            motion: event.motion,
            sequence: event.sequence,
            actor: event.actor.0,
            class: model.class_name(event.class),
            score: event.score,
            progress: event.progress,
            span: event.span,
            reported_secs: event.reported_secs,
            wall_secs: event.wall_secs,
            repetitions: event.repetitions,
            pace: event.pace,
            deviation: event.deviation,
        }
    }
}
