//! Assigns the joints of a limb's chain: thigh, shin and foot, or collar, arm, forearm and hand.
//!
//! Every choice of three points along the chain is judged: by what the names say, by the proportions of people, by how
//! far the two limbs of the pair begin apart, and by where the chain bends in the poses at hand. Names weigh most, but no
//! name makes a bone without a length, nor two thighs in one point.

use super::meaning::{NameMeaning, Side};
use super::proportions as human;
use super::tree::JointTree;
use crate::math::portable;

/// The joints of one limb.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Limb {
    /// Collar; never set for a leg.
    pub(super) first: Option<usize>,
    /// Thigh or upper arm.
    pub(super) upper: Option<usize>,
    /// Shin or forearm.
    pub(super) lower: Option<usize>,
    /// Foot or hand.
    pub(super) end: Option<usize>,
}

/// Kind of limb.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Part {
    Leg,
    /// With the length of the legs, hip to ankle, where it is known.
    Arm {
        leg: Option<f64>,
    },
}

/// Points of a chain: `upper < lower < end`; `end` may be one behind the last joint, the tip of its bone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ChainSplit {
    upper: usize,
    lower: usize,
    end: usize,
}

/// Both limbs of a pair, and what they cost: the less, the more like a person's.
pub(super) fn pair(tree: &JointTree, members: [usize; 2], part: Part) -> ([Limb; 2], f64) {
    let chains = members.map(|member| Chain::new(tree, member, part));
    let limbs = if chains[0].joints.len() == chains[1].joints.len() {
        let (place, cost) = best(chains[0].joints.len(), |place| {
            Some(
                (chains[0].cost(place)? + chains[1].cost(place)?) / 2.0
                    + separation(&chains, place),
            )
        });
        ([place; 2], cost)
    } else {
        let own = |at: usize| {
            let other = &chains[1 - at];
            best(chains[at].joints.len(), |place| {
                let from_other = place.upper.min(other.joints.len() - 1);
                let together =
                    tree.coincide(chains[at].joints[place.upper], other.joints[from_other]);
                Some(chains[at].cost(place)? + if together { 2.0 } else { 0.0 })
            })
        };
        let (a, b) = (own(0), own(1));
        ([a.0, b.0], (a.1 + b.1) / 2.0)
    };
    let (places, cost) = limbs;
    let other = |at: usize| chains[1 - at].joints.as_slice();
    let limbs = [0, 1].map(|at| chains[at].limb(places[at], other(at)));
    (limbs, cost)
}

/// A limb without another that mirrors it.
pub(super) fn single(tree: &JointTree, member: usize, part: Part) -> Limb {
    let chain = Chain::new(tree, member, part);
    let (place, _) = best(chain.joints.len(), |place| chain.cost(place));
    chain.limb(place, &[])
}

/// The limb whose joints the names tell, wherever they hang; `joints` are those of one side and kind, parents first.
pub(super) fn named(tree: &JointTree, joints: &[usize], part: Part) -> Limb {
    let Some(&top) = joints.first() else {
        return Limb::default();
    };
    let limb = single(tree, top, part);
    if limb.lower.is_some() {
        return limb;
    }
    // Joints that do not hang together, as in rigs whose feet follow handles.
    let first = |wanted: &dyn Fn(NameMeaning) -> bool| {
        joints.iter().copied().find(|&j| wanted(tree.kind(j)))
    };
    match part {
        Part::Leg => Limb {
            first: None,
            upper: first(&|k| k == NameMeaning::Thigh)
                .or(first(&|k| matches!(k, NameMeaning::Hip | NameMeaning::Leg))),
            lower: first(&|k| k == NameMeaning::Shin),
            end: first(&|k| k == NameMeaning::Foot),
        },
        Part::Arm { .. } => Limb {
            first: first(&|k| k == NameMeaning::Collar),
            upper: first(&|k| matches!(k, NameMeaning::UpperArm | NameMeaning::Arm)),
            lower: first(&|k| k == NameMeaning::Forearm),
            end: first(&|k| k == NameMeaning::Hand),
        },
    }
}

/// A foot or hand that hangs elsewhere (on a handle of the rig) and is called so.
pub(super) fn end_elsewhere(tree: &JointTree, limb: &mut Limb, side: Side, kind: NameMeaning) {
    if limb.end.is_some() || limb.lower.is_none() {
        return;
    }
    limb.end = (0..tree.skeleton.len())
        .find(|&j| tree.kind(j) == kind && tree.readings[j].side == Some(side));
}

