//! Spans of time.

use std::cmp::Ordering;
use std::fmt;
use std::ops::Range;

/// A span of time in seconds, half-open.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TimeSpan {
    /// When it begins.
    pub start_secs: f64,
    /// When it ends.
    pub stop_secs: f64,
}

impl TimeSpan {
    /// Two times that differ by no more than this are one: frames that became seconds carry rounding errors.
    pub const SAME_SECS: f64 = 1e-9;

    /// From one moment to another.
    pub const fn new(start_secs: f64, stop_secs: f64) -> Self {
        Self {
            start_secs,
            stop_secs,
        }
    }

    /// The span of frames that are `rate_hz` a second.
    pub fn of_frames(frames: Range<usize>, rate_hz: f64) -> Self {
        Self::new(frames.start as f64 / rate_hz, frames.end as f64 / rate_hz)
    }

    /// The frames nearest to it at `rate_hz` a second, half-open; never from a later one to an earlier one.
    pub fn frames(self, rate_hz: f64) -> Range<usize> {
        // What lies before 0, or is no number, becomes 0.
        let frame = |secs: f64| (secs * rate_hz).round() as usize;
        let start = frame(self.start_secs);
        start..frame(self.stop_secs).max(start)
    }

    /// Those of its frames that are among the first `count`.
    pub fn frames_among(self, count: usize, rate_hz: f64) -> Range<usize> {
        let frames = self.frames(rate_hz);
        frames.start.min(count)..frames.end.min(count)
    }

    /// Length, seconds.
    pub fn duration_secs(self) -> f64 {
        self.stop_secs - self.start_secs
    }

    /// Half-way between start and stop, seconds.
    pub fn middle_secs(self) -> f64 {
        0.5 * (self.start_secs + self.stop_secs)
    }

    /// True if both ends are numbers and in order.
    pub fn is_stretch(self) -> bool {
        self.start_secs.is_finite()
            && self.stop_secs.is_finite()
            && self.stop_secs > self.start_secs
    }

    /// True if the moment is in it: the start is, the stop is not.
    pub fn contains(self, secs: f64) -> bool {
        self.start_secs <= secs && secs < self.stop_secs
    }

    /// True if both have time in common.
    pub fn overlaps(self, other: Self) -> bool {
        self.start_secs < other.stop_secs && other.start_secs < self.stop_secs
    }

    /// Length of what both have in common; 0 if nothing.
    pub fn overlap_secs(self, other: Self) -> f64 {
        (self.stop_secs.min(other.stop_secs) - self.start_secs.max(other.start_secs)).max(0.0)
    }

    /// What both have in common over the shorter of the two, 0 to 1.
    pub fn overlap_share(self, other: Self) -> f64 {
        let shorter = self.duration_secs().min(other.duration_secs());
        self.overlap_secs(other) / shorter.max(f64::MIN_POSITIVE)
    }

    /// True if more than half of the shorter one is common to both: the match of the thesis (§5.4).
    pub fn matches(self, other: Self) -> bool {
        let shorter = self.duration_secs().min(other.duration_secs());
        self.overlap_secs(other) > 0.5 * shorter + Self::SAME_SECS
    }

    /// The union of spans, as disjoint spans in order. `sorted` is ordered by start. O(n).
    pub fn union(sorted: impl IntoIterator<Item = Self>) -> Vec<Self> {
        let mut merged: Vec<Self> = Vec::new();
        for next in sorted {
            match merged.last_mut() {
                Some(last) if next.start_secs <= last.stop_secs => {
                    last.stop_secs = last.stop_secs.max(next.stop_secs);
                }
                _ => merged.push(next),
            }
        }
        merged
    }

    /// Intersection over union, 0 to 1.
    pub fn iou(self, other: Self) -> f64 {
        let shared = self.overlap_secs(other);
        shared / (self.duration_secs() + other.duration_secs() - shared)
    }

    /// Both ends on another clock.
    pub fn map(self, mut secs: impl FnMut(f64) -> f64) -> Self {
        Self::new(secs(self.start_secs), secs(self.stop_secs))
    }

