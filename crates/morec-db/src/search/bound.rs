//! Lower bounds of how near any window of a clip is to an example, from the clip's [sketch](super::sketch).
//!
//! A distance of summaries is a weighted sum of Euclidean lengths. The octaves of halves, quarters and eighths, the mean pose
//! and the travel follow from prefix sums at the ends of eighths of the window; the octaves below only add to the length. What
//! the prefix sums are off by moves each of these vectors by no more than the length of its own error, which is taken
//! off. Clips are then read in the order of their bounds until these exceed what has been found (Seidl and Kriegel, *Optimal
//! multi-step k-nearest neighbor search*, 1998).

use morec::features::BoneSet;
use multiversion::multiversion;
use rayon::prelude::*;

use super::boxes::BoxView;
use super::candidates::{length_cost, pace_range, step, window_lengths};
use super::probe::{SIDE, SharedLanes, SketchProbes};
use super::sketch::{Sketch, SketchBytes, SketchTables};
use super::summary::WEIGHTS;
use super::window_sketch::{PARTS, WindowSketch, asinh};
use super::windows::TRAVEL;
use super::{Example, SearchOptions};

/// Windows that are looked at side by side: their travel fills a vector.
const GROUP: usize = SIDE / TRAVEL;
/// Factor and offset that a bound may lose to rounding: it is computed in single precision in another order than the distance.
const ROUNDING: (f32, f32) = (0.9999, 1e-3);

/// Detail of a bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoundDepth {
    /// By the [box](super::boxes) in which all windows lie: no window is looked at.
    Box,
    /// By the eighths of each window: nearly the distance itself.
    Eighths,
}

/// A clip's sketch and its bones.
#[derive(Debug, Clone, Copy)]
pub struct SketchedClip<'a> {
    /// Bytes of [`sketch_of`](super::sketch_of); empty if it has none.
    pub sketch: &'a [u8],
    /// Bones that its rows cover.
    pub bones: BoneSet,
}

/// Clips of which there are sketches, by their places.
pub trait SketchedClips: Sync {
    /// How many.
    fn count(&self) -> usize;
    /// The clip at a place below [`count`](Self::count).
    fn clip(&self, at: usize) -> SketchedClip<'_>;
}

/// For each clip a lower bound of the distance of every window that a [search](super::SearchIndex::search) would compare with
/// the example (or its mirror image): infinite if there is none, 0 if the clip has no sketch. A bound above `reach` says only
/// that the clip is farther than that. O(rows / example rows) for each clip, in parallel.
pub fn lower_bounds<'a>(
    example: &Example,
    options: &SearchOptions,
    depth: BoundDepth,
    reach: f32,
    clips: impl IndexedParallelIterator<Item = SketchedClip<'a>>,
) -> Vec<f32> {
    let query = SketchQuery {
        example: SketchProbes::of(example, options),
        tables: SketchTables::new(),
    };
    // What is beyond it stays so after rounding.
    let beyond = 1.01 * reach + 2.0 * ROUNDING.1;
    clips
        .map_init(Workspace::default, |work, clip| {
            query.least(work, &clip, depth, beyond)
        })
        .collect()
}

/// An example as sketches are compared with it.
struct SketchQuery {
    example: SketchProbes,
    tables: SketchTables,
}

impl SketchQuery {
    /// The least bound of a clip: infinite if it shares no bone with the example or its mirror image.
    fn least(
        &self,
        work: &mut Workspace,
        clip: &SketchedClip<'_>,
        depth: BoundDepth,
        beyond: f32,
    ) -> f32 {
        if work.bones != Some(clip.bones) {
            work.shared = self.example.shared(clip.bones);
            work.bones = Some(clip.bones);
        }
        if work.shared.is_empty() {
            return f32::INFINITY;
        }
        let least = least_bound(self, work, clip.sketch, depth, beyond);
        // No rows are a clip that is not searched; no sketch says nothing.
        least.map_or(0.0, |least| (ROUNDING.0 * least - ROUNDING.1).max(0.0))
    }

