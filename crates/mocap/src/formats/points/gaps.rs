//! Finds, fills and reports gaps of points.

use super::point::{Point, SHORT_GAP_SECS, SHOWN, is_seen};
use crate::clip::{Gap, Span};
use crate::formats::{Place, Warning};
use crate::math::Vec3;

/// Gaps found and filled.
#[derive(Default)]
pub(super) struct Filled {
    /// Short ones, of any point.
    pub(super) short: Vec<Span>,
    pub(super) long: Vec<Gap>,
}

impl Filled {
    /// Puts positions on the line between those around a gap; what comes before the first or after the last stays
    /// where that was.
    pub(super) fn fill(&mut self, joint: usize, positions: &mut [Vec3], most: usize) {
        for span in gaps(positions) {
            let before = span.start.checked_sub(1).map(|f| positions[f]);
            let after = positions.get(span.end).copied();
            let inside = before.is_some() && after.is_some();
            let (Some(from), Some(to)) = (before.or(after), after.or(before)) else {
                continue;
            };
            let steps = span.len() as f64 + 1.0;
            for frame in span.clone() {
                let t = (frame - span.start + 1) as f64 / steps;
                positions[frame] = from.lerp(&to, t);
            }
            if inside && span.len() <= most {
                self.short.push(span);
            } else {
                self.long.push(Gap {
                    joint,
                    frames: span,
                });
            }
        }
    }

    pub(super) fn note(&self, points: &[Point], rate_hz: f64, warnings: &mut Vec<Warning>) {
        if !self.short.is_empty() {
            let text = format!(
                "{} gaps of up to {SHORT_GAP_SECS} s filled by interpolation",
                self.short.len()
            );
            warnings.push(Warning::new(Place::File, text));
        }
        if self.long.is_empty() {
            return;
        }
        let mut longest: Vec<&Gap> = self.long.iter().collect();
        longest.sort_by_key(|gap| std::cmp::Reverse(gap.frames.len()));
        let shown: Vec<String> = longest
            .iter()
            .take(SHOWN)
            .map(|gap| {
                let secs = |frame: usize| frame as f64 / rate_hz;
                let Span { start, end } = gap.frames;
                let name = &points[gap.joint].name;
                format!("{name} from {:.2} to {:.2} s", secs(start), secs(end))
            })
            .collect();
        let more = if longest.len() > SHOWN { ", …" } else { "" };
        let text = format!(
            "{} gaps not filled, because they are too long or at an end of the clip: {}{more}",
            longest.len(),
            shown.join(", ")
        );
        warnings.push(Warning::new(Place::File, text));
    }
}

/// Runs of frames in which a point was not seen.
fn gaps(positions: &[Vec3]) -> Vec<Span> {
    let mut gaps: Vec<Span> = Vec::new();
    for (frame, position) in positions.iter().enumerate() {
        if is_seen(position) {
            continue;
        }
        match gaps.last_mut().filter(|gap| gap.end == frame) {
            Some(gap) => gap.end += 1,
            None => gaps.push(frame..frame + 1),
        }
    }
    gaps
}

/// Overlapping and touching spans made one, in order.
pub(super) fn union(mut spans: Vec<Span>) -> Vec<Span> {
    spans.sort_by_key(|span| span.start);
    let mut union: Vec<Span> = Vec::new();
    for span in spans {
        match union.last_mut().filter(|last| last.end >= span.start) {
            Some(last) => last.end = last.end.max(span.end),
            None => union.push(span),
        }
    }
    union
}