    /// True if both ends differ by less than `by_secs` from the other's.
    pub fn is_near(self, other: Self, by_secs: f64) -> bool {
        (self.start_secs - other.start_secs).abs() < by_secs
            && (self.stop_secs - other.stop_secs).abs() < by_secs
    }

    /// By start, then by stop.
    pub fn order(self, other: Self) -> Ordering {
        (self.start_secs.total_cmp(&other.start_secs))
            .then(self.stop_secs.total_cmp(&other.stop_secs))
    }
}

impl From<Range<f64>> for TimeSpan {
    fn from(secs: Range<f64>) -> Self {
        Self::new(secs.start, secs.end)
    }
}

impl fmt::Display for TimeSpan {
    /// `1.23–2.50 s`, with as many digits as are asked for: `{span:.2}`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.start_secs.fmt(f)?;
        f.write_str("–")?;
        self.stop_secs.fmt(f)?;
        f.write_str(" s")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn overlaps_are_those_counted_by_hand() {
        let of = TimeSpan::new(1.0, 3.0);
        for (other, shared, share, iou) in [
            (0.0..1.0, 0.0, 0.0, 0.0),
            (2.0..4.0, 1.0, 0.5, 1.0 / 3.0),
            (1.5..2.0, 0.5, 1.0, 0.25),
            (0.0..5.0, 2.0, 1.0, 0.4),
            (5.0..6.0, 0.0, 0.0, 0.0),
        ] {
            let other = TimeSpan::from(other);
            assert_eq!(of.overlap_secs(other), shared, "{other}");
            assert_eq!(of.overlap_share(other), share, "{other}");
            assert_eq!(of.iou(other), iou, "{other}");
            assert_eq!(of.overlaps(other), shared > 0.0, "{other}");
        }
    }

    #[test]
    fn half_of_the_shorter_one_is_no_match_and_rounding_makes_none() {
        let of = TimeSpan::new(1.0, 3.0);
        let found = [2.0, 2.0 - 1e-12, 1.9].map(|start| TimeSpan::new(start, start + 2.0));
        assert_eq!(found.map(|found| of.matches(found)), [false, false, true]);
        assert!(of.matches(TimeSpan::new(1.2, 1.3)));
    }

    #[test]
    fn the_start_is_inside_and_the_stop_is_not() {
        let span = TimeSpan::new(1.0, 2.5);
        assert_eq!((span.duration_secs(), span.middle_secs()), (1.5, 1.75));
        let inside = [0.9, 1.0, 2.4, 2.5, f64::NAN].map(|secs| span.contains(secs));
        assert_eq!(inside, [false, true, true, false, false]);
        assert!(span.is_near(TimeSpan::new(1.05, 2.45), 0.1));
        assert!(!span.is_near(TimeSpan::new(1.0, 2.7), 0.1));
    }

    #[test]
    fn spans_without_a_length_are_no_stretches() {
        for (start, stop) in [
            (1.0, 1.0),
            (2.0, 1.0),
            (f64::NAN, 1.0),
            (0.0, f64::INFINITY),
        ] {
            assert!(!TimeSpan::new(start, stop).is_stretch());
        }
        assert_eq!(TimeSpan::new(2.0, 1.0).frames(30.0), 60..60);
        assert_eq!(TimeSpan::new(-2.0, 1.0).frames(30.0), 0..30);
        assert_eq!(TimeSpan::new(1.0, 2.0).frames_among(40, 30.0), 30..40);
        assert_eq!(TimeSpan::new(2.0, 3.0).frames_among(40, 30.0), 40..40);
    }

    #[test]
    fn digits_are_those_asked_for() {
        let span = TimeSpan::new(0.5, 2.0);
        assert_eq!(format!("{span:.2}, {span}"), "0.50–2.00 s, 0.5–2 s");
    }

    proptest! {
        #[test]
        fn frames_come_back(start in 0usize..100_000, length in 0usize..1000, rate_hz in 10.0f64..250.0) {
            let frames = start..start + length;
            prop_assert_eq!(TimeSpan::of_frames(frames.clone(), rate_hz).frames(rate_hz), frames);
        }
    }
}
