//! The stream behind a recogniser's handle: pushing frames and polling events, without unsafe code.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

use morec::diagnosis::Diagnosis;
use morec::index::MotionIndex;
use morec::live::{Event, Frame, PerformerStream, StreamError, StreamOptions};

use crate::MorecStatus;
use crate::axes::Convention;
use crate::frame::CheckedFrame;
use crate::skeleton::{self, Declared};
use crate::status::CallError;

/// Events that one frame can settle at most beside progress, with room to spare; no frame is taken with less.
const ROOM: usize = 96;
/// Events that can wait by default.
const USUAL_EVENTS: usize = 256;
/// The fewest, and the most.
const EVENTS: std::ops::RangeInclusive<usize> = 128..=1 << 20;

/// A recogniser with a queue of events behind it. One thread may push while another polls.
pub(crate) struct Stream {
    declared: Declared,
    convention: Convention,
    input: Mutex<StreamInput>,
    output: Mutex<rtrb::Consumer<Event>>,
    counts: StreamCounts,
    latency_secs: f64,
    /// Events that one frame can settle at most.
    room: usize,
}

struct StreamInput {
    stream: PerformerStream,
    frame: Frame,
    events: rtrb::Producer<Event>,
}

#[derive(Debug, Default)]
struct StreamCounts {
    frames: AtomicU64,
    refused: AtomicU64,
    events: AtomicU64,
    lost: AtomicU64,
    suppressed: AtomicU64,
}

/// Counts since the stream began.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StreamStatus {
    pub(crate) frames: u64,
    pub(crate) refused_frames: u64,
    pub(crate) events: u64,
    pub(crate) lost_events: u64,
    pub(crate) suppressed: u64,
    pub(crate) latency_secs: f64,
}

impl Stream {
    /// A stream of what `declared` shows; `event_capacity` events can wait to be polled, 0 for the usual number.
    pub(crate) fn new(
        index: &Arc<MotionIndex>,
        declared: Declared,
        convention: Convention,
        options: &StreamOptions,
        event_capacity: usize,
    ) -> Result<Self, CallError> {
        let capacity = match event_capacity {
            0 => USUAL_EVENTS,
            capacity if EVENTS.contains(&capacity) => capacity,
            capacity => {
                let text = format!("event_capacity is {capacity}, expected 0 or {EVENTS:?}");
                return Err(CallError::invalid(text));
            }
        };
        if index.model.needs_rotations() && declared.rig == skeleton::body() {
            let text = "the index needs joint rotations: declare a skeleton and give rotations";
            return Err(CallError::new(
                MorecStatus::NothingInCommon,
                text.to_owned(),
            ));
        }
        let followed = index.model.classes().len();
        let room = ROOM + if options.progress { followed } else { 0 };
        let (rig, bones) = (declared.rig.clone(), Some(declared.bones));
        let stream = PerformerStream::of_rig(index, rig, bones, options).map_err(refusal)?;
        let (producer, consumer) = rtrb::RingBuffer::new(capacity.max(room));
        let input = StreamInput {
            stream,
            frame: Frame::default(),
            events: producer,
        };
        Ok(Self {
            latency_secs: input.stream.latency_secs().unwrap_or_default(),
            declared,
            convention,
            input: Mutex::new(input),
            output: Mutex::new(consumer),
            counts: StreamCounts::default(),
            room,
        })
    }

    /// What the caller declared of the stream.
    pub(crate) fn declared(&self) -> &Declared {
        &self.declared
    }

    /// Takes a frame; its events go to the queue.
    pub(crate) fn push(&self, given: &CheckedFrame) -> Result<(), CallError> {
        let input = &mut *turn(&self.input)?;
        self.make_room(input)?;
        given.pose(&self.declared, &self.convention, &mut input.frame)?;
        let settled = input.stream.push(&input.frame);
        self.queue(settled, &mut input.events);
        self.counts.frames.fetch_add(1, Relaxed);
        let suppressed = input.stream.suppressed();
        self.counts.suppressed.store(suppressed, Relaxed);
        Ok(())
    }

