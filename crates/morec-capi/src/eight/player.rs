//! Plays a clip at the speed of the performance.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::time::{Duration, Instant};

use morec::import::Take;
use morec::live::{Frame, PerformerId, Rig, Source, SourceEvent, wall_now_secs};

/// A source must not sleep longer than this.
const NAP: Duration = Duration::from_millis(10);

/// State shared between a player and its users.
#[derive(Debug)]
pub(super) struct Control {
    /// No further frame, please.
    pub(super) stop: AtomicBool,
    /// There will be no further frame.
    pub(super) depleted: AtomicBool,
    speed: AtomicU64,
}

impl Control {
    pub(super) fn new(speed: f64) -> Self {
        Self {
            stop: AtomicBool::new(false),
            depleted: AtomicBool::new(false),
            speed: AtomicU64::new(speed.to_bits()),
        }
    }

    pub(super) fn set_speed(&self, speed: f64) {
        self.speed.store(speed.to_bits(), Relaxed);
    }
}

/// Plays a clip once.
pub(super) struct SourcePlayer {
    take: Arc<Take>,
    control: Arc<Control>,
    announced: bool,
    frame: usize,
    /// Frame `since` was due at this moment, at this speed.
    anchor: Option<(Instant, f64)>,
    since: usize,
}

impl SourcePlayer {
    pub(super) fn new(take: &Arc<Take>, control: &Arc<Control>) -> Self {
        let (take, control) = (take.clone(), control.clone());
        Self {
            take,
            control,
            announced: false,
            frame: 0,
            anchor: None,
            since: 0,
        }
    }

    /// Time until the next frame is due.
    fn wait(&mut self) -> Duration {
        let speed = f64::from_bits(self.control.speed.load(Relaxed));
        if !speed.is_finite() {
            self.anchor = None;
            return Duration::ZERO;
        }
        let begun = match self.anchor {
            Some((begun, of)) if of == speed => begun,
            _ => {
                let now = Instant::now();
                (self.anchor, self.since) = (Some((now, speed)), self.frame);
                now
            }
        };
        let due_secs = (self.frame - self.since) as f64 / self.take.clip.rate_hz / speed;
        // A speed can be so low that a frame is due after the end of time.
        let due = Duration::try_from_secs_f64(due_secs).unwrap_or(Duration::MAX);
        due.saturating_sub(begun.elapsed())
    }
}

impl Source for SourcePlayer {
    fn next(&mut self, frame: &mut Frame) -> SourceEvent {
        let take = self.take.clone();
        let (clip, rest) = (&take.clip, take.rest());
        if !self.announced {
            self.announced = true;
            let rig = Rig {
                skeleton: clip.skeleton.clone(),
                roles: take.roles.clone(),
            };
            return SourceEvent::Rig(PerformerId(0), Arc::new(rig));
        }
        if self.frame >= clip.frames || self.control.stop.load(Relaxed) {
            return SourceEvent::Ended;
        }
        let wait = self.wait();
        std::thread::sleep(wait.min(NAP));
        if wait > NAP {
            return SourceEvent::Quiet;
        }
        // The rest pose that a conversion left shows the first pose after it, as everywhere.
        let shown = if rest.contains(&self.frame) {
            rest.end.min(clip.frames - 1)
        } else {
            self.frame
        };
        frame.pose.set(clip, shown);
        frame.actor = PerformerId(0);
        frame.time_secs = self.frame as f64 / clip.rate_hz;
        frame.wall_secs = wall_now_secs();
        self.frame += 1;
        SourceEvent::Frame
    }
}

impl Drop for SourcePlayer {
    fn drop(&mut self) {
        self.control.depleted.store(true, Relaxed);
    }
}
