//! Builds a clip from poses, frame by frame. All readers of formats with rotations use it; limits of size are enforced here.

use super::{ParseError, Place};
use crate::clip::{Clip, Joint, JointTrack, Skeleton, Span};
use crate::math::{Quat, Vec3, same_hemisphere, slerp};

/// A joint that strays from its place in its parent's frame by less than this share of the skeleton's size does not
/// move: files with positions in the world round them.
const STILL: f64 = 2e-5;

/// Collects the frames of one clip.
pub(super) struct ClipBuilder {
    joints: Vec<Joint>,
    /// Frames × joints, `parent_from_joint`.
    rotations: Vec<Quat>,
    /// Frames × joints, in the parent's frame.
    positions: Vec<Vec3>,
    frames: usize,
    /// Frames to be filled, in increasing order.
    missing: Vec<usize>,
}

impl ClipBuilder {
    /// A clip of `joints`, parents first, that has no frames yet.
    pub(super) fn new(joints: Vec<Joint>) -> Self {
        Self {
            joints,
            rotations: Vec::new(),
            positions: Vec::new(),
            frames: 0,
            missing: Vec::new(),
        }
    }

    /// Makes room for this many frames more.
    ///
    /// # Errors
    /// The system has no memory for them.
    pub(super) fn reserve(&mut self, frames: usize) -> Result<(), ParseError> {
        let poses = frames.saturating_mul(self.joints.len());
        let reserved = self.rotations.try_reserve_exact(poses);
        let reserved = reserved.and_then(|()| self.positions.try_reserve_exact(poses));
        reserved.map_err(|_| ParseError::of_memory(0, poses.saturating_mul(BYTES_A_POSE)))
    }

    /// Adds a frame of rotations and positions in the world. O(joints).
    pub(super) fn push_world(&mut self, rotations: &[Quat], positions: &[Vec3]) {
        for (j, joint) in self.joints.iter().enumerate() {
            let (rotation, position) = match joint.parent {
                Some(p) => {
                    let back = rotations[p].inverse();
                    (back * rotations[j], back * (positions[j] - positions[p]))
                }
                None => (rotations[j], positions[j]),
            };
            self.rotations.push(rotation);
            self.positions.push(position);
        }
        self.frames += 1;
    }

    /// Adds a frame of rotations and positions in the parents' frames. O(joints).
    pub(super) fn push_local(
        &mut self,
        rotations: impl IntoIterator<Item = Quat>,
        positions: impl IntoIterator<Item = Vec3>,
    ) {
        self.rotations.extend(rotations);
        self.positions.extend(positions);
        self.frames += 1;
        debug_assert_eq!(self.rotations.len(), self.frames * self.joints.len());
        debug_assert_eq!(self.positions.len(), self.frames * self.joints.len());
    }

    /// Adds a frame that the file lacks or spoils; it is interpolated in the end. O(joints).
    pub(super) fn push_missing(&mut self) {
        let n = self.joints.len();
        self.missing.push(self.frames);
        self.rotations
            .extend(std::iter::repeat_n(Quat::identity(), n));
        self.positions.extend(self.joints.iter().map(|j| j.offset));
        self.frames += 1;
    }

    /// The clip. Frames that are missing at its ends repeat the nearest one. O(frames × joints).
    ///
    /// # Errors
    /// A parent behind its child, which is the reader's mistake.
    pub(super) fn finish(mut self, name: String, rate_hz: f64) -> Result<Clip, ParseError> {
        let repaired = self.fill();
        self.make_continuous();
        let tracks = self.take_tracks();
        let skeleton = Skeleton::new(self.joints).map_err(|error| {
            ParseError::new(
                Place::File,
                "parents before their children",
                error.to_string(),
            )
        })?;
        Ok(Clip {
            name,
            skeleton,
            rate_hz,
            rotations: self.rotations,
            tracks,
            frames: self.frames,
            repaired,
            points: None,
        })
    }

    fn fill(&mut self) -> Vec<Span> {
        let mut spans: Vec<Span> = Vec::new();
        for &frame in &self.missing {
            match spans.last_mut() {
                Some(span) if span.end == frame => span.end += 1,
                _ => spans.push(frame..frame + 1),
            }
        }
        let n = self.joints.len();
        for span in &spans {
            let before = span.start.checked_sub(1);
            let after = (span.end < self.frames).then_some(span.end);
            let (Some(a), Some(b)) = (before.or(after), after.or(before)) else {
                continue;
            };
            for frame in span.clone() {
                let t = (frame + 1 - span.start) as f64 / (span.len() + 1) as f64;
                for j in 0..n {
                    let (a, b, at) = (a * n + j, b * n + j, frame * n + j);
                    self.rotations[at] = slerp(&self.rotations[a], &self.rotations[b], t);
                    self.positions[at] = self.positions[a].lerp(&self.positions[b], t);
                }
            }
        }
        spans
    }

    fn make_continuous(&mut self) {
        let n = self.joints.len();
        for at in n..self.rotations.len() {
            self.rotations[at] = same_hemisphere(&self.rotations[at - n], self.rotations[at]);
        }
    }

    /// Roots move; other joints only if their places differ. One that never moves is where the frames have it, whatever
    /// its rest says.
    fn take_tracks(&mut self) -> Vec<JointTrack> {
        let n = self.joints.len();
        if self.frames == 0 {
            return Vec::new();
        }
        let still = STILL * self.size();
        let mut tracks = Vec::new();
        for joint in 0..n {
            let places = || self.positions[joint..].iter().step_by(n);
            let first = self.positions[joint];
            let moves = places().any(|place| (place - first).norm() > still);
            if self.joints[joint].parent.is_none() || moves {
                let positions = places().copied().collect();
                tracks.push(JointTrack { joint, positions });
            } else {
                let mean = places().sum::<Vec3>() / self.frames as f64;
                self.joints[joint].offset = if mean == first { first } else { mean };
            }
        }
        tracks
    }

