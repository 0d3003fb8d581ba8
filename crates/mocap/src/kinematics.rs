//! Forward kinematics: joint positions in the world from joint rotations.
//!
//! ```
//! use mocap::kinematics::WorldPose;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let bytes = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/testdata/mclip/v1.mclip"));
//! let clip = mocap::read(bytes, "push.mclip")?.clips.remove(0);
//! let mut pose = WorldPose::default();
//! for frame in 0..clip.frames {
//!     pose.set(&clip, frame);                                           // no allocation after the first
//!     assert_eq!(pose.positions.len(), clip.skeleton.len());
//! }
//! # Ok(())
//! # }
//! ```

use crate::clip::{Clip, Points, Span};
use crate::math::{Quat, Vec3};

/// World positions and orientations of every joint at one frame; buffers are reused from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct WorldPose {
    /// World position of each joint, in the clip's length unit.
    pub positions: Vec<Vec3>,
    /// `world_from_joint` of each joint.
    pub rotations: Vec<Quat>,
}

impl WorldPose {
    /// Poses `clip`'s skeleton as in `frame`. O(joints); allocates only when the skeleton grew.
    pub fn set(&mut self, clip: &Clip, frame: usize) {
        self.positions.clear();
        self.rotations.clear();
        let locals = clip.frame_rotations(frame);
        let mut tracks = clip.tracks.iter().peekable();
        for (j, joint) in clip.skeleton.joints().iter().enumerate() {
            let local_position = match tracks.next_if(|t| t.joint == j) {
                Some(track) => track.positions[frame],
                None => joint.offset,
            };
            self.add(joint.parent, local_position, locals[j]);
        }
    }

    /// Poses the next joint: where it is and how it is turned in the frame of `parent`, in the world if it has none.
    ///
    /// # Panics
    /// If `parent` has not been posed yet.
    pub fn add(&mut self, parent: Option<usize>, local_position: Vec3, parent_from_joint: Quat) {
        let (position, rotation) = match parent {
            Some(p) => (
                self.positions[p] + self.rotations[p] * local_position,
                self.rotations[p] * parent_from_joint,
            ),
            None => (local_position, parent_from_joint),
        };
        self.positions.push(position);
        self.rotations.push(rotation);
    }

    /// The pose of one frame in buffers of its own.
    pub fn of(clip: &Clip, frame: usize) -> Self {
        let mut pose = Self::default();
        pose.set(clip, frame);
        pose
    }

    /// World position of where the bone of an end joint ends; the joint itself if the file says nothing.
    pub fn tip(&self, clip: &Clip, joint: usize) -> Vec3 {
        match clip.skeleton.joints()[joint].tip {
            Some(tip) => self.positions[joint] + self.rotations[joint] * tip,
            None => self.positions[joint],
        }
    }
}

/// World position of one joint: that of [`WorldPose`] without the others. O(depth of the joint).
#[cfg(feature = "formats")]
pub(crate) fn position_of(clip: &Clip, frame: usize, joint: usize) -> Vec3 {
    let rotations = clip.frame_rotations(frame);
    let mut position = clip.local_position(frame, joint);
    let mut above = clip.skeleton.joints()[joint].parent;
    while let Some(parent) = above {
        position = clip.local_position(frame, parent) + rotations[parent] * position;
        above = clip.skeleton.joints()[parent].parent;
    }
    position
}

impl Clip {
    /// Positions of the joints in the world, as a clip of points; `metres_per_unit` becomes its unit. A
    /// clip of points stays what it is. O(joints × frames).
    pub fn to_points(&self, metres_per_unit: Option<f64>) -> Clip {
        if !self.has_rotations() {
            return self.clone();
        }
        let mut positions = vec![Vec::with_capacity(self.frames); self.skeleton.len()];
        let mut pose = WorldPose::default();
        for frame in 0..self.frames {
            pose.set(self, frame);
            for (joint, position) in positions.iter_mut().zip(&pose.positions) {
                joint.push(*position);
            }
        }
        let joints = self.skeleton.joints().iter();
        let names = joints.map(|joint| joint.name.clone());
        let known = Points {
            metres_per_unit,
            ..Points::default()
        };
        let name = self.name.clone();
        let mut clip = Clip::of_points(name, self.rate_hz, names.zip(positions), known);
        clip.repaired.clone_from(&self.repaired);
        clip
    }
}

