//! Near-duplicates: clips with the motion of another clip, resampled, trimmed, on another skeleton, or mirrored.

use std::collections::BTreeSet;

use morec::TimeSpan;
use morec::features::Rows;
use rayon::prelude::*;

use super::layout::{directions, mirrored};
use super::windows::{SUMMARY, distance, shown};
use super::{Indexed, SearchIndex};
use crate::ClipId;

/// Two clips of which one is nearly the other.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct NearCopy {
    /// The longer clip.
    pub of: ClipId,
    /// The shorter one; the whole of it lies in the other.
    pub copy: ClipId,
    /// Where in the longer one.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// Mean squared distance of their directions.
    pub distance: f32,
    /// True if one is the other's mirror image.
    pub mirrored: bool,
}

/// Distances of copies at the same pace stay below this. A second take of the same move by the same person is further:
/// rows tell poses apart that a person cannot repeat.
const SAME: f32 = 0.005;

/// Lengths of copies differ by this share at most.
const SHORTER: f64 = 0.8;

/// Every pair of which one is nearly the other. O(clips²) summaries, and rows against rows where these agree.
pub fn near_duplicates(index: &SearchIndex) -> Vec<NearCopy> {
    pairs(index, |_| true)
}

/// The same of pairs with at least one of `clips`: O(clips · all clips).
pub fn near_duplicates_of(index: &SearchIndex, clips: &BTreeSet<ClipId>) -> Vec<NearCopy> {
    pairs(index, |clip| clips.contains(&clip))
}

/// Pairs of which one at least is `wanted`.
fn pairs(index: &SearchIndex, wanted: impl Fn(ClipId) -> bool) -> Vec<NearCopy> {
    let wanted: Vec<bool> = index.clips.iter().map(|clip| wanted(clip.clip)).collect();
    let summaries: Vec<[[f32; SUMMARY]; 2]> = index.clips.par_iter().map(summaries).collect();
    let mut found: Vec<NearCopy> = (0..index.clips.len())
        .into_par_iter()
        .flat_map_iter(|a| {
            let (summaries, wanted) = (&summaries, &wanted);
            let others = (a + 1..index.clips.len()).filter(move |b| wanted[a] || wanted[*b]);
            others
                .flat_map(move |b| [false, true].map(|mirror| (b, mirror)))
                .filter_map(move |(b, mirror)| {
                    let near = (&summaries[a][0], &summaries[b][usize::from(mirror)]);
                    pair(index, a, b, mirror, near)
                })
        })
        .collect();
    // A motion that is its own mirror image is found both ways; the plain one says enough.
    found.sort_by_key(|c| (c.of, c.copy, c.mirrored));
    found.dedup_by_key(|c| (c.of, c.copy));
    found
}

fn summaries(clip: &Indexed) -> [[f32; SUMMARY]; 2] {
    let mut out = [[0f32; SUMMARY]; 2];
    let all = 0..clip.laid.rows.len();
    clip.sums.summary(&all, &mut out[0]);
    super::Sums::of(&mirrored(&clip.laid).rows).summary(&all, &mut out[1]);
    out
}

fn pair(
    index: &SearchIndex,
    a: usize,
    b: usize,
    mirror: bool,
    (of_a, of_b): (&[f32; SUMMARY], &[f32; SUMMARY]),
) -> Option<NearCopy> {
    let rows = |i: usize| index.clips[i].laid.rows.len();
    let (long, short) = if rows(a) >= rows(b) { (a, b) } else { (b, a) };
    let bones = index.clips[a].laid.bones.and(index.clips[b].laid.bones);
    if (rows(short) as f64) < SHORTER * rows(long) as f64 || bones.len() < 6 || rows(short) < 10 {
        return None;
    }
    let (shown, share) = shown(bones);
    // Cutting a fifth away moves means and deviations; different motion moves them far more.
    if distance(of_a, of_b, &shown, share) > 0.5 {
        return None;
    }
    let (longer, shorter) = (&index.clips[long], &index.clips[short]);
    let example = if mirror {
        mirrored(&shorter.laid)
    } else {
        shorter.laid.clone()
    };
    // Velocities depend on the rate that a copy went through; directions do not.
    let columns = directions(example.bones.and(longer.laid.bones));
    let (distance, at) = alongside(&example.rows, &longer.laid.rows, &columns)?;
    let distance = distance / share;
    (distance < SAME).then(|| NearCopy {
        of: longer.clip,
        copy: shorter.clip,
        span: TimeSpan::of_frames(at..at + rows(short), index.tick_hz),
        distance,
        mirrored: mirror,
    })
}

/// Best place of `short` in `long` at the same pace, and the mean squared distance there. Warping would forgive a second
/// take its timing, and timing is what no second take has in common with the first.
fn alongside(short: &Rows, long: &Rows, columns: &[usize]) -> Option<(f32, usize)> {
    let limit = SAME * short.len() as f32;
    let sum = |at: usize, limit: f32| {
        let mut sum = 0.0;
        for t in 0..short.len() {
            let (a, b) = (short.row(t), long.row(at + t));
            sum += columns.iter().map(|c| (a[*c] - b[*c]).powi(2)).sum::<f32>();
            if sum > limit {
                return None;
            }
        }
        Some(sum)
    };
    let mut best: Option<(f32, usize)> = None;
    for at in 0..=long.len() - short.len() {
        if let Some(sum) = sum(at, best.map_or(limit, |b| b.0)) {
            best = Some((sum, at));
        }
    }
    best.map(|(sum, at)| (sum / short.len() as f32, at))
}
