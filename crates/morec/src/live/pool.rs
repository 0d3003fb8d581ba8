//! Runs many streams in one process on a few threads.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::broadcast::WorkerOptions;
use super::feed::{FeedSender, Waker, feed};
use super::status::{SessionCounters, StatusHandle};
use super::worker::{EventReader, StreamWorker, TurnOutcome};
use super::{Model, RecognizerCache, SessionError, SessionOptions};

/// Streams that may wait to be taken up by a thread.
const OPENING: usize = 64;

/// Recognises many streams on a fixed number of threads.
///
/// A stream stays with the thread that took it up, so its frames keep their order and its detections do not depend
/// on what else goes on. Streams of the same bones share their templates. A stream is opened with
/// [`open`](Pool::open), fed from any thread, and ends when its [`FeedSender`] is dropped.
#[derive(Debug)]
pub struct Pool {
    cache: Arc<RecognizerCache>,
    workers: Vec<Worker>,
    stop: Arc<AtomicBool>,
}

#[derive(Debug)]
struct Worker {
    streams: Option<SyncSender<Box<StreamWorker>>>,
    /// Streams it has.
    load: Arc<AtomicUsize>,
    waker: Arc<Waker>,
    thread: Option<JoinHandle<()>>,
}

/// The caller's end of a stream that a pool follows.
#[derive(Debug)]
pub struct PoolStream {
    /// Input for frames. Dropping it ends the stream.
    pub feed: FeedSender,
    /// Outputs for events; as many as [`SessionOptions::readers`].
    pub readers: Vec<EventReader>,
    /// Status of the stream.
    pub status: StatusHandle,
}

impl Pool {
    /// A pool of `threads` threads, at least one.
    ///
    /// # Errors
    /// The model's parts do not fit together, or the system refuses a thread.
    pub fn new<M: Clone + Into<Model>>(model: &M, threads: usize) -> Result<Self, SessionError> {
        let mut pool = Self {
            cache: Arc::new(RecognizerCache::new(model)),
            workers: Vec::new(),
            stop: Arc::default(),
        };
        for _ in 0..threads.max(1) {
            let (streams, taken) = sync_channel(OPENING);
            let (load, waker) = (Arc::new(AtomicUsize::new(0)), Arc::new(Waker::default()));
            let job = {
                let (load, waker) = (load.clone(), waker.clone());
                move || serve(&taken, &load, &waker)
            };
            let thread = thread::Builder::new()
                .name("morec pool".to_owned())
                .spawn(job)
                .map_err(|error| SessionError::Thread {
                    what: "a pool",
                    error,
                })?;
            pool.workers.push(Worker {
                streams: Some(streams),
                load,
                waker,
                thread: Some(thread),
            });
        }
        Ok(pool)
    }

    /// Opens a stream on the thread that has the fewest. May wait for it to take up streams opened before.
    pub fn open(&self, options: &SessionOptions) -> PoolStream {
        // There is at least one worker, and a tie goes to the first.
        let least = self
            .workers
            .iter()
            .min_by_key(|worker| worker.load.load(Relaxed));
        let waker = least.map_or_else(Arc::default, |worker| worker.waker.clone());
        let cells = Arc::new(SessionCounters::default());
        let (feed, receiver) = feed(
            options.frame_capacity,
            options.overload,
            &waker,
            &cells.dropped_frames,
            &self.stop,
        );
        let stream_options = WorkerOptions {
            events: options.events.clone(),
            overload: options.overload,
            readers: options.readers,
            capacity: options.event_capacity,
        };
        let (stream, readers) =
            StreamWorker::new(receiver, &self.cache, &stream_options, &cells, &self.stop);
        if let Some(worker) = least {
            worker.load.fetch_add(1, Relaxed);
            // A thread that has died gives the stream back, and dropping it ends the stream.
            let _ = worker
                .streams
                .as_ref()
                .map(|streams| streams.send(Box::new(stream)));
            worker.waker.wake();
        }
        PoolStream {
            feed,
            readers,
            status: StatusHandle { cells },
        }
    }

    /// Streams that have not ended.
    pub fn streams(&self) -> usize {
        self.workers
            .iter()
            .map(|worker| worker.load.load(Relaxed))
            .sum()
    }

    /// Waits until every stream has ended: until every [`FeedSender`] is dropped, and read as its options demand.
    pub fn join(mut self) {
        self.wait();
    }

    fn wait(&mut self) {
        self.workers
            .iter_mut()
            .for_each(|worker| worker.streams = None);
        for worker in &mut self.workers {
            worker.waker.wake();
            if let Some(thread) = worker.thread.take() {
                // A thread that panicked has ended, too.
                let _ = thread.join();
            }
        }
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        self.stop.store(true, Relaxed);
        self.wait();
    }
}

/// A worker's thread: every stream in turn, a few frames each.
fn serve(opened: &Receiver<Box<StreamWorker>>, load: &AtomicUsize, waker: &Waker) {
    let mut streams: Vec<Box<StreamWorker>> = Vec::new();
    loop {
        let closed = loop {
            match opened.try_recv() {
                Ok(stream) => streams.push(stream),
                Err(TryRecvError::Empty) => break false,
                Err(TryRecvError::Disconnected) => break true,
            }
        };
        let (mut busy, mut blocked) = (false, false);
        streams.retain_mut(|stream| match stream.work(16) {
            TurnOutcome::Ended => {
                load.fetch_sub(1, Relaxed);
                false
            }
            outcome => {
                busy |= outcome == TurnOutcome::Some;
                blocked |= outcome == TurnOutcome::Blocked;
                true
            }
        });
        if closed && streams.is_empty() {
            return;
        }
        if !busy {
            let nap = Duration::from_millis(if blocked { 1 } else { 20 });
            waker.sleep(nap, || {
                streams.iter().any(|stream| stream.is_ready()) && !blocked
            });
        }
    }
}
