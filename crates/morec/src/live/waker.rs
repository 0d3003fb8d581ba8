//! Sleep of a thread that has nothing to do, and its end.

use std::time::Duration;

// By this name, so that the models in `loom/` can put theirs in its place.
use super::sync::{AtomicBool, OnceLock, Ordering, Thread, current, park_timeout};

/// Longest sleep of a thread that missed its wake-up.
pub(super) const NAP: Duration = Duration::from_millis(20);

/// Lets one thread sleep until others have something for it.
#[derive(Debug, Default)]
pub(super) struct Waker {
    asleep: AtomicBool,
    thread: OnceLock<Thread>,
}

impl Waker {
    /// Wakes the sleeper, if it sleeps. Never waits.
    pub(super) fn wake(&self) {
        // Read and written at once, here and where the sleeper lies down: whichever comes second sees what the other
        // did before.
        if self.asleep.swap(false, Ordering::AcqRel)
            && let Some(thread) = self.thread.get()
        {
            thread.unpark();
        }
    }

    /// Sleeps for at most `most` unless `ready`, or until woken.
    pub(super) fn sleep(&self, most: Duration, ready: impl FnOnce() -> bool) {
        let me = current();
        // Another thread than the one that slept first is not woken; it looks again soon.
        let known = self.thread.get_or_init(|| me.clone()).id() == me.id();
        self.asleep.swap(true, Ordering::AcqRel);
        if !ready() {
            park_timeout(if known {
                most.min(NAP)
            } else {
                most.min(Duration::from_millis(2))
            });
        }
        self.asleep.swap(false, Ordering::AcqRel);
    }
}
