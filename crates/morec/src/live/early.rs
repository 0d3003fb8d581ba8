//! Tentative detections of motions that have not ended, and repetitions of activities.

use crate::TimeSpan;
use crate::classes::ClassId;
use crate::decode::Repetitions;

use super::event_buffer::EventBuffer;
use super::{Detection, EarlyDetection, EventOptions, Phase};

/// Progress is reported again when it has grown by this.
const STEP: f64 = 0.1;

/// A motion that goes on is reported again after this, seconds: activities and held poses make no progress that would be.
const HEARTBEAT_SECS: f64 = 1.0;

/// Nothing heard of a motion for so long is the end of the early detection, seconds: it came to nothing.
const FORGET_SECS: f64 = 0.5;

/// Activities of a class that begin less than this apart are the same, seconds: windows are looked at as often.
const SAME_START_SECS: f64 = 0.1;

/// Makes starts, updates and cancellations of early detections, a few for each motion, and an event of each repetition.
#[derive(Debug, Default)]
pub(super) struct EarlyTracker {
    tells_early: bool,
    tells_repetitions: bool,
    open: Option<OpenMotion>,
    repeated: Option<RepeatedActivity>,
}

#[derive(Debug, Clone, Copy)]
struct OpenMotion {
    /// Its number, once something was said of it.
    motion: Option<u64>,
    last_reported: EarlyDetection,
    heard_secs: f64,
}

/// An activity and those of its repetitions that were reported.
#[derive(Debug, Clone, Copy)]
struct RepeatedActivity {
    class: ClassId,
    span: TimeSpan,
    count: u32,
}

impl EarlyTracker {
    pub(super) fn new(options: &EventOptions) -> Self {
        Self {
            tells_early: options.tentative,
            tells_repetitions: options.each_repetition,
            ..Self::default()
        }
    }

    /// True if something is said of motions before their ends.
    pub(super) fn is_wanted(&self) -> bool {
        self.tells_early || self.tells_repetitions
    }

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
        out: &mut EventBuffer,
    ) {
        let is_news = |h: &EarlyDetection| h.goes_on || middle_secs(h) > after_secs;
        match (early.filter(is_news), &mut self.open) {
            (Some(early), None) => {
                self.open = Some(OpenMotion {
                    motion: None,
                    last_reported: early,
                    heard_secs: now_secs,
                });
                self.tell(Phase::Start, now_secs, out);
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
                    self.tell(Phase::Update, now_secs, out);
                }
            }
            (None, Some(open)) if now_secs - open.heard_secs > FORGET_SECS => {
                self.cancel(Some(now_secs), out)
            }
            (None, _) => {}
        }
        if let (Some(early), Some(open)) = (early.filter(|e| e.goes_on), &mut self.open)
            && let (Some(whole), Some(repeated)) = (early.whole, early.repetitions)
            && self.tells_repetitions
        {
            let motion = open.number(out);
            self.tell_repetitions(motion, &early, (whole, repeated.period_secs), now_secs, out);
        }
    }

    /// Tells the repetitions up to the `count`th, which was over at `stop_secs`, that were not reported yet. More than one were found at once,
    /// and lasted a period each.
    fn tell_repetitions(
        &mut self,
        motion: u64,
        of: &EarlyDetection,
        ((count, stop_secs), period_secs): ((u32, f64), f64),
        now_secs: f64,
        out: &mut EventBuffer,
    ) {
        let mut told = self.repeated_in(of);
        for number in told.count + 1..=count {
            let start_secs = told.span.stop_secs;
            told.span.stop_secs = stop_secs - f64::from(count - number) * period_secs;
            told.count = number;
            let one = EarlyDetection {
                progress: 1.0,
                start_secs,
                seen_secs: told.span.stop_secs,
                repetitions: Some(Repetitions {
                    count: number,
                    period_secs: told.span.stop_secs - start_secs,
                }),
                ..*of
            };
            out.add(Phase::Repetition, motion, one, now_secs);
        }
        self.repeated = Some(told);
    }

    /// What was reported of the repetitions of this activity.
    fn repeated_in(&self, of: &EarlyDetection) -> RepeatedActivity {
        let is_same = |told: &RepeatedActivity| {
            told.class == of.class && (told.span.start_secs - of.start_secs).abs() < SAME_START_SECS
        };
        self.repeated.filter(is_same).unwrap_or(RepeatedActivity {
            class: of.class,
            span: TimeSpan::new(of.start_secs, of.start_secs),
            count: 0,
        })
    }

    /// Tells the repetitions that are left of an activity that has ended: they take the rest of it, or a period each where that is less.
    pub(super) fn end_repetitions(
        &mut self,
        motion: u64,
        ended: &EarlyDetection,
        now_secs: f64,
        out: &mut EventBuffer,
    ) {
        let Some(repeated) = ended.repetitions.filter(|_| self.tells_repetitions) else {
            return;
        };
        let told = self.repeated_in(ended);
        let left = f64::from(repeated.count.saturating_sub(told.count));
        let period_secs = repeated
            .period_secs
            .min((ended.seen_secs - told.span.stop_secs) / left.max(1.0));
        let whole = (repeated.count, told.span.stop_secs + left * period_secs);
        self.tell_repetitions(motion, ended, (whole, period_secs), now_secs, out);
    }

    /// The motion's number, if `detection` is the end of the one that is open.
    pub(super) fn take(&mut self, detection: &Detection) -> Option<u64> {
        let is_end = |open: &OpenMotion| {
            let early = &open.last_reported;
            early.start_secs < detection.span.stop_secs
                && (!early.goes_on || early.class == detection.class)
        };
        self.open.take_if(|open| is_end(open))?.motion
    }

    /// Cancels the motion that was reported.
    pub(super) fn cancel(&mut self, now_secs: Option<f64>, out: &mut EventBuffer) {
        if let Some(open) = self.open {
            self.tell(Phase::Cancel, now_secs.unwrap_or(open.heard_secs), out);
        }
        self.open = None;
    }

    /// Says so much of the motion that is open.
    fn tell(&mut self, phase: Phase, now_secs: f64, out: &mut EventBuffer) {
        if let Some(open) = self.open.as_mut().filter(|_| self.tells_early) {
            let motion = open.number(out);
            out.add(phase, motion, open.last_reported, now_secs);
        }
    }
}

