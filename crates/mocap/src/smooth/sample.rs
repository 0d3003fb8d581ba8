//! Samples curves at any rate.

use super::bezier::rotation;
use super::{CompressedClip, Curve};
use crate::clip::{Clip, JointTrack};
use crate::math::{Quat, Vec3, same_hemisphere};
use crate::resample::{self, RateError};

impl CompressedClip {
    /// The `parent_from_joint` rotation of `joint` at a time; outside the clip it stands still. `None` if there is
    /// no such joint. O(log keyframes).
    pub fn rotation_at(&self, joint: usize, time_secs: f64) -> Option<Quat> {
        Some(rotation(
            &self.rotations.get(joint)?.at(self.place(time_secs)),
        ))
    }

    /// The position of `joint` in its parent's frame at a time: its curve's, or the skeleton's offset. `None` if
    /// there is no such joint. O(log keyframes).
    pub fn position_at(&self, joint: usize, time_secs: f64) -> Option<Vec3> {
        match self.positions.iter().find(|curve| curve.joint == joint) {
            Some(curve) => Some(curve.at(self.place(time_secs)).xyz()),
            None => self.skeleton.joints().get(joint).map(|joint| joint.offset),
        }
    }

    fn place(&self, time_secs: f64) -> f64 {
        time_secs * self.rate_hz
    }

    /// The clip at `rate_hz` frames a second. The first frame stays the first; the last is the last that lies within
    /// the source's. O(joints × (frames of the result + keyframes)).
    ///
    /// # Errors
    /// A rate beyond all use.
    pub fn sample(&self, rate_hz: f64) -> Result<Clip, RateError> {
        let instants = resample::instants(self.frames, self.rate_hz, rate_hz)?;
        Ok(self.at(rate_hz, &instants))
    }

    fn at(&self, rate_hz: f64, instants: &[(usize, f64)]) -> Clip {
        let joints = self.skeleton.len();
        let places = || instants.iter().map(|&(frame, t)| frame as f64 + t);
        let mut rotations = vec![Quat::identity(); instants.len() * joints];
        for (j, curve) in self.rotations.iter().enumerate() {
            fill_rotations(curve, places(), j, joints, &mut rotations);
        }
        let track = |curve: &Curve| {
            let mut positions = Vec::with_capacity(instants.len());
            curve.along(places(), |point| positions.push(point.xyz()));
            JointTrack {
                joint: curve.joint,
                positions,
            }
        };
        Clip {
            name: self.name.clone(),
            skeleton: self.skeleton.clone(),
            rate_hz,
            rotations,
            tracks: self.positions.iter().map(track).collect(),
            frames: instants.len(),
            repaired: resample::repaired_at(&self.repaired, instants),
            points: self
                .points
                .as_ref()
                .map(|p| resample::points_at(p, instants)),
        }
    }
}

/// Writes joint `j`'s column of a table of `joints` columns, signs continuous.
fn fill_rotations(
    curve: &Curve,
    places: impl Iterator<Item = f64>,
    j: usize,
    joints: usize,
    table: &mut [Quat],
) {
    let mut at = j;
    curve.along(places, |point| {
        let q = rotation(&point);
        table[at] = if at >= joints {
            same_hemisphere(&table[at - joints], q)
        } else {
            q
        };
        at += joints;
    });
}