/// Calls `each` with the time and pose of every frame of `clip` in turn, frame `f` at `f / rate_hz`.
///
/// Frames in `rest` (the T-pose that a conversion left at the start) show the first pose after them instead:
/// times stay those of the file, and the jump out of the T-pose is not taken for motion. In its gaps a point of a clip of
/// points is nowhere (its position is not a number), but for gaps at the clip's start: streams begin with its first frame.
pub fn for_each_world_pose(clip: &Clip, rest: &Span, each: impl FnMut(f64, &WorldPose)) {
    each_frame(clip, rest, |world, frame| world.set(clip, frame), each);
}

fn each_frame(
    clip: &Clip,
    rest: &Span,
    set: impl Fn(&mut WorldPose, usize),
    mut each: impl FnMut(f64, &WorldPose),
) {
    let mut world = WorldPose::default();
    for frame in 0..clip.frames {
        let shown = if rest.contains(&frame) {
            rest.end.min(clip.frames - 1)
        } else {
            frame
        };
        set(&mut world, shown);
        let gaps = clip.points.iter().flat_map(|points| &points.gaps);
        for gap in gaps.filter(|gap| gap.frames.start > 0 && gap.frames.contains(&shown)) {
            if let Some(position) = world.positions.get_mut(gap.joint) {
                *position = Vec3::repeat(f64::NAN);
            }
        }
        each(frame as f64 / clip.rate_hz, &world);
    }
}

/// A part of a clip's skeleton: some joints and all that they hang from.
#[derive(Debug)]
pub struct PartialSkeleton<'c> {
    clip: &'c Clip,
    /// Parents come first.
    joints: Vec<PartialJoint<'c>>,
}

#[derive(Debug)]
struct PartialJoint<'c> {
    joint: usize,
    parent: Option<usize>,
    offset: Vec3,
    /// Where it is in its parent's frame at each frame, if it moves there.
    track: Option<&'c [Vec3]>,
    /// True if other joints of the part hang from it.
    is_parent: bool,
}

impl<'c> PartialSkeleton<'c> {
    /// The part of `clip`'s skeleton that `wanted` joints need. O(joints).
    pub fn of(clip: &'c Clip, wanted: impl IntoIterator<Item = usize>) -> Self {
        let all = clip.skeleton.joints();
        let (mut included, mut is_parent) = (vec![false; all.len()], vec![false; all.len()]);
        wanted.into_iter().for_each(|joint| included[joint] = true);
        for (j, joint) in all.iter().enumerate().rev() {
            if let (true, Some(parent)) = (included[j], joint.parent) {
                (included[parent], is_parent[parent]) = (true, true);
            }
        }
        let joints = all.iter().enumerate().filter(|(j, _)| included[*j]);
        let joints = joints.map(|(joint, of)| PartialJoint {
            joint,
            parent: of.parent,
            offset: of.offset,
            track: clip.track(joint).map(|track| &track.positions[..]),
            is_parent: is_parent[joint],
        });
        Self {
            joints: joints.collect(),
            clip,
        }
    }

    /// [`for_each_world_pose`] of this part: joints outside are nowhere, and rotations of joints from which nothing hangs are
    /// not computed.
    pub fn for_each_world_pose(&self, rest: &Span, each: impl FnMut(f64, &WorldPose)) {
        each_frame(
            self.clip,
            rest,
            |world, frame| self.pose(world, frame),
            each,
        );
    }

    fn pose(&self, world: &mut WorldPose, frame: usize) {
        let locals = self.clip.frame_rotations(frame);
        world.positions.resize(locals.len(), Vec3::repeat(f64::NAN));
        world.rotations.resize(locals.len(), Quat::identity());
        let (positions, rotations) = (&mut world.positions[..], &mut world.rotations[..]);
        for part in &self.joints {
            let local_position = part.track.map_or(part.offset, |track| track[frame]);
            let (position, above) = match part.parent {
                Some(p) => (positions[p] + rotations[p] * local_position, rotations[p]),
                None => (local_position, Quat::identity()),
            };
            positions[part.joint] = position;
            if part.is_parent {
                rotations[part.joint] = above * locals[part.joint];
            }
        }
    }
}
