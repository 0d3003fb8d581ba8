//! A clip: a skeleton and its motion, as a file gave it.

use crate::math::{Quat, Vec3};

/// A half-open range of frames, `start..stop`.
pub type Span = std::ops::Range<usize>;

/// One joint of a [`Skeleton`].
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Name as the file spells it, namespaces and blanks included.
    pub name: String,
    /// Index of the parent joint; `None` for a root.
    pub parent: Option<usize>,
    /// Position in the parent's frame when nothing moves it, in the clip's length unit.
    pub offset: Vec3,
    /// For a joint that ends a chain: where its bone ends, in this joint's frame.
    pub tip: Option<Vec3>,
}

/// Joints in an order in which every parent comes before its children.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Skeleton {
    joints: Vec<Joint>,
}

/// A skeleton that breaks the rule that parents come first.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "joint {joint} ({name}) names joint {parent} as its parent; parents must come before their children"
)]
pub struct OrderError {
    /// The offending joint.
    pub joint: usize,
    /// Its name.
    pub name: String,
    /// What it gave as its parent.
    pub parent: usize,
}

impl Skeleton {
    /// Checks that every parent comes before its children.
    pub fn new(joints: Vec<Joint>) -> Result<Self, OrderError> {
        for (j, joint) in joints.iter().enumerate() {
            if let Some(parent) = joint.parent.filter(|&p| p >= j) {
                return Err(OrderError {
                    joint: j,
                    name: joint.name.clone(),
                    parent,
                });
            }
        }
        Ok(Self { joints })
    }

    /// The joints, parents first.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Number of joints.
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// Whether there is no joint at all.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// Moves the joints in their parents' frames.
    pub(crate) fn map_offsets(&mut self, new: impl Fn(&Joint, Vec3) -> Vec3) {
        for joint in &mut self.joints {
            joint.offset = new(joint, joint.offset);
        }
    }

    /// Moves the ends of the chains.
    pub(crate) fn map_tips(&mut self, new: impl Fn(Vec3) -> Vec3) {
        for tip in self
            .joints
            .iter_mut()
            .filter_map(|joint| joint.tip.as_mut())
        {
            *tip = new(*tip);
        }
    }

    /// Index of the first joint with exactly this name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|j| j.name == name)
    }

    /// Children of joint `parent`, in order. O(joints).
    pub fn children(&self, parent: usize) -> impl Iterator<Item = usize> + '_ {
        (parent + 1..self.joints.len()).filter(move |&j| self.joints[j].parent == Some(parent))
    }
}

/// A joint whose position in its parent's frame changes over time (a root, nearly always).
#[derive(Debug, Clone, PartialEq)]
pub struct JointTrack {
    /// Which joint.
    pub joint: usize,
    /// Its position in its parent's frame (in the world's, for a root), one for each frame, in the clip's
    /// length unit. Replaces [`Joint::offset`].
    pub positions: Vec<Vec3>,
}

/// A skeleton and frames at a fixed rate. Lengths and axes are the file's own until
/// [`import`](crate::import) has made them metres and Y-up.
#[derive(Debug, Clone, PartialEq)]
pub struct Clip {
    /// What the clip is called: its file's stem, by default.
    pub name: String,
    /// The joints.
    pub skeleton: Skeleton,
    /// Frames a second.
    pub rate_hz: f64,
    /// `parent_from_joint` rotations, frame by frame: frame `f`'s joint `j` is at `f * skeleton.len() + j`.
    /// Signs are continuous: each joint's quaternion lies in the hemisphere of its previous frame.
    pub rotations: Vec<Quat>,
    /// Joints that move in their parent's frame, in increasing joint order.
    pub tracks: Vec<JointTrack>,
    /// Number of frames.
    pub frames: usize,
    /// Frames that the file lacked or spoiled and that were filled by interpolation.
    pub repaired: Vec<Span>,
}

impl Clip {
    /// Length in seconds: frames over rate, so a frame counts for its whole period.
    pub fn duration_secs(&self) -> f64 {
        self.frames as f64 / self.rate_hz
    }

    /// The rotations of one frame, `parent_from_joint`, one for each joint.
    pub fn frame_rotations(&self, frame: usize) -> &[Quat] {
        let n = self.skeleton.len();
        &self.rotations[frame * n..(frame + 1) * n]
    }

    /// The movement of joint `joint` in its parent's frame, if it has any.
    pub fn track(&self, joint: usize) -> Option<&JointTrack> {
        self.tracks.iter().find(|t| t.joint == joint)
    }

    /// Position of `joint` in its parent's frame at `frame`.
    pub fn local_position(&self, frame: usize, joint: usize) -> Vec3 {
        match self.track(joint) {
            Some(track) => track.positions[frame],
            None => self.skeleton.joints()[joint].offset,
        }
    }
}
