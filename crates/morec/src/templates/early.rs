//! Which motion is under way, before it has ended.

use crate::classes::ClassId;

/// When a beginning is near enough to be told. Tentative: none of this has a say in detections.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EarlyDetectionParams {
    /// A match must have come through this share of its template.
    pub least_progress: f32,
    /// And have lasted for so many ticks.
    pub least_ticks: usize,
    /// Its distance must be below this times the index's threshold,
    pub reach: f32,
    /// below this times that of the nearest beginning of a negative,
    pub gate: f32,
    /// and below this times that of the nearest beginning of another class.
    pub rival: f32,
    /// All that for the same class at so many ticks in a row.
    pub streak: usize,
}

impl Default for EarlyDetectionParams {
    /// Chosen on referee signals by `examples/early.rs`: at half of a motion it is known nine times in ten, and of what is
    /// told as half done an eighth is wrong. With a reach of 1.2 and gates of 1 (0.84 known, 0.04 wrong) other motion
    /// is hardly ever taken for the beginning of a class.
    fn default() -> Self {
        Self {
            least_progress: 0.2,
            least_ticks: 2,
            reach: 1.8,
            gate: 1.1,
            rival: 1.1,
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
    /// The class.
    pub class: ClassId,
    /// Mean squared distance of what was seen from the beginning of a sample.
    pub distance: f32,
    /// Ticks since it began.
    pub age: usize,
    /// How much of the sample has been seen, 0 to 1.
    pub progress: f32,
}
