//! The bones of a humanoid with their names in VMC, their hierarchy, and their positions in an average person.

use crate::math::Vec3;
use crate::pose::Hand;
use crate::roles::{Role, RoleMap};

/// Number of bones.
pub const HUMANOID_BONES: usize = 55;

/// A bone that senders may name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HumanoidBone {
    /// Its name on the wire: Unity's `HumanBodyBones`.
    pub name: &'static str,
    /// The bone it hangs on, if that is sent; else that one's, and so on. Comes earlier in the table.
    pub parent: Option<usize>,
    /// The role of its joint; none of fingers, whose roles [`joint_of`] knows.
    pub role: Option<Role>,
    /// Position in the parent's frame in a T-pose, metres, right-handed, Y up, facing −Z (as poses come out of the
    /// conversion from Unity's axes); for senders that send no positions.
    pub offset: [f64; 3],
}

impl HumanoidBone {
    /// [`offset`](Self::offset) as a vector.
    pub fn offset(&self) -> Vec3 {
        Vec3::from(self.offset)
    }
}

const fn bone(
    name: &'static str,
    parent: usize,
    role: Option<Role>,
    x: f64,
    y: f64,
    z: f64,
) -> HumanoidBone {
    HumanoidBone {
        name,
        parent: Some(parent),
        role,
        offset: [x, y, z],
    }
}

/// A finger's bone.
const fn finger(name: &'static str, parent: usize, x: f64) -> HumanoidBone {
    bone(name, parent, None, x, 0.0, 0.0)
}

/// All bones, parents first. Lengths are those of a person of 1.7 m, after Drillis and Contini (1966).
pub const HUMANOID: [HumanoidBone; HUMANOID_BONES] = [
    HumanoidBone {
        name: "Hips",
        parent: None,
        role: Some(Role::Hips),
        offset: [0.0, 0.92, 0.0],
    },
    bone("LeftUpperLeg", 0, Some(Role::LeftThigh), -0.09, -0.02, 0.0),
    bone("RightUpperLeg", 0, Some(Role::RightThigh), 0.09, -0.02, 0.0),
    bone("LeftLowerLeg", 1, Some(Role::LeftShin), 0.0, -0.41, 0.0),
    bone("RightLowerLeg", 2, Some(Role::RightShin), 0.0, -0.41, 0.0),
    bone("LeftFoot", 3, Some(Role::LeftFoot), 0.0, -0.42, 0.0),
    bone("RightFoot", 4, Some(Role::RightFoot), 0.0, -0.42, 0.0),
    bone("Spine", 0, Some(Role::Torso), 0.0, 0.08, 0.0),
    bone("Chest", 7, None, 0.0, 0.13, 0.0),
    bone("UpperChest", 8, None, 0.0, 0.13, 0.0),
    bone("Neck", 9, Some(Role::Neck), 0.0, 0.15, 0.0),
    bone("Head", 10, Some(Role::Head), 0.0, 0.09, 0.0),
    bone(
        "LeftShoulder",
        9,
        Some(Role::LeftShoulder),
        -0.03,
        0.11,
        0.0,
    ),
    bone(
        "RightShoulder",
        9,
        Some(Role::RightShoulder),
        0.03,
        0.11,
        0.0,
    ),
    bone("LeftUpperArm", 12, Some(Role::LeftArm), -0.13, 0.0, 0.0),
    bone("RightUpperArm", 13, Some(Role::RightArm), 0.13, 0.0, 0.0),
    bone("LeftLowerArm", 14, Some(Role::LeftForearm), -0.30, 0.0, 0.0),
    bone(
        "RightLowerArm",
        15,
        Some(Role::RightForearm),
        0.30,
        0.0,
        0.0,
    ),
    bone("LeftHand", 16, Some(Role::LeftHand), -0.25, 0.0, 0.0),
    bone("RightHand", 17, Some(Role::RightHand), 0.25, 0.0, 0.0),
    bone("LeftToes", 5, None, 0.0, -0.06, -0.14),
    bone("RightToes", 6, None, 0.0, -0.06, -0.14),
    bone("LeftEye", 11, None, -0.03, 0.08, -0.08),
    bone("RightEye", 11, None, 0.03, 0.08, -0.08),
    bone("Jaw", 11, None, 0.0, 0.03, -0.05),
    finger("LeftThumbProximal", 18, -0.03),
    finger("LeftThumbIntermediate", 25, -0.04),
    finger("LeftThumbDistal", 26, -0.03),
    finger("LeftIndexProximal", 18, -0.09),
    finger("LeftIndexIntermediate", 28, -0.04),
    finger("LeftIndexDistal", 29, -0.02),
    finger("LeftMiddleProximal", 18, -0.09),
    finger("LeftMiddleIntermediate", 31, -0.04),
    finger("LeftMiddleDistal", 32, -0.03),
    finger("LeftRingProximal", 18, -0.09),
    finger("LeftRingIntermediate", 34, -0.04),
    finger("LeftRingDistal", 35, -0.02),
    finger("LeftLittleProximal", 18, -0.08),
    finger("LeftLittleIntermediate", 37, -0.03),
    finger("LeftLittleDistal", 38, -0.02),
    finger("RightThumbProximal", 19, 0.03),
    finger("RightThumbIntermediate", 40, 0.04),
    finger("RightThumbDistal", 41, 0.03),
    finger("RightIndexProximal", 19, 0.09),
    finger("RightIndexIntermediate", 43, 0.04),
    finger("RightIndexDistal", 44, 0.02),
    finger("RightMiddleProximal", 19, 0.09),
    finger("RightMiddleIntermediate", 46, 0.04),
    finger("RightMiddleDistal", 47, 0.03),
    finger("RightRingProximal", 19, 0.09),
    finger("RightRingIntermediate", 49, 0.04),
    finger("RightRingDistal", 50, 0.02),
    finger("RightLittleProximal", 19, 0.08),
    finger("RightLittleIntermediate", 52, 0.03),
    finger("RightLittleDistal", 53, 0.02),
];

