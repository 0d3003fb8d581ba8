//! What is reported, as the objects that JavaScript gets. Their fields are those of the command's JSON lines.

use morec::decode::Repetitions;
use morec::live::{Detection, Event, Model};
use serde::Serialize;

/// A detection; times in seconds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DetectionRow<'a> {
    class: &'a str,
    start_secs: f64,
    stop_secs: f64,
    score: f64,
    reported_secs: f64,
    #[serde(flatten)]
    repetitions: Option<Repetitions>,
}

impl<'a> From<&Detection<&'a str>> for DetectionRow<'a> {
    fn from(d: &Detection<&'a str>) -> Self {
        Self {
            class: d.class,
            start_secs: d.start_secs,
            stop_secs: d.stop_secs,
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
    class: &'a str,
    score: f64,
    progress: f64,
    start_secs: f64,
    stop_secs: f64,
    reported_secs: f64,
    #[serde(flatten)]
    repetitions: Option<Repetitions>,
}

impl<'a> EventRow<'a> {
    /// `event` with the name that its class has in `model`.
    pub fn new(event: &Event, model: &'a Model) -> Self {
        Self {
            phase: event.phase.name(),
            motion: event.motion,
            class: model.class_name(event.class),
            score: event.score,
            progress: event.progress,
            start_secs: event.start_secs,
            stop_secs: event.stop_secs,
            reported_secs: event.reported_secs,
            repetitions: event.repetitions,
        }
    }
}
