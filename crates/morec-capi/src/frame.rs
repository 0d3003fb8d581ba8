//! Converts frames of C to frames of recognition, for every method.

use morec::live::{Frame, wall_now_secs};
use morec::math::{Quat, Vec3};

use crate::axes::Convention;
use crate::memory::{self, Versioned};
use crate::skeleton::{Declared, is_place};
use crate::status::CallError;

/// Frame of reference of positions and rotations.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MorecSpace {
    /// Unset; the call fails.
    Unknown = 0,
    /// The world: `positions` are required; `rotations` turn the joints' axes into the world's.
    World = 1,
    /// The parent's frame: `rotations` are required; `positions` replace the skeleton's offsets. A root's are in the world.
    /// Requires a skeleton.
    Local = 2,
}

/// One performer's pose at one instant. Nothing of it is used after the call returns.
///
/// A missing joint has a position of NaN, or in local space a rotation of NaN. In local space, a position of NaN means the
/// skeleton's offset. Lengths may have any unit, the same in all frames; metres are best.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct MorecFrame {
    /// Set to `sizeof(MorecFrame)`.
    pub struct_size: usize,
    /// Time of the frame, seconds on any clock that does not go back, at any regular or irregular rate. Late and duplicate frames
    /// are ignored; after a gap or a step back of more than 0.5 s, the stream starts again.
    pub time_secs: f64,
    /// Number of joints: that of the skeleton; `MOREC_ROLE_COUNT` for a stream of roles.
    pub joint_count: usize,
    /// `joint_count` times x, y, z, or null. For a stream of roles: in the order of `MorecRole`.
    pub positions: *const f64,
    /// Quaternions: `joint_count` times x, y, z, w, of any length but 0; or null.
    pub rotations: *const f64,
    /// A `MorecSpace`.
    pub space: i32,
    /// Must be 0.
    pub reserved: u32,
}

// SAFETY: repr(C), begins with its size, numbers and pointers only.
unsafe impl Versioned for MorecFrame {
    const NAME: &'static str = "MorecFrame";
    const FIRST_SIZE: usize = size_of::<Self>();
}

/// A frame whose pointers were followed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CheckedFrame<'a> {
    time_secs: f64,
    space: MorecSpace,
    positions: Option<&'a [[f64; 3]]>,
    rotations: Option<&'a [[f64; 4]]>,
}

impl CheckedFrame<'_> {
    /// Follows the pointers of a frame of `joints` joints.
    ///
    /// # Safety
    /// `frame` is null or as its fields say, for `'a`.
    pub(crate) unsafe fn read<'a>(
        frame: *const MorecFrame,
        joints: usize,
    ) -> Result<CheckedFrame<'a>, CallError> {
        // SAFETY: as promised to this function.
        let c = unsafe { memory::read_struct(frame) }?;
        if c.joint_count != joints {
            let text = format!("joint_count is {}, the stream has {joints}", c.joint_count);
            return Err(CallError::invalid(text));
        }
        if !c.time_secs.is_finite() {
            return Err(CallError::invalid("time_secs is not a number"));
        }
        if c.reserved != 0 {
            return Err(CallError::invalid("reserved is not 0"));
        }
        let space = [MorecSpace::World, MorecSpace::Local]
            .into_iter()
            .find(|space| *space as i32 == c.space);
        let text = "expected MOREC_SPACE_WORLD or MOREC_SPACE_LOCAL";
        let space =
            space.ok_or_else(|| CallError::invalid(format!("space is {}, {text}", c.space)))?;
        // SAFETY: as promised to this function; three numbers are aligned as one.
        let positions = unsafe { memory::values_if_any(c.positions.cast(), joints, "positions") }?;
        // SAFETY: as promised to this function; four numbers are aligned as one.
        let rotations = unsafe { memory::values_if_any(c.rotations.cast(), joints, "rotations") }?;
        Ok(CheckedFrame {
            time_secs: c.time_secs,
            space,
            positions,
            rotations,
        })
    }

    /// Poses the skeleton of `declared` in `frame`, right-handed and Y up. `frame` is spoiled by an error.
    pub(crate) fn pose(
        &self,
        declared: &Declared,
        convention: &Convention,
        frame: &mut Frame,
    ) -> Result<(), CallError> {
        frame.time_secs = self.time_secs;
        frame.wall_secs = wall_now_secs();
        frame.pose.positions.clear();
        frame.pose.rotations.clear();
        match self.space {
            MorecSpace::Local => self.pose_local(declared, convention, frame)?,
            _ => self.pose_world(convention, frame)?,
        }
        let seen = |p: &Vec3| p.iter().all(|c| c.is_finite());
        if !frame.pose.positions.iter().any(seen) {
            return Err(CallError::invalid("the frame contains no joint"));
        }
        Ok(())
    }

    fn pose_world(&self, convention: &Convention, frame: &mut Frame) -> Result<(), CallError> {
        let Some(positions) = self.positions else {
            return Err(CallError::invalid("a frame in world space needs positions"));
        };
        for (joint, &p) in positions.iter().enumerate() {
            frame
                .pose
                .positions
                .push(convention.position(position(joint, p)?.unwrap_or(UNSEEN), true));
        }
        for (joint, &q) in self.rotations.unwrap_or_default().iter().enumerate() {
            frame
                .pose
                .rotations
                .push(convention.rotation(rotation(joint, q)?, true));
        }
        Ok(())
    }

    fn pose_local(
        &self,
        declared: &Declared,
        convention: &Convention,
        frame: &mut Frame,
    ) -> Result<(), CallError> {
        let Some(rotations) = self.rotations else {
            return Err(CallError::invalid("a frame in local space needs rotations"));
        };
        if self.positions.is_none() && !declared.has_offsets {
            return Err(CallError::invalid(
                "a frame in local space needs positions, or a skeleton with offsets",
            ));
        }
        for (j, joint) in declared.rig.skeleton.joints().iter().enumerate() {
            let is_root = joint.parent.is_none();
            let given = match self.positions {
                Some(positions) => {
                    position(j, positions[j])?.map(|p| convention.position(p, is_root))
                }
                None => None,
            };
            let offset = if declared.has_offsets {
                joint.offset
            } else {
                UNSEEN
            };
            let turned = convention.rotation(rotation(j, rotations[j])?, is_root);
            frame
                .pose
                .add(joint.parent, given.unwrap_or(offset), turned);
        }
        Ok(())
    }
}

const UNSEEN: Vec3 = Vec3::new(f64::NAN, f64::NAN, f64::NAN);

/// `None`: not seen.
fn position(joint: usize, p: [f64; 3]) -> Result<Option<Vec3>, CallError> {
    let p = Vec3::from(p);
    if p.iter().any(|c| c.is_nan()) {
        return Ok(None);
    }
    if is_place(&p) {
        Ok(Some(p))
    } else {
        Err(CallError::invalid(format!(
            "joint {joint}: the position is not finite: {p:?}"
        )))
    }
}

/// NaN throughout: not seen.
fn rotation(joint: usize, [x, y, z, w]: [f64; 4]) -> Result<Quat, CallError> {
    let q = nalgebra::Quaternion::new(w, x, y, z);
    if [x, y, z, w].iter().any(|c| c.is_nan()) {
        return Ok(Quat::new_unchecked(q * f64::NAN));
    }
    let length = q.norm();
    if length.is_finite() && length > 1e-9 {
        Ok(Quat::new_unchecked(q / length))
    } else {
        Err(CallError::invalid(format!(
            "joint {joint}: the rotation has the length {length}, expected 1"
        )))
    }
}