/// The place with the least cost; `None` if no place is possible.
fn best(joints: usize, cost: impl Fn(ChainSplit) -> Option<f64>) -> (Option<ChainSplit>, f64) {
    let mut best: Option<(f64, ChainSplit)> = None;
    for upper in 0..joints {
        for lower in upper + 1..joints {
            for end in lower + 1..=joints {
                let place = ChainSplit { upper, lower, end };
                let Some(cost) = cost(place) else { continue };
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, place));
                }
            }
        }
    }
    best.map_or((None, f64::INFINITY), |(cost, place)| (Some(place), cost))
}

/// Cost of a distance between the upper ends of two limbs that is not that of people.
fn separation(chains: &[Chain; 2], place: ChainSplit) -> f64 {
    const MOST: f64 = 3.0;
    let tree = chains[0].tree;
    let between = tree.distance(chains[0].joints[place.upper], chains[1].joints[place.upper]);
    let length = chains[0].length(place);
    let usual = match chains[0].part {
        Part::Leg => human::BETWEEN_HIPS,
        Part::Arm { .. } => human::BETWEEN_SHOULDERS,
    };
    0.7 * portable::ln(between / (length * usual)).abs().min(MOST)
}

/// The joints down one limb.
struct Chain<'a> {
    tree: &'a JointTree<'a>,
    part: Part,
    joints: Vec<usize>,
    /// Length of the bone that the last joint carries.
    tip: f64,
    /// From the first joint to the tip along the bones.
    whole: f64,
}

impl<'a> Chain<'a> {
    /// Longer chains than this are ropes.
    const MOST: usize = 24;

    fn new(tree: &'a JointTree<'a>, member: usize, part: Part) -> Self {
        let mut joints = tree.main_chain(member);
        joints.truncate(Self::MOST);
        let last = &tree.skeleton.joints()[joints[joints.len() - 1]];
        let tip = last.tip.map_or(0.0, |tip| tip.norm());
        let bones = joints
            .windows(2)
            .map(|pair| tree.distance(pair[0], pair[1]));
        let whole = bones.sum::<f64>() + tip;
        Self {
            tree,
            part,
            joints,
            tip,
            whole,
        }
    }

    /// From one point of the chain to another; the point behind the last joint is the tip.
    fn apart(&self, a: usize, b: usize, pose: usize) -> f64 {
        let positions = &self.tree.poses[pose];
        let last = b.min(self.joints.len() - 1);
        let between = (positions[self.joints[a]] - positions[self.joints[last]]).norm();
        between
            + if b == self.joints.len() {
                self.tip
            } else {
                0.0
            }
    }

    /// The longest that a bone is in any pose: where it bends it is shorter, and then it is none.
    fn bone(&self, a: usize, b: usize) -> f64 {
        (0..self.tree.poses.len())
            .map(|pose| self.apart(a, b, pose))
            .fold(0.0, f64::max)
    }

    fn length(&self, place: ChainSplit) -> f64 {
        self.bone(place.upper, place.lower) + self.bone(place.lower, place.end)
    }

    /// Excess of the way over the joints between over the bone, at most, as a share of it.
    fn bent(&self, a: usize, b: usize) -> f64 {
        if b - a < 2 {
            return 0.0;
        }
        let bent = |pose: usize| {
            let way: f64 = (a..b).map(|i| self.apart(i, i + 1, pose)).sum();
            way / self.apart(a, b, pose).max(1e-12) - 1.0
        };
        (0..self.tree.poses.len()).map(bent).fold(0.0, f64::max)
    }

    /// Cost of a choice of joints, from proportions, bends and names; `None` if its bones have no length.
    fn cost(&self, place: ChainSplit) -> Option<f64> {
        const SHORTEST: f64 = 0.08;
        let tip = place.end == self.joints.len();
        if tip && self.tip == 0.0 {
            return None;
        }
        let upper = self.bone(place.upper, place.lower);
        let lower = self.bone(place.lower, place.end);
        if upper.min(lower) <= SHORTEST * self.whole {
            return None;
        }
        let kind = |at: usize| self.tree.kind(self.joints[at]);
        let mut names = self.named_upper(kind(place.upper)) + self.named_lower(kind(place.lower));
        names += match tip {
            true => -0.5,
            false => self.named_end(kind(place.end)),
        };
        let share = portable::ln((upper + lower) / self.whole);
        let shape = match self.part {
            Part::Leg => 2.0 * portable::ln(upper / lower / human::THIGH_TO_SHIN).abs() - share,
            Part::Arm { leg } => {
                let of_leg = leg.map_or(0.0, |leg| {
                    portable::ln((upper + lower) / (leg * human::ARM_TO_LEG)).abs()
                });
                2.0 * portable::ln(upper / lower / human::ARM_TO_FOREARM).abs() - 0.5 * share
                    + 1.2 * of_leg
            }
        };
        let bends = self.bent(place.upper, place.lower) + self.bent(place.lower, place.end);
        Some(shape + (20.0 * bends).min(4.0) - self.turns(place) - names)
    }

