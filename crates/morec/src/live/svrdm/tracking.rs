//! Tracking (thesis, §4.6.5): cells to detections, and what is said of them.

use std::sync::Arc;
use std::sync::atomic::Ordering::{Relaxed, Release};
use std::thread;
use std::time::Duration;

use crate::live::broadcast::EventBroadcast;
use crate::live::broadcast::WorkerOptions;
use crate::live::early::EarlyTracker;
use crate::live::event_buffer::EventBuffer;
use crate::live::event_tracker::EventTracker;
use crate::live::status::SessionCounters;
use crate::live::{Detection, MAX_PERFORMERS, PerformerId, wall_now_secs};
use crate::svrdm::{Cell, ChunkDetection, SegmentScoring, SegmentTracking, SvrdmModel};

use super::belt::{RingReceiver, RingSender};
use super::message::{End, MessageStamp, StageMessage, What};

pub(super) struct Tracking {
    performers: Vec<TrackedPerformer>,
    min_chunks: usize,
    chunk_frames: i64,
    broadcast: EventBroadcast,
    cells: Arc<SessionCounters>,
}

struct TrackedPerformer {
    tracking: SegmentTracking,
    column: Vec<Cell>,
    tracker: EventTracker,
    /// Nothing is reported early by this method.
    early: EarlyTracker,
    out: EventBuffer,
}

impl Tracking {
    pub(super) fn new(
        model: &SvrdmModel,
        scoring: &SegmentScoring,
        options: &WorkerOptions,
        broadcast: EventBroadcast,
        cells: &Arc<SessionCounters>,
    ) -> Self {
        let performer = |actor| TrackedPerformer {
            tracking: SegmentTracking::of_model(model, scoring),
            column: vec![Cell::NOTHING; model.params.lengths()],
            tracker: EventTracker::new(model.classes.len(), options.events.refractory_secs),
            early: EarlyTracker::default(),
            out: EventBuffer::new(PerformerId(actor as u16)),
        };
        Self {
            performers: (0..MAX_PERFORMERS).map(performer).collect(),
            min_chunks: model.params.min_chunks,
            chunk_frames: model.params.chunk_frames as i64,
            broadcast,
            cells: cells.clone(),
        }
    }

    /// Parcels in, and back to where they came from.
    pub(super) fn run(
        mut self,
        mut from: RingReceiver<StageMessage>,
        mut home: RingSender<StageMessage>,
    ) {
        while let Some(message) = from.next() {
            self.take(&message);
            home.send(message);
            // Readers do not wake this thread: they would have to know of it.
            while !self.broadcast.deliver() {
                thread::sleep(Duration::from_millis(1));
            }
        }
    }

    fn take(&mut self, message: &StageMessage) {
        let MessageStamp {
            actor, wall_secs, ..
        } = message.mark;
        let performer = &mut self.performers[actor];
        match message.what {
            What::Segment(window) => {
                // Segments of all lengths that end with a chunk arrive one by one before the word that the column is whole.
                performer.column[window.chunks() - self.min_chunks] = message.cell
            }
            What::Column | What::End(_) => {
                let TrackedPerformer {
                    tracking,
                    column,
                    tracker,
                    early,
                    out,
                } = performer;
                let frames = self.chunk_frames;
                out.clear();
                out.arrive(wall_secs);
                let mut tell = |found: ChunkDetection| {
                    let detection = detection(&found, &message.mark, frames);
                    tracker.emit(&detection, early, out);
                };
                match message.what {
                    What::Column => tracking.push(column, &mut tell),
                    _ => tracking.finish(&mut tell),
                }
                self.broadcast.keep(out.events());
                column.fill(Cell::NOTHING);
                if let What::End(End::Gone) = message.what {
                    tracker.forget();
                }
                // Refractory times are kept by performer, the counter is the session's.
                let suppressed = self.performers.iter().map(|p| p.tracker.suppressed()).sum();
                self.cells.suppressed.store(suppressed, Relaxed);
            }
            What::Frame { time_secs } => {
                self.cells.frame_of(
                    PerformerId(actor as u16),
                    time_secs,
                    wall_secs,
                    wall_now_secs(),
                );
            }
            What::Rows => {}
        }
    }
}

impl Drop for Tracking {
    fn drop(&mut self) {
        self.cells.ended.store(true, Release);
    }
}

fn detection(found: &ChunkDetection, mark: &MessageStamp, chunk_frames: i64) -> Detection {
    let found = found.in_frames(chunk_frames);
    Detection {
        class: found.class,
        span: mark.steps.span(found.start, found.stop),
        score: found.score,
        reported_secs: mark.reported_secs,
        repetitions: None,
    }
}
