//! An average person with SMPL's joints. The body models of this family cannot be distributed.

use crate::clip::Joint;
use crate::math::Vec3;

/// Height of the person, metres.
const HEIGHT: f64 = 1.7;

/// A joint: name, parent, and its place in the parent's frame in parts of the body's height. T-pose, Y up, facing +Z,
/// the left at +X, as the models stand.
struct SmplJoint(&'static str, usize, [f64; 3]);

/// The joints that SMPL, SMPL-H and SMPL-X share, in their order (Loper et al., *SMPL: A Skinned Multi-Person Linear Model*,
/// 2015; Pavlakos et al., 2019). Heights of ankle, knee, hip, shoulder and chin and the lengths of arm, forearm, hand and
/// foot are the proportions of Drillis and Contini (*Body Segment Parameters*, 1966); the trunk's joints between are spread
/// over its length.
const PARTS: [SmplJoint; 22] = [
    SmplJoint("pelvis", 0, [0.0, 0.575, 0.0]),
    SmplJoint("left_hip", 0, [0.050, -0.045, 0.0]),
    SmplJoint("right_hip", 0, [-0.050, -0.045, 0.0]),
    SmplJoint("spine1", 0, [0.0, 0.060, 0.0]),
    SmplJoint("left_knee", 1, [0.0, -0.245, 0.0]),
    SmplJoint("right_knee", 2, [0.0, -0.245, 0.0]),
    SmplJoint("spine2", 3, [0.0, 0.075, 0.0]),
    SmplJoint("left_ankle", 4, [0.0, -0.246, 0.0]),
    SmplJoint("right_ankle", 5, [0.0, -0.246, 0.0]),
    SmplJoint("spine3", 6, [0.0, 0.040, 0.0]),
    SmplJoint("left_foot", 7, [0.010, -0.030, 0.075]),
    SmplJoint("right_foot", 8, [-0.010, -0.030, 0.075]),
    SmplJoint("neck", 9, [0.0, 0.100, 0.0]),
    SmplJoint("left_collar", 9, [0.040, 0.058, 0.0]),
    SmplJoint("right_collar", 9, [-0.040, 0.058, 0.0]),
    SmplJoint("head", 12, [0.0, 0.060, 0.0]),
    SmplJoint("left_shoulder", 13, [0.065, 0.010, 0.0]),
    SmplJoint("right_shoulder", 14, [-0.065, 0.010, 0.0]),
    SmplJoint("left_elbow", 16, [0.186, 0.0, 0.0]),
    SmplJoint("right_elbow", 17, [-0.186, 0.0, 0.0]),
    SmplJoint("left_wrist", 18, [0.146, 0.0, 0.0]),
    SmplJoint("right_wrist", 19, [-0.146, 0.0, 0.0]),
];

/// Ends of chains, in parts of the height.
const TIPS: [(usize, [f64; 3]); 5] = [
    (10, [0.0, 0.0, 0.045]),
    (11, [0.0, 0.0, 0.045]),
    (15, [0.0, 0.090, 0.0]),
    (20, [0.108, 0.0, 0.0]),
    (21, [-0.108, 0.0, 0.0]),
];

/// Number of joints.
pub(super) const JOINTS: usize = PARTS.len();

/// The joints, parents first, metres.
pub(super) fn joints() -> Vec<Joint> {
    let tip = |j: usize| TIPS.iter().find(|(joint, _)| *joint == j).map(|tip| tip.1);
    PARTS
        .iter()
        .enumerate()
        .map(|(j, SmplJoint(name, parent, offset))| Joint {
            name: (*name).to_owned(),
            parent: (j > 0).then_some(*parent),
            offset: Vec3::from(*offset) * HEIGHT,
            tip: tip(j).map(|tip| Vec3::from(tip) * HEIGHT),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::Skeleton;
    use crate::roles::{Role, find};

    #[test]
    fn the_body_is_one_person_with_every_role() {
        let joints = joints();
        let mut places: Vec<Vec3> = Vec::new();
        for joint in &joints {
            places.push(joint.offset + joint.parent.map_or_else(Vec3::zeros, |p| places[p]));
        }
        let top = places[15] + joints[15].tip.unwrap();
        assert!((top.y - HEIGHT).abs() < 1e-9, "{top}");
        assert!(
            (places[7].y - 0.039 * HEIGHT).abs() < 1e-9,
            "ankle {}",
            places[7]
        );
        assert!(
            (places[16].y - 0.818 * HEIGHT).abs() < 0.01,
            "shoulder {}",
            places[16]
        );
        let found = find(&Skeleton::new(joints).unwrap());
        assert!(found.notes.is_empty(), "{:?}", found.notes);
        for (role, joint) in [
            (Role::Hips, 0),
            (Role::LeftThigh, 1),
            (Role::RightShin, 5),
            (Role::LeftFoot, 7),
            (Role::Neck, 12),
            (Role::Head, 15),
            (Role::LeftShoulder, 13),
            (Role::RightArm, 17),
            (Role::LeftForearm, 18),
            (Role::RightHand, 21),
        ] {
            assert_eq!(found.map.joint(role), Some(joint), "{role}");
        }
    }
}
