//! An event with everything that a sink may want to tell of it.

use anyhow::Result;
use morec::live::{Event, Phase};

use crate::dates::with_millis;

/// An event, its class's name and its source.
#[derive(Debug, Clone, Copy)]
pub struct Said<'a> {
    /// What the session said.
    pub event: &'a Event,
    /// The class's name.
    pub class: &'a str,
    /// The source as it was typed.
    pub source: &'a str,
}

impl Said<'_> {
    /// Whether it is the final word on a motion.
    pub fn is_final(&self) -> bool {
        self.event.phase == Phase::End
    }

    /// As one line of JSON, without the line's end.
    pub fn json(&self) -> String {
        let e = self.event;
        serde_json::json!({
            "type": "motion",
            "phase": e.phase.name(),
            "class": self.class,
            "score": rounded(e.score, 4),
            "progress": rounded(e.progress, 3),
            "start_secs": rounded(e.start_secs, 4),
            "stop_secs": rounded(e.stop_secs, 4),
            "reported_secs": rounded(e.reported_secs, 4),
            "start_wall": with_millis(e.wall_at_secs(e.start_secs)),
            "stop_wall": with_millis(e.wall_at_secs(e.stop_secs)),
            "source": self.source,
            "actor": e.actor.0,
            "motion": e.motion,
            "seq": e.sequence,
        })
        .to_string()
    }
}

fn rounded(value: f64, digits: i32) -> f64 {
    let scale = 10f64.powi(digits);
    (value * scale).round() / scale
}

/// Takes events, one by one, without holding up whoever tells them.
pub trait Sink {
    /// Tells one event.
    fn tell(&mut self, said: &Said) -> Result<()>;
}
