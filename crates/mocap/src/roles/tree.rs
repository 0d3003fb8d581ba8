//! The shape of a skeleton: bone lengths, reaches, and pairs of limbs that mirror each other.

use super::meaning::{NameMeaning, Side};
use super::names::{JointNames, Reading};
use crate::clip::Skeleton;
use crate::math::Vec3;

/// A skeleton with what its shape and names say of every joint.
pub(super) struct JointTree<'a> {
    pub(super) skeleton: &'a Skeleton,
    pub(super) readings: Vec<Reading>,
    /// Positions of the joints, in the zero pose or any others; never empty.
    pub(super) poses: &'a [Vec<Vec3>],
    /// The first of these.
    pub(super) positions: &'a [Vec3],
    /// Children that belong to the body.
    children: Vec<Vec<usize>>,
    /// Length of the longest chain from each joint down to a tip.
    reach: Vec<f64>,
    /// Joints on the longest chain (by number) from each joint down, itself included.
    height: Vec<usize>,
}

/// Two subtrees that mirror each other, hanging on the same joint.
#[derive(Debug, Clone, Copy)]
pub(super) struct MirroredPair {
    pub(super) parent: usize,
    pub(super) members: [usize; 2],
}

/// A joint with limbs under it is no prop, whatever it is called: `Camera`, `Target_Root`.
fn keep_bodies(skeleton: &Skeleton, readings: &mut [Reading]) {
    const LIMBS: usize = 6;
    let mut limbs = vec![0usize; readings.len()];
    for j in (0..readings.len()).rev() {
        let kind = readings[j].kind;
        limbs[j] += usize::from(readings[j].side.is_some() && (kind.is_leg() || kind.is_arm()));
        if kind == NameMeaning::Other && limbs[j] >= LIMBS {
            readings[j].kind = NameMeaning::Unknown;
        }
        if let Some(parent) = skeleton.joints()[j].parent {
            limbs[parent] += limbs[j];
        }
    }
}

/// Limbs of a person differ less than this from side to side; trackers may err so far.
const UNLIKE: f64 = 0.25;

impl<'a> JointTree<'a> {
    pub(super) fn new(skeleton: &'a Skeleton, names: &JointNames, poses: &'a [Vec<Vec3>]) -> Self {
        let joints = skeleton.joints();
        let positions: &[Vec3] = &poses[0];
        let mut readings = names.readings().to_vec();
        keep_bodies(skeleton, &mut readings);
        let mut children = vec![Vec::new(); joints.len()];
        let mut reach: Vec<f64> = joints
            .iter()
            .map(|j| j.tip.map_or(0.0, |tip| tip.norm()))
            .collect();
        let mut height = vec![1; joints.len()];
        // Parents come first, so that backwards every joint is finished before its parent needs it.
        for j in (0..joints.len()).rev() {
            children[j].reverse();
            let Some(p) = joints[j].parent else { continue };
            if matches!(readings[j].kind, NameMeaning::Other | NameMeaning::Animal) {
                continue;
            }
            children[p].push(j);
            reach[p] = reach[p].max(reach[j] + (positions[j] - positions[p]).norm());
            height[p] = height[p].max(height[j] + 1);
        }
        Self {
            skeleton,
            readings,
            poses,
            positions,
            children,
            reach,
            height,
        }
    }

    pub(super) fn parent(&self, joint: usize) -> Option<usize> {
        self.skeleton.joints()[joint].parent
    }

    pub(super) fn kind(&self, joint: usize) -> NameMeaning {
        self.readings[joint].kind
    }

    pub(super) fn reach(&self, joint: usize) -> f64 {
        self.reach[joint]
    }

    pub(super) fn children(&self, joint: usize) -> &[usize] {
        &self.children[joint]
    }

    pub(super) fn distance(&self, a: usize, b: usize) -> f64 {
        (self.positions[a] - self.positions[b]).norm()
    }

    /// The longest reach of any joint: a length to compare with.
    pub(super) fn size(&self) -> f64 {
        self.reach.iter().copied().fold(0.0, f64::max)
    }

    /// True if two joints are in one place, seen against the size of the body.
    pub(super) fn coincide(&self, a: usize, b: usize) -> bool {
        self.distance(a, b) <= 1e-4 * self.size()
    }

    /// `joint` and its ancestors, upwards.
    pub(super) fn upwards(&self, joint: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(Some(joint), |&j| self.parent(j))
    }

    pub(super) fn is_above(&self, ancestor: usize, joint: usize) -> bool {
        ancestor != joint && self.upwards(joint).any(|j| j == ancestor)
    }

    /// The nearest joint that is both joints' ancestor or one of them.
    pub(super) fn meeting(&self, a: usize, b: usize) -> Option<usize> {
        self.upwards(a).find(|&j| j == b || self.is_above(j, b))
    }

