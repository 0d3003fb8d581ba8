//! Determines the left limb of a pair.

use super::limbs::Limb;
use super::meaning::Side;
use super::tree::{JointTree, MirroredPair};
use super::{Role, RoleMap};
use crate::math::Vec3;

/// Knees that bend less than this share of the leg do not tell where they point.
const LEAST_BEND: f64 = 0.04;
/// The same of a zero pose, in which bones need not lie as in any body.
const LEAST_BEND_AT_ZERO: f64 = 0.12;
/// Weight of the toes relative to the bends of both knees, in leg lengths.
const TOES: f64 = 0.3;
/// A mean cosine from here on is certain.
const CERTAIN: f64 = 0.5;

/// Evidence of left and right from the body's shape and poses.
pub(super) struct SideCues {
    /// Towards the left, from each pose: up × forward.
    left: Vec<Vec3>,
    /// The mean cosine between the way from the right hip to the left, by names, and the left by toes and by knees.
    toes: Option<f64>,
    knees: Option<f64>,
}

impl SideCues {
    pub(super) fn of(tree: &JointTree, map: &RoleMap, legs: Option<[Limb; 2]>) -> Self {
        let mut left = Vec::with_capacity(tree.poses.len());
        let (mut toes, mut knees) = (Vec::new(), Vec::new());
        for pose in tree.poses {
            let up = upwards(pose, map);
            let forward_toes = across(
                legs.iter()
                    .flatten()
                    .filter_map(|leg| toes_of(tree, pose, leg)),
                up,
            );
            let usual = usual(up);
            // Toes tell at once, knees the better the more they bend.
            let least = match tree.poses.len() {
                1 => LEAST_BEND_AT_ZERO,
                _ => LEAST_BEND,
            };
            let knee_of = |leg| knee_of(pose, leg).filter(|(_, share)| *share > least);
            let bend = legs.iter().flatten().filter_map(knee_of);
            let bent: f64 = bend.map(|(_, share)| share).sum();
            let knee = |leg| Some(knee_of(leg)?.0);
            let forward_knees = across(legs.iter().flatten().filter_map(knee), up);
            let forward = match (forward_toes, forward_knees) {
                (Some(toes), Some(knees)) => toes * TOES + knees * bent,
                (toes, knees) => toes.or(knees).unwrap_or(usual),
            };
            left.push(up.cross(&forward));
            let Some(apart) = legs.and_then(|legs| apart(tree, pose, legs)) else {
                continue;
            };
            toes.extend(forward_toes.map(|forward| up.cross(&forward).dot(&apart)));
            knees.extend(forward_knees.map(|forward| up.cross(&forward).dot(&apart)));
        }
        let mean = |values: Vec<f64>| match values.len() {
            0 => None,
            count => Some(values.iter().sum::<f64>() / count as f64),
        };
        Self {
            left,
            toes: mean(toes),
            knees: mean(knees),
        }
    }

    /// The side of a pair's first limb, and a note where it is a guess.
    pub(super) fn first(
        &self,
        tree: &JointTree,
        pair: MirroredPair,
        limbs: [Limb; 2],
    ) -> (Side, Option<String>) {
        if let Some(first) = tree.side(pair.members[0]) {
            return (first, None);
        }
        let joint = |i: usize| limbs[i].upper.unwrap_or(pair.members[i]);
        let leftwards: f64 = tree
            .poses
            .iter()
            .zip(&self.left)
            .map(|(pose, left)| (pose[joint(0)] - pose[joint(1)]).dot(left))
            .sum();
        let side = if leftwards > 0.0 {
            Side::Left
        } else {
            Side::Right
        };
        let note =
            "left and right are inferred from the toes, because the joint names give no side";
        (side, Some(note.to_owned()))
    }

    /// Exchanges all sides where toes and knees agree over several poses that the names have them the wrong way
    /// round.
    pub(super) fn settle(&self, taken: &mut [Option<Side>; 2], notes: &mut Vec<String>) {
        const POSES: usize = 3;
        let (Some(toes), Some(knees)) = (self.toes, self.knees) else {
            return;
        };
        if toes > -CERTAIN || knees > -CERTAIN || self.left.len() < POSES {
            return;
        }
        for side in taken.iter_mut().flatten() {
            *side = side.other();
        }
        notes.push(
            "left and right in the joint names contradict the direction of toes and knees; the body's direction is used (--roles \
             overrides it)"
                .to_owned(),
        );
    }
}

/// From the right hip to the left, by the names, of unit length.
fn apart(tree: &JointTree, pose: &[Vec3], legs: [Limb; 2]) -> Option<Vec3> {
    let [a, b] = [legs[0].upper?, legs[1].upper?];
    let towards = match tree.side(a)? {
        Side::Left => pose[a] - pose[b],
        Side::Right => pose[b] - pose[a],
    };
    towards.try_normalize(1e-9)
}

fn upwards(pose: &[Vec3], map: &RoleMap) -> Vec3 {
    let at = |role: Role| map.joint(role).map(|joint| pose[joint]);
    let high = at(Role::Head).or(at(Role::Neck)).or(at(Role::Torso));
    let low = at(Role::Hips).unwrap_or_else(Vec3::zeros);
    high.map_or_else(Vec3::zeros, |high| high - low)
        .try_normalize(1e-9)
        .unwrap_or(Vec3::y())
}

/// Forward without a witness: +Z in a Y-up file, −Y in a Z-up one.
fn usual(up: Vec3) -> Vec3 {
    if up.z.abs() > up.y.abs() {
        -Vec3::y()
    } else {
        Vec3::z()
    }
}

/// The sum of the directions, level and of unit length, if they point anywhere but up or down.
fn across(directions: impl Iterator<Item = Vec3>, up: Vec3) -> Option<Vec3> {
    let sum: Vec3 = directions.sum();
    let level = sum - up * sum.dot(&up);
    if level.norm() <= 0.3 * sum.norm() {
        return None;
    }
    level.try_normalize(1e-12)
}

/// From heel to toes.
fn toes_of(tree: &JointTree, pose: &[Vec3], leg: &Limb) -> Option<Vec3> {
    let foot = leg.end?;
    match tree.main_chain(foot).last() {
        Some(&toes) if toes != foot => Some(pose[toes] - pose[foot]),
        // The tip turns with the foot, which the zero pose alone knows.
        _ if tree.poses.len() == 1 => tree.skeleton.joints()[foot].tip,
        _ => None,
    }
}

/// From the line between hip and ankle to the knee, where it is bent, and how long that is as a share of the line.
fn knee_of(pose: &[Vec3], leg: &Limb) -> Option<(Vec3, f64)> {
    let [hip, knee, ankle] = [pose[leg.upper?], pose[leg.lower?], pose[leg.end?]];
    let line = (ankle - hip).try_normalize(1e-12)?;
    let out = (knee - hip) - line * (knee - hip).dot(&line);
    let share = out.norm() / (ankle - hip).norm();
    Some((out, share))
}