    /// Something for a joint that is seen to bend, as knees and elbows do.
    fn turns(&self, place: ChainSplit) -> f64 {
        if self.tree.poses.len() < 3 || place.end == self.joints.len() {
            return 0.0;
        }
        let [a, b, c] = [place.upper, place.lower, place.end].map(|at| self.joints[at]);
        let angles = self.tree.poses.iter().map(|pose| {
            let (upper, lower) = (pose[b] - pose[a], pose[c] - pose[b]);
            upper.angle(&lower)
        });
        let (low, high) = angles.fold((f64::MAX, f64::MIN), |(low, high), angle| {
            (low.min(angle), high.max(angle))
        });
        0.4 * ((high - low) / 0.6).clamp(0.0, 1.0)
    }

    fn named_upper(&self, kind: NameMeaning) -> f64 {
        use NameMeaning::*;
        match (self.part, kind) {
            (_, Unknown) => 0.0,
            (Part::Leg, Thigh) | (Part::Arm { .. }, UpperArm) => 3.0,
            (Part::Leg, Leg) => 1.2,
            (Part::Arm { .. }, Arm) => 2.5,
            (Part::Leg, Hip) | (Part::Arm { .. }, Shoulder) => 1.0,
            (Part::Leg, HipJoint | Hips | Spine) | (Part::Arm { .. }, Collar | Spine) => -2.0,
            (Part::Leg, Foot) | (Part::Arm { .. }, Hand) => -4.0,
            (_, Toe | Finger) => -6.0,
            _ => -3.0,
        }
    }

    fn named_lower(&self, kind: NameMeaning) -> f64 {
        use NameMeaning::*;
        match (self.part, kind) {
            (_, Unknown) => 0.0,
            (Part::Leg, Shin) | (Part::Arm { .. }, Forearm) => 3.0,
            (Part::Leg, Leg) => 1.5,
            (Part::Arm { .. }, Arm) => 0.5,
            (Part::Leg, Foot) | (Part::Arm { .. }, Hand) => -4.0,
            (_, Toe | Finger) => -6.0,
            _ => -3.0,
        }
    }

    fn named_end(&self, kind: NameMeaning) -> f64 {
        use NameMeaning::*;
        match (self.part, kind) {
            (_, Unknown) => 0.0,
            (Part::Leg, Foot) | (Part::Arm { .. }, Hand) => 3.0,
            (_, Toe | Finger) => -1.5,
            _ => -3.0,
        }
    }

    fn limb(&self, place: Option<ChainSplit>, other: &[usize]) -> Limb {
        let Some(ChainSplit { upper, lower, end }) = place else {
            return Limb {
                upper: self.joints.first().copied(),
                lower: self.joints.get(1).copied(),
                ..Limb::default()
            };
        };
        Limb {
            first: self.collar(upper, other),
            upper: Some(self.joints[upper]),
            lower: Some(self.joints[lower]),
            end: self.joints.get(end).copied(),
        }
    }

    /// The joint before the upper arm that a collar bone turns about; `other` are the joints of the other side.
    fn collar(&self, upper: usize, other: &[usize]) -> Option<usize> {
        if self.part == Part::Leg {
            return None;
        }
        let tree = self.tree;
        let is_apart = |&j: &usize| {
            let dummy = tree
                .parent(j)
                .is_some_and(|parent| tree.coincide(j, parent));
            !dummy && !other.iter().any(|&o| tree.coincide(j, o))
        };
        let before = || self.joints[..upper].iter().copied();
        let called = |kind| {
            let mut apart = before().filter(is_apart);
            apart.find(|&j| tree.kind(j) == kind)
        };
        // Both collars may begin in one point, if nothing better is called so.
        let in_one_point = || {
            before().find(|&j| matches!(tree.kind(j), NameMeaning::Collar | NameMeaning::Shoulder))
        };
        called(NameMeaning::Collar)
            .or_else(|| called(NameMeaning::Shoulder))
            .or_else(in_one_point)
            .or_else(|| called(NameMeaning::Unknown))
    }
}
