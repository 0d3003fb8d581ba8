//! Roles of points in clips without rotations, by their names and number, from tables of known sets.
//!
//! A flat set of points has no tree to look at, but its names come from few sources: landmark models and published
//! marker sets. A role is played by one point or by something between several: the hips by the middle
//! of the hip joints, a knee by the middle of two markers, a hip joint by a regression from the pelvis.

mod anatomy;
mod hands;
mod landmarks;
mod markers;
mod names;
mod place;
mod set;
mod tracked;

pub use hands::{
    NUMBERED_HANDS, NumberedPoints, SideVotes, hand_role, numbered_hand, recognise_hands,
    recognise_numbered_hand,
};
pub use place::PointJoint;
pub(in crate::roles) use place::said;
pub use set::Recognised;
pub use tracked::recognise_tracked;

use super::Role;
use crate::math::Vec3;
use names::{normalised, numbers};
use set::PointSet;

/// Numbers whose left and right limbs differ more than this are no landmarks: markers are numbered, too.
const UNLIKE: f64 = 0.25;

/// So much of a set must be there; points beside it do not matter.
const LEAST_COVERAGE: f64 = 0.5;

/// So much of a set of landmarks must be there for its name to be said. Their words are those of every skeleton: a suit's
/// hip, spine, neck, head, shoulders and feet are half of the 17 joints of Human3.6M.
const LEAST_NAMED: f64 = 0.75;

/// The part of a point's name that says whose it is: `Anna` of `Anna:LFHD`, else nothing.
pub fn subject_of(name: &str) -> &str {
    name.rsplit_once(':').map_or("", |(subject, _)| subject)
}

/// Numbers of points of the sets whose points may come as numbers alone.
#[cfg(feature = "formats")]
pub(crate) fn numbered_counts() -> impl Iterator<Item = usize> {
    let numbered = landmarks::SETS.iter().filter(|set| set.numbered);
    numbered.map(PointSet::len)
}

/// The set that points of these names belong to, and who plays what. `None` if too few parts of a body are known.
/// O(sets × points).
pub fn recognise(names: &[&str]) -> Option<Recognised> {
    recognise_posed(names, &[])
}

/// Who plays what among points of these names: names of roles if most are, else those of the set that they belong to, else
/// points of hands, of the right one if no name says a side, else tracked points. Empty if nothing is known. O(sets × points).
pub fn places_of(names: &[&str]) -> Vec<(Role, PointJoint)> {
    let named = names.iter().enumerate();
    let by_role: Vec<(Role, PointJoint)> = named
        .filter_map(|(at, name)| Some((Role::from_name(name)?, PointJoint::Point(at))))
        .collect();
    if by_role.len() >= 5 && 2 * by_role.len() > names.len() {
        return by_role;
    }
    if let Some(body) = recognise(names) {
        return body.roles;
    }
    let found = recognise_hands(names, &[]).or_else(|| recognise_tracked(names));
    let roles = found.map_or_else(Vec::new, |(_, roles)| roles);
    let places = roles.into_iter();
    places
        .map(|(role, at)| (role, PointJoint::Point(at)))
        .collect()
}

/// [`recognise`] with the points in some frames, which settle what numbers alone do not: 17 points may be COCO's or
/// those of Human3.6M. The set in which left and right limbs are equally long is taken.
pub fn recognise_posed(names: &[&str], poses: &[Vec<Vec3>]) -> Option<Recognised> {
    let sets = || landmarks::SETS.iter().chain(&markers::SETS);
    if let Some(order) = numbers(names).filter(|_| !names.iter().any(|name| is_no_body(name))) {
        let fitting = sets().filter(|set| set.numbered && set.len() == names.len());
        let candidates = fitting.filter_map(|set| {
            let own: Vec<&str> = set.points.split_whitespace().collect();
            let named: Vec<String> = order.iter().map(|&number| own[number].to_owned()).collect();
            set.assign(&named)
        });
        return candidates
            .filter(|found| is_steady(found, poses))
            .map(|found| (asymmetry(&found, poses), found))
            .filter(|(unlike, _)| *unlike < UNLIKE)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, found)| found);
    }
    let names = normalised(names);
    let mut fitting: Vec<(f64, &PointSet)> = sets()
        .filter(|set| set.by_name)
        .map(|set| (set.likeness(&names), set))
        .collect();
    fitting.sort_by(|a, b| b.0.total_cmp(&a.0));
    let best = fitting
        .iter()
        .filter(|(_, set)| set.coverage(&names) >= LEAST_COVERAGE)
        .find_map(|(_, set)| {
            let found = match (set.numbered, set.roles) {
                (true, _) => set.assign(&names)?,
                (false, []) => anatomy::assign(&names)?,
                (false, _) => anatomy::complete(set.assign(&names)?, &names),
            };
            let is_named = !set.numbered || set.coverage(&names) >= LEAST_NAMED;
            let name = if is_named { set } else { &landmarks::JOINTS }.name;
            Some(Recognised { set: name, ..found })
        });
    let joints = landmarks::JOINTS.assign(&names);
    // Words for joints say more than those of bones that markers are stuck to.
    best.or_else(|| match joints {
        Some(found) if found.has_hips() => Some(anatomy::complete(found, &names)),
        joints => anatomy::assign(&names).or(joints),
    })
}

