//! Passes frames from one thread to another over a bounded, wait-free ring that reuses its buffers.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

pub(super) use super::waker::Waker;

use super::waker::NAP;
use super::{Frame, PerformerId, Rig, SourceItem};

/// Fate of a frame that arrives while earlier frames still wait for recognition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OverflowPolicy {
    /// The source waits for room. Nothing is lost and the outcome does not depend on timing: for files.
    #[default]
    Wait,
    /// The new frame is dropped and counted; the source is never held up: for devices that go on regardless.
    Drop,
}

/// An item of the ring.
pub(super) type QueueItem = SourceItem<Box<Frame>>;

/// Room for skeletons beside the frames, so that these are never dropped for lack of it.
const BESIDE_FRAMES: usize = 16;

/// The end of a feed that frames are put into. Dropping it ends the stream.
#[derive(Debug)]
pub struct FeedSender {
    items: rtrb::Producer<QueueItem>,
    spare: rtrb::Consumer<Box<Frame>>,
    overload: OverflowPolicy,
    wakers: Arc<Wakers>,
    dropped: Arc<AtomicU64>,
    stop: Arc<AtomicBool>,
}

/// The end that frames come out of.
#[derive(Debug)]
pub(super) struct FeedReceiver {
    items: rtrb::Consumer<QueueItem>,
    spare: rtrb::Producer<Box<Frame>>,
    wakers: Arc<Wakers>,
}

#[derive(Debug)]
struct Wakers {
    /// Waits for frames; shared with other feeds that the same thread serves.
    receiver: Arc<Waker>,
    /// Waits for room.
    sender: Waker,
}

/// A ring for `frames` frames whose receiver is woken by `receiver`; it counts what it drops in `dropped` and gives up
/// waiting when `stop` is set.
pub(super) fn feed(
    frames: usize,
    overload: OverflowPolicy,
    receiver: &Arc<Waker>,
    dropped: &Arc<AtomicU64>,
    stop: &Arc<AtomicBool>,
) -> (FeedSender, FeedReceiver) {
    let frames = frames.max(1);
    let (items, taken) = rtrb::RingBuffer::new(frames + BESIDE_FRAMES);
    let (mut back, spare) = rtrb::RingBuffer::new(frames);
    for _ in 0..frames {
        // There is room for exactly as many.
        let _ = back.push(Box::default());
    }
    let wakers = Arc::new(Wakers {
        receiver: receiver.clone(),
        sender: Waker::default(),
    });
    let (dropped, stop) = (dropped.clone(), stop.clone());
    let sender = FeedSender {
        items,
        spare,
        overload,
        wakers: wakers.clone(),
        dropped,
        stop,
    };
    (
        sender,
        FeedReceiver {
            items: taken,
            spare: back,
            wakers,
        },
    )
}

impl FeedSender {
    /// Sends `frame` and leaves a used one in its place, to be filled anew. Returns whether it went: not if the ring
    /// was full and [`OverflowPolicy::Drop`] holds (it is then counted), nor if the session has ended. Takes no memory.
    pub fn send(&mut self, frame: &mut Box<Frame>) -> bool {
        loop {
            if let Ok(spare) = self.spare.pop() {
                let full = std::mem::replace(frame, spare);
                return self.push(QueueItem::Frame(full));
            }
            if self.items.is_abandoned() || self.stop.load(Ordering::Relaxed) {
                return false;
            }
            if self.overload == OverflowPolicy::Drop {
                self.dropped.fetch_add(1, Ordering::Relaxed);
                return false;
            }
            self.wait(|s| !s.spare.is_empty());
        }
    }

    /// Announces that the next frames of `actor` are poses of `rig`. Waits while the queue is full, so it is never dropped.
    pub fn set_rig(&mut self, actor: PerformerId, rig: &Arc<Rig>) {
        self.push(QueueItem::Rig(actor, rig.clone()));
    }

    /// Announces that `actor` has stopped for now. Waits while the queue is full.
    pub fn end_performer(&mut self, actor: PerformerId) {
        self.push(QueueItem::Gone(actor));
    }

    /// Frames there is room for now.
    pub fn available(&self) -> usize {
        self.spare.slots()
    }

    fn push(&mut self, item: QueueItem) -> bool {
        let mut item = item;
        loop {
            match self.items.push(item) {
                Ok(()) => {
                    self.wakers.receiver.wake();
                    return true;
                }
                Err(rtrb::PushError::Full(back)) => item = back,
            }
            if self.items.is_abandoned() || self.stop.load(Ordering::Relaxed) {
                return false;
            }
            self.wait(|s| !s.items.is_full());
        }
    }

    fn wait(&self, ready: impl Fn(&Self) -> bool) {
        let over = || self.items.is_abandoned() || self.stop.load(Ordering::Relaxed);
        self.wakers.sender.sleep(NAP, || ready(self) || over());
    }
}

impl Drop for FeedSender {
    fn drop(&mut self) {
        // The receiver must not sleep through the end. It sees the end once the ring's half is dropped, after this:
        // a nap is the longest it can miss it by.
        self.wakers.receiver.wake();
    }
}

impl FeedReceiver {
    pub(super) fn next(&mut self) -> Option<QueueItem> {
        self.items.pop().ok()
    }

    /// Gives a frame's buffer back to the sender.
    pub(super) fn give_back(&mut self, frame: Box<Frame>) {
        // As many go round as there is room for; after the sender's end it does not matter.
        let _ = self.spare.push(frame);
        self.wakers.sender.wake();
    }

    /// True if something waits to be taken.
    pub(super) fn has_more(&self) -> bool {
        !self.items.is_empty()
    }

    /// True if the sender is gone and everything it sent was taken.
    pub(super) fn is_ended(&self) -> bool {
        // In this order: what was sent before the end is seen after it.
        self.items.is_abandoned() && self.items.is_empty()
    }
}
