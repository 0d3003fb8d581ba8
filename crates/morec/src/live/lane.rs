//! One stream's recognition: what a session's thread, or a thread of a pool, does with one feed.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use crate::features::BoneSet;
use crate::templates::TemplateModel;

use super::feed::{FeedReceiver, Item, Waker};
use super::performer::{EventOptions, Performer};
use super::status::Cells;
use super::{Actor, Event, Frame, MAX_ACTORS, Overload, Recognizer, Rig, wall_now_secs};

/// Events that one frame can give at most, with room to spare: what a lane keeps while its readers are full.
const PENDING: usize = 256;

/// Recognisers ready to be copied, one for each set of bones that has come up.
#[derive(Debug)]
pub(super) struct Stock {
    model: Arc<TemplateModel>,
    made: Mutex<Vec<(BoneSet, Option<Recognizer>)>>,
}

impl Stock {
    pub(super) fn new(model: &Arc<TemplateModel>) -> Self {
        Self { model: model.clone(), made: Mutex::new(Vec::new()) }
    }

    /// A recogniser for `bones`; its templates are shared with all others of the same bones. `None` if the index and
    /// the stream have no bone in common. Takes the lock, at a new skeleton only.
    fn get(&self, bones: BoneSet) -> Option<Recognizer> {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = made.iter().find(|(of, _)| *of == bones) {
            return known.clone();
        }
        let new = Recognizer::new(&self.model, bones).ok();
        made.push((bones, new.clone()));
        new
    }
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
            let left = most.checked_sub(begun.elapsed()).filter(|left| !left.is_zero())?;
            if self.is_ended() {
                return self.pop();
            }
            self.waker.sleep(left, || !self.events.is_empty() || self.events.is_abandoned());
        }
    }

    /// Whether the stream has ended and every event has been taken.
    pub fn is_ended(&self) -> bool {
        self.events.is_abandoned() && self.events.is_empty()
    }
}

#[derive(Debug)]
struct Outlet {
    events: rtrb::Producer<Event>,
    waker: Arc<Waker>,
}

impl Drop for Outlet {
    fn drop(&mut self) {
        self.waker.wake();
    }
}

/// What became of a lane's turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Work {
    /// There was something to do, and there may be more.
    Some,
    /// There was nothing.
    Idle,
    /// Readers must make room first.
    Blocked,
    /// The stream has ended, and everything is told.
    Ended,
}

/// How a lane is run.
#[derive(Debug, Clone)]
pub(super) struct LaneOptions {
    pub(super) events: EventOptions,
    pub(super) overload: Overload,
    pub(super) readers: usize,
    pub(super) capacity: usize,
}

#[derive(Debug)]
pub(super) struct Lane {
    feed: FeedReceiver,
    performers: Vec<Performer>,
    stock: Arc<Stock>,
    outlets: Vec<Outlet>,
    pending: Vec<Event>,
    cells: Arc<Cells>,
    stop: Arc<AtomicBool>,
    overload: Overload,
    sequence: u64,
    /// The feed has ended, and the performers have said their last.
    finished: bool,
}

impl Lane {
    /// A lane and its readers.
    pub(super) fn new(
        feed: FeedReceiver,
        stock: &Arc<Stock>,
        options: &LaneOptions,
        cells: &Arc<Cells>,
        stop: &Arc<AtomicBool>,
    ) -> (Self, Vec<EventReader>) {
        let pair = || {
            let (events, taken) = rtrb::RingBuffer::new(options.capacity.max(PENDING));
            let waker = Arc::new(Waker::default());
            (Outlet { events, waker: waker.clone() }, EventReader { events: taken, waker })
        };
        let (outlets, readers) = (0..options.readers.max(1)).map(|_| pair()).unzip();
        let performer = |i| Performer::new(&stock.model, Actor(i as u16), &options.events);
        let lane = Self {
            feed,
            performers: (0..MAX_ACTORS).map(performer).collect(),
            stock: stock.clone(),
            outlets,
            pending: Vec::with_capacity(PENDING),
            cells: cells.clone(),
            stop: stop.clone(),
            overload: options.overload,
            sequence: 0,
            finished: false,
        };
        (lane, readers)
    }

