//! Missing and damaged frames: recorded in order, then interpolated from their neighbours.

use crate::clip::Span;
use crate::math::{Quat, Vec3, slerp};

/// Increasing frame numbers at which something is missing.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Gaps {
    frames: Vec<usize>,
}

impl Gaps {
    /// The gaps at these increasing frames.
    pub fn from_frames(frames: &[usize]) -> Self {
        Self {
            frames: frames.to_vec(),
        }
    }

    /// Adds `frame`, which is larger than all before it.
    pub fn add(&mut self, frame: usize) {
        self.frames.push(frame);
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.frames.clear();
    }

    /// Renumbers for a clip into which the frames `lost` were put back, and adds these. O(both).
    pub fn shift(&mut self, lost: &[usize]) {
        let mut all = Vec::with_capacity(self.frames.len() + lost.len());
        let mut before = 0;
        for &frame in &self.frames {
            while before < lost.len() && lost[before] <= frame + before {
                all.push(lost[before]);
                before += 1;
            }
            all.push(frame + before);
        }
        all.extend(&lost[before..]);
        self.frames = all;
    }

    /// Adds the frames of `other`.
    pub fn merge(&mut self, other: &Gaps) {
        if other.frames.is_empty() {
            return;
        }
        self.frames.extend(&other.frames);
        self.frames.sort_unstable();
        self.frames.dedup();
    }

    /// Runs of neighbouring frames.
    pub fn spans(&self) -> Vec<Span> {
        let mut spans: Vec<Span> = Vec::new();
        for &frame in &self.frames {
            match spans.last_mut().filter(|s| s.end == frame) {
                Some(span) => span.end += 1,
                None => spans.push(frame..frame + 1),
            }
        }
        spans
    }
}

/// Makes room in `rows` of `width` for those at the increasing row numbers `lost`; each is a copy of the row
/// before it, or of the first.
pub(super) fn spread<T: Copy>(rows: &mut Vec<T>, width: usize, lost: &[usize]) {
    if lost.is_empty() || rows.is_empty() {
        return;
    }
    let mut all = Vec::with_capacity(rows.len() + lost.len() * width);
    let mut next = 0;
    for &row in lost {
        let kept = row * width - all.len();
        all.extend_from_slice(&rows[next..next + kept]);
        next += kept;
        let copied = next.saturating_sub(width);
        all.extend_from_slice(&rows[copied..copied + width]);
    }
    all.extend_from_slice(&rows[next..]);
    *rows = all;
}

/// Fills `span` of a column of rotations (every `stride`th element of `rotations`, `frames` of them): along the
/// shorter arc between its neighbours, or with the one neighbour it has.
pub(super) fn fill_rotations(rotations: &mut [Quat], stride: usize, frames: usize, span: Span) {
    let before = span.start.checked_sub(1).map(|f| rotations[f * stride]);
    let after = (span.end < frames).then(|| rotations[span.end * stride]);
    let (Some(from), Some(to)) = (before.or(after), after.or(before)) else {
        return;
    };
    for (frame, t) in steps(&span) {
        rotations[frame * stride] = slerp(&from, &to, t);
    }
}

/// Fills `span` of `positions` on the straight line between its neighbours, or with the one neighbour it has.
pub(super) fn fill_positions(positions: &mut [Vec3], span: Span) {
    let before = span.start.checked_sub(1).map(|f| positions[f]);
    let after = positions.get(span.end).copied();
    let (Some(from), Some(to)) = (before.or(after), after.or(before)) else {
        return;
    };
    for (frame, t) in steps(&span) {
        positions[frame] = from.lerp(&to, t);
    }
}

/// The frames of `span` and how far each lies between the frames on either side of it, 0 to 1 exclusive.
fn steps(span: &Span) -> impl Iterator<Item = (usize, f64)> + use<> {
    let (start, whole) = (span.start, (span.len() + 1) as f64);
    span.clone()
        .map(move |frame| (frame, (frame - start + 1) as f64 / whole))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Axis;
    use proptest::prelude::*;

    proptest! {
        /// Against the slow way: every frame in a list, the lost ones inserted one by one.
        #[test]
        fn lost_rows_find_their_places(is_lost in proptest::collection::vec(proptest::bool::weighted(0.2), 1..25)) {
            let kept = is_lost.iter().filter(|l| !**l).count();
            let lost: Vec<usize> = (0..is_lost.len()).filter(|&f| is_lost[f]).collect();
            let mut count = 0;
            let slow: Vec<Option<usize>> = is_lost
                .iter()
                .map(|&l| {
                    count += usize::from(!l);
                    (!l).then(|| count - 1)
                })
                .collect();
            prop_assume!(kept > 0);

            let mut rows: Vec<usize> = (0..kept).flat_map(|r| [r, r]).collect();
            spread(&mut rows, 2, &lost);
            prop_assert_eq!(rows.len(), 2 * slow.len());
            let mut last = 0;
            for (f, frame) in slow.iter().enumerate() {
                last = frame.unwrap_or(last);
                prop_assert_eq!(&rows[2 * f..2 * f + 2], &[last, last]);
            }

            let mut gaps = Gaps::from_frames(&(0..kept).filter(|r| r % 3 == 0).collect::<Vec<_>>());
            gaps.shift(&lost);
            let expected: Vec<_> = (0..slow.len()).filter(|&f| slow[f].is_none_or(|r| r % 3 == 0)).collect();
            prop_assert_eq!(gaps, Gaps::from_frames(&expected));
        }
    }

    #[test]
    fn a_gap_is_crossed_evenly() {
        let mut rotations: Vec<Quat> = [0.0, 9.0, 9.0, 0.9]
            .iter()
            .map(|a| Axis::Y.rotation(*a))
            .collect();
        fill_rotations(&mut rotations, 1, 4, 1..3);
        for (f, q) in rotations.iter().enumerate() {
            assert!(q.angle_to(&Axis::Y.rotation(0.3 * f as f64)) < 1e-12);
        }
    }

    #[test]
    fn a_gap_at_an_end_holds_its_neighbour() {
        let mut positions = vec![Vec3::x() * 7.0, Vec3::x(), Vec3::x() * 9.0];
        fill_positions(&mut positions, 0..1);
        fill_positions(&mut positions, 2..3);
        assert_eq!(positions, [Vec3::x(); 3]);
    }
}