    /// The least bound over all windows and probes; `None` without a sketch.
    #[inline(always)]
    fn least_of(
        &self,
        work: &mut Workspace,
        bytes: &[u8],
        depth: BoundDepth,
        beyond: f32,
    ) -> Option<f32> {
        let bytes = SketchBytes::of(bytes)?;
        let rows = bytes.rows;
        let excess = self.example.excess(rows);
        // The lengths of all windows.
        let mut lengths = [0; 4];
        let mut count = 0;
        if rows >= 3 {
            lengths[..3].copy_from_slice(&window_lengths(self.example.rows, rows));
            count = 3;
        }
        if self.example.whole {
            lengths[count] = rows;
            count += 1;
        }
        let lengths = &lengths[..count];
        let mut least = beyond;
        if depth == BoundDepth::Box {
            return Some(self.by_box(work, &bytes, lengths, excess).min(least));
        }
        work.sketch.read(&bytes, &self.tables);
        for length in lengths {
            let cost = length_cost(*length, self.example.rows, pace_range()) + excess;
            let (step, last) = (step(*length), rows - length);
            let mut start = 0;
            while start <= last {
                let count = ((last - start) / step + 1).min(GROUP);
                for at in 0..count {
                    work.windows[at].turn(start + at * step, *length);
                }
                self.compare(work, count, cost, &mut least);
                start += count * step;
            }
        }
        Some(least)
    }

    /// The least bound of windows of these lengths by what all windows lie within.
    #[inline(always)]
    fn by_box(
        &self,
        work: &Workspace,
        bytes: &SketchBytes<'_>,
        lengths: &[usize],
        excess: f32,
    ) -> f32 {
        let within = BoxView::new(bytes.within);
        let mut least = f32::INFINITY;
        for at in 0..self.example.probes.len() {
            let (probe, shared) = (&self.example.probes[at], &work.shared[at]);
            let pose = within.pose(&probe.pose.0, &shared.mask.0).sqrt();
            let travel = within.travel(&probe.travel).sqrt();
            let still = excess + WEIGHTS.pose * shared.scale * pose + WEIGHTS.travel * travel;
            for length in lengths {
                let cost = length_cost(*length, self.example.rows, pace_range());
                let octaves = within.octaves(*length, &probe.roots, &shared.bone_mask);
                let motion = WEIGHTS.motion * shared.scale * octaves.sqrt();
                least = least.min(still + cost + motion);
            }
        }
        least
    }

    /// Lowers `least` to the least bound of the windows that are turned to, at a cost of their length, if that is less.
    #[inline(always)]
    fn compare(&self, work: &mut Workspace, count: usize, cost: f32, least: &mut f32) {
        let Workspace {
            sketch,
            windows,
            shared,
            ..
        } = work;
        let mut travels = [0f32; SIDE];
        for at in 0..count {
            windows[at].take(sketch, &self.tables, [0, PARTS]);
            let travel = windows[at].mean_travel();
            for i in 0..TRAVEL {
                travels[TRAVEL * at + i] = travel[i];
            }
        }
        let travels = asinh(&travels);
        for at in 0..count {
            let window = &mut windows[at];
            for probe in 0..self.example.probes.len() {
                let (probe, shared) = (&self.example.probes[probe], &shared[probe]);
                // Each part of the distance is a bound of the whole: as soon as they exceed what is known, the rest is not
                // computed. Pose and travel need the window's ends alone, and tell most windows from most examples.
                let travel = WEIGHTS.travel * window.travel(probe, &travels, TRAVEL * at);
                if cost + travel >= *least {
                    continue;
                }
                let pose = WEIGHTS.pose * shared.scale * window.pose(probe, shared);
                let still = cost + travel + pose;
                if still >= *least {
                    continue;
                }
                window.take_halves(sketch, &self.tables);
                let weight = WEIGHTS.motion * shared.scale;
                if still + weight * window.halves(probe, shared) >= *least {
                    continue;
                }
                window.take_eighths(sketch, &self.tables);
                *least = least.min(still + weight * window.eighths(probe, shared));
            }
        }
    }
}

/// What is used again from clip to clip.
#[derive(Default)]
struct Workspace {
    sketch: Sketch,
    windows: [WindowSketch; GROUP],
    /// Of the last clip, and what it shares with each probe: most clips show the same bones.
    bones: Option<BoneSet>,
    shared: Vec<SharedLanes>,
}

/// The least bound of a clip over all windows and probes; `None` without a sketch.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn least_bound(
    query: &SketchQuery,
    work: &mut Workspace,
    bytes: &[u8],
    depth: BoundDepth,
    beyond: f32,
) -> Option<f32> {
    query.least_of(work, bytes, depth, beyond)
}
