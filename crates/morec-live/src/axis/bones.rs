//! The bones of the broadcast in its order, with their positions in an average person.

use morec::clip::{Joint, Skeleton};
use morec::math::Vec3;
use morec::roles::{Role, RoleMap};

/// Number of bones.
pub const AXIS_BONE_COUNT: usize = 59;

/// A bone of the broadcast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisBone {
    /// Its name in BVH files of the same programs.
    pub name: &'static str,
    /// The bone it hangs on; comes earlier in the table.
    pub parent: Option<usize>,
    /// The role of its joint.
    pub role: Option<Role>,
    /// Position in the parent's frame, centimetres, while nothing is turned: a T-pose that faces +Z, left at +X.
    pub offset_cm: [f64; 3],
}

const fn bone(
    name: &'static str,
    parent: usize,
    role: Option<Role>,
    x: f64,
    y: f64,
    z: f64,
) -> AxisBone {
    AxisBone {
        name,
        parent: Some(parent),
        role,
        offset_cm: [x, y, z],
    }
}

/// A bone that plays no role.
const fn plain(name: &'static str, parent: usize, x: f64, y: f64, z: f64) -> AxisBone {
    bone(name, parent, None, x, y, z)
}

/// All bones, parents first. Lengths are those of a person of 1.7 m, after Drillis and Contini (1966).
pub const AXIS_BONES: [AxisBone; AXIS_BONE_COUNT] = [
    AxisBone {
        name: "Hips",
        parent: None,
        role: Some(Role::Hips),
        offset_cm: [0.0, 92.0, 0.0],
    },
    bone("RightUpLeg", 0, Some(Role::RightThigh), -9.0, -2.0, 0.0),
    bone("RightLeg", 1, Some(Role::RightShin), 0.0, -41.0, 0.0),
    bone("RightFoot", 2, Some(Role::RightFoot), 0.0, -42.0, 0.0),
    bone("LeftUpLeg", 0, Some(Role::LeftThigh), 9.0, -2.0, 0.0),
    bone("LeftLeg", 4, Some(Role::LeftShin), 0.0, -41.0, 0.0),
    bone("LeftFoot", 5, Some(Role::LeftFoot), 0.0, -42.0, 0.0),
    bone("Spine", 0, Some(Role::Torso), 0.0, 8.0, 0.0),
    plain("Spine1", 7, 0.0, 10.0, 0.0),
    plain("Spine2", 8, 0.0, 8.0, 0.0),
    plain("Spine3", 9, 0.0, 8.0, 0.0),
    bone("Neck", 10, Some(Role::Neck), 0.0, 15.0, 0.0),
    bone("Head", 11, Some(Role::Head), 0.0, 9.0, 0.0),
    bone(
        "RightShoulder",
        10,
        Some(Role::RightShoulder),
        -3.0,
        11.0,
        0.0,
    ),
    bone("RightArm", 13, Some(Role::RightArm), -13.0, 0.0, 0.0),
    bone(
        "RightForeArm",
        14,
        Some(Role::RightForearm),
        -30.0,
        0.0,
        0.0,
    ),
    bone("RightHand", 15, Some(Role::RightHand), -25.0, 0.0, 0.0),
    plain("RightHandThumb1", 16, -3.0, 0.0, 3.0),
    plain("RightHandThumb2", 17, -4.0, 0.0, 0.0),
    plain("RightHandThumb3", 18, -3.0, 0.0, 0.0),
    plain("RightInHandIndex", 16, -3.0, 0.0, 2.0),
    plain("RightHandIndex1", 20, -6.0, 0.0, 0.0),
    plain("RightHandIndex2", 21, -4.0, 0.0, 0.0),
    plain("RightHandIndex3", 22, -2.0, 0.0, 0.0),
    plain("RightInHandMiddle", 16, -3.0, 0.0, 1.0),
    plain("RightHandMiddle1", 24, -6.0, 0.0, 0.0),
    plain("RightHandMiddle2", 25, -4.0, 0.0, 0.0),
    plain("RightHandMiddle3", 26, -2.0, 0.0, 0.0),
    plain("RightInHandRing", 16, -3.0, 0.0, 0.0),
    plain("RightHandRing1", 28, -6.0, 0.0, 0.0),
    plain("RightHandRing2", 29, -4.0, 0.0, 0.0),
    plain("RightHandRing3", 30, -2.0, 0.0, 0.0),
    plain("RightInHandPinky", 16, -3.0, 0.0, -1.0),
    plain("RightHandPinky1", 32, -5.0, 0.0, 0.0),
    plain("RightHandPinky2", 33, -4.0, 0.0, 0.0),
    plain("RightHandPinky3", 34, -2.0, 0.0, 0.0),
    bone("LeftShoulder", 10, Some(Role::LeftShoulder), 3.0, 11.0, 0.0),
    bone("LeftArm", 36, Some(Role::LeftArm), 13.0, 0.0, 0.0),
    bone("LeftForeArm", 37, Some(Role::LeftForearm), 30.0, 0.0, 0.0),
    bone("LeftHand", 38, Some(Role::LeftHand), 25.0, 0.0, 0.0),
    plain("LeftHandThumb1", 39, 3.0, 0.0, 3.0),
    plain("LeftHandThumb2", 40, 4.0, 0.0, 0.0),
    plain("LeftHandThumb3", 41, 3.0, 0.0, 0.0),
    plain("LeftInHandIndex", 39, 3.0, 0.0, 2.0),
    plain("LeftHandIndex1", 43, 6.0, 0.0, 0.0),
    plain("LeftHandIndex2", 44, 4.0, 0.0, 0.0),
    plain("LeftHandIndex3", 45, 2.0, 0.0, 0.0),
    plain("LeftInHandMiddle", 39, 3.0, 0.0, 1.0),
    plain("LeftHandMiddle1", 47, 6.0, 0.0, 0.0),
    plain("LeftHandMiddle2", 48, 4.0, 0.0, 0.0),
    plain("LeftHandMiddle3", 49, 2.0, 0.0, 0.0),
    plain("LeftInHandRing", 39, 3.0, 0.0, 0.0),
    plain("LeftHandRing1", 51, 6.0, 0.0, 0.0),
    plain("LeftHandRing2", 52, 4.0, 0.0, 0.0),
    plain("LeftHandRing3", 53, 2.0, 0.0, 0.0),
    plain("LeftInHandPinky", 39, 3.0, 0.0, -1.0),
    plain("LeftHandPinky1", 55, 5.0, 0.0, 0.0),
    plain("LeftHandPinky2", 56, 4.0, 0.0, 0.0),
    plain("LeftHandPinky3", 57, 2.0, 0.0, 0.0),
];

