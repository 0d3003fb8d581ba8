//! Tentative detections of motions that have not ended.

use super::emitter::EventEmitter;
use super::{Detection, EarlyDetection, Event, Phase};

/// Progress is reported again when it has grown by this.
const STEP: f64 = 0.1;

/// A motion that goes on is reported again after this, seconds: activities and held poses make no progress that would be.
const HEARTBEAT_SECS: f64 = 1.0;

/// Nothing heard of a motion for so long is the end of the early detection, seconds: it came to nothing.
const FORGET_SECS: f64 = 0.5;

/// Makes starts, updates and cancellations of early detections, a few for each motion.
#[derive(Debug, Default)]
pub(super) struct EarlyTracker {
    open: Option<OpenMotion>,
}

#[derive(Debug, Clone, Copy)]
struct OpenMotion {
    motion: u64,
    last_reported: EarlyDetection,
    heard_secs: f64,
}

impl EarlyTracker {
    /// The last report of a motion that is still under way.
    pub(super) fn last_reported(&self) -> Option<EarlyDetection> {
        self.open.map(|open| open.last_reported)
    }

    /// Takes what seems to be under way at `now_secs`; nothing that began before `after_secs` is reported again.
    pub(super) fn look(
        &mut self,
        early: Option<EarlyDetection>,
        after_secs: f64,
        now_secs: f64,
        say: &mut EventEmitter<impl FnMut(Event)>,
    ) {
        match (
            early.filter(|h| middle_secs(h) > after_secs),
            &mut self.open,
        ) {
            (Some(early), None) => {
                let motion = say.new_motion();
                say.event(Phase::Start, motion, early, now_secs);
                self.open = Some(OpenMotion {
                    motion,
                    last_reported: early,
                    heard_secs: now_secs,
                });
            }
            (Some(early), Some(open)) => {
                open.heard_secs = now_secs;
                let last = &open.last_reported;
                let news = early.class != last.class
                    || early.progress >= last.progress + STEP
                    || early.seen_secs >= last.seen_secs + HEARTBEAT_SECS
                    || early.repetitions.map(|r| r.count) != last.repetitions.map(|r| r.count);
                if news {
                    open.last_reported = early;
                    let motion = open.motion;
                    say.event(Phase::Update, motion, early, now_secs);
                }
            }
            (None, Some(open)) if now_secs - open.heard_secs > FORGET_SECS => {
                self.cancel(Some(now_secs), say)
            }
            (None, _) => {}
        }
    }

    /// The motion's number, if `detection` is the end of the one that is open.
    pub(super) fn take(&mut self, detection: &Detection) -> Option<u64> {
        let open = self
            .open
            .filter(|open| open.last_reported.start_secs < detection.stop_secs)?;
        self.open = None;
        Some(open.motion)
    }

    /// Cancels the motion that was reported.
    pub(super) fn cancel(
        &mut self,
        now_secs: Option<f64>,
        say: &mut EventEmitter<impl FnMut(Event)>,
    ) {
        if let Some(open) = self.open.take() {
            say.event(
                Phase::Cancel,
                open.motion,
                open.last_reported,
                now_secs.unwrap_or(open.heard_secs),
            );
        }
    }
}

/// Tails of a motion that has just ended resemble its beginning: what is reported must lie mostly after it.
fn middle_secs(early: &EarlyDetection) -> f64 {
    0.5 * (early.start_secs + early.seen_secs)
}
