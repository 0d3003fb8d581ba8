//! Finding the roles: limbs and trunk by the shape of the tree, then names, then sides.

use super::limbs::{self, Limb, Part};
use super::names::{NameMeaning, Side};
use super::proportions as human;
use super::sides::SideCues;
use super::tree::{JointTree, MirroredPair};
use super::{Role, RoleMap, trunk};
use crate::clip::Skeleton;
use crate::math::Vec3;

/// What was found, and what is worth saying about it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RolesFound {
    /// Who plays what.
    pub map: RoleMap,
    /// Guesses and oddities, each in a sentence.
    pub notes: Vec<String>,
}

/// Finds the roles of `skeleton` from its tree, its bone lengths and its names. O(joints²) at worst.
///
/// Names that say nothing (`joint_7`) leave the tree and the lengths: two pairs of limbs that mirror each other, in
/// the proportions of people. Left and right are then told by where the toes point in the zero pose.
pub fn find(skeleton: &Skeleton) -> RolesFound {
    let mut positions: Vec<Vec3> = Vec::with_capacity(skeleton.len());
    for joint in skeleton.joints() {
        positions.push(joint.offset + joint.parent.map_or_else(Vec3::zeros, |p| positions[p]));
    }
    find_moving(skeleton, &[positions])
}

/// [`find`] with the joints where `poses` says, as in frames of a clip (a position for each joint, any unit): better
/// witnesses than a zero pose that nobody ever stood in. Where knees and elbows bend, they are told from joints that
/// halve a bone; where knees and toes point tells left from right, even against the names.
///
/// # Panics
/// If there is no pose, or one that is not as long as the skeleton.
pub fn find_moving(skeleton: &Skeleton, poses: &[Vec<Vec3>]) -> RolesFound {
    assert!(!poses.is_empty(), "at least one pose");
    assert!(
        poses.iter().all(|pose| pose.len() == skeleton.len()),
        "a position for each joint"
    );
    let mut found = RolesFound::default();
    if skeleton.is_empty() {
        return found;
    }
    let tree = JointTree::new(skeleton, poses);
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
    found
}

/// A pair of limbs with its joints.
#[derive(Debug, Clone, Copy)]
pub(super) struct FoundPair {
    pub(super) pair: MirroredPair,
    pub(super) limbs: [Limb; 2],
    cost: f64,
}

impl FoundPair {
    fn of(tree: &JointTree, pair: MirroredPair, part: Part) -> Self {
        let (limbs, cost) = limbs::pair(tree, pair.members, part);
        Self { pair, limbs, cost }
    }

    /// The middle of the joints that `of` names.
    fn middle(&self, pose: &[Vec3], of: impl Fn(&Limb) -> Option<usize>) -> Option<Vec3> {
        let [a, b] = [of(&self.limbs[0])?, of(&self.limbs[1])?];
        Some((pose[a] + pose[b]) / 2.0)
    }
}

/// The legs and the arms.
#[derive(Debug)]
pub(super) struct LimbPairs {
    pub(super) legs: Option<FoundPair>,
    pub(super) arms: Option<FoundPair>,
    /// Length of the legs, hip to ankle.
    leg: Option<f64>,
}