impl OpenMotion {
    fn number(&mut self, out: &mut EventBuffer) -> u64 {
        *self.motion.get_or_insert_with(|| out.new_motion())
    }
}

/// Tails of a motion that has just ended resemble its beginning: what is reported must lie mostly after it.
fn middle_secs(early: &EarlyDetection) -> f64 {
    0.5 * (early.start_secs + early.seen_secs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::live::event_tracker::EventTracker;
    use crate::live::{Event, PerformerId};

    const JOG: ClassId = ClassId(0);
    const WAVE: ClassId = ClassId(1);

    fn ends(class: ClassId, start_secs: f64, stop_secs: f64, count: u32) -> Detection {
        Detection {
            class,
            span: TimeSpan::new(start_secs, stop_secs),
            score: 1.0,
            reported_secs: stop_secs,
            repetitions: (count > 0).then_some(Repetitions {
                count,
                period_secs: 2.0,
            }),
        }
    }

    /// A jog from 10 s on, as seen at a time in seconds.
    fn jogs(seen_secs: f64) -> EarlyDetection {
        let turns = (seen_secs - 10.0) / 2.0;
        // The period shows after three seconds, and what is certain is two seconds old.
        let is_counted = turns > 1.5;
        let whole = (turns - 1.0).floor().max(0.0);
        EarlyDetection {
            class: JOG,
            score: 0.8,
            progress: 0.5,
            start_secs: 10.0,
            seen_secs,
            goes_on: true,
            repetitions: is_counted.then_some(Repetitions {
                count: turns.round() as u32,
                period_secs: 2.0,
            }),
            whole: (is_counted && whole > 0.0).then_some((whole as u32, 10.0 + 2.0 * whole)),
        }
    }

    /// A jog of ten seconds with a wave in its middle.
    fn told(tentative: bool, each_repetition: bool) -> Vec<Event> {
        let options = EventOptions {
            tentative,
            each_repetition,
            ..Default::default()
        };
        let mut looked = EarlyTracker::new(&options);
        let mut tracker = EventTracker::new(2, 0.0);
        let mut out = EventBuffer::new(PerformerId(0));
        for tick in 0..=48 {
            let now_secs = 10.0 + f64::from(tick) / 4.0;
            if tick == 24 {
                let wave = ends(WAVE, 15.0, 16.0, 0);
                tracker.emit(&wave, &mut looked, &mut out);
            }
            if tick == 48 {
                let jog = ends(JOG, 10.0, 19.2, 5);
                tracker.emit(&jog, &mut looked, &mut out);
            }
            let early = (8..48).contains(&tick).then(|| jogs(now_secs));
            let after_secs = tracker.last_stop_secs();
            looked.look(early, after_secs, now_secs, &mut out);
        }
        out.events().to_vec()
    }

    #[test]
    fn each_repetition_is_told_once_and_they_fill_the_activity() {
        for early in [false, true] {
            let events = told(early, true);
            let jog = events.last().unwrap();
            assert_eq!((jog.phase, jog.class), (Phase::End, JOG));
            let repetitions: Vec<&Event> = (events.iter())
                .filter(|e| e.phase == Phase::Repetition)
                .collect();
            let bounds = repetitions.iter().map(|e| e.span);
            let expected = [
                (10.0, 12.0),
                (12.0, 14.0),
                (14.0, 16.0),
                (16.0, 18.0),
                (18.0, 19.2),
            ];
            for (span, (first, last)) in bounds.zip(expected) {
                assert!(span.is_near(TimeSpan::new(first, last), 1e-9));
            }
            let numbers = repetitions.iter().map(|e| e.repetitions.unwrap().count);
            assert_eq!(numbers.collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
            assert!(repetitions.iter().all(|e| e.motion == jog.motion));
            assert_eq!(events.len(), if early { 18 } else { 7 });
        }
    }

    #[test]
    fn an_activity_goes_on_beside_a_gesture_that_ends() {
        let events = told(true, false);
        let (of_jog, of_wave): (Vec<&Event>, Vec<&Event>) =
            events.iter().partition(|e| e.motion == events[0].motion);
        assert!(of_jog.iter().all(|e| e.class == JOG));
        assert_eq!(of_wave.len(), 1);
        for pair in of_jog.windows(2) {
            assert!(pair[1].span.stop_secs - pair[0].span.stop_secs < 1.2);
        }
    }
}
