//! Sources of live poses: a clip, or a device on a thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};

use morec::live::{Frame, PerformerId, Rig, Source, SourceCounts, SourceEvent, wall_now_secs};
use morec_db::ClipId;

use crate::body::ClipMotion;
use crate::store::Wake;

/// Between one lap of a clip and the next.
const PAUSE_SECS: f64 = 1.0;
/// Frames that wait for the window at most: what a minute at 240 Hz has.
const WAITING: usize = 16_384;

/// Something that a source said.
pub enum LiveItem {
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
    pub fn poll(&mut self, dt: f64, out: &mut Vec<LiveItem>) {
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

    /// Ends the thread of a device. A clip has no thread.
    pub fn stop(&mut self) {
        if let Feed::Thread(feed) = self {
            feed.stop();
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
    /// Where laps and leaps began: seconds of stream, and the frame of the clip there. The last is under way.
    laps: Vec<(f64, usize)>,
    now_secs: f64,
    next_frame: usize,
    /// True once another moment was chosen, until it is played.
    leapt: bool,
    /// A multiple of the performance's speed.
    pub speed: f64,
    /// Time of day at which the first lap began.
    begun_wall_secs: f64,
}

impl ClipFeed {
    pub fn new(motion: Arc<ClipMotion>) -> Self {
        Self {
            laps: vec![(0.0, first(&motion))],
            next_frame: first(&motion),
            motion,
            announced: false,
            now_secs: 0.0,
            leapt: false,
            speed: 1.0,
            begun_wall_secs: wall_now_secs(),
        }
    }

    /// The clip, and the moment of it that a moment of the stream shows; both in seconds.
    pub fn moment(&self, stream_secs: f64) -> (ClipId, f64) {
        let lap = self.laps.iter().rev().find(|lap| lap.0 <= stream_secs);
        let (origin_secs, from) = lap.unwrap_or(&self.laps[0]);
        let into = stream_secs - origin_secs;
        let rate_hz = self.motion.clip.rate_hz;
        (self.motion.id, *from as f64 / rate_hz + into)
    }

    /// The moment that comes next, and the length of the clip, seconds.
    pub fn position(&self) -> (f64, f64) {
        let secs = self.next_frame as f64 / self.motion.clip.rate_hz;
        (secs, self.motion.secs())
    }

    /// Goes on at a moment of the clip, seconds, as if somebody else came.
    pub fn seek(&mut self, secs: f64) {
        let last = self.motion.clip.frames.saturating_sub(1);
        let frame = (secs.max(0.0) * self.motion.clip.rate_hz).round() as usize;
        self.next_frame = frame.clamp(first(&self.motion), last);
        // Times of frames go on.
        let origin_secs = self.now_secs + 1.0 / self.motion.clip.rate_hz;
        self.laps.push((origin_secs, self.next_frame));
        self.leapt = true;
    }

    /// Seconds of stream at which the next frame comes.
    fn next_secs(&self) -> f64 {
        let (origin_secs, from) = self.laps[self.laps.len() - 1];
        origin_secs + (self.next_frame - from) as f64 / self.motion.clip.rate_hz
    }

    /// Time until the next frame comes, seconds on the wall.
    pub fn next_frame_secs(&self) -> f64 {
        (self.next_secs() - self.now_secs).max(0.0) / self.speed.max(1e-3)
    }

    fn poll(&mut self, dt: f64, out: &mut Vec<LiveItem>) {
        if !self.announced {
            self.announced = true;
            let rig = Rig {
                skeleton: self.motion.clip.skeleton.clone(),
                roles: self.motion.roles.clone(),
            };
            out.push(LiveItem::Rig(PerformerId(0), Arc::new(rig)));
        }
        if std::mem::take(&mut self.leapt) {
            out.push(LiveItem::Gone(PerformerId(0)));
        }
        self.now_secs += dt.max(0.0) * self.speed;
        let motion = self.motion.clone();
        let (clip, begin) = (&motion.clip, first(&motion));
        while self.next_secs() <= self.now_secs {
            let time_secs = self.next_secs();
            if self.next_frame >= clip.frames {
                self.laps.push((time_secs + PAUSE_SECS, begin));
                self.next_frame = begin;
                out.push(LiveItem::Gone(PerformerId(0)));
                continue;
            }
            let mut frame = Frame {
                time_secs,
                // A clip comes evenly, however seldom the window draws.
                wall_secs: self.begun_wall_secs + time_secs,
                ..Frame::default()
            };
            frame.pose.set(clip, self.next_frame);
            self.next_frame += 1;
            out.push(LiveItem::Frame(Box::new(frame)));
        }
    }
}

fn first(motion: &ClipMotion) -> usize {
    motion.rest.end.min(motion.clip.frames.saturating_sub(1))
}

/// A source that is asked on a thread of its own.
pub struct ThreadFeed {
    /// `None` once it is stopped.
    items: Option<Receiver<LiveItem>>,
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
            items: Some(items),
            counts,
            last: std::cell::Cell::default(),
            stop,
        })
    }

    fn stop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        self.items = None;
    }

    fn poll(&mut self, out: &mut Vec<LiveItem>) {
        let Some(items) = &self.items else { return };
        loop {
            match items.try_recv() {
                Ok(item) => out.push(item),
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => {
                    out.push(LiveItem::Ended);
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
        self.stop();
    }
}

fn ask(
    mut source: Box<dyn Source>,
    sender: &SyncSender<LiveItem>,
    counter: &SyncSender<SourceCounts>,
    stop: &AtomicBool,
    wake: &Wake,
) {
    let mut frame = Frame::default();
    while !stop.load(Ordering::Relaxed) {
        let item = match source.next(&mut frame) {
            SourceEvent::Frame => LiveItem::Frame(Box::new(frame.clone())),
            SourceEvent::Rig(actor, rig) => LiveItem::Rig(actor, rig),
            SourceEvent::Gone(actor) => LiveItem::Gone(actor),
            SourceEvent::Quiet => {
                // Nobody has asked for the last ones yet: these are newer, and come with the next.
                let _ = counter.try_send(source.counts());
                continue;
            }
            SourceEvent::Ended => {
                let _ = sender.send(LiveItem::Ended);
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
