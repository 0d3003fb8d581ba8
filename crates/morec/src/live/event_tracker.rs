//! Turns detections into events: numbers motions and applies the refractory time.

use super::early::EarlyTracker;
use super::event_buffer::EventBuffer;
use super::{Detection, EarlyDetection, Phase};

/// Tells one performer's motions.
#[derive(Debug)]
pub(super) struct EventTracker {
    refractory_secs: f64,
    /// When the last motion ended that was reported: of all classes, and of each.
    any_secs: f64,
    class_secs: Vec<f64>,
    suppressed: u64,
}

impl EventTracker {
    pub(super) fn new(classes: usize, refractory_secs: f64) -> Self {
        let (any_secs, class_secs) = (f64::NEG_INFINITY, vec![f64::NEG_INFINITY; classes]);
        Self {
            refractory_secs,
            any_secs,
            class_secs,
            suppressed: 0,
        }
    }

    /// Tells the end of a motion, unless the refractory rule says otherwise.
    pub(super) fn emit(&mut self, d: &Detection, early: &mut EarlyTracker, out: &mut EventBuffer) {
        let before_secs = &mut self.class_secs[d.class.index()];
        // A method that lets rivals wait may report what ended first after what ended later.
        if (d.span.stop_secs - *before_secs).abs() < self.refractory_secs {
            self.suppressed += 1;
            early.cancel(Some(d.reported_secs), out);
            return;
        }
        *before_secs = before_secs.max(d.span.stop_secs);
        self.any_secs = self.any_secs.max(d.span.stop_secs);
        let motion = early.take(d).unwrap_or_else(|| out.new_motion());
        let ended = EarlyDetection {
            class: d.class,
            score: d.score,
            progress: 1.0,
            start_secs: d.span.start_secs,
            seen_secs: d.span.stop_secs,
            goes_on: false,
            repetitions: d.repetitions,
            whole: None,
        };
        early.end_repetitions(motion, &ended, d.reported_secs, out);
        out.add(Phase::End, motion, ended, d.reported_secs);
    }

    /// When the last motion ended that was reported.
    pub(super) fn last_stop_secs(&self) -> f64 {
        self.any_secs
    }

    /// A clock that begins anew must not find its motions refused for the old one's.
    pub(super) fn forget(&mut self) {
        self.any_secs = f64::NEG_INFINITY;
        self.class_secs.fill(f64::NEG_INFINITY);
    }

    /// Motions that were not reported because of the refractory rule.
    pub(super) fn suppressed(&self) -> u64 {
        self.suppressed
    }
}
