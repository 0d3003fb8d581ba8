//! Spans of time and their overlaps.

use morec::TimeSpan;

/// True if the intersection over union is at least `least`.
pub(super) fn reaches(a: TimeSpan, b: TimeSpan, least: f64) -> bool {
    a.overlaps(b) && a.iou(b) >= least - TimeSpan::SAME_SECS
}

/// True if less than half of `span` lies in any of `disjoint` stretches. O(n).
pub(super) fn mostly_outside(span: TimeSpan, disjoint: &[TimeSpan]) -> bool {
    let inside: f64 = disjoint.iter().map(|other| span.overlap_secs(*other)).sum();
    inside < 0.5 * span.duration_secs() - TimeSpan::SAME_SECS
}

/// The stretches of 0 to `duration` that none of `disjoint` covers, if they last at least `least` seconds.
pub(super) fn gaps(disjoint: &[TimeSpan], duration: f64, least: f64) -> Vec<TimeSpan> {
    // A rate printed with few digits (frame time .0083333) makes 48 frames a little shorter than 0.4 s.
    const ROUNDED_RATE_SECS: f64 = 1e-3;
    let mut gaps = Vec::new();
    let mut from = 0.0;
    for next in disjoint.iter().chain([&TimeSpan::new(duration, duration)]) {
        let gap = TimeSpan::new(from, next.start_secs.min(duration));
        if gap.duration_secs() >= least - ROUNDED_RATE_SECS {
            gaps.push(gap);
        }
        from = next.stop_secs.max(from);
    }
    gaps
}
