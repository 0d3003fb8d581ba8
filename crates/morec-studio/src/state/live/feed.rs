//! Sources of live poses: a clip, or a device on a thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};

use morec::live::{Frame, PerformerId, Rig, Source, SourceCounts, SourceEvent, wall_now_secs};
use morec_db::ClipId;

use crate::jobs::load::ClipMotion;
use crate::store::Wake;

/// Between one lap of a clip and the next.
const PAUSE_SECS: f64 = 1.0;
/// Frames that wait for the window at most: what a minute at 240 Hz has.
const WAITING: usize = 16_384;

/// Something that a source said.
pub enum SourceItem {
    Rig(PerformerId, Arc<Rig>),
    Frame(Box<Frame>),
    Gone(PerformerId),
    Ended,
}

/// Poses as they come.
pub enum Feed {
    Clip(ClipFeed),
    Thread(ThreadFeed),
}

impl Feed {
    /// Appends what has come while `dt` seconds passed on the wall.
    pub fn poll(&mut self, dt: f64, out: &mut Vec<SourceItem>) {
        match self {
            Feed::Clip(feed) => feed.poll(dt, out),
            Feed::Thread(feed) => feed.poll(out),
        }
    }

    /// See [`ClipFeed::moment`]; `None` for a device.
    pub fn moment(&self, stream_secs: f64) -> Option<(ClipId, f64)> {
        match self {
            Feed::Clip(feed) => Some(feed.moment(stream_secs)),
            Feed::Thread(_) => None,
        }
    }

    pub fn counts(&self) -> SourceCounts {
        match self {
            Feed::Clip(_) => SourceCounts::default(),
            Feed::Thread(feed) => feed.counts(),
        }
    }
}

/// A clip of the database, played as if somebody performed it; again and again.
pub struct ClipFeed {
    motion: Arc<ClipMotion>,
    announced: bool,
    /// Seconds of stream at which the present lap began.
    origin_secs: f64,
    now_secs: f64,
    next_frame: usize,
    /// Time of day at which the first lap began.
    begun_wall_secs: f64,
}

impl ClipFeed {
    pub fn new(motion: Arc<ClipMotion>) -> Self {
        Self {
            next_frame: first(&motion),
            motion,
            announced: false,
            origin_secs: 0.0,
            now_secs: 0.0,
            begun_wall_secs: wall_now_secs(),
        }
    }

    /// The clip, and the moment of it that a moment of the stream shows; both in seconds.
    pub fn moment(&self, stream_secs: f64) -> (ClipId, f64) {
        let clip = &self.motion.clip;
        let secs = |frames: usize| frames as f64 / clip.rate_hz;
        let begin = first(&self.motion);
        let lap_secs = secs(clip.frames - begin) + PAUSE_SECS;
        (
            self.motion.id,
            secs(begin) + stream_secs.rem_euclid(lap_secs),
        )
    }

    fn poll(&mut self, dt: f64, out: &mut Vec<SourceItem>) {
        if !self.announced {
            self.announced = true;
            let rig = Rig {
                skeleton: self.motion.clip.skeleton.clone(),
                roles: self.motion.roles.clone(),
            };
            out.push(SourceItem::Rig(PerformerId(0), Arc::new(rig)));
        }
        // A window that was hidden for an hour does not play an hour at once.
        self.now_secs += dt.clamp(0.0, 1.0);
        let motion = self.motion.clone();
        let (clip, begin) = (&motion.clip, first(&motion));
        let time = |feed: &Self| feed.origin_secs + (feed.next_frame - begin) as f64 / clip.rate_hz;
        while time(self) <= self.now_secs {
            if self.next_frame >= clip.frames {
                self.origin_secs = time(self) + PAUSE_SECS;
                self.next_frame = begin;
                out.push(SourceItem::Gone(PerformerId(0)));
                continue;
            }
            let time_secs = time(self);
            let mut frame = Frame {
                time_secs,
                // A clip comes evenly, however seldom the window draws.
                wall_secs: self.begun_wall_secs + time_secs,
                ..Frame::default()
            };
            frame.pose.set(clip, self.next_frame);
            self.next_frame += 1;
            out.push(SourceItem::Frame(Box::new(frame)));
        }
    }
}

fn first(motion: &ClipMotion) -> usize {
    motion.rest.end.min(motion.clip.frames.saturating_sub(1))
}

/// A source that is asked on a thread of its own.
pub struct ThreadFeed {
    items: Receiver<SourceItem>,
    counts: Receiver<SourceCounts>,
    last: std::cell::Cell<SourceCounts>,
    stop: Arc<AtomicBool>,
}

impl ThreadFeed {
    /// Asks `source` until the feed is dropped.
    pub fn start(source: Box<dyn Source>, wake: Wake) -> std::io::Result<Self> {
        let (sender, items) = sync_channel(WAITING);
        let (counter, counts) = sync_channel(1);
        let stop = Arc::new(AtomicBool::new(false));
        let theirs = stop.clone();
        std::thread::Builder::new()
            .name("live source".to_owned())
            .spawn(move || ask(source, &sender, &counter, &theirs, &wake))?;
        Ok(Self {
            items,
            counts,
            last: std::cell::Cell::default(),
            stop,
        })
    }

    fn poll(&mut self, out: &mut Vec<SourceItem>) {
        loop {
            match self.items.try_recv() {
                Ok(item) => out.push(item),
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => {
                    out.push(SourceItem::Ended);
                    return;
                }
            }
        }
    }

    fn counts(&self) -> SourceCounts {
        if let Ok(counts) = self.counts.try_recv() {
            self.last.set(counts);
        }
        self.last.get()
    }
}

impl Drop for ThreadFeed {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

fn ask(
    mut source: Box<dyn Source>,
    sender: &SyncSender<SourceItem>,
    counter: &SyncSender<SourceCounts>,
    stop: &AtomicBool,
    wake: &Wake,
) {
    let mut frame = Frame::default();
    while !stop.load(Ordering::Relaxed) {
        let item = match source.next(&mut frame) {
            SourceEvent::Frame => SourceItem::Frame(Box::new(frame.clone())),
            SourceEvent::Rig(actor, rig) => SourceItem::Rig(actor, rig),
            SourceEvent::Gone(actor) => SourceItem::Gone(actor),
            SourceEvent::Quiet => {
                // Nobody has asked for the last ones yet: these are newer, and come with the next.
                let _ = counter.try_send(source.counts());
                continue;
            }
            SourceEvent::Ended => {
                let _ = sender.send(SourceItem::Ended);
                wake();
                return;
            }
        };
        if sender.send(item).is_err() {
            return;
        }
        wake();
    }
}
