//! Assigns hips, torso, neck and head.

use super::Role;
use super::meaning::NameMeaning;
use super::pairs::{LimbPairs, RolesFound};
use super::tree::JointTree;

/// A first joint above the shoulders by no more than this share of the legs is the neck's, else the head's.
const NECK_RISE: f64 = 0.12;

/// Finds the joints of the trunk.
pub(super) fn find(tree: &JointTree, pairs: &LimbPairs, found: &mut RolesFound) {
    let trunk = Trunk { tree, pairs };
    let seen = trunk.hips();
    // Without legs or a name for it, the root is the lowest joint of the trunk: the hips, unless it is known as something above.
    let hips = seen.unwrap_or(0);
    let (neck, head) = trunk.neck_and_head(hips, &mut found.notes);
    let is_above = neck == Some(hips) || head == Some(hips);
    let root = (!is_above).then_some(hips);
    found.map.set(Role::Hips, seen.or(root));
    found.map.set(Role::Neck, neck);
    found.map.set(Role::Head, head);
    found.map.set(Role::Torso, trunk.torso(hips, neck));
}

struct Trunk<'a> {
    tree: &'a JointTree<'a>,
    pairs: &'a LimbPairs,
}

impl Trunk<'_> {
    fn contains(&self, joint: usize) -> bool {
        let pairs = self.pairs.legs.iter().chain(&self.pairs.arms);
        let mut limbs = pairs.flat_map(|found| found.pair.members);
        !limbs.any(|limb| limb == joint || self.tree.is_above(limb, joint))
    }

    fn by_name(&self, kind: NameMeaning) -> Option<usize> {
        (0..self.tree.skeleton.len()).find(|&j| self.is_called(j, kind))
    }

    fn is_called(&self, joint: usize, kind: NameMeaning) -> bool {
        self.tree.kind(joint) == kind
            && self.tree.readings[joint].side.is_none()
            && self.contains(joint)
    }

    /// The joint that the arms hang on.
    fn top(&self) -> Option<usize> {
        self.pairs.arms.as_ref().map(|arms| arms.pair.parent)
    }

    fn meeting(&self) -> Option<usize> {
        let legs = self.pairs.legs.as_ref()?.pair.parent;
        let above = self.top().and_then(|top| self.tree.meeting(legs, top));
        Some(above.unwrap_or(legs))
    }

    /// The joint at which legs and arms meet, or what is called hips next to it.
    fn hips(&self) -> Option<usize> {
        let is_hips = |j: &usize| self.tree.kind(*j) == NameMeaning::Hips;
        let met = || {
            let meeting = self.meeting()?;
            let legs = self.pairs.legs.as_ref()?.pair.parent;
            let called = self.tree.upwards(meeting).find(is_hips);
            let called = called.or_else(|| self.tree.upwards(legs).find(is_hips));
            Some(called.unwrap_or(meeting))
        };
        met().or_else(|| self.by_name(NameMeaning::Hips))
    }

    /// The first joint of the spine that is not in the hips' place.
    fn torso(&self, hips: usize, neck: Option<usize>) -> Option<usize> {
        let tree = self.tree;
        let by_name = || self.by_name(NameMeaning::Spine).filter(|&j| j != hips);
        let Some(top) = self.top().or(neck.and_then(|neck| tree.parent(neck))) else {
            return by_name();
        };
        // Hips beside the spine hang on the joint where both begin.
        let below = match tree.is_above(hips, top) {
            true => hips,
            false => tree.meeting(hips, top)?,
        };
        let mut spine: Vec<usize> = tree.upwards(top).take_while(|&j| j != below).collect();
        spine.reverse();
        let first = spine.iter().copied().find(|&j| !tree.coincide(j, hips));
        // All of the spine in one joint in the hips' place, and the arms on it.
        first.filter(|&j| Some(j) != neck || spine.len() == 1)
    }

    fn neck_and_head(
        &self,
        hips: usize,
        notes: &mut Vec<String>,
    ) -> (Option<usize>, Option<usize>) {
        let tree = self.tree;
        let called_head = self.by_name(NameMeaning::Head);
        let neck = self.by_name(NameMeaning::Neck).filter(|&neck| {
            called_head.is_none_or(|head| tree.is_above(neck, head))
                && self
                    .top()
                    .is_none_or(|top| neck == top || !tree.is_above(neck, top))
        });
        let Some(top) = self.top() else {
            return (neck, called_head);
        };
        let rising = match called_head {
            Some(head) => {
                let base = neck.unwrap_or(top);
                let way: Vec<usize> = tree.upwards(head).take_while(|&j| j != base).collect();
                way.into_iter().rev().collect()
            }
            None => self.rising(neck.unwrap_or(top), hips),
        };
        match (neck, called_head) {
            (Some(_), Some(_)) => (neck, called_head),
            (Some(_), None) => (neck, self.head_of(&rising)),
            (None, Some(head)) => match rising.as_slice() {
                [first, .., _] => (Some(*first), Some(head)),
                _ => (self.stand_in(top, hips, notes), Some(head)),
            },
            (None, None) => match rising.as_slice() {
                [] => (None, None),
                [only] if self.is_neck(*only) => (Some(*only), None),
                [only] => (self.stand_in(top, hips, notes), Some(*only)),
                [first, rest @ ..] => (Some(*first), self.head_of(rest)),
            },
        }
    }

    /// The joint that the arms hang on, as the neck of a body that has none.
    fn stand_in(&self, top: usize, hips: usize, notes: &mut Vec<String>) -> Option<usize> {
        if top == hips || self.tree.coincide(top, hips) {
            return None;
        }
        notes.push(format!(
            "the skeleton has no neck joint; `{}`, where the arms begin, is used",
            self.tree.skeleton.joints()[top].name
        ));
        Some(top)
    }

    /// True if a single joint above the shoulders is as low as a neck.
    fn is_neck(&self, joint: usize) -> bool {
        let measured = || {
            let up = self.pairs.upwards(self.tree)?;
            let (shoulders, leg) = self.pairs.shoulders(self.tree)?;
            let rise = (self.tree.positions[joint] - shoulders).dot(&up);
            Some(rise < NECK_RISE * leg)
        };
        measured().unwrap_or(false)
    }

    /// The chain of the trunk that rises highest from a joint and does not lead to the legs.
    fn rising(&self, from: usize, hips: usize) -> Vec<usize> {
        let tree = self.tree;
        let legs = self.pairs.legs.as_ref().map(|legs| legs.pair.parent);
        let leads_to_legs = |j: usize| legs.is_some_and(|legs| j == legs || tree.is_above(j, legs));
        let up = self.pairs.upwards(tree);
        let rise = |j: usize| {
            let chain = tree.main_chain(j);
            let end = tree.positions[chain[chain.len() - 1]] - tree.positions[from];
            let length = tree.reach(j) + tree.distance(from, j);
            match up {
                // What hangs down a back is no neck, however long.
                Some(up) if length > 0.0 && end.norm() > 0.0 => length * end.dot(&up) / end.norm(),
                _ => length,
            }
        };
        let start = tree
            .children(from)
            .iter()
            .copied()
            .filter(|&j| self.contains(j) && !leads_to_legs(j))
            .max_by(|&a, &b| rise(a).total_cmp(&rise(b)));
        let chain = start
            .map(|start| tree.main_chain(start))
            .unwrap_or_default();
        // Dummies at the middle of the body are no neck.
        chain
            .into_iter()
            .skip_while(|&j| tree.coincide(j, hips))
            .collect()
    }

    /// The first joint of the chain that several others hang on, as the parts of a face do; else the last joint that has a
    /// bone: one without a tip is itself only the end of a bone.
    fn head_of(&self, chain: &[usize]) -> Option<usize> {
        let (&last, before) = chain.split_last()?;
        let fork = chain
            .iter()
            .copied()
            .find(|&j| self.tree.children(j).len() > 1);
        let is_end = self.tree.skeleton.joints()[last].tip.is_none()
            && self.tree.skeleton.children(last).next().is_none();
        let last_bone = before.last().copied().filter(|_| is_end);
        fork.or(last_bone).or(Some(last))
    }
}
