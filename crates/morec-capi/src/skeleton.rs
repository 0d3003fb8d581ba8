//! Reads the caller's description of a skeleton.

use std::ffi::c_char;

use morec::clip::{Joint, Skeleton};
use morec::features::{BoneSet, KeyPose};
use morec::index::MotionIndex;
use morec::kinematics::WorldPose;
use morec::live::Rig;
use morec::math::{Quat, Vec3};
use morec::roles::points::places_of;
use morec::roles::{Role, RoleMap};

use crate::axes::Convention;
use crate::memory::{self, Versioned};
use crate::status::CallError;
use crate::words;

/// The joints of a stream's skeleton. Everything is copied; nothing is used after the call returns.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct MorecSkeleton {
    /// Set to `sizeof(MorecSkeleton)`.
    pub struct_size: usize,
    /// Number of joints, 1 to 4096.
    pub joint_count: usize,
    /// `joint_count` numbers: each joint's parent, which must come before it, or −1 for a root.
    pub parents: *const i32,
    /// `joint_count` names, UTF-8, or null. If `roles` is null, roles are inferred from them. Joints without parents may be
    /// landmarks or points of hands.
    pub names: *const *const c_char,
    /// `joint_count` times x, y, z: the joint's position in its parent's frame; or null if every frame has positions.
    pub offsets: *const f64,
    /// `joint_count` values of `MorecRole`, `MOREC_ROLE_NONE` for most joints; or null: inferred from the tree and the names.
    /// Points of hands (`left_palm`, `left_thumb_1` … `right_little_tip`), points of a custom skeleton and `face` have the
    /// numbers from `MOREC_ROLE_COUNT` to below `MOREC_POINT_COUNT`; see `morec_role_from_name`.
    pub roles: *const i32,
}

// SAFETY: repr(C), begins with its size, numbers and pointers only.
unsafe impl Versioned for MorecSkeleton {
    const NAME: &'static str = "MorecSkeleton";
    const FIRST_SIZE: usize = size_of::<Self>();
}

/// A skeleton as recognition takes it, and what was said of it.
#[derive(Debug)]
pub(crate) struct Declared {
    /// Joints and roles; offsets right-handed with Y up.
    pub(crate) rig: Rig,
    /// Bones that its frames can be expected to show.
    pub(crate) bones: BoneSet,
    /// True if there are offsets; else every frame must hold positions.
    pub(crate) has_offsets: bool,
}

/// The rig of a stream that shows all parts of a body: joint `r` plays role `r`.
pub(crate) fn body() -> Rig {
    let mut rig = Rig::of_roles();
    let joints = rig.skeleton.joints().iter().take(Role::BODY_COUNT);
    rig.skeleton = Skeleton::new(joints.cloned().collect()).unwrap_or_default();
    for role in Role::ALL.into_iter().filter(|role| !role.is_of_body()) {
        rig.roles.set(role, None);
    }
    rig
}

/// For a stream that shows roles: joint `r` plays role `r`. `mask` has bit `r` for each that it shows.
pub(crate) fn of_roles(mask: u32) -> Result<Declared, CallError> {
    let mut rig = body();
    if mask >> Role::BODY_COUNT != 0 {
        return Err(CallError::invalid(format!(
            "roles is {mask:#x}, which has bits beyond the {} roles",
            Role::BODY_COUNT
        )));
    }
    for role in Role::BODY
        .into_iter()
        .filter(|role| mask >> role.index() & 1 == 0)
    {
        rig.roles.set(role, None);
    }
    Ok(Declared {
        bones: BoneSet::of_roles(&rig.roles),
        rig,
        has_offsets: false,
    })
}

/// Reads a skeleton.
///
/// # Safety
/// `skeleton` is null or as its fields say.
pub(crate) unsafe fn read(
    skeleton: *const MorecSkeleton,
    convention: &Convention,
    index: &MotionIndex,
) -> Result<Declared, CallError> {
    // SAFETY: as promised to this function.
    let c = unsafe { memory::read_struct(skeleton) }?;
    let most = morec::formats::Limits::default().joints;
    if !(1..=most).contains(&c.joint_count) {
        return Err(CallError::invalid(format!(
            "joint_count is {}, expected 1 to {most}",
            c.joint_count
        )));
    }
    // SAFETY: as promised to this function.
    let parents = unsafe { memory::values(c.parents, c.joint_count, "parents") }?;
    // SAFETY: as promised to this function.
    let offsets = unsafe { memory::values_if_any(c.offsets, 3 * c.joint_count, "offsets") }?;
    // SAFETY: as promised to this function.
    let names = unsafe { names(c.names, c.joint_count) }?;
    // SAFETY: as promised to this function.
    let roles = unsafe { memory::values_if_any(c.roles, c.joint_count, "roles") }?;
    let skeleton = joints(parents, &names, offsets, convention)?;
    let roles = match roles {
        Some(roles) => given_roles(roles)?,
        None => {
            let mut found = RoleMap::find(&skeleton);
            if parents.iter().all(|parent| *parent == -1) {
                let points = of_points(&names);
                let is_more = points.played().count() > found.played().count();
                found = if is_more { points } else { found };
            }
            index.complete_roles(&mut found, &skeleton);
            found
        }
    };
    let has_offsets = offsets.is_some();
    let mut bones = BoneSet::of_roles(&roles);
    if has_offsets {
        // Joints in one place are no bone, and will not become one.
        bones = bones.and(BoneSet::of_pose(&rest(&skeleton, &roles)));
    }
    Ok(Declared {
        rig: Rig { skeleton, roles },
        bones,
        has_offsets,
    })
}

