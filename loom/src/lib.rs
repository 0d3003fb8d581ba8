//! Models of the waking and sleeping of `crates/morec/src/live/waker.rs`, tried in every order of steps that two or
//! three threads can take, on every outcome that the memory model allows.
//!
//! Here nobody's sleep ends by itself: a call that is lost is a thread that sleeps for ever, which loom reports.

#[allow(dead_code)]
#[path = "../../crates/morec/src/live/waker.rs"]
mod waker;

mod sync {
    pub(super) use loom::sync::atomic::{AtomicBool, Ordering, fence};
    pub(super) use loom::thread::{Thread, current};

    /// Sleeps until it is called, however long that takes.
    pub(super) fn park_timeout(_: std::time::Duration) {
        loom::thread::park();
    }

    /// A value that is there for whoever sees the flag.
    #[derive(Debug)]
    pub(super) struct OnceLock<T> {
        set: AtomicBool,
        value: std::sync::OnceLock<T>,
    }

    impl<T> Default for OnceLock<T> {
        fn default() -> Self {
            Self { set: AtomicBool::new(false), value: std::sync::OnceLock::new() }
        }
    }

    impl<T> OnceLock<T> {
        pub(super) fn get(&self) -> Option<&T> {
            if self.set.load(Ordering::Acquire) { self.value.get() } else { None }
        }

        pub(super) fn get_or_init(&self, make: impl FnOnce() -> T) -> &T {
            let value = self.value.get_or_init(make);
            self.set.store(true, Ordering::Release);
            value
        }
    }
}

#[cfg(test)]
mod tests {
    use loom::sync::Arc;
    use loom::sync::atomic::{AtomicBool, AtomicUsize, Ordering::*};
    use loom::thread;

    use crate::waker::{NAP, Waker};

    /// Sleeps until `ready`.
    fn wait(waker: &Waker, ready: impl Fn() -> bool) {
        while !ready() {
            waker.sleep(NAP, &ready);
        }
    }

    #[test]
    fn a_call_after_the_news_is_never_lost() {
        loom::model(|| {
            let (waker, news) = (Arc::new(Waker::default()), Arc::new(AtomicBool::new(false)));
            let other = {
                let (waker, news) = (waker.clone(), news.clone());
                thread::spawn(move || {
                    news.store(true, Release);
                    waker.wake();
                })
            };
            wait(&waker, || news.load(Acquire));
            other.join().unwrap();
        });
    }

    /// A ring with two items: the sleeper takes the first and sleeps again.
    #[test]
    fn every_item_is_taken_and_then_the_end() {
        loom::model(|| {
            let waker = Arc::new(Waker::default());
            let (sent, ended) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicBool::new(false)));
            let other = {
                let (waker, sent, ended) = (waker.clone(), sent.clone(), ended.clone());
                thread::spawn(move || {
                    sent.store(1, Release);
                    waker.wake();
                    // As the belts do: first the end, then the call.
                    ended.store(true, Release);
                    waker.wake();
                })
            };
            let mut taken = 0;
            loop {
                if sent.load(Acquire) > taken {
                    taken += 1;
                } else if ended.load(Acquire) {
                    // What was sent before the end is seen after it.
                    taken += usize::from(sent.load(Acquire) > taken);
                    break;
                } else {
                    waker.sleep(NAP, || sent.load(Acquire) > taken || ended.load(Acquire));
                }
            }
            assert_eq!(taken, 1);
            other.join().unwrap();
        });
    }

    /// Segment assembly: chunks come from one side, used boxes from the other, and both call the same sleeper.
    #[test]
    fn two_who_call_the_same_sleeper_do_not_lose_each_others_calls() {
        let mut model = loom::model::Builder::new();
        model.preemption_bound = Some(3);
        model.check(|| {
            let waker = Arc::new(Waker::default());
            let news = [(); 2].map(|()| Arc::new(AtomicBool::new(false)));
            let others = news.clone().map(|news| {
                let waker = waker.clone();
                thread::spawn(move || {
                    news.store(true, Release);
                    waker.wake();
                })
            });
            wait(&waker, || news[0].load(Acquire));
            wait(&waker, || news[1].load(Acquire));
            others.map(|other| other.join().unwrap());
        });
    }

    /// A session that is stopped: the flag needs no order of its own, the call makes it seen.
    #[test]
    fn a_flag_without_an_order_is_seen_after_the_call() {
        loom::model(|| {
            let (waker, stop) = (Arc::new(Waker::default()), Arc::new(AtomicBool::new(false)));
            let other = {
                let (waker, stop) = (waker.clone(), stop.clone());
                thread::spawn(move || {
                    stop.store(true, Relaxed);
                    waker.wake();
                })
            };
            wait(&waker, || stop.load(Relaxed));
            other.join().unwrap();
        });
    }
}
