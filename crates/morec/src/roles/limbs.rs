//! Which joints of a limb's subtree are thigh, shin and foot, or collar, arm, forearm and hand.
//!
//! Both readings are tried: the names, with their traps settled by what other names are there; and the lengths
//! alone. Names win where they make a chain of real bones.

use super::names::Kind;
use super::tree::Tree;

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

/// Thigh, shin and foot among the joints under `member`.
pub(super) fn leg(tree: &Tree, member: usize) -> Limb {
    let named = leg_by_name(tree, &tree.subtree(member));
    if is_real(tree, &named) {
        return with_end(tree, named);
    }
    by_length(tree, &tree.main_chain(member), |_, _| true)
}

/// Collar, upper arm, forearm and hand among the joints under `member`.
pub(super) fn arm(tree: &Tree, member: usize) -> Limb {
    let named = arm_by_name(tree, &tree.subtree(member));
    if is_real(tree, &named) {
        return with_end(tree, named);
    }
    let chain: Vec<usize> = tree
        .main_chain(member)
        .into_iter()
        .filter(|&j| tree.kind(j) != Kind::Finger)
        .collect();
    // A forearm is not much longer than its upper arm: this tells the upper arm from a long collar.
    let human = |upper: f64, lower: f64| lower < 1.25 * upper && upper < 2.0 * lower;
    let limb = by_length(tree, &chain, human);
    let before = limb
        .upper
        .and_then(|upper| chain.iter().position(|&j| j == upper)?.checked_sub(1));
    Limb {
        first: before.map(|at| chain[at]),
        ..limb
    }
}

/// Settles the words of a leg. `joints` are parents first.
pub(super) fn leg_by_name(tree: &Tree, joints: &[usize]) -> Limb {
    let first = |kind| joints.iter().copied().find(|&j| tree.kind(j) == kind);
    let (leg, hip) = (first(Kind::Leg), first(Kind::Hip));
    let shin = first(Kind::Shin);
    let above_shin = |j: &usize| shin.is_some_and(|shin| tree.is_above(*j, shin));
    // `LeftLeg` is the thigh only above a knee of its own name; a hip is the thigh if nothing else is.
    let upper = first(Kind::Thigh).or(leg.filter(above_shin)).or(hip);
    let lower = shin.or(leg.filter(|leg| Some(*leg) != upper));
    let under_lower = |j: &usize| lower.is_some_and(|lower| tree.is_above(lower, *j));
    let end = joints
        .iter()
        .copied()
        .filter(under_lower)
        .find(|&j| tree.kind(j) == Kind::Foot);
    Limb {
        first: None,
        upper,
        lower,
        end,
    }
}

/// Settles the words of an arm. `joints` are parents first.
pub(super) fn arm_by_name(tree: &Tree, joints: &[usize]) -> Limb {
    let first = |kind| joints.iter().copied().find(|&j| tree.kind(j) == kind);
    let shoulder = first(Kind::Shoulder);
    // `LeftShoulder` is the upper arm if no joint is called arm.
    let upper = first(Kind::UpperArm).or(first(Kind::Arm)).or(shoulder);
    let collar = first(Kind::Collar)
        .or(shoulder)
        .filter(|j| Some(*j) != upper);
    let lower = first(Kind::Forearm);
    let under_lower = |j: &usize| lower.is_some_and(|lower| tree.is_above(lower, *j));
    let end = joints
        .iter()
        .copied()
        .filter(under_lower)
        .find(|&j| tree.kind(j) == Kind::Hand);
    Limb {
        first: collar,
        upper,
        lower,
        end,
    }
}

/// Whether the names made a chain whose bones have a length.
fn is_real(tree: &Tree, limb: &Limb) -> bool {
    let (Some(upper), Some(lower)) = (limb.upper, limb.lower) else {
        return false;
    };
    let whole = tree.reach(upper);
    let bone = |a: usize, b: usize| tree.is_above(a, b) && tree.distance(a, b) > 0.1 * whole;
    bone(upper, lower)
        && limb.end.is_none_or(|end| bone(lower, end))
        && limb.first.is_none_or(|first| tree.is_above(first, upper))
}

/// Where no name says foot or hand: the next joint of the chain, if that is one of the body's.
fn with_end(tree: &Tree, limb: Limb) -> Limb {
    let next = || {
        let chain = tree.main_chain(limb.lower?);
        chain
            .into_iter()
            .skip(1)
            .find(|&j| !matches!(tree.kind(j), Kind::Finger | Kind::Toe))
    };
    Limb {
        end: limb.end.or_else(next),
        ..limb
    }
}

/// The two neighbouring bones of a chain with the greatest length together, among those that `fits`.
fn by_length(tree: &Tree, chain: &[usize], fits: impl Fn(f64, f64) -> bool) -> Limb {
    let bone = |i: usize| tree.distance(chain[i], chain[i + 1]);
    // A first joint in the place of its parent is a dummy: what leads away from it is no limb's bone.
    let dummies = chain
        .iter()
        .take_while(|&&j| tree.parent(j).is_some_and(|p| tree.coincide(j, p)))
        .count();
    let starts = dummies..chain.len().saturating_sub(2);
    let longest = |starts: &mut dyn Iterator<Item = usize>| {
        starts.max_by(|&a, &b| (bone(a) + bone(a + 1)).total_cmp(&(bone(b) + bone(b + 1))))
    };
    let start = longest(&mut starts.clone().filter(|&i| fits(bone(i), bone(i + 1))))
        .or_else(|| longest(&mut starts.clone()));
    match start {
        Some(i) => Limb {
            first: None,
            upper: Some(chain[i]),
            lower: Some(chain[i + 1]),
            end: Some(chain[i + 2]),
        },
        None => Limb {
            upper: chain.first().copied(),
            lower: chain.get(1).copied(),
            ..Limb::default()
        },
    }
}
