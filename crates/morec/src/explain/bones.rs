//! Bones whose directions differ from those of a template.

use crate::features::{ALL_BONES, Rows};
use crate::train::align;

use super::reason::BoneOff;
use crate::features::BoneSet;

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

/// Angle between the directions of the bone in `slot` in row `i` of `a` and row `j` of `b`, degrees.
pub(super) fn angle_at(a: &Rows, i: usize, b: &Rows, j: usize, slot: usize) -> f64 {
    let at = |rows: &Rows, i: usize| {
        let row = &rows.row(i)[3 * slot..3 * slot + 3];
        [f64::from(row[0]), f64::from(row[1]), f64::from(row[2])]
    };
    angle(at(a, i), at(b, j)).to_degrees()
}

fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let lengths = (dot(&a, &a) * dot(&b, &b)).sqrt();
    if lengths > 1e-12 {
        (dot(&a, &b) / lengths).clamp(-1.0, 1.0).acos()
    } else {
        0.0
    }
}
