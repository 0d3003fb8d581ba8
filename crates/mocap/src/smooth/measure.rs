//! Measures the difference between a compressed clip and its source, frame by frame.

use super::CompressedClip;
use super::errors::Errors;
use super::playhead::Playhead;
use crate::clip::Clip;
use crate::kinematics::WorldPose;
use crate::math::Quat;

/// The largest and the mean of many.
#[derive(Default)]
struct ErrorSum {
    largest: f64,
    sum: f64,
    count: usize,
}

impl ErrorSum {
    fn add(&mut self, value: f64) {
        self.largest = self.largest.max(value);
        self.sum += value;
        self.count += 1;
    }

    fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

/// The angle between two rotations; exact near 0, where an arc cosine would lose half the digits.
pub(super) fn angle_between(a: &Quat, b: &Quat) -> f64 {
    let (minus, plus) = ((a.coords - b.coords).norm(), (a.coords + b.coords).norm());
    4.0 * minus.min(plus).atan2(minus.max(plus))
}

impl Errors {
    /// The distances between a clip and its curves, which have its joints, tracks and frames. O(frames × joints).
    pub(super) fn of(curves: &CompressedClip, clip: &Clip) -> Self {
        let metres_per_unit = curves.params.metres_per_unit;
        let (mut angle, mut position, mut world) = (
            ErrorSum::default(),
            ErrorSum::default(),
            ErrorSum::default(),
        );
        for (track, curve) in clip.tracks.iter().zip(&curves.positions) {
            let mut positions = track.positions.iter();
            curve.along((0..clip.frames).map(|frame| frame as f64), |point| {
                let off = positions.next().map(|p| (p - point.xyz()).norm());
                position.add(off.unwrap_or_default() * metres_per_unit);
            });
        }
        let (mut pose, mut played) = (WorldPose::default(), Playhead::new(clip));
        for frame in 0..clip.frames {
            pose.set(clip, frame);
            played.set(curves.curves(), frame);
            for (x, y) in clip.frame_rotations(frame).iter().zip(played.rotations()) {
                angle.add(angle_between(x, y));
            }
            for (x, y) in pose.positions.iter().zip(played.world()) {
                world.add((x - y).norm() * metres_per_unit);
            }
        }
        Self {
            max_angle_rad: angle.largest,
            mean_angle_rad: angle.mean(),
            max_position_metres: position.largest,
            mean_position_metres: position.mean(),
            max_joint_position_metres: world.largest,
            mean_joint_position_metres: world.mean(),
        }
    }
}

impl CompressedClip {
    /// Distance of the curves from `clip` at each of its frames; `None` if its joints, tracks or number of frames
    /// are not those of the clip that was compressed. O(frames × joints).
    pub fn measure(&self, clip: &Clip) -> Option<Errors> {
        let same = clip.frames == self.frames
            && clip.skeleton == self.skeleton
            && clip.rotations.len() == clip.frames * clip.skeleton.len()
            && clip
                .tracks
                .iter()
                .map(|t| t.joint)
                .eq(self.positions.iter().map(|c| c.joint))
            && clip.tracks.iter().all(|t| t.positions.len() == clip.frames);
        same.then(|| Errors::of(self, clip))
    }
}
