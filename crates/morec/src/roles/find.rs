//! Finding the roles: limbs and trunk by the shape of the tree, then names, then sides.

use super::limbs::{self, Limb};
use super::names::{Kind, Side};
use super::tree::{Pair, Tree};
use super::{Role, RoleMap};
use crate::clip::Skeleton;
use crate::math::Vec3;

/// What was found, and what is worth saying about it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Found {
    /// Who plays what.
    pub map: RoleMap,
    /// Guesses and oddities, each in a sentence.
    pub notes: Vec<String>,
}

/// Finds the roles of `skeleton` from its tree, its bone lengths and its names. O(joints²) at worst.
///
/// Names that say nothing (`joint_7`) leave the tree and the lengths: two pairs of limbs that mirror each other,
/// the lower one the legs. Left and right are then told by where the toes point in the zero pose.
pub fn find(skeleton: &Skeleton) -> Found {
    let mut positions: Vec<Vec3> = Vec::with_capacity(skeleton.len());
    for joint in skeleton.joints() {
        positions.push(joint.offset + joint.parent.map_or_else(Vec3::zeros, |p| positions[p]));
    }
    find_posed(skeleton, &positions)
}

/// [`find`] with the joints where `positions` says (one for each joint, any unit), as in a frame of a clip: a
/// better witness than a zero pose that nobody ever stood in.
///
/// # Panics
/// If `positions` is not as long as the skeleton.
pub fn find_posed(skeleton: &Skeleton, positions: &[Vec3]) -> Found {
    assert_eq!(skeleton.len(), positions.len(), "a position for each joint");
    let mut found = Found::default();
    if skeleton.is_empty() {
        return found;
    }
    let tree = Tree::new(skeleton, positions);
    let (legs, arms) = legs_and_arms(&tree);
    trunk(&tree, legs, arms, &mut found.map);
    let leg = legs.map(|pair| (pair, pair.members.map(|m| limbs::leg(&tree, m))));
    let arm = arms.map(|pair| (pair, pair.members.map(|m| limbs::arm(&tree, m))));
    let left = lateral(&tree, &found.map, leg.map(|(_, limbs)| limbs));
    for side in [Side::Left, Side::Right] {
        let limb = match leg {
            Some((pair, limbs)) => limbs[member(&tree, pair, limbs, side, left, &mut found.notes)],
            None => limbs::leg_by_name(&tree, &named(&tree, side, Kind::is_leg)),
        };
        set_leg(&mut found.map, side, limb);
        let limb = match arm {
            Some((pair, limbs)) => limbs[member(&tree, pair, limbs, side, left, &mut found.notes)],
            None => limbs::arm_by_name(&tree, &named(&tree, side, Kind::is_arm)),
        };
        set_arm(&mut found.map, side, limb);
    }
    found.notes.dedup();
    found
}

/// The pair of legs and the pair of arms.
fn legs_and_arms(tree: &Tree) -> (Option<Pair>, Option<Pair>) {
    let mut pairs = tree.pairs();
    let reach = |pair: &Pair| tree.reach(pair.members[0]) + tree.reach(pair.members[1]);
    pairs.sort_by(|a, b| reach(b).total_cmp(&reach(a)));
    let votes = |pair: &Pair| pair.members.iter().map(|&m| tree.leg_votes(m)).sum::<i64>();
    let mut legs = pairs.iter().copied().find(|pair| votes(pair) > 0);
    let mut arms = pairs.iter().copied().find(|pair| votes(pair) < 0);
    let mut silent: Vec<Pair> = pairs
        .iter()
        .copied()
        .filter(|pair| votes(pair) == 0)
        .take(2)
        .collect();
    if legs.is_none() && arms.is_none() && silent.len() == 2 {
        // The legs hang nearer to the root; on one joint, the longer limbs come first already.
        silent.sort_by_key(|pair| tree.upwards(pair.parent).count());
    }
    let mut silent = silent.into_iter();
    legs = legs.or_else(|| silent.next());
    arms = arms.or_else(|| silent.next());
    (legs, arms)
}

fn named(tree: &Tree, side: Side, belongs: impl Fn(Kind) -> bool) -> Vec<usize> {
    (0..tree.skeleton.len())
        .filter(|&j| tree.readings[j].side == Some(side) && belongs(tree.kind(j)))
        .collect()
}

