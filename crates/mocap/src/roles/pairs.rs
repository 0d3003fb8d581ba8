//! Identifies legs and arms among the pairs of mirrored limbs.

use super::RoleMap;
use super::limbs::{self, Limb, Part};
use super::proportions as human;
use super::tree::{JointTree, MirroredPair};
use crate::math::{Vec3, portable};

/// Roles that were found, with notes about guesses.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RolesFound {
    /// The joint of each role.
    pub map: RoleMap,
    /// Guesses and oddities, each in a sentence.
    pub notes: Vec<String>,
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
    pub(super) leg: Option<f64>,
}

impl LimbPairs {
    /// Names choose first; among pairs whose names say nothing, those that make a person.
    pub(super) fn choose(tree: &JointTree) -> Self {
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

    pub(super) fn leg_limbs(&self) -> Option<[Limb; 2]> {
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

/// Deviation of these legs and arms from a person's: the length of the trunk, and that it leads away from the feet.
fn person(tree: &JointTree, legs: &FoundPair, arms: &FoundPair) -> f64 {
    const UNKNOWN: f64 = 2.0;
    let lengths = || {
        let hips = legs.middle(tree.positions, |limb| limb.upper)?;
        let shoulders = arms.middle(tree.positions, |limb| limb.upper)?;
        let trunk = (shoulders - hips).norm() / (length(tree, legs)? * human::TRUNK_TO_LEG);
        Some(portable::ln(trunk.max(1e-6)).abs().min(3.0))
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