impl LimbPairs {
    /// Names choose first; among pairs whose names say nothing, those that make a person.
    fn choose(tree: &JointTree) -> Self {
        const LOOKED_AT: usize = 6;
        let mut pairs = tree.pairs();
        let reach = |pair: &MirroredPair| tree.reach(pair.members[0]) + tree.reach(pair.members[1]);
        pairs.sort_by(|a, b| reach(b).total_cmp(&reach(a)));
        let votes =
            |pair: &MirroredPair| pair.members.iter().map(|&m| tree.leg_votes(m)).sum::<i64>();
        let find =
            |fits: &dyn Fn(i64) -> bool| pairs.iter().copied().find(|pair| fits(votes(pair)));
        let (legs, arms) = (find(&|v| v > 0), find(&|v| v < 0));
        let silent: Vec<MirroredPair> = pairs
            .iter()
            .copied()
            .filter(|pair| votes(pair) == 0)
            .take(LOOKED_AT)
            .collect();
        let candidates = |named: Option<MirroredPair>| match named {
            Some(pair) => vec![pair],
            None => silent.clone(),
        };
        let mut best: Option<(f64, FoundPair, FoundPair)> = None;
        for leg_pair in candidates(legs) {
            let legs = FoundPair::of(tree, leg_pair, Part::Leg);
            let part = Part::Arm {
                leg: length(tree, &legs),
            };
            let others = candidates(arms).into_iter();
            for arm_pair in others.filter(|pair| pair.members != leg_pair.members) {
                let arms = FoundPair::of(tree, arm_pair, part);
                let cost = legs.cost + arms.cost + person(tree, &legs, &arms);
                if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
                    best = Some((cost, legs, arms));
                }
            }
        }
        let (legs, arms) = match best {
            Some((_, legs, arms)) => (Some(legs), Some(arms)),
            // One pair alone: legs, unless it is called arms.
            None => {
                let part = Part::Arm { leg: None };
                let legs = legs.or(silent.first().copied().filter(|_| arms.is_none()));
                (
                    legs.map(|pair| FoundPair::of(tree, pair, Part::Leg)),
                    arms.map(|pair| FoundPair::of(tree, pair, part)),
                )
            }
        };
        Self {
            leg: legs.as_ref().and_then(|legs| length(tree, legs)),
            legs,
            arms,
        }
    }

    fn leg_limbs(&self) -> Option<[Limb; 2]> {
        self.legs.as_ref().map(|legs| legs.limbs)
    }

    /// From the middle of the hip joints to that of the shoulders, in the first pose.
    pub(super) fn upwards(&self, tree: &JointTree) -> Option<Vec3> {
        let (legs, arms) = (self.legs.as_ref()?, self.arms.as_ref()?);
        let hips = legs.middle(tree.positions, |limb| limb.upper)?;
        (arms.middle(tree.positions, |limb| limb.upper)? - hips).try_normalize(1e-9)
    }

    /// The middle of the shoulders in the first pose, and the length of the legs.
    pub(super) fn shoulders(&self, tree: &JointTree) -> Option<(Vec3, f64)> {
        let middle = self
            .arms
            .as_ref()?
            .middle(tree.positions, |limb| limb.upper)?;
        Some((middle, self.leg?))
    }
}

/// The mean length of both legs, hip to ankle.
fn length(tree: &JointTree, legs: &FoundPair) -> Option<f64> {
    let one = |limb: &Limb| {
        let [a, b, c] = [limb.upper?, limb.lower?, limb.end?];
        Some(tree.distance(a, b) + tree.distance(b, c))
    };
    Some((one(&legs.limbs[0])? + one(&legs.limbs[1])?) / 2.0)
}

/// How far these legs and arms are from making a person: the length of the trunk, and that it leads away from the feet.
fn person(tree: &JointTree, legs: &FoundPair, arms: &FoundPair) -> f64 {
    const UNKNOWN: f64 = 2.0;
    let lengths = || {
        let hips = legs.middle(tree.positions, |limb| limb.upper)?;
        let shoulders = arms.middle(tree.positions, |limb| limb.upper)?;
        let trunk = (shoulders - hips).norm() / (length(tree, legs)? * human::TRUNK_TO_LEG);
        Some(trunk.max(1e-6).ln().abs().min(3.0))
    };
    let against_feet = |pose: &Vec<Vec3>| {
        let hips = legs.middle(pose, |limb| limb.upper)?;
        let up = (arms.middle(pose, |limb| limb.upper)? - hips).try_normalize(1e-12)?;
        let down = (legs.middle(pose, |limb| limb.end)? - hips).try_normalize(1e-12)?;
        Some(1.0 + up.dot(&down))
    };
    let turned: Vec<f64> = tree.poses.iter().filter_map(against_feet).collect();
    let turned = match turned.len() {
        0 => UNKNOWN,
        count => turned.iter().sum::<f64>() / count as f64,
    };
    // The root is nearer to the hips.
    let depth = |pair: &FoundPair| tree.upwards(pair.pair.parent).count();
    let upside_down = if depth(legs) > depth(arms) { 0.5 } else { 0.0 };
    lengths().unwrap_or(UNKNOWN) + turned + upside_down
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
