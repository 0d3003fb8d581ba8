//! Lower bounds of how near any window of a clip is to an example, from the clip's [sketch](super::sketch).
//!
//! A distance of summaries is a weighted sum of Euclidean lengths. The octaves of halves, quarters and eighths, the mean pose
//! and the travel follow from prefix sums at the ends of eighths of the window; the octaves below only add to the length. What
//! the prefix sums are off by moves each of these vectors by no more than the length of its own error, which is taken
//! off. Clips are then read in the order of their bounds until these exceed what has been found (Seidl and Kriegel, *Optimal
//! multi-step k-nearest neighbor search*, 1998).

use morec::features::{BoneSet, RowLayout};
use multiversion::multiversion;
use rayon::prelude::*;

use super::candidates::{QueryDescriptor, length_cost, pace_range, spans};
use super::layout::ROOT_WEIGHT;
use super::rank::probes;
use super::sketch::{LANES, PLACES, Prefix, ROOT_LANE, Sketch, SketchTables, UNIT};
use super::summary::{MEAN, ROOT, Summary, SummaryDistance, WEIGHTS};
use super::windows::{TRAVEL, X};
use super::{Example, SearchOptions};

/// Octaves that a sketch speaks of.
const OCTAVES: usize = 3;

/// What a bound may lose to rounding: it is computed in single precision in another order than the distance.
const ROUNDING: (f32, f32) = (0.9999, 1e-3);

/// How closely clips are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoundDepth {
    /// By the halves of windows.
    Halves,
    /// By their eighths: some three times the work, and nearly the distance itself.
    Eighths,
}

/// A clip's sketch and its bones.
#[derive(Debug, Clone, Copy)]
pub struct SketchedClip<'a> {
    /// Bytes of [`sketch_of`](super::sketch_of); empty if it has none.
    pub sketch: &'a [u8],
    /// Bones that its rows speak of.
    pub bones: BoneSet,
}

/// For each clip a lower bound of the distance of every window that a [search](super::SearchIndex::search) would compare with
/// the example (or its mirror image): infinite if there is none, 0 if the clip has no sketch. O(rows / example rows) for each
/// clip, in parallel.
pub fn lower_bounds<'a>(
    example: &Example,
    options: &SearchOptions,
    depth: BoundDepth,
    clips: impl IndexedParallelIterator<Item = SketchedClip<'a>>,
) -> Vec<f32> {
    let probes = probes(example, options, None);
    let query = SketchQuery {
        probes: probes.iter().map(SketchProbe::new).collect(),
        rows: example.laid.rows.len(),
        whole: probes.iter().any(|probe| probe.whole),
        tables: SketchTables::new(),
    };
    clips
        .map_init(Sketch::default, |sketch, clip| {
            query.least(sketch, &clip, depth)
        })
        .collect()
}

/// An example as sketches are compared with it.
struct SketchQuery {
    probes: Vec<SketchProbe>,
    rows: usize,
    whole: bool,
    tables: SketchTables,
}

/// The example or its mirror image, laid out by lanes.
struct SketchProbe {
    bones: BoneSet,
    octaves: [[f32; LANES]; OCTAVES],
    pose: [f32; LANES],
    travel: [f32; TRAVEL],
}

impl SketchProbe {
    fn new(probe: &QueryDescriptor<'_>) -> Self {
        let summary: &Summary = &probe.look.summary;
        let lanes = |from: usize| {
            let mut lanes = [0f32; LANES];
            lanes[..X].copy_from_slice(&summary[from..from + X]);
            lanes
        };
        Self {
            bones: probe.bones,
            octaves: std::array::from_fn(|octave| lanes(octave * X)),
            pose: lanes(MEAN),
            travel: std::array::from_fn(|i| summary[ROOT + i]),
        }
    }
}

/// What is compared of a clip: 1 in the lanes of shared bones, and their scale.
struct SharedLanes {
    mask: [f32; LANES],
    scale: f32,
}

impl SharedLanes {
    fn of(bones: BoneSet) -> Self {
        let mut mask = [0f32; LANES];
        for bone in bones.indices() {
            mask[RowLayout::ALL.direction(bone)].fill(1.0);
        }
        Self {
            mask,
            scale: SummaryDistance::over(bones).scale(),
        }
    }
}

impl SketchQuery {
    fn least(&self, sketch: &mut Sketch, clip: &SketchedClip<'_>, depth: BoundDepth) -> f32 {
        let shared: Vec<BoneSet> = self
            .probes
            .iter()
            .map(|p| p.bones.and(clip.bones))
            .collect();
        if shared.iter().any(|bones| bones.is_empty()) {
            return f32::INFINITY;
        }
        let shared: Vec<SharedLanes> = shared.into_iter().map(SharedLanes::of).collect();
        let least = match depth {
            BoundDepth::Halves => least_by_halves(self, &shared, sketch, clip.sketch),
            BoundDepth::Eighths => least_by_eighths(self, &shared, sketch, clip.sketch),
        };
        // No rows are a clip that is not searched; no sketch says nothing.
        least.map_or(0.0, |least| (ROUNDING.0 * least - ROUNDING.1).max(0.0))
    }

    /// The least bound over all windows and probes; `None` without a sketch.
    #[inline(always)]
    fn least_of<const PARTS: usize>(
        &self,
        shared: &[SharedLanes],
        sketch: &mut Sketch,
        bytes: &[u8],
    ) -> Option<f32> {
        if !sketch.read(bytes, &self.tables) {
            return None;
        }
        let rows = sketch.rows;
        let excess = if self.whole {
            length_cost(self.rows, rows, 1.4)
        } else {
            0.0
        };
        let whole = self.whole.then_some(0..rows);
        let mut least = f32::INFINITY;
        for span in spans(self.rows, rows).chain(whole) {
            let length = length_cost(span.len(), self.rows, pace_range()) + excess;
            let window = Window::<PARTS>::of(sketch, &self.tables, span.start, span.len());
            for (probe, shared) in self.probes.iter().zip(shared) {
                least = least.min(window.bound(probe, shared) + length);
            }
        }
        Some(least)
    }
}

