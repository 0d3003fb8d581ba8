//! One stream's recognition: what a session's thread, or a thread of a pool, does with one feed.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

pub use super::broadcast::EventReader;
use super::broadcast::{EventBroadcast, WorkerOptions};
use super::feed::{FeedReceiver, QueueItem};
use super::performer::Performer;
use super::status::SessionCounters;
use super::{Frame, MAX_PERFORMERS, PerformerId, RecognizerCache, Rig, wall_now_secs};

/// Frames of a performer after which its diagnosis is renewed: a quarter of a second at 60 Hz.
const DIAGNOSE_EVERY: u64 = 16;

/// Result of a worker's turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TurnOutcome {
    /// There was something to do, and there may be more.
    Some,
    /// There was nothing.
    Idle,
    /// Readers must make room first.
    Blocked,
    /// The stream has ended, and everything is reported.
    Ended,
}

#[derive(Debug)]
pub(super) struct StreamWorker {
    feed: FeedReceiver,
    performers: Vec<Performer>,
    /// Frames that each performer has had.
    frames: [u64; MAX_PERFORMERS],
    broadcast: EventBroadcast,
    cells: Arc<SessionCounters>,
    stop: Arc<AtomicBool>,
    /// Frames of performers beyond those that can be followed.
    beyond: u64,
    /// The feed has ended, and the performers have said their last.
    finished: bool,
}

impl StreamWorker {
    /// A worker and its readers.
    pub(super) fn new(
        feed: FeedReceiver,
        cache: &Arc<RecognizerCache>,
        options: &WorkerOptions,
        cells: &Arc<SessionCounters>,
        stop: &Arc<AtomicBool>,
    ) -> (Self, Vec<EventReader>) {
        let (broadcast, readers) =
            EventBroadcast::new(options, cache.model().classes().len(), cells, stop);
        let performer = |i| Performer::sharing(cache, PerformerId(i as u16), &options.events);
        let worker = Self {
            feed,
            performers: (0..MAX_PERFORMERS).map(performer).collect(),
            frames: [0; MAX_PERFORMERS],
            broadcast,
            cells: cells.clone(),
            stop: stop.clone(),
            beyond: 0,
            finished: false,
        };
        (worker, readers)
    }

    /// True if there is something to do.
    pub(super) fn is_ready(&self) -> bool {
        self.feed.has_more() || self.feed.is_ended()
    }

    /// Takes up to `most` things from the feed.
    pub(super) fn work(&mut self, most: usize) -> TurnOutcome {
        let mut done = 0;
        loop {
            if !self.deliver() {
                return TurnOutcome::Blocked;
            }
            if self.finished {
                return TurnOutcome::Ended;
            }
            if done >= most {
                return TurnOutcome::Some;
            }
            match self.feed.next() {
                Some(QueueItem::Frame(frame)) => {
                    self.frame(&frame);
                    self.feed.give_back(frame);
                }
                Some(QueueItem::Rig(actor, rig)) => self.set_rig(actor, &rig),
                Some(QueueItem::Gone(actor)) => self.gone(actor),
                None if self.feed.is_ended() || self.stop.load(Relaxed) => {
                    (0..self.performers.len()).for_each(|i| self.gone(PerformerId(i as u16)));
                    self.finished = true;
                }
                None if done == 0 => return TurnOutcome::Idle,
                None => return TurnOutcome::Some,
            }
            done += 1;
        }
    }

    fn frame(&mut self, frame: &Frame) {
        match self.performers.get_mut(frame.actor.index()) {
            Some(performer) => {
                self.broadcast.keep(performer.push(frame));
                self.cells
                    .admits_strangers(frame.actor, performer.admits_strangers());
                let frames = &mut self.frames[frame.actor.index()];
                *frames += 1;
                if frames.is_multiple_of(DIAGNOSE_EVERY) {
                    self.cells.diagnosis(frame.actor, performer.diagnosis());
                }
            }
            None => self.beyond += 1,
        }
        self.cells.frame(frame, wall_now_secs());
    }

    fn set_rig(&mut self, actor: PerformerId, rig: &Arc<Rig>) {
        if let Some(performer) = self.performers.get_mut(actor.index()) {
            self.broadcast.keep(performer.set_rig(rig));
        }
    }

    fn gone(&mut self, actor: PerformerId) {
        if let Some(performer) = self.performers.get_mut(actor.index()) {
            self.broadcast.keep(performer.finish());
            self.cells.diagnosis(actor, performer.diagnosis());
            self.cells
                .admits_strangers(actor, performer.admits_strangers());
        }
    }

    /// Hands out what is pending; says whether nothing is left.
    fn deliver(&mut self) -> bool {
        if self.broadcast.has_pending() {
            self.count();
        }
        self.broadcast.deliver()
    }

    fn count(&self) {
        let sum = |of: fn(&Performer) -> u64| self.performers.iter().map(of).sum::<u64>();
        self.cells
            .suppressed
            .store(sum(Performer::suppressed), Relaxed);
        self.cells
            .dropped_detections
            .store(sum(Performer::dropped), Relaxed);
        self.cells
            .unusable
            .store(sum(Performer::unusable) + self.beyond, Relaxed);
    }
}

impl Drop for StreamWorker {
    fn drop(&mut self) {
        self.count();
        self.cells
            .ended
            .store(true, std::sync::atomic::Ordering::Release);
    }
}