    /// Whether there is something to do.
    pub(super) fn is_ready(&self) -> bool {
        self.feed.has_more() || self.feed.is_ended()
    }

    /// Takes up to `most` things from the feed.
    pub(super) fn work(&mut self, most: usize) -> Work {
        let mut done = 0;
        loop {
            if !self.deliver() {
                return Work::Blocked;
            }
            if self.finished {
                return Work::Ended;
            }
            if done >= most {
                return Work::Some;
            }
            match self.feed.next() {
                Some(Item::Frame(frame)) => {
                    self.frame(&frame);
                    self.feed.give_back(frame);
                }
                Some(Item::Rig(actor, rig)) => self.set_rig(actor, &rig),
                Some(Item::Gone(actor)) => self.gone(actor),
                None if self.feed.is_ended() || self.stop.load(Relaxed) => {
                    (0..self.performers.len()).for_each(|i| self.gone(Actor(i as u16)));
                    self.finished = true;
                }
                None if done == 0 => return Work::Idle,
                None => return Work::Some,
            }
            done += 1;
        }
    }

    fn frame(&mut self, frame: &Frame) {
        match self.performers.get_mut(frame.actor.index()) {
            Some(performer) => {
                let (stock, pending) = (&self.stock, &mut self.pending);
                performer.push(frame, &mut |bones| stock.get(bones), &mut |event| keep(pending, event));
            }
            None => _ = self.cells.unusable.fetch_add(1, Relaxed),
        }
        self.cells.frame(frame, wall_now_secs());
    }

    fn set_rig(&mut self, actor: Actor, rig: &Arc<Rig>) {
        if let Some(performer) = self.performers.get_mut(actor.index()) {
            performer.set_rig(rig, &mut |event| keep(&mut self.pending, event));
        }
    }

    fn gone(&mut self, actor: Actor) {
        if let Some(performer) = self.performers.get_mut(actor.index()) {
            performer.finish(&mut |event| keep(&mut self.pending, event));
        }
    }

    /// Hands out what is pending; says whether nothing is left.
    fn deliver(&mut self) -> bool {
        if self.pending.is_empty() {
            return true;
        }
        self.outlets.retain(|outlet| !outlet.events.is_abandoned());
        let waits = self.overload == Overload::Wait && !self.stop.load(Relaxed);
        if waits && self.outlets.iter().any(|outlet| outlet.events.slots() < self.pending.len()) {
            return false;
        }
        for event in &mut self.pending {
            self.sequence += 1;
            event.sequence = self.sequence;
            self.cells.event(event);
            for outlet in &mut self.outlets {
                if outlet.events.push(*event).is_err() {
                    self.cells.dropped_events.fetch_add(1, Relaxed);
                }
            }
        }
        self.pending.clear();
        self.outlets.iter().for_each(|outlet| outlet.waker.wake());
        let sum = |of: fn(&Performer) -> u64| self.performers.iter().map(of).sum();
        self.cells.suppressed.store(sum(Performer::suppressed), Relaxed);
        self.cells.unusable.store(sum(Performer::unusable), Relaxed);
        true
    }
}

impl Drop for Lane {
    fn drop(&mut self) {
        let sum = |of: fn(&Performer) -> u64| self.performers.iter().map(of).sum();
        self.cells.suppressed.store(sum(Performer::suppressed), Relaxed);
        self.cells.unusable.store(sum(Performer::unusable), Relaxed);
        self.cells.ended.store(true, std::sync::atomic::Ordering::Release);
    }
}

fn keep(pending: &mut Vec<Event>, event: Event) {
    // A frame settles a few motions at most; the buffer never grows.
    if pending.len() < pending.capacity() {
        pending.push(event);
    }
}