    /// The longest way from a root to a leaf, in the first frame.
    fn size(&self) -> f64 {
        let mut reach = vec![0.0; self.joints.len()];
        for (j, joint) in self.joints.iter().enumerate() {
            if let Some(p) = joint.parent {
                reach[j] = reach[p] + self.positions[j].norm();
            }
        }
        reach.into_iter().fold(0.0, f64::max)
    }
}

/// Names of the clips of one file: the file's own for one clip, `file#name` for several; a name that is empty or
/// taken becomes a number.
pub(super) fn clip_names(file: &str, names: &[String]) -> Vec<String> {
    if names.len() == 1 {
        return vec![file.to_owned()];
    }
    let mut given: Vec<String> = Vec::with_capacity(names.len());
    for (k, name) in names.iter().enumerate() {
        let mut chosen = format!("{file}#{}", name.trim());
        if name.trim().is_empty() || given.contains(&chosen) {
            chosen = format!("{file}#{}", k + 1);
        }
        given.push(chosen);
    }
    given
}

/// Poses (frames × joints) that are made of a file however small it is,
const FREE_POSES: usize = 1 << 22;
/// and this many for each of its bytes: two keys may stand far apart, and a short file could fill the memory with that.
const POSES_A_BYTE: usize = 16;

/// Memory for a pose while a clip is made: rotation, position and, of what moves, its track.
const BYTES_A_POSE: usize = size_of::<Quat>() + 2 * size_of::<Vec3>();

/// Refuses to make more frames of a file than its size lets believe. `earlier` poses have been made of it before.
pub(super) fn check_size(
    frames: usize,
    joints: usize,
    earlier: usize,
    bytes: usize,
    limits: &super::Limits,
) -> Result<(), ParseError> {
    let refuse = |expected: String, found: usize| {
        Err(ParseError::new(Place::File, expected, found.to_string()))
    };
    if joints > limits.joints {
        return refuse(format!("at most {} joints", limits.joints), joints);
    }
    if frames > limits.frames {
        return refuse(format!("at most {} frames", limits.frames), frames);
    }
    let most = FREE_POSES.max(bytes.saturating_mul(POSES_A_BYTE));
    match frames.saturating_mul(joints).saturating_add(earlier) {
        poses if poses > most => refuse(
            format!("at most {most} rotations in {bytes} bytes of keys"),
            poses,
        ),
        poses => limits.afford(poses, BYTES_A_POSE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::WorldPose;
    use crate::math::Axis;

    fn chain() -> Vec<Joint> {
        [None, Some(0), Some(1)]
            .into_iter()
            .enumerate()
            .map(|(j, parent)| Joint {
                name: format!("j{j}"),
                parent,
                offset: Vec3::new(0.0, 9.0, 0.0),
                tip: None,
            })
            .collect()
    }

    #[test]
    fn poses_in_the_world_come_back() {
        let mut builder = ClipBuilder::new(chain());
        let frames: Vec<(Vec<Quat>, Vec<Vec3>)> = (0..5)
            .map(|f| {
                let turn = Axis::Z.rotation(0.3 * f as f64);
                let root = Vec3::new(f as f64, 0.0, 0.0);
                let knee = root + turn * Vec3::new(0.0, 1.0, 0.0);
                let stretch = 1.0 + 0.1 * f as f64;
                let foot = knee + turn * turn * Vec3::new(0.0, stretch, 0.0);
                (vec![turn, turn * turn, turn], vec![root, knee, foot])
            })
            .collect();
        for (rotations, positions) in &frames {
            builder.push_world(rotations, positions);
        }
        let clip = builder.finish("c".into(), 30.0).unwrap();
        let moving: Vec<usize> = clip.tracks.iter().map(|t| t.joint).collect();
        assert_eq!(moving, [0, 2], "the knee keeps its distance, the foot not");
        for (f, (rotations, positions)) in frames.iter().enumerate() {
            let pose = WorldPose::of(&clip, f);
            for j in 0..3 {
                assert!((pose.positions[j] - positions[j]).norm() < 1e-9);
                assert!(pose.rotations[j].angle_to(&rotations[j]) < 1e-6);
            }
        }
    }

    #[test]
    fn what_is_missing_is_filled() {
        let mut builder = ClipBuilder::new(chain());
        let push = |builder: &mut ClipBuilder, x: f64| {
            builder.push_local([Axis::X.rotation(x); 3], [Vec3::new(x, 0.0, 0.0); 3]);
        };
        builder.push_missing();
        push(&mut builder, 0.2);
        builder.push_missing();
        builder.push_missing();
        push(&mut builder, 0.8);
        let clip = builder.finish("c".into(), 30.0).unwrap();
        assert_eq!(clip.repaired, [0..1, 2..4]);
        for (frame, x) in [(0, 0.2), (2, 0.4), (3, 0.6)] {
            assert!((clip.local_position(frame, 0).x - x).abs() < 1e-9);
            assert!(clip.frame_rotations(frame)[1].angle_to(&Axis::X.rotation(x)) < 1e-6);
        }
    }

    #[test]
    fn several_clips_are_told_apart() {
        let names = ["walk", "", "walk"].map(str::to_owned);
        assert_eq!(clip_names("f", &names), ["f#walk", "f#2", "f#3"]);
        assert_eq!(clip_names("f", &names[..1]), ["f"]);
    }
}
