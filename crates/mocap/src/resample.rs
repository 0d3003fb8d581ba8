//! Resamples a clip to another rate.
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let bytes = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/testdata/mclip/v1.mclip"));
//! let clip = mocap::read(bytes, "push.mclip")?.clips.remove(0);
//! let slower = clip.resampled(24.0)?;
//! assert!((slower.duration_secs() - clip.duration_secs()).abs() < 1.0 / 24.0);
//! # Ok(())
//! # }
//! ```

use crate::clip::{Clip, Gap, JointTrack, Points, Span};
use crate::math::{same_hemisphere, slerp};

/// A rate that no clip can be brought to, or that a clip cannot have.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("cannot resample from {from_hz} to {to_hz} frames a second: rates are 0.001 to 100000")]
pub struct RateError {
    /// The clip's rate.
    pub from_hz: f64,
    /// The rate asked for.
    pub to_hz: f64,
}

/// Share of the steps between frames that makes a part of the median step the usual one.
const USUAL_SHARE: f64 = 0.2;

/// The usual one of the steps between a stream's frames: the mean of those near the median, or near a half or a third of the
/// median if a fifth of all steps are: most steps of a stream may be longer because frames are missing. `None` without
/// steps. O(n log n).
pub fn usual_step(steps: &[f64]) -> Option<f64> {
    let mut sorted = steps.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let median = *sorted.get(sorted.len() / 2)?;
    let near = |step: f64| {
        // Printed times have few digits.
        let allowed = 0.1 * step + 0.0011;
        let near = sorted.iter().filter(|s| (*s - step).abs() <= allowed);
        let (sum, count) = near.fold((0.0, 0usize), |(sum, n), s| (sum + s, n + 1));
        (count > 0).then(|| (sum / count as f64, count))
    };
    let least = USUAL_SHARE * sorted.len() as f64;
    let of_frames = [3.0, 2.0].into_iter().find_map(|frames| {
        let (step, count) = near(median / frames)?;
        (count as f64 >= least).then_some(step)
    });
    of_frames.or_else(|| Some(near(median)?.0))
}

/// Instants that lie this near to a frame, in frames, are that frame: rates are known to fewer digits.
const SAME_FRAME: f64 = 1e-6;

impl Clip {
    /// The clip at `rate_hz` frames a second: spherical interpolation for rotations (along the shorter arc, signs
    /// continuous), linear for positions. The first frame stays the first; the last is the last that lies within the
    /// clip. Where an instant of the new clip is one of the old, its values are the old ones bit for bit, but for
    /// a quaternion's sign. A clip of no frames or one keeps its frames. O(joints × frames of the result).
    ///
    /// # Errors
    /// If one of the two rates is not finite or beyond all use.
    pub fn resampled(&self, rate_hz: f64) -> Result<Clip, RateError> {
        let instants = instants(self.frames, self.rate_hz, rate_hz)?;
        Ok(Clip {
            name: self.name.clone(),
            skeleton: self.skeleton.clone(),
            rate_hz,
            rotations: self.rotations_at(&instants),
            tracks: self.tracks.iter().map(|t| track_at(t, &instants)).collect(),
            frames: instants.len(),
            repaired: repaired_at(&self.repaired, &instants),
            points: self.points.as_ref().map(|p| points_at(p, &instants)),
        })
    }

    fn rotations_at(&self, instants: &[(usize, f64)]) -> Vec<crate::math::Quat> {
        let joints = self.skeleton.len();
        let mut rotations = Vec::with_capacity(instants.len() * joints);
        for &(frame, t) in instants {
            let before = self.frame_rotations(frame);
            let after = if t > 0.0 {
                self.frame_rotations(frame + 1)
            } else {
                before
            };
            for j in 0..joints {
                let rotation = slerp(&before[j], &after[j], t);
                let previous = rotations
                    .len()
                    .checked_sub(joints)
                    .map_or(rotation, |p| rotations[p]);
                rotations.push(same_hemisphere(&previous, rotation));
            }
        }
        rotations
    }
}

/// Positions of the frames of a clip of `frames` frames at `to_hz` among those it has at `from_hz`: a frame, and how far
/// towards the next. All of them lie within the clip.
///
/// # Errors
/// If one of the two rates is not finite or beyond all use.
pub(crate) fn instants(
    frames: usize,
    from_hz: f64,
    to_hz: f64,
) -> Result<Vec<(usize, f64)>, RateError> {
    if ![from_hz, to_hz]
        .iter()
        .all(|rate| (1e-3..=1e5).contains(rate))
    {
        return Err(RateError { from_hz, to_hz });
    }
    let old_per_new = from_hz / to_hz;
    let last = frames.saturating_sub(1) as f64;
    let new_frames = match frames {
        0 => 0,
        _ => ((last + SAME_FRAME) / old_per_new).floor() as usize + 1,
    };
    Ok((0..new_frames)
        .map(|f| instant(f as f64 * old_per_new, last))
        .collect())
}

/// Runs of new frames that a repaired old one has a part in.
pub(crate) fn repaired_at(repaired: &[Span], instants: &[(usize, f64)]) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    let mut repaired = repaired.iter().peekable();
    for (new, &(frame, t)) in instants.iter().enumerate() {
        while repaired.next_if(|span| span.end <= frame).is_some() {}
        let last_used = frame + usize::from(t > 0.0);
        if repaired.peek().is_none_or(|span| span.start > last_used) {
            continue;
        }
        match spans.last_mut().filter(|s| s.end == new) {
            Some(span) => span.end += 1,
            None => spans.push(new..new + 1),
        }
    }
    spans
}

