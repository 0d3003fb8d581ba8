//! The positions of one point over time, with gaps.

use crate::math::Vec3;

/// Gaps of up to this are filled and trusted: markers hardly leave a straight line in so little time.
pub(in crate::formats) const SHORT_GAP_SECS: f64 = 0.25;

/// Names shown in a warning.
pub(super) const SHOWN: usize = 6;

/// One point over time; a position that is not finite was not seen.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::formats) struct Point {
    pub(in crate::formats) name: String,
    pub(in crate::formats) positions: Vec<Vec3>,
}

/// A position that was not seen.
pub(in crate::formats) const UNSEEN: Vec3 = Vec3::new(f64::NAN, f64::NAN, f64::NAN);

pub(super) fn is_seen(position: &Vec3) -> bool {
    position.iter().all(|c| c.is_finite())
}
