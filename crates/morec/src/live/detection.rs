//! Detections, final and tentative, and the buffer for the results of one push.

use std::fmt;

use crate::TimeSpan;
use crate::classes::ClassId;
use crate::decode::Repetitions;

use super::Model;

/// Detections that one push can complete at most; more than a motion a tick is not a motion.
const MAX_DETECTIONS_PER_PUSH: usize = 64;

/// The meaning of a [score](Detection::score), in the words used by every interface.
pub const SCORE: &str = "Probability that the detection is right, 0 to 1. The lowest accepted score is 0.05 to 0.44, depending \
    on the index. For held poses and indexes without calibration (svrdm, older files) it is the similarity to a sample instead.";

/// A motion recognised in a stream. Its class is a number of the index's, or a name ([`named`](Detection::named)).
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Detection<C = ClassId> {
    /// Class of the motion.
    pub class: C,
    /// Start and stop of the motion, seconds on the stream's clock.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// Probability that the detection is right, 0 to 1. The lowest accepted score is 0.05 to 0.44, depending on the index. For
    /// held poses and indexes without calibration (svrdm, older files) it is the similarity to a sample instead.
    pub score: f64,
    /// Time of the report on the stream's clock, seconds: that of the pose that completed the detection.
    pub reported_secs: f64,
    /// Repetitions, for a repeated activity.
    pub repetitions: Option<Repetitions>,
}

impl Detection {
    /// The same detection with the name of its class in `model`.
    pub fn named(self, model: &Model) -> Detection<&str> {
        let class = model.class_name(self.class);
        self.with_class(class)
    }
}

impl<C> Detection<C> {
    /// The same detection with another value for its class.
    pub fn with_class<D>(self, class: D) -> Detection<D> {
        Detection {
            class,
            span: self.span,
            score: self.score,
            reported_secs: self.reported_secs,
            repetitions: self.repetitions,
        }
    }
}

impl<C: fmt::Display> fmt::Display for Detection<C> {
    /// `wave from 1.23 s to 2.50 s, score 0.87`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (from, to) = (self.span.start_secs, self.span.stop_secs);
        write!(
            f,
            "{} from {from:.2} s to {to:.2} s, score {:.2}",
            self.class, self.score
        )
    }
}

/// A motion that is probably being performed: tentative, before its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EarlyDetection {
    /// Class of the motion, tentatively.
    pub class: ClassId,
    /// Similarity to the beginning of a sample: 0 is the least that is reported, 1 is identical.
    pub score: f64,
    /// Share of the motion that was seen, 0 to 1.
    pub progress: f64,
    /// When it began, on the stream's clock.
    pub start_secs: f64,
    /// Up to when it was seen.
    pub seen_secs: f64,
    /// True of an activity: other motions come and go while it does.
    pub goes_on: bool,
    /// Of an activity that repeats, so far.
    pub repetitions: Option<Repetitions>,
    /// Of those, how many are certainly over, and when the last of them was.
    pub whole: Option<(u32, f64)>,
}

/// Time of a path: its origin and its step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Steps {
    pub origin_secs: f64,
    pub step_secs: f64,
}

impl Steps {
    /// Steps from `origin_secs` at `rate_hz` a second.
    pub(super) fn at_rate(origin_secs: f64, rate_hz: f64) -> Self {
        Self {
            origin_secs,
            step_secs: 1.0 / rate_hz,
        }
    }

    /// From step `start` to step `stop`.
    pub(super) fn span(self, start: i64, stop: i64) -> TimeSpan {
        let at = |step: i64| self.origin_secs + step as f64 * self.step_secs;
        TimeSpan::new(at(start), at(stop))
    }
}

/// Detections of the present push, with the time at which they are reported.
#[derive(Debug)]
pub(super) struct DetectionBuffer {
    pub(super) detections: Vec<Detection>,
    pub(super) reported_secs: f64,
    /// Detections for which there was no room.
    pub(super) dropped: u64,
}

impl DetectionBuffer {
    pub(super) fn new() -> Self {
        Self {
            detections: Vec::with_capacity(MAX_DETECTIONS_PER_PUSH),
            reported_secs: 0.0,
            dropped: 0,
        }
    }

    pub(super) fn begin(&mut self, reported_secs: f64) {
        self.detections.clear();
        self.reported_secs = reported_secs;
    }

    /// Adds what lies from step `start` to step `stop`.
    pub(super) fn add(
        &mut self,
        class: ClassId,
        at: Steps,
        (start, stop): (i64, i64),
        score: f64,
        repetitions: Option<Repetitions>,
    ) {
        // The buffer never grows: pushing must not allocate.
        if self.detections.len() < self.detections.capacity() {
            self.detections.push(Detection {
                class,
                span: at.span(start, stop),
                score,
                reported_secs: self.reported_secs,
                repetitions,
            });
        } else {
            self.dropped += 1;
        }
    }
}

impl Clone for DetectionBuffer {
    /// By hand, because a copied vector has room only for what it holds.
    fn clone(&self) -> Self {
        let mut copy = Self {
            reported_secs: self.reported_secs,
            dropped: self.dropped,
            ..Self::new()
        };
        copy.detections.extend_from_slice(&self.detections);
        copy
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_there_is_no_room_for_is_counted() {
        let mut found = DetectionBuffer::new();
        let at = Steps {
            origin_secs: 0.0,
            step_secs: 0.1,
        };
        found.begin(1.0);
        for start in 0..70 {
            found.add(ClassId(0), at, (start, start + 1), 0.5, None);
        }
        assert_eq!((found.detections.len(), found.dropped), (64, 6));
        found.begin(2.0);
        found.add(ClassId(0), at, (0, 1), 0.5, None);
        assert_eq!((found.detections.len(), found.dropped), (1, 6));
        assert_eq!(found.clone().dropped, 6);
    }
}