#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn least_by_halves(
    query: &SketchQuery,
    shared: &[SharedLanes],
    sketch: &mut Sketch,
    bytes: &[u8],
) -> Option<f32> {
    query.least_of::<2>(shared, sketch, bytes)
}

#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn least_by_eighths(
    query: &SketchQuery,
    shared: &[SharedLanes],
    sketch: &mut Sketch,
    bytes: &[u8],
) -> Option<f32> {
    query.least_of::<8>(shared, sketch, bytes)
}

/// What a sketch says of a window: prefix sums at the ends of its `PARTS` parts, 2 or 8.
struct Window<const PARTS: usize> {
    first: Prefix,
    /// Those at the end of each part.
    ends: [Prefix; PARTS],
    rows: f32,
}

impl<const PARTS: usize> Window<PARTS> {
    #[inline(always)]
    fn of(sketch: &Sketch, tables: &SketchTables, start: usize, rows: usize) -> Self {
        let base = sketch.block(start * PLACES);
        let at = |part: usize| {
            let place = start * PLACES + rows * part * (PLACES / PARTS);
            sketch.until(place, base, tables)
        };
        Self {
            first: at(0),
            ends: std::array::from_fn(|part| at(part + 1)),
            rows: rows as f32,
        }
    }

    #[inline(always)]
    fn end(&self, part: usize) -> &Prefix {
        if part == 0 {
            &self.first
        } else {
            &self.ends[part - 1]
        }
    }

    /// A bound of the distance of the window from a probe.
    #[inline(always)]
    fn bound(&self, probe: &SketchProbe, shared: &SharedLanes) -> f32 {
        let scale = shared.scale.sqrt();
        WEIGHTS.motion * scale * self.motion(probe, shared)
            + WEIGHTS.pose * scale * self.pose(probe, shared)
            + WEIGHTS.travel * self.travel(probe)
    }

    /// Of the deviations in the upper octaves, of as many as give most.
    #[inline(always)]
    fn motion(&self, probe: &SketchProbe, shared: &SharedLanes) -> f32 {
        let (mut squares, mut errors, mut most) = ([0f32; LANES], 0f32, 0f32);
        for octave in 0..PARTS.ilog2() as usize {
            let (pairs, width) = (1 << octave, PARTS >> octave);
            let per_row = pairs as f32 / self.rows;
            let mut energy = [0f32; LANES];
            let mut moved = 0f32;
            for pair in 0..pairs {
                let [a, b, c] = [0, width / 2, width].map(|part| self.end(pair * width + part));
                for lane in 0..LANES {
                    // Half of what the means of the two halves differ by.
                    let h = (2.0 * b.sums[lane] - a.sums[lane] - c.sums[lane]) * (UNIT * per_row);
                    energy[lane] += h * h;
                }
                moved += ((a.errors[0] + 2.0 * b.errors[0] + c.errors[0]) * per_row).powi(2);
            }
            let share = 1.0 / pairs as f32;
            for lane in 0..LANES {
                let apart = probe.octaves[octave][lane] - (energy[lane] * share).sqrt();
                squares[lane] += shared.mask[lane] * apart * apart;
            }
            errors += moved * share;
            most = most.max(sum(&squares).sqrt() - errors.sqrt());
        }
        most
    }

    /// Of the mean pose.
    #[inline(always)]
    fn pose(&self, probe: &SketchProbe, shared: &SharedLanes) -> f32 {
        let (first, last) = (&self.first, self.end(PARTS));
        let mut squares = [0f32; LANES];
        for lane in 0..LANES {
            let mean = (last.sums[lane] - first.sums[lane]) * (UNIT / self.rows);
            let apart = probe.pose[lane] - mean;
            squares[lane] = shared.mask[lane] * apart * apart;
        }
        (sum(&squares).sqrt() - (first.errors[0] + last.errors[0]) / self.rows).max(0.0)
    }

    /// Of the travel.
    #[inline(always)]
    fn travel(&self, probe: &SketchProbe) -> f32 {
        let (first, last) = (&self.first, self.end(PARTS));
        let per_row = 1.0 / (self.rows * ROOT_WEIGHT as f32);
        let mut squares = 0f32;
        for (i, wanted) in probe.travel.iter().enumerate() {
            let mean = (last.sums[ROOT_LANE + i] - first.sums[ROOT_LANE + i]) * (UNIT * per_row);
            squares += (wanted - mean.asinh()).powi(2);
        }
        // The inverse hyperbolic sine is nowhere steeper than 1.
        (squares.sqrt() - (first.errors[1] + last.errors[1]) * per_row).max(0.0)
    }
}

/// The sum of all lanes, by halves.
#[inline(always)]
fn sum(lanes: &[f32; LANES]) -> f32 {
    let mut sixteen = [0f32; 16];
    for (i, sum) in sixteen.iter_mut().enumerate() {
        *sum = lanes[i] + lanes[16 + i] + lanes[32 + i];
    }
    let eight: [f32; 8] = std::array::from_fn(|i| sixteen[i] + sixteen[8 + i]);
    let four: [f32; 4] = std::array::from_fn(|i| eight[i] + eight[4 + i]);
    (four[0] + four[2]) + (four[1] + four[3])
}
