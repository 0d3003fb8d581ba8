//! Tracking (thesis, §4.6.5): cells to detections, and what is said of them.

use std::sync::Arc;
use std::sync::atomic::Ordering::{Relaxed, Release};
use std::thread;
use std::time::Duration;

use crate::live::early::Early;
use crate::live::lane::LaneOptions;
use crate::live::outlets::Outlets;
use crate::live::status::Cells;
use crate::live::teller::Teller;
use crate::live::{Actor, Detection, MAX_ACTORS, wall_now_secs};
use crate::svrdm::{Cell, ChunkDetection, SegmentScoring, SegmentTracking, SvrdmModel};

use super::belt::{In, Out};
use super::parcel::{End, Mark, Parcel, What};

/// The last stage.
pub(super) struct Tracking {
    performers: Vec<TrackedPerformer>,
    min_chunks: usize,
    chunk_frames: i64,
    outlets: Outlets,
    cells: Arc<Cells>,
}

struct TrackedPerformer {
    tracking: SegmentTracking,
    column: Vec<Cell>,
    teller: Teller,
    /// Nothing is told early by this method.
    early: Early,
}

impl Tracking {
    pub(super) fn new(
        model: &SvrdmModel,
        scoring: &SegmentScoring,
        options: &LaneOptions,
        outlets: Outlets,
        cells: &Arc<Cells>,
    ) -> Self {
        let performer = |actor| TrackedPerformer {
            tracking: SegmentTracking::of_model(model, scoring),
            column: vec![Cell::NOTHING; model.params.lengths()],
            teller: Teller::new(
                Actor(actor as u16),
                model.classes.len(),
                options.events.refractory_secs,
            ),
            early: Early::default(),
        };
        Self {
            performers: (0..MAX_ACTORS).map(performer).collect(),
            min_chunks: model.params.min_chunks,
            chunk_frames: model.params.chunk_frames as i64,
            outlets,
            cells: cells.clone(),
        }
    }

    /// Parcels in, and back to where they came from.
    pub(super) fn run(mut self, mut from: In<Parcel>, mut home: Out<Parcel>) {
        while let Some(parcel) = from.next() {
            self.take(&parcel);
            home.send(parcel);
            // Readers do not wake this thread: they would have to know of it.
            while !self.outlets.deliver() {
                thread::sleep(Duration::from_millis(1));
            }
        }
    }

    fn take(&mut self, parcel: &Parcel) {
        let Mark {
            actor, wall_secs, ..
        } = parcel.mark;
        let performer = &mut self.performers[actor];
        match parcel.what {
            What::Segment(window) => {
                performer.column[window.chunks() - self.min_chunks] = parcel.cell
            }
            What::Column | What::End(_) => {
                let TrackedPerformer {
                    tracking,
                    column,
                    teller,
                    early,
                } = performer;
                let (frames, outlets) = (self.chunk_frames, &mut self.outlets);
                let mut tell = |found: ChunkDetection| {
                    let detection = detection(&found, &parcel.mark, frames);
                    teller.tell(&detection, early, wall_secs, &mut |event| {
                        outlets.keep(event)
                    });
                };
                match parcel.what {
                    What::Column => tracking.push(column, &mut tell),
                    _ => tracking.finish(&mut tell),
                }
                column.fill(Cell::NOTHING);
                if let What::End(End::Gone) = parcel.what {
                    teller.forget();
                }
                let suppressed = self.performers.iter().map(|p| p.teller.suppressed()).sum();
                self.cells.suppressed.store(suppressed, Relaxed);
            }
            What::Frame { time_secs } => {
                self.cells
                    .frame_of(Actor(actor as u16), time_secs, wall_secs, wall_now_secs());
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

fn detection(found: &ChunkDetection, mark: &Mark, chunk_frames: i64) -> Detection {
    let found = found.in_frames(chunk_frames);
    let at_secs = |frame: i64| mark.steps.origin_secs + frame as f64 * mark.steps.step_secs;
    Detection {
        class: found.class,
        start_secs: at_secs(found.start),
        stop_secs: at_secs(found.stop),
        score: found.score,
        reported_secs: mark.reported_secs,
    }
}