/// Hips, torso, neck and head.
fn trunk(tree: &Tree, legs: Option<Pair>, arms: Option<Pair>, map: &mut RoleMap) {
    let limbs: Vec<usize> = legs
        .iter()
        .chain(&arms)
        .flat_map(|pair| pair.members)
        .collect();
    let in_trunk = |j: usize| {
        !limbs
            .iter()
            .any(|&limb| limb == j || tree.is_above(limb, j))
    };
    let by_name = |kind| {
        (0..tree.skeleton.len())
            .find(|&j| tree.kind(j) == kind && tree.readings[j].side.is_none() && in_trunk(j))
    };
    let hips = hips(tree, legs, arms).or(by_name(Kind::Hips)).unwrap_or(0);
    map.set(Role::Hips, Some(hips));

    let (mut neck, mut head) = (by_name(Kind::Neck), by_name(Kind::Head));
    if let (None, Some(arms)) = (head, arms) {
        let chain = neck_chain(tree, arms.parent, legs, &in_trunk, hips);
        head = head_of(tree, &chain);
        neck = neck.or(chain.first().copied().filter(|first| Some(*first) != head));
    }
    map.set(Role::Neck, neck);
    map.set(Role::Head, head);

    let top = arms
        .map(|pair| pair.parent)
        .or(neck.and_then(|neck| tree.parent(neck)));
    let torso = match top {
        Some(top) => {
            let mut spine: Vec<usize> = tree.upwards(top).take_while(|&j| j != hips).collect();
            spine.reverse();
            // Without the hips above it, this is no spine.
            let hangs = spine
                .first()
                .is_some_and(|&first| tree.is_above(hips, first));
            spine
                .into_iter()
                .filter(|_| hangs)
                .find(|&j| !tree.coincide(j, hips))
        }
        None => by_name(Kind::Spine).filter(|&j| j != hips),
    };
    map.set(Role::Torso, torso);
}

/// Where legs and arms meet, or what is called hips next to it.
fn hips(tree: &Tree, legs: Option<Pair>, arms: Option<Pair>) -> Option<usize> {
    let legs = legs?.parent;
    let meeting = arms
        .and_then(|arms| tree.meeting(legs, arms.parent))
        .unwrap_or(legs);
    let is_hips = |j: &usize| tree.kind(*j) == Kind::Hips;
    let called = tree
        .upwards(meeting)
        .find(is_hips)
        .or_else(|| Some(legs).filter(is_hips));
    Some(called.unwrap_or(meeting))
}

/// The longest chain of the trunk that rises from the arms' joint and does not lead to the legs.
fn neck_chain(
    tree: &Tree,
    from: usize,
    legs: Option<Pair>,
    in_trunk: &impl Fn(usize) -> bool,
    hips: usize,
) -> Vec<usize> {
    let leads_to_legs =
        |j: usize| legs.is_some_and(|legs| j == legs.parent || tree.is_above(j, legs.parent));
    let span = |j: usize| tree.reach(j) + tree.distance(from, j);
    let start = tree
        .children(from)
        .iter()
        .copied()
        .filter(|&j| in_trunk(j) && !leads_to_legs(j))
        .max_by(|&a, &b| span(a).total_cmp(&span(b)));
    let chain = start
        .map(|start| tree.main_chain(start))
        .unwrap_or_default();
    // Dummies at the middle of the body are no neck.
    chain
        .into_iter()
        .skip_while(|&j| tree.coincide(j, hips))
        .collect()
}

/// The last joint of the chain that has a bone: one without a tip is itself only the end of a bone.
fn head_of(tree: &Tree, chain: &[usize]) -> Option<usize> {
    let (&last, before) = chain.split_last()?;
    let is_end = tree.skeleton.joints()[last].tip.is_none();
    before
        .last()
        .copied()
        .filter(|_| is_end && before.len() > 1)
        .or(Some(last))
}

/// The direction to the left of the body, as far as the pose tells: up × forward.
fn lateral(tree: &Tree, map: &RoleMap, legs: Option<[Limb; 2]>) -> Vec3 {
    let at = |joint: usize| tree.positions[joint];
    let low = map.joint(Role::Hips).map_or_else(Vec3::zeros, at);
    let high = map
        .joint(Role::Head)
        .or(map.joint(Role::Neck))
        .or(map.joint(Role::Torso));
    let up = high
        .map_or_else(Vec3::zeros, |high| at(high) - low)
        .try_normalize(1e-9)
        .unwrap_or(Vec3::y());
    let toes: Vec3 = legs
        .iter()
        .flatten()
        .filter_map(|leg| toes_from_heel(tree, leg.end?))
        .sum();
    let forward = toes - up * toes.dot(&up);
    // Without toes: facing +Z in a Y-up file, −Y in a Z-up one.
    let usual = if up.z.abs() > up.y.abs() {
        -Vec3::y()
    } else {
        Vec3::z()
    };
    let forward = if forward.norm() > 0.3 * toes.norm() && toes.norm() > 0.0 {
        forward
    } else {
        usual
    };
    up.cross(&forward)
}

fn toes_from_heel(tree: &Tree, foot: usize) -> Option<Vec3> {
    match tree.main_chain(foot).last() {
        Some(&toes) if toes != foot => Some(tree.positions[toes] - tree.positions[foot]),
        _ => tree.skeleton.joints()[foot].tip,
    }
}

/// Which member of the pair, 0 or 1, is on `side`.
fn member(
    tree: &Tree,
    pair: Pair,
    limbs: [Limb; 2],
    side: Side,
    left: Vec3,
    notes: &mut Vec<String>,
) -> usize {
    if let Some(first) = tree.side(pair.members[0]) {
        return usize::from(first != side);
    }
    let at = |i: usize| tree.positions[limbs[i].upper.unwrap_or(pair.members[i])];
    let first_is_left = (at(0) - at(1)).dot(&left) > 0.0;
    notes.push("left and right are told by where the toes point; the names do not say".to_owned());
    usize::from(first_is_left != (side == Side::Left))
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
