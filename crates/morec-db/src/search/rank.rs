//! Candidates by summary, exact places by warping, one ranking.

use std::ops::Range;

use morec::features::Rows;
use morec::templates::Bank;
use rayon::prelude::*;

use super::layout::{Laid, mirrored, shared_columns};
use super::windows::{SUMMARY, Sums, distance, shown};
use super::{Example, Indexed, SearchIndex};
use crate::ClipId;

/// How to search.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchOptions {
    /// So many hits at most.
    pub limit: usize,
    /// Look for the mirror image too.
    pub mirror: bool,
    /// One hit for each clip, its best.
    pub one_a_clip: bool,
    /// How much the distance along the warping path counts against the summary's, 0 to 1.
    pub warp_share: f32,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self { limit: 20, mirror: false, one_a_clip: false, warp_share: 0.5 }
    }
}

/// A stretch that is like the example.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Hit {
    /// Its clip.
    pub clip: ClipId,
    /// Where it starts, seconds from the clip's beginning.
    pub start_secs: f64,
    /// Where it stops.
    pub stop_secs: f64,
    /// 1 for the same motion, towards 0 for another.
    pub score: f32,
    /// Mean squared distance along the warping path.
    pub warp_distance: f32,
    /// Whether its mirror image is what is like the example.
    pub mirrored: bool,
}

/// A window that looks like the example by its summary.
#[derive(Clone)]
struct Candidate {
    clip: usize,
    span: Range<usize>,
    distance: f32,
    mirrored: bool,
}

/// Example lengths that windows are tried at.
const SCALES: [f64; 3] = [0.7, 1.0, 1.4];

impl SearchIndex {
    /// The stretches most like `example`, best first. O(rows / example rows) summaries, then exact warping of the
    /// nearest few hundred.
    pub fn search(&self, example: &Example, options: &SearchOptions) -> Vec<Hit> {
        let mut hits = self.ranked(example, options, false);
        if options.mirror {
            let image = Example { laid: mirrored(&example.laid), from: example.from.clone() };
            hits.extend(self.ranked(&image, options, true));
        }
        hits.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.clip.cmp(&b.clip)));
        let mut kept: Vec<Hit> = Vec::new();
        for hit in hits {
            let same = |k: &&Hit| k.clip == hit.clip && (options.one_a_clip || overlap(k, &hit) > 0.3);
            if kept.len() < options.limit && !kept.iter().any(|k| same(&k)) {
                kept.push(hit);
            }
        }
        kept
    }

    fn ranked(&self, example: &Example, options: &SearchOptions, mirrored: bool) -> Vec<Hit> {
        let mut candidates: Vec<Candidate> = self
            .clips
            .par_iter()
            .enumerate()
            .flat_map_iter(|(number, clip)| candidates(number, clip, example, mirrored))
            .collect();
        let wanted = 8 * options.limit.max(8);
        if candidates.len() > wanted {
            candidates.select_nth_unstable_by(wanted, |a, b| a.distance.total_cmp(&b.distance));
            candidates.truncate(wanted);
        }
        candidates.par_iter().map(|c| self.place(c, example, options)).collect()
    }

    /// Where within a candidate's surroundings the example lies exactly.
    fn place(&self, candidate: &Candidate, example: &Example, options: &SearchOptions) -> Hit {
        let clip = &self.clips[candidate.clip];
        let n = example.laid.rows.len();
        let from = candidate.span.start.saturating_sub(n / 3);
        let to = (candidate.span.end + n / 3).min(clip.laid.rows.len());
        let shared = example.laid.bones.and(clip.laid.bones);
        // A clip of less than half the example's length holds no path: its summary alone says how near it is.
        let (warp, span) = warp(&example.laid, &clip.laid, from..to, &shared_columns(shared))
            .unwrap_or_else(|| (2.0 * candidate.distance, candidate.span.clone()));
        let share = options.warp_share;
        let distance = (1.0 - share) * candidate.distance + share * warp;
        Hit {
            clip: clip.clip,
            start_secs: span.start as f64 / self.tick_hz,
            stop_secs: span.end as f64 / self.tick_hz,
            score: (-distance / 2.0).exp(),
            warp_distance: warp,
            mirrored: candidate.mirrored,
        }
    }
}

