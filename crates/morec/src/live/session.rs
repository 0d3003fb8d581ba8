//! A session: a source, recognition and readers, each at its own pace on its own thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::broadcast::WorkerOptions;
use super::event::EventOptions;
use super::feed::{FeedReceiver, FeedSender, feed};
use super::status::{SessionCounters, Status, StatusHandle};
use super::waker::Waker;
use super::worker::{EventReader, StreamWorker, TurnOutcome};
use super::{
    Frame, Model, OverflowPolicy, RecognizerCache, SessionError, Source, SourceEvent, svrdm,
};

/// Distribution of recognition over threads. Events do not depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Threading {
    /// All of it on one thread.
    #[default]
    Inline,
    /// Each stage on its own thread, as in the thesis; for the method `svrdm` only. Uses six threads besides the source's for one
    /// stream, which can pay off if cores are idle.
    Stages,
}

/// How a session runs: threads, queues, what is reported.
#[derive(Debug, Clone)]
pub struct SessionOptions {
    /// Distribution of recognition over threads; pools are always inline.
    pub layout: Threading,
    /// Called first on every thread of the session with the purpose of the thread: `source`, `recognition`, or the stage. Can
    /// bind the thread to a core or set its priority.
    pub on_thread: Option<fn(&'static str)>,
    /// Selection of events.
    pub events: EventOptions,
    /// Behaviour when recognition or a reader is too slow.
    pub overload: OverflowPolicy,
    /// Frames that may wait for recognition.
    pub frame_capacity: usize,
    /// Events that may wait for each reader; at least 256.
    pub event_capacity: usize,
    /// Number of readers; each gets every event.
    pub readers: usize,
}

impl Default for SessionOptions {
    fn default() -> Self {
        Self {
            layout: Threading::default(),
            on_thread: None,
            events: EventOptions::default(),
            overload: OverflowPolicy::Wait,
            // Two seconds at 120 Hz: longer waits are no live recognition.
            frame_capacity: 240,
            event_capacity: 1024,
            readers: 1,
        }
    }
}

/// A source on a thread of its own, recognition on another, joined by bounded wait-free rings.
///
/// Events come out of [`EventReader`]s; [`status`](Session::status) can be read at any time. Neither a slow reader
/// nor a curious one holds up the stream unless [`OverflowPolicy::Wait`] asks for just that. The frame path takes no lock,
/// and no memory once every buffer has been round.
#[derive(Debug)]
pub struct Session {
    cells: Arc<SessionCounters>,
    stop: Arc<AtomicBool>,
    waker: Arc<Waker>,
    threads: Vec<JoinHandle<()>>,
    on_thread: Option<fn(&'static str)>,
}

impl Session {
    /// Starts recognising the poses of `source` on new threads. Returns the session and its readers of events.
    ///
    /// # Errors
    /// The parts of the model do not fit together, a thread cannot be started, or stages are requested for a method without them.
    pub fn start<M: Clone + Into<Model>>(
        model: &M,
        source: Box<dyn Source>,
        options: &SessionOptions,
    ) -> Result<(Self, Vec<EventReader>), SessionError> {
        let (mut session, sender, readers) = Self::open(model, options)?;
        let (cells, stop) = (session.cells.clone(), session.stop.clone());
        session.spawn(
            "source",
            Box::new(move || carry(source, sender, &cells, &stop)),
        )?;
        Ok((session, readers))
    }

    /// A session without a source, fed by the caller through the [`FeedSender`]. Dropping the sender ends the stream.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn open<M: Clone + Into<Model>>(
        model: &M,
        options: &SessionOptions,
    ) -> Result<(Self, FeedSender, Vec<EventReader>), SessionError> {
        let (cells, stop, waker) = (
            Arc::new(SessionCounters::default()),
            Arc::default(),
            Arc::new(Waker::default()),
        );
        let (sender, receiver) = feed(
            options.frame_capacity,
            options.overload,
            &waker,
            &cells.dropped_frames,
            &stop,
        );
        let worker_options = WorkerOptions {
            events: options.events.clone(),
            overload: options.overload,
            readers: options.readers,
            capacity: options.event_capacity,
        };
        let on_thread = options.on_thread;
        let mut session = Self {
            cells,
            stop,
            waker,
            threads: Vec::with_capacity(7),
            on_thread,
        };
        let readers = session.recognise(
            model.clone().into(),
            receiver,
            options.layout,
            &worker_options,
        )?;
        Ok((session, sender, readers))
    }