    /// The body joints under `joint` and itself, parents first.
    pub(super) fn subtree(&self, joint: usize) -> Vec<usize> {
        let mut joints = Vec::new();
        let mut left = vec![joint];
        while let Some(j) = left.pop() {
            joints.push(j);
            left.extend(self.children[j].iter().rev());
        }
        joints
    }

    /// Down from `joint`, at every fork along the longer reach; twist joints are passed over.
    pub(super) fn main_chain(&self, joint: usize) -> Vec<usize> {
        let mut chain = vec![joint];
        let mut at = joint;
        while let Some(&next) = self.children[at]
            .iter()
            .max_by(|&&a, &&b| self.span(at, a).total_cmp(&self.span(at, b)))
        {
            if self.kind(next) != NameMeaning::Twist {
                chain.push(next);
            }
            at = next;
        }
        chain
    }

    fn span(&self, parent: usize, child: usize) -> f64 {
        self.reach[child] + self.distance(parent, child)
    }

    /// The side that the names in a subtree agree on.
    pub(super) fn side(&self, joint: usize) -> Option<Side> {
        let count = |side| {
            self.subtree(joint)
                .into_iter()
                .filter(|&j| self.readings[j].side == Some(side))
                .count()
        };
        let (left, right) = (count(Side::Left), count(Side::Right));
        match () {
            () if left > 2 * right => Some(Side::Left),
            () if right > 2 * left => Some(Side::Right),
            () => None,
        }
    }

    /// Joints in a subtree whose names belong to a leg, less those that belong to an arm.
    pub(super) fn leg_votes(&self, joint: usize) -> i64 {
        let vote = |j: usize| i64::from(self.kind(j).is_leg()) - i64::from(self.kind(j).is_arm());
        self.subtree(joint).into_iter().map(vote).sum()
    }

    /// Every pair of limbs that is not itself part of a limb.
    pub(super) fn pairs(&self) -> Vec<MirroredPair> {
        let mut pairs = Vec::new();
        let roots = (0..self.skeleton.len()).filter(|&j| self.parent(j).is_none());
        let mut left: Vec<usize> = roots.collect();
        while let Some(parent) = left.pop() {
            let mut free = self.longest_children(parent);
            let rest = self.children[parent].iter().filter(|j| !free.contains(j));
            left.extend(rest);
            while let Some((a, b)) = self.best_pair(&free) {
                pairs.push(MirroredPair {
                    parent,
                    members: [a, b],
                });
                free.retain(|&j| j != a && j != b);
            }
            left.extend(free.into_iter().rev());
        }
        pairs
    }

    /// The children that could be limbs, few enough to compare each with each.
    fn longest_children(&self, parent: usize) -> Vec<usize> {
        const MOST: usize = 16;
        let mut long: Vec<usize> = self.children[parent].clone();
        long.sort_by(|&a, &b| self.span(parent, b).total_cmp(&self.span(parent, a)));
        long.truncate(MOST);
        long.sort_unstable();
        long
    }

    fn best_pair(&self, free: &[usize]) -> Option<(usize, usize)> {
        let mut best: Option<(f64, usize, usize)> = None;
        for (i, &a) in free.iter().enumerate() {
            for &b in &free[i + 1..] {
                let Some(cost) = self.unlikeness(a, b) else {
                    continue;
                };
                if best.is_none_or(|(least, ..)| cost < least) {
                    best = Some((cost, a, b));
                }
            }
        }
        best.map(|(_, a, b)| (a, b))
    }

    /// Deviation of two subtrees from mirror images of each other; `None` if they are no pair of limbs.
    fn unlikeness(&self, a: usize, b: usize) -> Option<f64> {
        let named = match (self.side(a), self.side(b)) {
            (Some(a), Some(b)) if a == b => return None,
            (Some(_), Some(_)) => true,
            (None, None) => false,
            _ => return None,
        };
        let (legs_a, legs_b) = (self.leg_votes(a).signum(), self.leg_votes(b).signum());
        if legs_a != legs_b {
            return None;
        }
        let shortest = if named && legs_a != 0 { 2 } else { 3 };
        if self.height[a].min(self.height[b]) < shortest {
            return None;
        }
        let cost = self.length_mismatch(a, b);
        (named || cost < UNLIKE && self.height[a] == self.height[b]).then_some(cost)
    }

    /// Mean relative difference of the bones of two chains, 0 to 1.
    fn length_mismatch(&self, a: usize, b: usize) -> f64 {
        let lengths = |joint| -> Vec<f64> {
            self.main_chain(joint)
                .windows(2)
                .map(|pair| self.distance(pair[0], pair[1]))
                .collect()
        };
        let (a, b) = (lengths(a), lengths(b));
        let at = |lengths: &[f64], i: usize| lengths.get(i).copied().unwrap_or(0.0);
        let (mut apart, mut sum) = (0.0, 0.0);
        for i in 0..a.len().max(b.len()) {
            apart += (at(&a, i) - at(&b, i)).abs();
            sum += at(&a, i) + at(&b, i);
        }
        if sum > 0.0 { apart / sum } else { 1.0 }
    }
}
