//! Emission of one performer's events.

use super::{EarlyDetection, Event, PerformerId, Phase};
use crate::TimeSpan;

/// Numbers motions and gives events their common parts.
pub(super) struct EventEmitter<'a, F: FnMut(Event)> {
    pub(super) actor: PerformerId,
    pub(super) wall_secs: f64,
    pub(super) motions: &'a mut u64,
    pub(super) out: &'a mut F,
}

impl<F: FnMut(Event)> EventEmitter<'_, F> {
    pub(super) fn new_motion(&mut self) -> u64 {
        *self.motions += 1;
        *self.motions
    }

    pub(super) fn event(
        &mut self,
        phase: Phase,
        motion: u64,
        what: EarlyDetection,
        reported_secs: f64,
    ) {
        (self.out)(Event {
            phase,
            motion,
            // Whoever carries events out numbers them.
            sequence: 0,
            actor: self.actor,
            class: what.class,
            score: what.score,
            progress: what.progress,
            span: TimeSpan::new(what.start_secs, what.seen_secs),
            reported_secs,
            wall_secs: self.wall_secs,
            repetitions: what.repetitions,
        });
    }
}