    fn recognise(
        &mut self,
        model: Model,
        feed: FeedReceiver,
        layout: Threading,
        options: &WorkerOptions,
    ) -> Result<Vec<EventReader>, SessionError> {
        let (cells, stop, waker) = (self.cells.clone(), self.stop.clone(), self.waker.clone());
        match (layout, model) {
            (Threading::Inline, model) => {
                let (worker, readers) = StreamWorker::new(
                    feed,
                    &Arc::new(RecognizerCache::new(&model)),
                    options,
                    &cells,
                    &stop,
                );
                self.spawn("recognition", Box::new(move || recognise(worker, &waker)))?;
                Ok(readers)
            }
            (Threading::Stages, Model::Svrdm(model)) => {
                let shared = svrdm::Shared {
                    cells: &cells,
                    stop: &stop,
                    waker: &waker,
                };
                svrdm::start(&model, feed, options, &shared, &mut |what, job| {
                    self.spawn(what, job)
                })
            }
            (Threading::Stages, other) => Err(SessionError::NoStages {
                method: other.method(),
            }),
        }
    }

    fn spawn(
        &mut self,
        what: &'static str,
        job: Box<dyn FnOnce() + Send>,
    ) -> Result<(), SessionError> {
        let named = thread::Builder::new().name(format!("morec {what}"));
        let on_thread = self.on_thread;
        let job = move || {
            if let Some(on_thread) = on_thread {
                on_thread(what);
            }
            job();
        };
        self.threads.push(
            named
                .spawn(job)
                .map_err(|error| SessionError::Thread { what, error })?,
        );
        Ok(())
    }

    /// Status of the session. Never waits, and never delays recognition.
    pub fn status(&self) -> Status {
        self.handle().get()
    }

    /// A handle for reading the status from other threads.
    pub fn handle(&self) -> StatusHandle {
        StatusHandle {
            cells: self.cells.clone(),
        }
    }

    /// Waits until the source has ended and all events are reported. With [`OverflowPolicy::Wait`], readers must continue reading
    /// meanwhile.
    pub fn join(mut self) -> Status {
        self.wait();
        self.status()
    }

    /// Ends the session now: fetches no more poses from the source, recognises those already fetched, and drops events for
    /// which a reader has no room; these are counted.
    pub fn stop(mut self) -> Status {
        self.end();
        self.status()
    }

    fn end(&mut self) {
        self.stop.store(true, Relaxed);
        self.waker.wake();
        self.wait();
    }

    fn wait(&mut self) {
        for thread in self.threads.drain(..) {
            // A thread that panicked has ended, too; its ends of the rings say so to the others.
            let _ = thread.join();
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.end();
    }
}

/// The source's thread.
fn carry(
    mut source: Box<dyn Source>,
    mut sender: FeedSender,
    cells: &SessionCounters,
    stop: &AtomicBool,
) {
    let mut frame: Box<Frame> = Box::default();
    while !stop.load(Relaxed) {
        match source.next(&mut frame) {
            SourceEvent::Frame => _ = sender.send(&mut frame),
            SourceEvent::Rig(actor, rig) => sender.set_rig(actor, &rig),
            SourceEvent::Gone(actor) => sender.end_performer(actor),
            SourceEvent::Quiet => {}
            SourceEvent::Ended => break,
        }
        cells.source(&source.counts());
    }
    cells.source(&source.counts());
}

/// Recognition's thread.
fn recognise(mut worker: StreamWorker, waker: &Waker) {
    loop {
        match worker.work(64) {
            TurnOutcome::Some => {}
            TurnOutcome::Idle => waker.sleep(Duration::from_millis(20), || worker.is_ready()),
            // Readers do not wake recognition: they would have to know of it.
            TurnOutcome::Blocked => thread::sleep(Duration::from_millis(1)),
            TurnOutcome::Ended => return,
        }
    }
}