    /// Ends the stream: its last events go to the queue. The next frame begins a new one.
    pub(crate) fn finish(&self) -> Result<(), CallError> {
        let input = &mut *turn(&self.input)?;
        self.make_room(input)?;
        self.queue(input.stream.finish(), &mut input.events);
        let suppressed = input.stream.suppressed();
        self.counts.suppressed.store(suppressed, Relaxed);
        Ok(())
    }

    /// Forgets everything, waiting events too.
    pub(crate) fn reset(&self) -> Result<(), CallError> {
        let input = &mut *turn(&self.input)?;
        let output = &mut *turn(&self.output)?;
        while output.pop().is_ok() {}
        input.stream.reset().map_err(|e| refusal(e.into()))?;
        let counts = &self.counts;
        for count in [
            &counts.frames,
            &counts.refused,
            &counts.events,
            &counts.lost,
            &counts.suppressed,
        ] {
            count.store(0, Relaxed);
        }
        Ok(())
    }

    /// Hands events to `take` in their order, at most `most`; says how many.
    pub(crate) fn poll(
        &self,
        most: usize,
        mut take: impl FnMut(usize, &Event),
    ) -> Result<usize, CallError> {
        let output = &mut *turn(&self.output)?;
        if most == 0 && !output.is_empty() {
            return Err(MorecStatus::BufferTooSmall.into());
        }
        let mut taken = 0;
        while taken < most {
            let Ok(event) = output.pop() else { break };
            take(taken, &event);
            taken += 1;
        }
        Ok(taken)
    }

    pub(crate) fn status(&self) -> StreamStatus {
        let counts = &self.counts;
        StreamStatus {
            frames: counts.frames.load(Relaxed),
            refused_frames: counts.refused.load(Relaxed),
            events: counts.events.load(Relaxed),
            lost_events: counts.lost.load(Relaxed),
            suppressed: counts.suppressed.load(Relaxed),
            latency_secs: self.latency_secs,
        }
    }

    /// Diagnosis of the stream; refused while another thread pushes.
    pub(crate) fn diagnosis(&self) -> Result<Diagnosis, CallError> {
        Ok(turn(&self.input)?.stream.diagnosis())
    }

    /// What is wrong with the stream for its index, a sentence each.
    pub(crate) fn findings(&self) -> Result<Vec<String>, CallError> {
        Ok(turn(&self.input)?.stream.findings())
    }

    fn queue(&self, settled: &[Event], events: &mut rtrb::Producer<Event>) {
        for event in settled {
            self.counts.events.fetch_add(1, Relaxed);
            // There is room, or the frame would not have been taken; if ever not, it is reported.
            if events.push(*event).is_err() {
                self.counts.lost.fetch_add(1, Relaxed);
            }
        }
    }

    fn make_room(&self, input: &StreamInput) -> Result<(), CallError> {
        if input.events.slots() >= self.room {
            return Ok(());
        }
        self.counts.refused.fetch_add(1, Relaxed);
        Err(MorecStatus::QueueFull.into())
    }
}

/// Why a stream cannot be, as a status.
fn refusal(error: StreamError) -> CallError {
    match error {
        StreamError::Option(_) => CallError::invalid(error.to_string()),
        _ => CallError::new(MorecStatus::NothingInCommon, error.to_string()),
    }
}

/// This thread's turn, if no other thread has it. Never waits.
fn turn<T>(of: &Mutex<T>) -> Result<MutexGuard<'_, T>, CallError> {
    match of.try_lock() {
        Ok(guard) => Ok(guard),
        Err(TryLockError::WouldBlock) => Err(MorecStatus::Busy.into()),
        // A fault came in between, once; what is behind it cannot be trusted.
        Err(TryLockError::Poisoned(_)) => Err(MorecStatus::Internal.into()),
    }
}