/// The same for a clip of points: a gap is every new frame that a missing old one has a part in.
pub(crate) fn points_at(points: &Points, instants: &[(usize, f64)]) -> Points {
    let mut gaps = Vec::new();
    for of_joint in points.gaps.chunk_by(|a, b| a.joint == b.joint) {
        let spans: Vec<Span> = of_joint.iter().map(|gap| gap.frames.clone()).collect();
        let joint = of_joint[0].joint;
        let at = repaired_at(&spans, instants).into_iter();
        gaps.extend(at.map(|frames| Gap { joint, frames }));
    }
    Points { gaps, ..*points }
}

/// The frame at or before the place `at` (in frames), and how far it lies towards the next, 0 to 1 exclusive.
fn instant(at: f64, last: f64) -> (usize, f64) {
    let nearest = at.round();
    if (at - nearest).abs() <= SAME_FRAME || at >= last {
        return (nearest.min(last) as usize, 0.0);
    }
    (at.floor() as usize, at.fract())
}

fn track_at(track: &JointTrack, instants: &[(usize, f64)]) -> JointTrack {
    let position = |&(frame, t): &(usize, f64)| match t > 0.0 {
        true => track.positions[frame].lerp(&track.positions[frame + 1], t),
        false => track.positions[frame],
    };
    JointTrack {
        joint: track.joint,
        positions: instants.iter().map(position).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Axis, Vec3};
    use crate::smooth::tests::one_joint;
    use proptest::prelude::*;

    /// One joint that turns about Y and moves along X, given by functions of time.
    fn clip(
        rate_hz: f64,
        frames: usize,
        angle: impl Fn(f64) -> f64,
        x: impl Fn(f64) -> f64,
    ) -> Clip {
        let rotation = |t| Axis::Y.rotation(angle(t));
        one_joint(rate_hz, frames, rotation, |t| Vec3::new(x(t), 0.0, 0.0))
    }

    proptest! {
        /// Uniform turning and moving is what both interpolations follow exactly, at any pair of rates.
        #[test]
        fn uniform_motion_stays_what_it_is(from in 15.0f64..240.0, to in 15.0f64..240.0, frames in 0usize..200) {
            let old = clip(from, frames, |t| 3.0 * t, |t| 2.0 * t);
            let new = old.resampled(to).unwrap();
            prop_assert_eq!(new.rotations.len(), new.frames);
            for f in 0..new.frames {
                let t = f as f64 / to;
                prop_assert!(new.rotations[f].angle_to(&Axis::Y.rotation(3.0 * t)) < 1e-6);
                prop_assert!((new.tracks[0].positions[f].x - 2.0 * t).abs() < 1e-6);
                prop_assert!(f == 0 || new.rotations[f - 1].coords.dot(&new.rotations[f].coords) >= 0.0);
            }
            if frames > 0 {
                let lost = (frames - 1) as f64 / from - (new.frames - 1) as f64 / to;
                prop_assert!((-1e-6..1.0 / to).contains(&lost), "lost {} s", lost);
            }
        }
    }

    #[test]
    fn coinciding_instants_keep_every_bit() {
        let old = clip(120.0, 121, |t| (7.0 * t).sin() * 3.0, |t| (3.0 * t).cos());
        let new = old.resampled(30.0).unwrap();
        assert_eq!(new.frames, 31);
        for f in 0..31 {
            assert_eq!(new.tracks[0].positions[f], old.tracks[0].positions[4 * f]);
            assert_eq!(
                new.rotations[f].coords.abs(),
                old.rotations[4 * f].coords.abs()
            );
        }
        let up = new.resampled(90.0).unwrap();
        assert_eq!(up.frames, 91);
        assert!((0..31).all(|f| up.rotations[3 * f] == new.rotations[f]));
        assert_eq!(old.resampled(120.0).unwrap(), old);
    }

    #[test]
    fn nothing_and_a_single_frame_stay() {
        for frames in [0, 1] {
            let old = clip(120.0, frames, |_| 1.0, |_| 2.0);
            let new = old.resampled(33.0).unwrap();
            assert_eq!(
                new,
                Clip {
                    rate_hz: 33.0,
                    ..old
                }
            );
        }
    }

    #[test]
    fn repaired_frames_are_still_marked() {
        let mut old = clip(60.0, 61, |t| t, |t| t);
        old.repaired = vec![0..1, 11..13, 60..61];
        assert_eq!(old.resampled(30.0).unwrap().repaired, [0..1, 6..7, 30..31]);
        assert_eq!(
            old.resampled(120.0).unwrap().repaired,
            [0..2, 21..26, 119..121]
        );
    }

    #[test]
    fn gaps_of_points_follow() {
        let mut old = clip(60.0, 61, |t| t, |t| t);
        let gap = |joint, frames| Gap { joint, frames };
        let gaps = vec![gap(0, 11..13), gap(0, 60..61), gap(3, 0..1)];
        old.points = Some(Points {
            gaps,
            metres_per_unit: Some(0.001),
        });
        let new = old.resampled(30.0).unwrap().points.unwrap();
        assert_eq!(new.gaps, [gap(0, 6..7), gap(0, 30..31), gap(3, 0..1)]);
        assert_eq!(new.metres_per_unit, Some(0.001));
    }

    #[test]
    fn impossible_rates_are_refused() {
        for rate in [0.0, -30.0, f64::NAN, f64::INFINITY, 1e9] {
            assert!(clip(30.0, 3, |t| t, |t| t).resampled(rate).is_err());
        }
    }
}
