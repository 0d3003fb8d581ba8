//! Models of the waking and sleeping of `crates/morec/src/live/waker.rs`, tried in every order of steps that two or
//! three threads can take, on every outcome that the memory model allows.
//!
//! Here nobody's sleep ends by itself: a call that is lost is a thread that sleeps for ever, which loom reports.

#[allow(dead_code)]
#[path = "../../crates/morec/src/live/waker.rs"]
mod waker;

mod sync {
    pub(super) use loom::sync::atomic::{AtomicBool, Ordering};
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
            Self {
                set: AtomicBool::new(false),
                value: std::sync::OnceLock::new(),
            }
        }
    }

    impl<T> OnceLock<T> {
        pub(super) fn get(&self) -> Option<&T> {
            if self.set.load(Ordering::Acquire) {
                self.value.get()
            } else {
                None
            }
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

    /// Runs `sleeper` beside `others`, each on its own thread. (Who joins must not be the sleeper: a call that comes
    /// when nobody sleeps any more would end loom's joining, too.)
    fn model(make: impl Fn() -> (Job, Vec<Job>) + Send + Sync + 'static) {
        let mut builder = loom::model::Builder::new();
        builder.preemption_bound = Some(3);
        builder.check(move || {
            let (sleeper, others) = make();
            let threads: Vec<_> = [sleeper]
                .into_iter()
                .chain(others)
                .map(thread::spawn)
                .collect();
            threads
                .into_iter()
                .for_each(|thread| thread.join().unwrap());
        });
    }

    type Job = Box<dyn FnOnce() + Send>;

    /// Sleeps until `ready`.
    fn wait(waker: &Waker, ready: impl Fn() -> bool) {
        while !ready() {
            waker.sleep(NAP, &ready);
        }
    }

    fn setting(
        flag: &Arc<AtomicBool>,
        order: std::sync::atomic::Ordering,
        waker: &Arc<Waker>,
    ) -> Job {
        let (flag, waker) = (flag.clone(), waker.clone());
        Box::new(move || {
            flag.store(true, order);
            waker.wake();
        })
    }

    #[test]
    fn a_call_after_the_news_is_never_lost() {
        model(|| {
            let (waker, news) = (Arc::new(Waker::default()), Arc::new(AtomicBool::new(false)));
            let other = setting(&news, Release, &waker);
            (
                Box::new(move || wait(&waker, || news.load(Acquire))),
                vec![other],
            )
        });
    }

    /// A session that is stopped: the flag needs no order of its own, the call makes it seen.
    #[test]
    fn a_flag_without_an_order_is_seen_after_the_call() {
        model(|| {
            let (waker, stop) = (Arc::new(Waker::default()), Arc::new(AtomicBool::new(false)));
            let other = setting(&stop, Relaxed, &waker);
            (
                Box::new(move || wait(&waker, || stop.load(Relaxed))),
                vec![other],
            )
        });
    }

    /// A belt: an item is taken, and then the end is seen.
    #[test]
    fn every_item_is_taken_and_then_the_end() {
        model(|| {
            let waker = Arc::new(Waker::default());
            let (sent, ended) = (
                Arc::new(AtomicUsize::new(0)),
                Arc::new(AtomicBool::new(false)),
            );
            let other: Job = {
                let (waker, sent, ended) = (waker.clone(), sent.clone(), ended.clone());
                Box::new(move || {
                    sent.store(1, Release);
                    waker.wake();
                    // As the belts do: first the end, then the call.
                    ended.store(true, Release);
                    waker.wake();
                })
            };
            let sleeper = move || {
                wait(&waker, || sent.load(Acquire) > 0 || ended.load(Acquire));
                // What was sent before the end is seen after it.
                assert_eq!(sent.load(Acquire), 1);
                wait(&waker, || ended.load(Acquire));
            };
            (Box::new(sleeper), vec![other])
        });
    }

    /// Segment assembly: chunks come from one side, used boxes from the other, and both call the same sleeper.
    #[test]
    fn two_who_call_the_same_sleeper_do_not_lose_each_others_calls() {
        model(|| {
            let waker = Arc::new(Waker::default());
            let news = [(); 2].map(|()| Arc::new(AtomicBool::new(false)));
            let others = news
                .iter()
                .map(|news| setting(news, Release, &waker))
                .collect();
            let sleeper = move || {
                wait(&waker, || news[0].load(Acquire));
                wait(&waker, || news[1].load(Acquire));
            };
            (Box::new(sleeper), others)
        });
    }
}
