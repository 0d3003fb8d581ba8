//! Detection of motions before they have ended.

use crate::classes::ClassId;
use crate::decode::Repetitions;

/// Bounds of beginnings for tentative events. They do not influence detections.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EarlyDetectionParams {
    /// A match must have come through this share of its template.
    pub least_progress: f32,
    /// And have lasted for this many ticks.
    pub least_ticks: usize,
    /// Its distance must be below this times the index's threshold,
    ///
    /// 0.85 and the gates of 0.9 after 1.8 and 1.1: precision of tentative events 0.96 for 0.68 on referee signals,
    /// 0.67 for 0.53 in Kinect sessions; recall 0.86 as before, and 0.94 for 0.96.
    pub reach: f32,
    /// below this times that of the nearest beginning of a negative,
    pub gate: f32,
    /// and below this times that of the nearest beginning of another class.
    pub rival: f32,
    /// All that for the same class at this many ticks in a row.
    pub streak: usize,
}

impl Default for EarlyDetectionParams {
    /// Chosen on referee signals and on sessions before a Kinect by `examples/early.rs`; `docs/figures.md` has what they give.
    /// With a reach of 1.8 and gates of 1.1, recall is 0.86 for 0.86 on the signals and 0.96 for 0.94 in the sessions, and precision
    /// 0.68 for 0.96 and 0.53 for 0.67.
    fn default() -> Self {
        Self {
            least_progress: 0.2,
            least_ticks: 2,
            reach: 0.85,
            gate: 0.9,
            rival: 0.9,
            streak: 1,
        }
    }
}

impl EarlyDetectionParams {
    /// Rows that a match must have come to, of a template of `length`.
    pub fn least_rows(&self, length: usize) -> usize {
        ((length as f32 * self.least_progress).ceil() as usize).clamp(1, length.max(1))
    }
}

/// A class that seems to be under way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OngoingMatch {
    /// The class of the beginning that was matched.
    pub class: ClassId,
    /// Mean squared distance of what was seen from the beginning of a sample.
    pub distance: f32,
    /// Ticks since it began.
    pub age: usize,
    /// Share of the sample that has been seen, 0 to 1.
    pub progress: f32,
    /// Its duration so far over that of the sample so far.
    pub pace: f32,
    /// True of an activity: other motions come and go while it does.
    pub goes_on: bool,
    /// Of an activity that repeats, so far.
    pub repetitions: Option<Repetitions>,
    /// Of those, how many are certainly over, and ticks since the last of them was.
    pub whole: Option<(u32, f64)>,
}
