//! Finds the moving part of a whole clip.

use std::ops::Range;

use crate::features::{BoneSet, Rows};

/// Ticks each side that a tick's pose is averaged over, against jitter.
const AVERAGE_TICKS: usize = 2;
/// Ticks each side between which movement is measured.
const REACH_TICKS: usize = 3;
/// Movement above this share of the largest counts as motion.
const MOVING_SHARE: f64 = 0.2;
/// Ticks kept before and after the motion.
const PAD_TICKS: usize = 2;

/// The stretch of `rows` from the first to the last movement: a clip that holds one motion mostly begins and
/// ends at rest, and the rest is not the motion.
///
/// Movement of a tick is how far the bone directions travel over ±3 ticks of the averaged rows; it
/// counts above a fifth of the way from the stillest tenth to the largest. Never empty if `rows` is not.
pub fn motion_span(rows: &Rows, bones: BoneSet) -> Range<usize> {
    let n = rows.len();
    if n == 0 {
        return 0..0;
    }
    let columns = 3 * bones.len();
    let averaged: Vec<Vec<f32>> = (0..n).map(|t| average(rows, t, columns)).collect();
    let movement: Vec<f64> = (0..n)
        .map(|t| {
            distance(
                &averaged[t.saturating_sub(REACH_TICKS)],
                &averaged[(t + REACH_TICKS).min(n - 1)],
            )
        })
        .collect();
    let mut sorted = movement.clone();
    sorted.sort_by(f64::total_cmp);
    let still = sorted[n / 10];
    let bar = still + MOVING_SHARE * (sorted[n - 1] - still);
    let moves = |t: &usize| movement[*t] > bar;
    let (Some(first), Some(last)) = ((0..n).find(moves), (0..n).rev().find(moves)) else {
        return 0..n;
    };
    // Movement measured over a reach begins that much before the motion and ends that much after it.
    let start = (first + REACH_TICKS).saturating_sub(PAD_TICKS);
    let stop = (last + 1 + PAD_TICKS).saturating_sub(REACH_TICKS).min(n);
    if start < stop {
        start..stop
    } else {
        first..last + 1
    }
}

fn average(rows: &Rows, tick: usize, columns: usize) -> Vec<f32> {
    let near = || {
        (0..=2 * AVERAGE_TICKS)
            .map(|k| (tick + k).saturating_sub(AVERAGE_TICKS).min(rows.len() - 1))
    };
    let count = near().count() as f32;
    (0..columns)
        .map(|c| near().map(|t| rows.row(t)[c]).sum::<f32>() / count)
        .collect()
}

fn distance(a: &[f32], b: &[f32]) -> f64 {
    crate::templates::align::squared_distance(a, b).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn still_ends_are_cut_and_what_moves_is_kept() {
        let bones = BoneSet::NONE.with(6);
        let mut rows = Rows::new(10);
        for t in 0..90 {
            let angle = (f64::from(t - 30) / 30.0).clamp(0.0, 1.0) * 2.0;
            let jitter = 0.004 * f64::from(t % 3);
            let mut row = [0.0f32; 10];
            row[0] = (angle.cos() + jitter) as f32;
            row[1] = angle.sin() as f32;
            rows.push(&row);
        }
        let part = motion_span(&rows, bones);
        assert!(
            (26..=32).contains(&part.start) && (58..=64).contains(&part.end),
            "{part:?}"
        );
    }

    #[test]
    fn a_clip_without_movement_is_kept_whole() {
        let rows = Rows::from_values(10, vec![0.5; 10 * 20]);
        assert_eq!(motion_span(&rows, BoneSet::NONE.with(6)), 0..20);
    }
}
