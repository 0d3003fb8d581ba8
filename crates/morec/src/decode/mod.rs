//! Decoding: from distances at every tick to one detection for each motion. A reported detection is never revoked. Used by the
//! template engine; knows distances and thresholds, but neither rows nor templates.

mod decoder;
mod params;

#[cfg(test)]
mod tests;

use crate::classes::ClassId;
use crate::math::portable;

pub use decoder::{Decoder, ScoredCandidate};
pub use params::{CandidatePolicy, DecodeParams, TYPICAL_SPREAD};

/// Distance of a class that nothing has matched yet.
pub const FAR: f32 = 1e30;

/// Distance of one class at one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassDistance {
    /// Smallest distance to any of the class's templates; [`FAR`] if none has matched.
    pub distance: f32,
    /// Ticks since that template's match began.
    pub age: usize,
    /// Spread of the matched stretch about its mean.
    pub spread: f32,
    /// Distance as a share of that of a body at rest: see [`NormalizedMatch`](crate::templates::NormalizedMatch).
    pub rest_share: f32,
}

impl ClassDistance {
    /// No match.
    pub const NONE: Self = Self {
        distance: FAR,
        age: 0,
        spread: 0.0,
        rest_share: 0.0,
    };
}

/// A stretch that may be a motion, for a judge to look at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Class of the candidate.
    pub class: ClassId,
    /// Its last tick.
    pub tick: i64,
    /// Ticks from its first to its last.
    pub age: usize,
    /// The class's distance there.
    pub distance: f32,
    /// Smallest distance of another class: under [`CandidatePolicy::Verify`] within [`DecodeParams::peak_ticks`], under
    /// [`CandidatePolicy::Gate`] of a rival within [`DecodeParams::rival_ticks`]. [`FAR`] if there is none.
    pub other: f32,
    /// Smallest negative distance within the same ticks.
    pub negative: f32,
}

impl Candidate {
    /// See [`TickDetection::separation`].
    pub fn separation(&self) -> f32 {
        let nearest = self.distance.max(f32::MIN_POSITIVE);
        portable::ln(self.other.max(nearest) / nearest).min(1.0)
    }
}

/// A motion recognised, in ticks of the present stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TickDetection {
    /// Class of the detection.
    pub class: ClassId,
    /// First tick.
    pub start: i64,
    /// One past the last tick.
    pub stop: i64,
    /// 0 just accepted … 1 certain.
    pub score: f64,
    /// Distinctness from other classes: the logarithm of the nearest other class's distance over its own, from 0
    /// (as near) to 1 (e times as far, or farther), as the nearest neighbour distance ratio of Mendes Júnior et al., *Nearest neighbors
    /// distance ratio open-set classifier*, 2017.
    pub separation: f32,
    /// See [`ClassDistance::rest_share`].
    pub rest_share: f32,
    /// Of an activity that repeats.
    pub repetitions: Option<Repetitions>,
}

/// Repetitions of an activity.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Repetitions {
    /// The nearest whole number, at least 1.
    #[serde(rename = "repetitions")]
    pub count: u32,
    /// Duration of one, as it was last.
    pub period_secs: f64,
}

/// A copy of a vector that has as much room: a derived copy has room for what it holds only, and pushing must not allocate.
pub(crate) fn copy_with_room<T: Copy>(of: &Vec<T>) -> Vec<T> {
    let mut copy = Vec::with_capacity(of.capacity());
    copy.extend_from_slice(of);
    copy
}

/// A stretch of fewer ticks than this after its first is no motion.
pub const MIN_AGE_TICKS: usize = 3;