/// # Safety
/// `names` is null or points to `count` texts that end with a zero.
unsafe fn names(names: *const *const c_char, count: usize) -> Result<Vec<String>, CallError> {
    // SAFETY: as promised to this function.
    let Some(names) = unsafe { memory::values_if_any(names, count, "names") }? else {
        return Ok(vec![String::new(); count]);
    };
    let name = |(joint, name): (usize, &*const c_char)| {
        // SAFETY: as promised to this function.
        unsafe { memory::text(*name, &format!("the name of joint {joint}")) }.map(str::to_owned)
    };
    names.iter().enumerate().map(name).collect()
}

fn joints(
    parents: &[i32],
    names: &[String],
    offsets: Option<&[f64]>,
    convention: &Convention,
) -> Result<Skeleton, CallError> {
    let mut joints = Vec::with_capacity(parents.len());
    for (j, (&parent, name)) in parents.iter().zip(names).enumerate() {
        let parent = match usize::try_from(parent) {
            Ok(parent) => Some(parent),
            Err(_) if parent == -1 => None,
            Err(_) => {
                let text = format!("the parent of joint {j} is {parent}, expected a joint or -1");
                return Err(CallError::invalid(text));
            }
        };
        let offset = offsets.map_or_else(Vec3::zeros, |o| {
            Vec3::new(o[3 * j], o[3 * j + 1], o[3 * j + 2])
        });
        if !is_place(&offset) {
            return Err(CallError::invalid(format!(
                "the offset of joint {j} is not finite"
            )));
        }
        let offset = convention.position(offset, parent.is_none());
        joints.push(Joint {
            name: name.clone(),
            parent,
            offset,
            tip: None,
        });
    }
    Skeleton::new(joints).map_err(|error| CallError::invalid(error.to_string()))
}

/// No performer is farther away than this; lengths of such numbers can still be squared.
const FARTHEST: f64 = 1e9;

/// True for a finite position.
pub(crate) fn is_place(p: &Vec3) -> bool {
    p.iter().all(|c| c.abs() <= FARTHEST)
}

/// The roles of joints that hang from nothing, by their names.
fn of_points(names: &[String]) -> RoleMap {
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let mut map = RoleMap::default();
    for (role, place) in places_of(&names) {
        map.set(role, place.single());
    }
    map
}

fn given_roles(roles: &[i32]) -> Result<RoleMap, CallError> {
    let mut map = RoleMap::default();
    for (joint, &number) in roles.iter().enumerate() {
        if number == words::MorecRole::None as i32 {
            continue;
        }
        let role = words::role(number).ok_or_else(|| {
            CallError::invalid(format!("joint {joint}: role {number} does not exist"))
        })?;
        if let Some(other) = map.joint(role) {
            return Err(CallError::invalid(format!(
                "joints {other} and {joint} are both {role}"
            )));
        }
        map.set(role, Some(joint));
    }
    Ok(map)
}

/// Positions of the role joints in the zero pose.
fn rest(skeleton: &Skeleton, roles: &RoleMap) -> KeyPose {
    let mut pose = WorldPose::default();
    for joint in skeleton.joints() {
        pose.add(joint.parent, joint.offset, Quat::identity());
    }
    KeyPose::of(&pose, roles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_role_has_one_joint_and_a_parent_comes_first() {
        assert!(given_roles(&[0, -1, 0]).is_err());
        assert!(given_roles(&[Role::COUNT as i32]).is_err());
        let convention = Convention::new(1, 0).unwrap();
        let names = vec![String::new(); 2];
        assert!(joints(&[1, -1], &names, None, &convention).is_err());
        assert!(joints(&[-1, -2], &names, None, &convention).is_err());
        assert!(
            joints(
                &[-1, 0],
                &names,
                Some(&[0.0, 0.0, 0.0, f64::NAN, 0.0, 0.0]),
                &convention
            )
            .is_err()
        );
    }
}
