//! Bones whose directions differ from those of a template.

use morec::features::{ALL_BONES, Rows};
use morec::templates::{align, angle_at};

use super::reason::BoneOff;
use morec::features::BoneSet;

/// At most this many bones are named.
const MOST: usize = 3;
/// Bones that are off by less are not named, in degrees.
const LEAST_DEGREES: f64 = 15.0;

/// The bones that differ most between two stretches of rows, aligned in time; the mean angle of each along the path.
/// O(rows²).
pub(super) fn farthest(template: &Rows, stretch: &Rows, bones: BoneSet) -> Vec<BoneOff> {
    let path = align(template, stretch);
    let mean_degrees = |slot: usize| {
        let angles = path
            .iter()
            .map(|&(i, j)| angle_at(template, i, stretch, j, slot));
        angles.sum::<f64>() / path.len().max(1) as f64
    };
    let mut off: Vec<BoneOff> = bones
        .indices()
        .enumerate()
        .map(|(slot, bone)| BoneOff {
            bone: ALL_BONES[bone].name,
            degrees: mean_degrees(slot),
        })
        .filter(|b| b.degrees >= LEAST_DEGREES)
        .collect();
    off.sort_by(|a, b| b.degrees.total_cmp(&a.degrees));
    off.truncate(MOST);
    off
}