/// The first bone of a finger: thumb to little finger of the left hand, three bones each from the base on, then of the right.
const FIRST_FINGER: usize = 25;

/// The joint of this bone among those that play `roles`. The last bone of a finger is the third joint or, where a skeleton has three
/// joints a finger, the last, which plays the tip.
pub fn joint_of(bone: usize, roles: &RoleMap) -> Option<usize> {
    let Some(number) = bone.checked_sub(FIRST_FINGER) else {
        return HUMANOID[bone].role.and_then(|role| roles.joint(role));
    };
    let finger = Hand::BOTH[number / 15].points().fingers[number / 3 % 5];
    let joint = roles.joint(finger[number % 3]);
    let last = (number % 3 == 2).then_some(finger[3]);
    joint.or_else(|| roles.joint(last?))
}

/// Number of the bone of this name.
pub fn bone_of_name(name: &str) -> Option<usize> {
    HUMANOID.iter().position(|bone| bone.name == name)
}

/// The bone on the other side; bones of the middle are their own.
pub fn mirrored(bone: usize) -> usize {
    let name = HUMANOID[bone].name;
    let of = |side: &str, other: &str| {
        let rest = name.strip_prefix(side)?;
        HUMANOID
            .iter()
            .position(|b| b.name.strip_prefix(other) == Some(rest))
    };
    of("Left", "Right")
        .or_else(|| of("Right", "Left"))
        .unwrap_or(bone)
}

/// Bones as a set: bit `b` is bone `b`.
pub type BoneMask = u64;

/// A body shows its hips, and this many other joints that play a role.
const BODY_JOINTS: u32 = 5;

/// True if bones make a body that can be recognised, and not only some message in the form of one.
pub fn is_body(mask: BoneMask) -> bool {
    let plays = |bone: &usize| mask >> bone & 1 == 1 && HUMANOID[*bone].role.is_some();
    let hips = HUMANOID.iter().position(|bone| bone.parent.is_none());
    let joints = (0..HUMANOID_BONES).filter(plays).count() as u32;
    hips.is_some_and(|hips| mask >> hips & 1 == 1) && joints > BODY_JOINTS
}

/// The nearest bone above `bone` that is in `sent`.
pub fn parent_among(bone: usize, sent: BoneMask) -> Option<usize> {
    std::iter::successors(HUMANOID[bone].parent, |&b| HUMANOID[b].parent)
        .find(|b| sent >> b & 1 == 1)
}

/// Position of `bone` in a T-pose seen from `above`, some bone above it, or from the floor.
pub fn standard_offset(bone: usize, above: Option<usize>) -> Vec3 {
    let chain = std::iter::successors(Some(bone), |&b| HUMANOID[b].parent);
    chain
        .take_while(|b| Some(*b) != above)
        .map(|b| HUMANOID[b].offset())
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parents_come_first_sides_mirror_each_other_and_every_role_is_played_once() {
        for (b, bone) in HUMANOID.iter().enumerate() {
            assert!(bone.parent.is_none_or(|p| p < b), "{}", bone.name);
            let other = mirrored(b);
            assert_eq!(mirrored(other), b, "{}", bone.name);
            assert_eq!(
                other == b,
                !bone.name.contains("Left") && !bone.name.contains("Right")
            );
            let [x, y, z] = HUMANOID[other].offset;
            assert_eq!(
                bone.offset,
                [if x == 0.0 { 0.0 } else { -x }, y, z],
                "{}",
                bone.name
            );
        }
        for role in Role::BODY {
            assert_eq!(
                HUMANOID.iter().filter(|b| b.role == Some(role)).count(),
                1,
                "{role}"
            );
        }
    }
}
