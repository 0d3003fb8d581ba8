//! Delivers the events of a session: one ring buffer for each reader, so that a slow reader delays nobody.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

use super::status::SessionCounters;
use super::waker::Waker;
use super::{Event, EventOptions, OverflowPolicy};

/// Events that one frame can give at most, with room to spare, beside progress: what is kept while readers are full.
const PENDING: usize = 256;

#[derive(Debug, Clone)]
pub(super) struct WorkerOptions {
    pub(super) events: EventOptions,
    pub(super) overload: OverflowPolicy,
    pub(super) readers: usize,
    pub(super) capacity: usize,
}

/// The end of a session that events come out of.
#[derive(Debug)]
pub struct EventReader {
    events: rtrb::Consumer<Event>,
    waker: Arc<Waker>,
}

impl EventReader {
    /// The next event, if there is one. Never waits.
    pub fn pop(&mut self) -> Option<Event> {
        self.events.pop().ok()
    }

    /// The next event; waits for it for at most `most`. `None` also once the stream has [ended](Self::is_ended).
    pub fn wait(&mut self, most: Duration) -> Option<Event> {
        let begun = std::time::Instant::now();
        loop {
            if let Some(event) = self.pop() {
                return Some(event);
            }
            let left = most
                .checked_sub(begun.elapsed())
                .filter(|left| !left.is_zero())?;
            if self.is_ended() {
                return self.pop();
            }
            self.waker.sleep(left, || {
                !self.events.is_empty() || self.events.is_abandoned()
            });
        }
    }

    /// True if the stream has ended and every event has been taken.
    pub fn is_ended(&self) -> bool {
        self.events.is_abandoned() && self.events.is_empty()
    }
}

#[derive(Debug)]
struct EventSender {
    events: rtrb::Producer<Event>,
    waker: Arc<Waker>,
}

impl Drop for EventSender {
    fn drop(&mut self) {
        self.waker.wake();
    }
}

/// The readers of a stream, and what waits to be handed to them.
#[derive(Debug)]
pub(super) struct EventBroadcast {
    broadcast: Vec<EventSender>,
    pending: Vec<Event>,
    cells: Arc<SessionCounters>,
    stop: Arc<AtomicBool>,
    overload: OverflowPolicy,
    sequence: u64,
}

impl EventBroadcast {
    /// Outlets and their readers, for a model of so many classes.
    pub(super) fn new(
        options: &WorkerOptions,
        classes: usize,
        cells: &Arc<SessionCounters>,
        stop: &Arc<AtomicBool>,
    ) -> (Self, Vec<EventReader>) {
        let pending = PENDING + if options.events.progress { classes } else { 0 };
        let pair = || {
            let (events, taken) = rtrb::RingBuffer::new(options.capacity.max(pending));
            let waker = Arc::new(Waker::default());
            (
                EventSender {
                    events,
                    waker: waker.clone(),
                },
                EventReader {
                    events: taken,
                    waker,
                },
            )
        };
        let (broadcast, readers) = (0..options.readers.max(1)).map(|_| pair()).unzip();
        let broadcast = Self {
            broadcast,
            pending: Vec::with_capacity(pending),
            cells: cells.clone(),
            stop: stop.clone(),
            overload: options.overload,
            sequence: 0,
        };
        (broadcast, readers)
    }

    /// Puts events where the next delivery takes them from.
    pub(super) fn keep(&mut self, events: &[Event]) {
        // A frame settles a few motions at most; the buffer never grows.
        let room = self.pending.capacity() - self.pending.len();
        let kept = events.len().min(room);
        self.pending.extend_from_slice(&events[..kept]);
        if kept < events.len() {
            let dropped = (events.len() - kept) as u64;
            self.cells.dropped_events.fetch_add(dropped, Relaxed);
        }
    }

    pub(super) fn has_pending(&self) -> bool {
        !self.pending.is_empty()
    }

    /// Hands out what is pending; says whether nothing is left. Something is only if [`OverflowPolicy::Wait`] holds, a
    /// reader has no room and the session goes on.
    pub(super) fn deliver(&mut self) -> bool {
        if self.pending.is_empty() {
            return true;
        }
        self.broadcast
            .retain(|outlet| !outlet.events.is_abandoned());
        let waits = self.overload == OverflowPolicy::Wait && !self.stop.load(Relaxed);
        if waits
            && self
                .broadcast
                .iter()
                .any(|outlet| outlet.events.slots() < self.pending.len())
        {
            return false;
        }
        for event in &mut self.pending {
            self.sequence += 1;
            event.sequence = self.sequence;
            self.cells.event(event);
            for outlet in &mut self.broadcast {
                if outlet.events.push(*event).is_err() {
                    self.cells.dropped_events.fetch_add(1, Relaxed);
                }
            }
        }
        self.pending.clear();
        self.broadcast.iter().for_each(|outlet| outlet.waker.wake());
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classes::ClassId;
    use crate::live::{EventOptions, PerformerId, Phase};

    #[test]
    fn what_there_is_no_room_for_is_counted() {
        let options = WorkerOptions {
            events: EventOptions::default(),
            overload: OverflowPolicy::Wait,
            readers: 1,
            capacity: PENDING,
        };
        let (cells, stop) = (Arc::new(SessionCounters::default()), Arc::default());
        let (mut broadcast, mut readers) = EventBroadcast::new(&options, 1, &cells, &stop);
        let event = Event {
            phase: Phase::End,
            motion: 1,
            sequence: 0,
            actor: PerformerId(0),
            class: ClassId(0),
            score: 1.0,
            progress: 1.0,
            span: crate::TimeSpan::new(0.0, 1.0),
            reported_secs: 1.0,
            wall_secs: 0.0,
            repetitions: None,
            pace: None,
            deviation: None,
        };
        (0..PENDING + 3).for_each(|_| broadcast.keep(&[event]));
        assert!(broadcast.deliver());
        let taken = std::iter::from_fn(|| readers[0].pop()).count();
        let dropped = cells.dropped_events.load(Relaxed);
        assert_eq!((taken, dropped), (PENDING, 3));
    }
}
