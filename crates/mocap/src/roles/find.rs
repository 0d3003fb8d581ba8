//! Infers roles: limbs and trunk by the shape of the tree, then names, then sides.

use super::limbs::{self, Limb, Part};
use super::meaning::{NameMeaning, Side};
use super::names::JointNames;
use super::pairs::{LimbPairs, RolesFound};
use super::sides::SideCues;
use super::tree::JointTree;
use super::{Role, RoleMap, trunk};
use crate::clip::Skeleton;
use crate::math::Vec3;
use crate::pose::BoneSet;

/// Finds the roles of `skeleton` from its tree, its bone lengths and its names. O(joints²) at worst.
///
/// Names that say nothing (`joint_7`) leave the tree and the lengths: two pairs of limbs that mirror each other, in
/// the proportions of people. Left and right then follow from where the toes point in the zero pose.
pub fn find(skeleton: &Skeleton) -> RolesFound {
    find_moving(skeleton, &[zero_pose(skeleton)])
}

/// Positions of the joints without rotations.
pub(crate) fn zero_pose(skeleton: &Skeleton) -> Vec<Vec3> {
    let mut positions: Vec<Vec3> = Vec::with_capacity(skeleton.len());
    for joint in skeleton.joints() {
        positions.push(joint.offset + joint.parent.map_or_else(Vec3::zeros, |p| positions[p]));
    }
    positions
}

/// [`find`] with the joints where `poses` says, as in frames of a clip (a position for each joint, any unit): better
/// witnesses than a zero pose that no person ever stood in. Where knees and elbows bend, they are distinguished from joints that
/// halve a bone; where knees and toes point tells left from right, even against the names.
///
/// # Panics
/// If there is no pose, or one that is not as long as the skeleton.
pub fn find_moving(skeleton: &Skeleton, poses: &[Vec<Vec3>]) -> RolesFound {
    find_named(skeleton, &JointNames::of(skeleton), poses)
}

/// [`find_moving`] with the names as they were read.
pub(crate) fn find_named(
    skeleton: &Skeleton,
    names: &JointNames,
    poses: &[Vec<Vec3>],
) -> RolesFound {
    assert!(!poses.is_empty(), "at least one pose");
    assert!(
        poses.iter().all(|pose| pose.len() == skeleton.len()),
        "a position for each joint"
    );
    let mut found = RolesFound::default();
    if skeleton.is_empty() {
        return found;
    }
    let tree = JointTree::new(skeleton, names, poses);
    let pairs = LimbPairs::choose(&tree);
    trunk::find(&tree, &pairs, &mut found);
    let sides = SideCues::of(&tree, &found.map, pairs.leg_limbs());
    let mut taken = [None, None];
    for (at, found_pair) in [&pairs.legs, &pairs.arms].into_iter().enumerate() {
        taken[at] = found_pair.as_ref().map(|found_pair| {
            let (first, note) = sides.first(&tree, found_pair.pair, found_pair.limbs);
            found.notes.extend(note);
            first
        });
    }
    sides.settle(&mut taken, &mut found.notes);
    for side in [Side::Left, Side::Right] {
        let member = |at: usize| usize::from(taken[at] != Some(side));
        let mut leg = match &pairs.legs {
            Some(legs) => legs.limbs[member(0)],
            None => limbs::named(&tree, &named(&tree, side, NameMeaning::is_leg), Part::Leg),
        };
        limbs::end_elsewhere(&tree, &mut leg, side, NameMeaning::Foot);
        set_leg(&mut found.map, side, leg);
        let part = Part::Arm { leg: pairs.leg };
        let mut arm = match &pairs.arms {
            Some(arms) => arms.limbs[member(1)],
            None => limbs::named(&tree, &named(&tree, side, NameMeaning::is_arm), part),
        };
        limbs::end_elsewhere(&tree, &mut arm, side, NameMeaning::Hand);
        set_arm(&mut found.map, side, arm);
    }
    found.notes.dedup();
    // Of a body they are found where they are asked for: most poses do without.
    if BoneSet::of_roles(&found.map).is_empty() {
        found.map = found.map.with_fingers(skeleton).into_owned();
    }
    found
}

fn named(tree: &JointTree, side: Side, belongs: impl Fn(NameMeaning) -> bool) -> Vec<usize> {
    (0..tree.skeleton.len())
        .filter(|&j| tree.readings[j].side == Some(side) && belongs(tree.kind(j)))
        .collect()
}

fn set_leg(map: &mut RoleMap, side: Side, limb: Limb) {
    let [thigh, shin, foot] = match side {
        Side::Left => [Role::LeftThigh, Role::LeftShin, Role::LeftFoot],
        Side::Right => [Role::RightThigh, Role::RightShin, Role::RightFoot],
    };
    map.set(thigh, limb.upper);
    map.set(shin, limb.lower);
    map.set(foot, limb.end);
}

fn set_arm(map: &mut RoleMap, side: Side, limb: Limb) {
    let [shoulder, arm, forearm, hand] = match side {
        Side::Left => [
            Role::LeftShoulder,
            Role::LeftArm,
            Role::LeftForearm,
            Role::LeftHand,
        ],
        Side::Right => [
            Role::RightShoulder,
            Role::RightArm,
            Role::RightForearm,
            Role::RightHand,
        ],
    };
    map.set(shoulder, limb.first);
    map.set(arm, limb.upper);
    map.set(forearm, limb.lower);
    map.set(hand, limb.end);
}

impl RoleMap {
    /// The roles of `skeleton`, by its tree first and its names second; [`find`] says more.
    pub fn find(skeleton: &Skeleton) -> Self {
        find(skeleton).map
    }
}