/// True if a numbered point is called after something that is no body: `brow7`, `hand_3`.
fn is_no_body(name: &str) -> bool {
    const OTHERS: [&str; 12] = [
        "face", "hand", "finger", "brow", "lip", "mouth", "cheek", "jaw", "eye", "rigid", "camera",
        "cluster",
    ];
    let lower = name.to_ascii_lowercase();
    OTHERS.iter().any(|other| lower.contains(other))
}

/// Pairs of left and right bones.
const LIMBS: [[Role; 4]; 4] = [
    [
        Role::LeftThigh,
        Role::LeftShin,
        Role::RightThigh,
        Role::RightShin,
    ],
    [
        Role::LeftShin,
        Role::LeftFoot,
        Role::RightShin,
        Role::RightFoot,
    ],
    [
        Role::LeftArm,
        Role::LeftForearm,
        Role::RightArm,
        Role::RightForearm,
    ],
    [
        Role::LeftForearm,
        Role::LeftHand,
        Role::RightForearm,
        Role::RightHand,
    ],
];

/// True if bones keep their lengths from pose to pose, as far as a depth camera sees them: what is numbered at random does
/// not.
fn is_steady(found: &Recognised, poses: &[Vec<Vec3>]) -> bool {
    const MOST: f64 = 0.35;
    let place = |role: Role| {
        let place = found.roles.iter().find(|(known, _)| *known == role);
        place.map(|(_, place)| place)
    };
    let mut spreads: Vec<f64> = Vec::new();
    for [a, b] in LIMBS.iter().flat_map(|l| [[l[0], l[1]], [l[2], l[3]]]) {
        let (Some(a), Some(b)) = (place(a), place(b)) else {
            continue;
        };
        let length = |pose: &Vec<Vec3>| Some((a.at(|p| pose[p])? - b.at(|p| pose[p])?).norm());
        let lengths: Vec<f64> = poses.iter().filter_map(length).collect();
        let count = lengths.len().max(1) as f64;
        let mean = lengths.iter().sum::<f64>() / count;
        let variance = lengths.iter().map(|l| (l - mean).powi(2)).sum::<f64>() / count;
        spreads.push(variance.sqrt() / mean.max(1e-12));
    }
    spreads.sort_by(f64::total_cmp);
    spreads
        .get(spreads.len() / 2)
        .is_none_or(|&spread| spread < MOST)
}

/// Dissimilarity of left and right limbs, 0 to 1; 1 without poses.
fn asymmetry(found: &Recognised, poses: &[Vec<Vec3>]) -> f64 {
    let (mut apart, mut sum) = (0.0, 0.0);
    for pose in poses {
        let at = |role: Role| {
            let place = found.roles.iter().find(|(known, _)| *known == role);
            place.and_then(|(_, place)| place.at(|p| pose[p]))
        };
        for limb in LIMBS {
            let [Some(a), Some(b), Some(c), Some(d)] = limb.map(at) else {
                continue;
            };
            let (left, right) = ((a - b).norm(), (c - d).norm());
            apart += (left - right).abs();
            sum += left + right;
        }
    }
    if sum > 0.0 { apart / sum } else { 1.0 }
}

#[cfg(test)]
mod tests;