/// Parents and lengths of the bones.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisSkeleton {
    pub(super) skeleton: Skeleton,
    pub(super) roles: RoleMap,
}

/// A skeleton that cannot be the broadcast's.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected {AXIS_BONE_COUNT} joints in the broadcast's order, beginning with the hips, found {found}"
)]
pub struct AxisSkeletonError {
    /// Number of joints.
    pub found: usize,
}

impl Default for AxisSkeleton {
    /// [`AXIS_BONES`].
    fn default() -> Self {
        let mut roles = RoleMap::default();
        for (b, bone) in AXIS_BONES.iter().enumerate() {
            if let Some(role) = bone.role {
                roles.set(role, Some(b));
            }
        }
        let joint = |bone: &AxisBone| Joint {
            name: bone.name.to_owned(),
            parent: bone.parent,
            offset: Vec3::from(bone.offset_cm) / 100.0,
            tip: None,
        };
        // Parents come first in the table, so this cannot fail.
        let skeleton = Skeleton::new(AXIS_BONES.iter().map(joint).collect()).unwrap_or_default();
        Self { skeleton, roles }
    }
}

impl AxisSkeleton {
    /// That of a clip which the same program wrote, in metres: its joints are taken to be the broadcast's in its order,
    /// whatever they are called.
    ///
    /// # Errors
    /// The clip has another number of joints than the broadcast.
    pub fn of_clip(skeleton: &Skeleton, roles: &RoleMap) -> Result<Self, AxisSkeletonError> {
        if skeleton.len() != AXIS_BONE_COUNT {
            return Err(AxisSkeletonError {
                found: skeleton.len(),
            });
        }
        Ok(Self {
            skeleton: skeleton.clone(),
            roles: roles.clone(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parents_come_first_sides_mirror_each_other_and_every_role_is_played_once() {
        for (b, bone) in AXIS_BONES.iter().enumerate() {
            assert!(bone.parent.is_none_or(|p| p < b), "{}", bone.name);
            let other = match bone.name.strip_prefix("Left") {
                Some(rest) => format!("Right{rest}"),
                None => bone.name.replacen("Right", "Left", 1),
            };
            let other = AXIS_BONES.iter().find(|b| b.name == other).unwrap();
            let [x, y, z] = other.offset_cm;
            assert_eq!(
                bone.offset_cm,
                [if x == 0.0 { 0.0 } else { -x }, y, z],
                "{}",
                bone.name
            );
            let parents = (bone.parent, other.parent);
            let depth =
                |p: Option<usize>| std::iter::successors(p, |&p| AXIS_BONES[p].parent).count();
            assert_eq!(depth(parents.0), depth(parents.1), "{}", bone.name);
        }
        for role in Role::BODY {
            assert_eq!(
                AXIS_BONES.iter().filter(|b| b.role == Some(role)).count(),
                1,
                "{role}"
            );
        }
    }

    #[test]
    fn only_a_skeleton_of_as_many_joints_will_do() {
        let own = AxisSkeleton::default();
        assert_eq!(
            AxisSkeleton::of_clip(&own.skeleton, &own.roles),
            Ok(own.clone())
        );
        let found = AxisSkeleton::of_clip(&Skeleton::default(), &own.roles);
        assert_eq!(found, Err(AxisSkeletonError { found: 0 }));
    }
}