/// Windows of a clip at three lengths, a quarter apart; a clip that is too short counts as one window.
fn candidates(number: usize, clip: &Indexed, example: &Example, mirrored: bool) -> Vec<Candidate> {
    let n = example.laid.rows.len();
    let rows = clip.laid.rows.len();
    let shared = example.laid.bones.and(clip.laid.bones);
    if shared.is_empty() || rows < 3 {
        return Vec::new();
    }
    let (shown, share) = shown(shared);
    let mut wanted = [0f32; SUMMARY];
    Sums::of(&example.laid.rows).summary(&(0..n), &mut wanted);
    let mut found = Vec::new();
    let mut summary = [0f32; SUMMARY];
    for scale in SCALES {
        let length = ((n as f64 * scale).round() as usize).clamp(3, rows.max(3)).min(rows);
        let hop = (length / 4).max(1);
        for start in (0..=rows - length).step_by(hop) {
            let span = start..start + length;
            let own =
                |(id, own): &(ClipId, Range<usize>)| *id == clip.clip && overlaps(own, &span) && !mirrored;
            if example.from.as_ref().is_some_and(own) {
                continue;
            }
            clip.sums.summary(&span, &mut summary);
            let distance = distance(&wanted, &summary, &shown, share) + missing(length, n);
            found.push(Candidate { clip: number, span, distance, mirrored });
        }
    }
    // Neighbours of a good window say the same: the best of each surroundings is enough.
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let mut kept: Vec<Candidate> = Vec::new();
    for candidate in found {
        if !kept.iter().any(|k| overlaps(&k.span, &candidate.span)) {
            kept.push(candidate);
        }
    }
    kept
}

/// What a window costs for what it lacks of the example's length, beyond a difference in pace.
fn missing(length: usize, example: usize) -> f32 {
    let share = (length as f32 / (SCALES[0] as f32 * example as f32)).min(1.0);
    4.0 * (1.0 - share)
}

/// More than a third of the shorter.
fn overlaps(a: &Range<usize>, b: &Range<usize>) -> bool {
    let shared = a.end.min(b.end).saturating_sub(a.start.max(b.start));
    3 * shared > a.len().min(b.len())
}

fn overlap(a: &Hit, b: &Hit) -> f64 {
    let shared = (a.stop_secs.min(b.stop_secs) - a.start_secs.max(b.start_secs)).max(0.0);
    shared / (a.stop_secs - a.start_secs).min(b.stop_secs - b.start_secs).max(1e-9)
}

/// The best path of `example` through rows `within` of a clip, by these columns: mean squared distance, and where it lies.
pub fn warp(
    example: &Laid,
    clip: &Laid,
    within: Range<usize>,
    columns: &[usize],
) -> Option<(f32, Range<usize>)> {
    let shared = example.bones.and(clip.bones);
    let mut bank = Bank::new(&[take(&example.rows, columns)], columns.len());
    let stream = take(&clip.rows.slice(within.clone()), columns);
    let mut best: Option<(f32, Range<usize>)> = None;
    for (tick, row) in stream.iter().enumerate() {
        bank.step(row);
        let found = bank.matched(0);
        if found.distance < 1e20 && best.as_ref().is_none_or(|(d, _)| found.distance < *d) {
            best = Some((found.distance, within.start + tick - found.age..within.start + tick + 1));
        }
    }
    let (_, share) = shown(shared);
    best.map(|(distance, span)| (distance / share, span))
}

fn take(rows: &Rows, columns: &[usize]) -> Rows {
    let mut out = Rows::new(columns.len());
    let mut taken = vec![0f32; columns.len()];
    for row in rows.iter() {
        for (value, column) in taken.iter_mut().zip(columns) {
            *value = row[*column];
        }
        out.push(&taken);
    }
    out
}
