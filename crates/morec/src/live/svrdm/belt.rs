//! Boxes from one stage's thread to the next: a wait-free ring whose boxes come round again.

use std::sync::Arc;

use crate::live::waker::{NAP, Waker};

/// The end that boxes are put into. Dropping it ends the belt.
#[derive(Debug)]
pub(super) struct RingSender<T> {
    /// `None` only while it is being dropped.
    ring: Option<rtrb::Producer<Box<T>>>,
    waker: Arc<Waker>,
}

/// The end that boxes come out of.
#[derive(Debug)]
pub(super) struct RingReceiver<T> {
    ring: rtrb::Consumer<Box<T>>,
    waker: Arc<Waker>,
}

/// A belt with room for `boxes`, which must be all that there are: then there is room for each at any time. `waker` is
/// that of the thread that takes them.
pub(super) fn belt<T>(boxes: usize, waker: &Arc<Waker>) -> (RingSender<T>, RingReceiver<T>) {
    let (ring, taken) = rtrb::RingBuffer::new(boxes);
    (
        RingSender {
            ring: Some(ring),
            waker: waker.clone(),
        },
        RingReceiver {
            ring: taken,
            waker: waker.clone(),
        },
    )
}

impl<T> RingSender<T> {
    /// Sends a box. Never waits.
    pub(super) fn send(&mut self, item: Box<T>) {
        if let Some(ring) = &mut self.ring {
            // There is room for all boxes; if nobody takes them any more it does not matter.
            let _ = ring.push(item);
            self.waker.wake();
        }
    }
}

impl<T> Drop for RingSender<T> {
    fn drop(&mut self) {
        // First the end, then the call, so that the woken thread sees it.
        self.ring = None;
        self.waker.wake();
    }
}

impl<T> RingReceiver<T> {
    /// The next box; waits for it. `None` once the other end is gone and all it sent was taken.
    pub(super) fn next(&mut self) -> Option<Box<T>> {
        loop {
            if let Ok(item) = self.ring.pop() {
                return Some(item);
            }
            if self.ring.is_abandoned() {
                // What was sent before the end is seen after it.
                return self.ring.pop().ok();
            }
            self.waker
                .sleep(NAP, || !self.ring.is_empty() || self.ring.is_abandoned());
        }
    }
}
