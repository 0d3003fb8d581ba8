//! The events of one push.

use super::{EarlyDetection, Event, PerformerId, Phase};
use crate::TimeSpan;
use crate::templates::Deviation;

/// Events that one frame gives at most in practice: room is made for as many.
const ROOM: usize = 96;

/// Events of one performer's last push: numbers motions and events, and gives events their common parts.
#[derive(Debug, Default)]
pub(super) struct EventBuffer {
    actor: PerformerId,
    wall_secs: f64,
    motions: u64,
    sequence: u64,
    events: Vec<Event>,
}

impl EventBuffer {
    pub(super) fn new(actor: PerformerId) -> Self {
        Self {
            actor,
            ..Self::default()
        }
    }

    /// Takes the memory that pushes need, of which `more` events beyond the usual ones.
    pub(super) fn reserve(&mut self, more: usize) {
        self.events.reserve(ROOM + more);
    }

    /// Begins another push: the events of the last one are gone.
    pub(super) fn clear(&mut self) {
        self.events.clear();
    }

    /// Events from now on are settled by a frame that arrived at `wall_secs`.
    pub(super) fn arrive(&mut self, wall_secs: f64) {
        self.wall_secs = wall_secs;
    }

    pub(super) fn events(&self) -> &[Event] {
        &self.events
    }

    /// Notes how far performances that ended were from samples, as `measured` says.
    pub(super) fn compare(&mut self, mut measured: impl FnMut(&Event) -> Option<Deviation>) {
        let ended = |event: &&mut Event| matches!(event.phase, Phase::End | Phase::Repetition);
        for event in self.events.iter_mut().filter(ended) {
            event.deviation = measured(event);
            event.pace = event.deviation.map(|deviation| deviation.pace);
        }
    }

    pub(super) fn new_motion(&mut self) -> u64 {
        self.motions += 1;
        self.motions
    }

    pub(super) fn add(
        &mut self,
        phase: Phase,
        motion: u64,
        what: EarlyDetection,
        reported_secs: f64,
    ) {
        self.sequence += 1;
        self.events.push(Event {
            phase,
            motion,
            sequence: self.sequence,
            actor: self.actor,
            class: what.class,
            score: what.score,
            progress: what.progress,
            span: TimeSpan::new(what.start_secs, what.seen_secs),
            reported_secs,
            wall_secs: self.wall_secs,
            repetitions: what.repetitions,
            pace: None,
            deviation: None,
        });
    }

    /// Adds how far a class has come, which is no motion yet.
    pub(super) fn add_progress(&mut self, of: EarlyDetection, pace: f64, reported_secs: f64) {
        self.add(Phase::Progress, 0, of, reported_secs);
        if let Some(event) = self.events.last_mut() {
            event.pace = Some(pace);
        }
    }
}
