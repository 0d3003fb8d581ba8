//! Stretches of time and what they share.

use std::cmp::Ordering;

/// Two times that differ by no more than this are one: frames that became seconds carry rounding errors.
const SAME_SECS: f64 = 1e-9;

/// A stretch of time in seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub start: f64,
    pub stop: f64,
}

impl Interval {
    /// True if both ends are numbers and in order.
    pub fn is_stretch(self) -> bool {
        self.start.is_finite() && self.stop.is_finite() && self.stop > self.start
    }

    pub fn secs(self) -> f64 {
        self.stop - self.start
    }

    /// By start, then by stop.
    pub fn order(self, other: Interval) -> Ordering {
        self.start
            .total_cmp(&other.start)
            .then(self.stop.total_cmp(&other.stop))
    }

    /// Length of what both share; 0 if nothing.
    pub fn overlap(self, other: Interval) -> f64 {
        (self.stop.min(other.stop) - self.start.max(other.start)).max(0.0)
    }

    /// Intersection over union, 0 to 1.
    pub fn iou(self, other: Interval) -> f64 {
        let shared = self.overlap(other);
        shared / (self.secs() + other.secs() - shared)
    }

    /// True if the intersection over union is at least `least`.
    pub fn reaches(self, other: Interval, least: f64) -> bool {
        self.overlap(other) > 0.0 && self.iou(other) >= least - SAME_SECS
    }

    /// The thesis's match (§5.4): they share more than half of the shorter one.
    pub fn matches(self, other: Interval) -> bool {
        self.overlap(other) > 0.5 * self.secs().min(other.secs()) + SAME_SECS
    }
}

/// The union of stretches, as disjoint stretches in order. `sorted` is ordered by start. O(n).
pub(super) fn union(sorted: impl IntoIterator<Item = Interval>) -> Vec<Interval> {
    let mut merged: Vec<Interval> = Vec::new();
    for next in sorted {
        match merged.last_mut() {
            Some(last) if next.start <= last.stop => last.stop = last.stop.max(next.stop),
            _ => merged.push(next),
        }
    }
    merged
}

/// True if less than half of `interval` lies in any of `disjoint` stretches. O(n).
pub(super) fn mostly_outside(interval: Interval, disjoint: &[Interval]) -> bool {
    let inside: f64 = disjoint.iter().map(|other| interval.overlap(*other)).sum();
    inside < 0.5 * interval.secs() - SAME_SECS
}

/// The stretches of 0 to `duration` that none of `disjoint` covers, if they last at least `least` seconds.
pub(super) fn gaps(disjoint: &[Interval], duration: f64, least: f64) -> Vec<Interval> {
    // A rate printed with few digits (frame time .0083333) makes 48 frames a little shorter than 0.4 s.
    const ROUNDED_RATE_SECS: f64 = 1e-3;
    let mut gaps = Vec::new();
    let mut from = 0.0;
    let end = Interval {
        start: duration,
        stop: duration,
    };
    for next in disjoint.iter().chain([&end]) {
        let gap = Interval {
            start: from,
            stop: next.start.min(duration),
        };
        if gap.secs() >= least - ROUNDED_RATE_SECS {
            gaps.push(gap);
        }
        from = next.stop.max(from);
    }
    gaps
}
