//! A clip: a skeleton and its motion, with the units and axes of its file. Readers produce it, [`import`](crate::import)
//! converts it to metres with Y up, and everything after that works on the result.

#[cfg(feature = "formats")]
use crate::math::same_hemisphere;
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
    /// Index of the joint at fault.
    pub joint: usize,
    /// Name of the clip.
    pub name: String,
    /// The parent that it gave.
    pub parent: usize,
}

impl Skeleton {
    /// Checks that every parent comes before its children.
    ///
    /// # Errors
    /// A joint whose parent does not come before it.
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

    /// Names of the joints, parents first.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.joints.iter().map(|joint| joint.name.as_str())
    }

    /// Number of joints.
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// True if there is no joint at all.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// Moves the joints in their parents' frames.
    #[cfg(feature = "formats")]
    pub(crate) fn map_offsets(&mut self, new: impl Fn(&Joint, Vec3) -> Vec3) {
        for joint in &mut self.joints {
            joint.offset = new(joint, joint.offset);
        }
    }

    /// Moves the ends of the chains.
    #[cfg(feature = "formats")]
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
    /// Index of the joint in the skeleton.
    pub joint: usize,
    /// Its position in its parent's frame (in the world's, for a root), one for each frame, in the clip's
    /// length unit. Replaces [`Joint::offset`].
    pub positions: Vec<Vec3>,
}

/// A stretch of frames in which a point was not seen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Gap {
    /// The joint that stands for the point.
    pub joint: usize,
    /// Frames of the clip, from 0, the stop excluded.
    pub frames: Span,
}

/// Properties of a clip of points: markers, landmarks or joint positions without rotations.
///
/// Its skeleton is flat: each point is a root joint with a [`JointTrack`] and no rotation. Every position is finite:
/// where a point was not seen, it lies on the line between where it was seen before and after.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Points {
    /// Stretches too long for interpolation to be trusted, by joint and then by time. Positions there are
    /// placeholders; features leave the point out.
    pub gaps: Vec<Gap>,
    /// Metres in the clip's unit of length, if the file states one.
    pub metres_per_unit: Option<f64>,
}

/// A skeleton and frames at a fixed rate. Lengths and axes are the file's own until
/// [`import`](crate::import) has made them metres and Y-up.
#[derive(Debug, Clone, PartialEq)]
pub struct Clip {
    /// Name of the clip: its file's stem, by default.
    pub name: String,
    /// Joints, their parents and offsets.
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
    /// Set for a clip of points: rotations are then unknown and stored as identities.
    pub points: Option<Points>,
}

impl Clip {
    /// True if the point `joint` was not seen at `frame`. O(gaps).
    pub fn is_gap_at(&self, joint: usize, frame: usize) -> bool {
        let gaps = self.points.iter().flat_map(|points| &points.gaps);
        gaps.into_iter()
            .any(|gap| gap.joint == joint && gap.frames.contains(&frame))
    }

    /// A clip of points: for each a name and its positions, one for each frame.
    ///
    /// # Panics
    /// If the points have different numbers of positions.
    pub fn of_points(
        name: String,
        rate_hz: f64,
        points: impl IntoIterator<Item = (String, Vec<Vec3>)>,
        known: Points,
    ) -> Self {
        let (mut joints, mut tracks) = (Vec::new(), Vec::new());
        for (joint, (name, positions)) in points.into_iter().enumerate() {
            joints.push(Joint {
                name,
                parent: None,
                offset: positions.first().copied().unwrap_or_else(Vec3::zeros),
                tip: None,
            });
            tracks.push(JointTrack { joint, positions });
        }
        let frames = tracks.first().map_or(0, |t| t.positions.len());
        assert!(tracks.iter().all(|t| t.positions.len() == frames));
        Self {
            name,
            rotations: vec![Quat::identity(); frames * joints.len()],
            skeleton: Skeleton { joints },
            rate_hz,
            tracks,
            frames,
            repaired: Vec::new(),
            points: Some(known),
        }
    }

    /// A clip of other joints with the name, rate and repairs of `from`, whose first joint moves in the world as `places`
    /// say.
    ///
    /// # Panics
    /// If parents do not come first, or numbers of frames differ.
    #[cfg(feature = "formats")]
    pub(crate) fn of_chain(
        from: &Clip,
        joints: Vec<Joint>,
        rotations: Vec<Quat>,
        places: Vec<Vec3>,
    ) -> Self {
        assert_eq!(rotations.len(), from.frames * joints.len());
        assert_eq!(places.len(), from.frames);
        for (j, joint) in joints.iter().enumerate() {
            assert!(joint.parent.is_none_or(|parent| parent < j));
        }
        let mut clip = Self {
            name: from.name.clone(),
            skeleton: Skeleton { joints },
            rate_hz: from.rate_hz,
            rotations,
            tracks: vec![JointTrack {
                joint: 0,
                positions: places,
            }],
            frames: from.frames,
            repaired: from.repaired.clone(),
            points: None,
        };
        let joints = clip.skeleton.len();
        for at in joints..clip.rotations.len() {
            let before = clip.rotations[at - joints];
            clip.rotations[at] = same_hemisphere(&before, clip.rotations[at]);
        }
        clip
    }

    /// Adds joints that move in the world, each with a position for every frame. O(frames × joints).
    ///
    /// # Panics
    /// If there are not as many positions as frames.
    #[cfg(feature = "formats")]
    pub(crate) fn add_roots(&mut self, roots: Vec<(String, Vec<Vec3>)>) {
        let (before, added) = (self.skeleton.len(), roots.len());
        if added == 0 {
            return;
        }
        for (name, positions) in roots {
            assert_eq!(positions.len(), self.frames, "a position for each frame");
            let joint = self.skeleton.len();
            self.skeleton.joints.push(Joint {
                name,
                parent: None,
                offset: positions.first().copied().unwrap_or_else(Vec3::zeros),
                tip: None,
            });
            self.tracks.push(JointTrack { joint, positions });
        }
        let mut rotations = Vec::with_capacity(self.frames * (before + added));
        for frame in 0..self.frames {
            rotations.extend_from_slice(&self.rotations[frame * before..(frame + 1) * before]);
            rotations.resize(rotations.len() + added, Quat::identity());
        }
        self.rotations = rotations;
    }

    /// True if joints are known to turn; a clip of points has positions alone.
    pub fn has_rotations(&self) -> bool {
        self.points.is_none()
    }

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
