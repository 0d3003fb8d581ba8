//! The method of 2009 on live streams: on one thread ([`SvrdmPipeline`]), or a thread for each stage.
//!
//! The stages are as the thesis laid it out on its processor (§4.6.1, §4.7.3): frames →
//! input assembly → segment assembly → feature vector extraction → classification → scoring → tracking → events.
//!
//! Stages are joined by bounded wait-free rings whose boxes come round again: segments travel in the same boxes from
//! segment assembly to tracking and home. Everything goes in one order, so that events are those of the inline layout,
//! to the bit. When the last stage is held up, so is the first, and what then happens to frames is
//! [`OverflowPolicy`](super::OverflowPolicy)'s matter, as ever.

mod belt;
mod between;
mod input;
mod message;
mod pipeline;
mod tracking;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

use crate::svrdm::{SegmentScoring, SvrdmModel};

use self::belt::belt;
use self::between::{Segments, classify, extract, score};
use self::input::{Chunks, Fate, PerformerInput};
use self::message::{Chunk, StageMessage};
pub(super) use self::pipeline::SvrdmPipeline;
use self::tracking::Tracking;
use super::broadcast::WorkerOptions;
use super::broadcast::{EventBroadcast, EventReader};
use super::feed::{FeedReceiver, QueueItem};
use super::status::SessionCounters;
use super::waker::Waker;
use super::{Frame, MAX_PERFORMERS, PerformerId, SessionError, wall_now_secs};

/// Chunks on their way at once.
const CHUNKS: usize = 16;
/// Segments, and other news, on their way at once: a few chunks' worth.
const PARCELS: usize = 128;

/// Starts a thread and gives it its name.
pub(super) type Spawn<'a> =
    dyn FnMut(&'static str, Box<dyn FnOnce() + Send>) -> Result<(), SessionError> + 'a;

/// Parts that a session shares with its stages.
pub(super) struct Shared<'a> {
    pub(super) cells: &'a Arc<SessionCounters>,
    pub(super) stop: &'a Arc<AtomicBool>,
    /// Of the thread that takes frames from the feed.
    pub(super) waker: &'a Arc<Waker>,
}

/// Starts all stages behind `feed`. They end one after the other once the feed has.
pub(super) fn start(
    model: &Arc<SvrdmModel>,
    feed: FeedReceiver,
    options: &WorkerOptions,
    shared: &Shared<'_>,
    spawn: &mut Spawn<'_>,
) -> Result<Vec<EventReader>, SessionError> {
    let scoring = SegmentScoring::new(model).map_err(|error| SessionError::Start(error.into()))?;
    let (broadcast, readers) = EventBroadcast::new(options, 0, shared.cells, shared.stop);
    let tracking = Tracking::new(model, &scoring, options, broadcast, shared.cells);
    let [segments, features, classes, scores, last] =
        std::array::from_fn(|_| Arc::new(Waker::default()));
    let (chunks_out, chunks_in) = belt(CHUNKS, &segments);
    let (mut chunks_used, chunks_spare) = belt(CHUNKS, shared.waker);
    (0..CHUNKS).for_each(|_| chunks_used.send(Box::new(Chunk::new(model))));
    let (to_features, from_segments) = belt(PARCELS, &features);
    let (to_classes, from_features) = belt(PARCELS, &classes);
    let (to_scores, from_classes) = belt(PARCELS, &scores);
    let (to_tracking, from_scores) = belt(PARCELS, &last);
    let (mut home, spare) = belt(PARCELS, &segments);
    (0..PARCELS).for_each(|_| home.send(Box::new(StageMessage::new(model))));

    let of = || model.clone();
    let assembly = Segments {
        chunks: chunks_in,
        used: chunks_used,
        out: to_features,
        spare,
    };
    let input = InputStage {
        feed,
        performers: (0..MAX_PERFORMERS)
            .map(|actor| PerformerInput::new(model, actor))
            .collect(),
        chunks: Chunks {
            out: chunks_out,
            spare: chunks_spare,
        },
        cells: shared.cells.clone(),
        stop: shared.stop.clone(),
        waker: shared.waker.clone(),
    };
    spawn(
        "tracking",
        Box::new(move || tracking.run(from_scores, home)),
    )?;
    spawn(
        "scoring",
        Box::new(move || score(scoring, from_classes, to_tracking)),
    )?;
    let model = of();
    spawn(
        "classification",
        Box::new(move || classify(&model, from_features, to_scores)),
    )?;
    let model = of();
    spawn(
        "extraction",
        Box::new(move || extract(&model, from_segments, to_classes)),
    )?;
    let model = of();
    spawn("segments", Box::new(move || assembly.run(&model)))?;
    spawn("input", Box::new(move || input.run()))?;
    Ok(readers)
}

/// The first stage: frames of all performers to chunks.
struct InputStage {
    feed: FeedReceiver,
    performers: Vec<PerformerInput>,
    chunks: Chunks,
    cells: Arc<SessionCounters>,
    stop: Arc<AtomicBool>,
    waker: Arc<Waker>,
}

impl InputStage {
    fn run(mut self) {
        loop {
            match self.feed.next() {
                Some(QueueItem::Frame(frame)) => {
                    self.frame(&frame);
                    self.feed.give_back(frame);
                }
                Some(QueueItem::Rig(actor, rig)) => {
                    if let Some(performer) = self.performers.get_mut(actor.index()) {
                        performer.set_rig(&rig, &mut self.chunks);
                    }
                }
                Some(QueueItem::Gone(actor)) => self.gone(actor),
                None if self.feed.is_ended() || self.stop.load(Relaxed) => break,
                None => {
                    let feed = &self.feed;
                    self.waker.sleep(Duration::from_millis(20), || {
                        feed.has_more() || feed.is_ended()
                    });
                }
            }
        }
        (0..MAX_PERFORMERS).for_each(|actor| self.gone(PerformerId(actor as u16)));
    }

    fn frame(&mut self, frame: &Frame) {
        let performer = self.performers.get_mut(frame.actor.index());
        let fate = performer.map_or(Fate::Unusable, |performer| {
            performer.push(frame, &mut self.chunks)
        });
        if fate == Fate::Unusable {
            self.cells.unusable.fetch_add(1, Relaxed);
        }
        if fate != Fate::Sent {
            self.cells.frame(frame, wall_now_secs());
        }
    }

    fn gone(&mut self, actor: PerformerId) {
        if let Some(performer) = self.performers.get_mut(actor.index()) {
            performer.finish(&mut self.chunks);
        }
    }
}
