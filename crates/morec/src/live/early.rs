//! What seems to be under way, while it is.

use crate::classes::ClassId;

use super::event_tracker::Say;
use super::{Detection, Event, Phase};

/// A motion that seems to be under way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EarlyDetection {
    /// What it seems to be.
    pub class: ClassId,
    /// How near what was seen is: 0 just worth telling … 1 identical to the beginning of a sample.
    pub score: f64,
    /// How much of the motion was seen, 0 to 1.
    pub progress: f64,
    /// When it began, on the stream's clock.
    pub start_secs: f64,
    /// Up to when it was seen.
    pub seen_secs: f64,
}

/// Progress is told again when it has grown by this.
const STEP: f64 = 0.1;

/// Nothing heard of a motion for so long is the end of the hunch, seconds: it came to nothing.
const FORGET_SECS: f64 = 0.5;

/// Makes starts, updates and cancellations of hunches, a few for each motion.
#[derive(Debug, Default)]
pub(super) struct EarlyTracker {
    open: Option<OpenMotion>,
}

#[derive(Debug, Clone, Copy)]
struct OpenMotion {
    motion: u64,
    told: EarlyDetection,
    heard_secs: f64,
}

impl EarlyTracker {
    /// What was told last of a motion that is still under way.
    pub(super) fn told(&self) -> Option<EarlyDetection> {
        self.open.map(|open| open.told)
    }

    /// Takes what seems to be under way at `now_secs`; nothing that began before `after_secs` is told again.
    pub(super) fn look(
        &mut self,
        hunch: Option<EarlyDetection>,
        after_secs: f64,
        now_secs: f64,
        say: &mut Say<impl FnMut(Event)>,
    ) {
        match (
            hunch.filter(|h| middle_secs(h) > after_secs),
            &mut self.open,
        ) {
            (Some(hunch), None) => {
                let motion = say.new_motion();
                say.event(Phase::Start, motion, hunch, now_secs);
                self.open = Some(OpenMotion {
                    motion,
                    told: hunch,
                    heard_secs: now_secs,
                });
            }
            (Some(hunch), Some(open)) => {
                open.heard_secs = now_secs;
                let news =
                    hunch.class != open.told.class || hunch.progress >= open.told.progress + STEP;
                if news {
                    open.told = hunch;
                    let motion = open.motion;
                    say.event(Phase::Update, motion, hunch, now_secs);
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
            .filter(|open| open.told.start_secs < detection.stop_secs)?;
        self.open = None;
        Some(open.motion)
    }

    /// What was told came to nothing.
    pub(super) fn cancel(&mut self, now_secs: Option<f64>, say: &mut Say<impl FnMut(Event)>) {
        if let Some(open) = self.open.take() {
            say.event(
                Phase::Cancel,
                open.motion,
                open.told,
                now_secs.unwrap_or(open.heard_secs),
            );
        }
    }
}

/// Tails of a motion that has just ended resemble its beginning: what is told must lie mostly after it.
fn middle_secs(hunch: &EarlyDetection) -> f64 {
    0.5 * (hunch.start_secs + hunch.seen_secs)
}
