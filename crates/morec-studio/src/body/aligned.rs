//! One performance beside another: which moment of the second belongs to a moment of the first.

use std::sync::Arc;

use morec_measure::explain::MotionDeviation;

use super::ClipMotion;
use crate::stretch::Stretch;

/// Two stretches along their warping path.
#[derive(Debug)]
pub struct Aligned {
    pub of: Stretch,
    pub with: Stretch,
    /// True if the second is shown in a mirror.
    pub mirrored: bool,
    /// The second's clip.
    pub motion: Arc<ClipMotion>,
    /// For every tick of the first, the moment of the second, seconds.
    pub path: Vec<f64>,
    pub tick_hz: f64,
    /// How far the first is from the second; `None` of stretches too long to align.
    pub deviation: Option<MotionDeviation>,
}

impl Aligned {
    /// The moment of the second stretch that belongs to a moment of the first; before and after it, at the same pace.
    pub fn at(&self, secs: f64) -> f64 {
        let (first, last) = (self.with.span.start_secs, self.with.span.stop_secs);
        let of = self.of.span;
        if secs <= of.start_secs {
            return (first + secs - of.start_secs).max(0.0);
        }
        if secs >= of.stop_secs {
            return last + secs - of.stop_secs;
        }
        let place = (secs - of.start_secs) * self.tick_hz;
        let (tick, rest) = (place.floor() as usize, place.fract());
        let here = self.path.get(tick).copied().unwrap_or(last);
        let next = self.path.get(tick + 1).copied().unwrap_or(last);
        here + (next - here) * rest
    }
}
