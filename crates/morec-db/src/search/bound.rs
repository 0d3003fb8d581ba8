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
use super::sketch::{LANES, PLACES, ROOT_LANE, Sketch, SketchTables, UNIT};
use super::summary::{MEAN, ROOT, Summary, SummaryDistance, WEIGHTS};
use super::windows::{TRAVEL, X};
use super::{Example, SearchOptions};

/// Octaves that a sketch speaks of.
const OCTAVES: usize = 3;
/// Lanes that are compared before the others.
const GLANCE: usize = 16;
/// Parts of a window in the last octave.
const PARTS: usize = 1 << OCTAVES;

/// Factor and offset that a bound may lose to rounding: it is computed in single precision in another order than the distance.
const ROUNDING: (f32, f32) = (0.9999, 1e-3);

/// Detail of a bound.
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
/// the example (or its mirror image): infinite if there is none, 0 if the clip has no sketch. A bound above `reach` says only
/// that the clip is farther than that. O(rows / example rows) for each clip, in parallel.
pub fn lower_bounds<'a>(
    example: &Example,
    options: &SearchOptions,
    depth: BoundDepth,
    reach: f32,
    clips: impl IndexedParallelIterator<Item = SketchedClip<'a>>,
) -> Vec<f32> {
    let probes = probes(example, options, None);
    let query = SketchQuery {
        probes: probes.iter().map(SketchProbe::new).collect(),
        rows: example.laid.rows.len(),
        whole: probes.iter().any(|probe| probe.whole),
        tables: SketchTables::new(),
    };
    // What is beyond it stays so after rounding.
    let beyond = 1.01 * reach + 2.0 * ROUNDING.1;
    clips
        .map_init(Sketch::default, |sketch, clip| {
            query.least(sketch, &clip, depth, beyond)
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

/// Lanes of bones that the example and a clip share, 1 in a mask, and their scale.
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
    fn least(
        &self,
        sketch: &mut Sketch,
        clip: &SketchedClip<'_>,
        depth: BoundDepth,
        beyond: f32,
    ) -> f32 {
        let shared: Vec<BoneSet> = self
            .probes
            .iter()
            .map(|p| p.bones.and(clip.bones))
            .collect();
        if shared.iter().any(|bones| bones.is_empty()) {
            return f32::INFINITY;
        }
        let shared: Vec<SharedLanes> = shared.into_iter().map(SharedLanes::of).collect();
        let least = least_bound(self, &shared, sketch, clip.sketch, depth, beyond);
        // No rows are a clip that is not searched; no sketch says nothing.
        least.map_or(0.0, |least| (ROUNDING.0 * least - ROUNDING.1).max(0.0))
    }

    /// The least bound over all windows and probes; `None` without a sketch.
    #[inline(always)]
    fn least_of(
        &self,
        shared: &[SharedLanes],
        sketch: &mut Sketch,
        bytes: &[u8],
        depth: BoundDepth,
        beyond: f32,
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
        let mut least = beyond;
        let mut window = WindowSketch::new();
        for span in spans(self.rows, rows).chain(whole) {
            let length = length_cost(span.len(), self.rows, pace_range()) + excess;
            window.turn(span.start, span.len());
            for (probe, shared) in self.probes.iter().zip(shared) {
                // Each part of the distance is a bound of the whole: as soon as they exceed what is known, the rest is not computed.
                let scale = shared.scale.sqrt();
                let weight = WEIGHTS.motion * scale;
                // Most windows are far from most examples in every few bones.
                let first = window.glance(sketch, &self.tables, probe, shared, 0);
                if weight * first + length >= least {
                    continue;
                }
                let second = window.glance(sketch, &self.tables, probe, shared, GLANCE);
                if weight * second + length >= least {
                    continue;
                }
                window.take_halves(sketch, &self.tables);
                let mut motion = weight * window.halves(probe, shared) + length;
                if motion >= least {
                    continue;
                }
                if depth == BoundDepth::Eighths {
                    window.take_eighths(sketch, &self.tables);
                    motion = weight * window.eighths(probe, shared) + length;
                }
                let bound = motion + WEIGHTS.pose * scale * window.pose(probe, shared);
                if bound < least {
                    least = least.min(bound + WEIGHTS.travel * window.travel(probe));
                }
            }
        }
        Some(least)
    }
}

/// The least bound of a clip over all windows and probes; `None` without a sketch.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn least_bound(
    query: &SketchQuery,
    shared: &[SharedLanes],
    sketch: &mut Sketch,
    bytes: &[u8],
    depth: BoundDepth,
    beyond: f32,
) -> Option<f32> {
    query.least_of(shared, sketch, bytes, depth, beyond)
}

/// A window in a sketch: prefix sums at the ends of its eighths, in units, and their errors, in rows.
struct WindowSketch {
    start: usize,
    rows: usize,
    per_row: f32,
    ends: [[f32; LANES]; PARTS + 1],
    errors: [[f32; 2]; PARTS + 1],
    /// True if the ends of its halves are there.
    halved: bool,
    /// True if all are.
    complete: bool,
}

impl WindowSketch {
    fn new() -> Self {
        Self {
            start: 0,
            rows: 1,
            per_row: 1.0,
            ends: [[0.0; LANES]; PARTS + 1],
            errors: [[0.0; 2]; PARTS + 1],
            halved: false,
            complete: false,
        }
    }

    /// Turns to another window.
    #[inline(always)]
    fn turn(&mut self, start: usize, rows: usize) {
        (self.start, self.rows, self.per_row) = (start, rows, 1.0 / rows as f32);
        (self.halved, self.complete) = (false, false);
    }

    /// Distance of the deviations between the halves, at least, by a few lanes alone; nothing is kept.
    #[inline(always)]
    fn glance(
        &self,
        sketch: &Sketch,
        tables: &SketchTables,
        probe: &SketchProbe,
        shared: &SharedLanes,
        from: usize,
    ) -> f32 {
        let places = [0, PARTS / 2, PARTS].map(|part| self.place(part));
        let base = sketch.block(places[0]);
        let left = sketch.until::<GLANCE>(places[0], base, tables, from);
        let middle = sketch.until::<GLANCE>(places[1], base, tables, from);
        let right = sketch.until::<GLANCE>(places[2], base, tables, from);
        let wanted = &probe.octaves[0][from..from + GLANCE];
        let mask = &shared.mask[from..from + GLANCE];
        let mut squares = [0f32; GLANCE];
        for lane in 0..GLANCE {
            let h = (2.0 * middle[lane] - left[lane] - right[lane]) * (UNIT * self.per_row);
            let apart = (wanted[lane] - h.abs()) * mask[lane];
            squares[lane] = apart * apart;
        }
        let [a, b, c] = places.map(|place| sketch.errors(place)[0]);
        sum(&squares).sqrt() - (a + 2.0 * b + c) * self.per_row
    }

    /// Takes the ends of the halves.
    #[inline(always)]
    fn take_halves(&mut self, sketch: &Sketch, tables: &SketchTables) {
        if !self.halved {
            for part in [0, PARTS / 2, PARTS] {
                self.end(sketch, tables, part);
            }
            self.halved = true;
        }
    }

    /// Place at which a part begins, in eighths of rows.
    #[inline(always)]
    fn place(&self, part: usize) -> usize {
        self.start * PLACES + self.rows * part
    }

    /// Takes the ends of the other parts.
    #[inline(always)]
    fn take_eighths(&mut self, sketch: &Sketch, tables: &SketchTables) {
        if !self.complete {
            for part in [1, 2, 3, 5, 6, 7] {
                self.end(sketch, tables, part);
            }
            self.complete = true;
        }
    }

    #[inline(always)]
    fn end(&mut self, sketch: &Sketch, tables: &SketchTables, part: usize) {
        let (base, place) = (sketch.block(self.place(0)), self.place(part));
        self.errors[part] = sketch.errors(place);
        self.ends[part] = sketch.until(place, base, tables, 0);
    }

    /// Squares of what the deviations in an octave differ by, and of what they may be off.
    #[inline(always)]
    fn octave(&self, octave: usize, probe: &SketchProbe, squares: &mut [f32; LANES]) -> f32 {
        let (pairs, width) = (1 << octave, PARTS >> octave);
        let per_row = pairs as f32 * self.per_row;
        let mut energy = [0f32; LANES];
        let mut moved = 0f32;
        for pair in 0..pairs {
            let [a, b, c] = [0, width / 2, width].map(|part| pair * width + part);
            let [left, middle, right] = [&self.ends[a], &self.ends[b], &self.ends[c]];
            for lane in 0..LANES {
                // Half of what the means of the two halves differ by.
                let h = (2.0 * middle[lane] - left[lane] - right[lane]) * (UNIT * per_row);
                energy[lane] += h * h;
            }
            let error = self.errors[a][0] + 2.0 * self.errors[b][0] + self.errors[c][0];
            moved += (error * per_row).powi(2);
        }
        let share = 1.0 / pairs as f32;
        for lane in 0..LANES {
            let apart = probe.octaves[octave][lane] - (energy[lane] * share).sqrt();
            squares[lane] += apart * apart;
        }
        moved * share
    }

    /// Distance of the deviations between the halves, at least.
    #[inline(always)]
    fn halves(&self, probe: &SketchProbe, shared: &SharedLanes) -> f32 {
        let mut squares = [0f32; LANES];
        let moved = self.octave(0, probe, &mut squares);
        (masked_sum(&squares, shared).sqrt() - moved.sqrt()).max(0.0)
    }

    /// Distance of the deviations in the upper octaves, at least: of as many as give most.
    #[inline(always)]
    fn eighths(&self, probe: &SketchProbe, shared: &SharedLanes) -> f32 {
        let (mut squares, mut moved, mut most) = ([0f32; LANES], 0f32, 0f32);
        for octave in 0..OCTAVES {
            moved += self.octave(octave, probe, &mut squares);
            most = most.max(masked_sum(&squares, shared).sqrt() - moved.sqrt());
        }
        most
    }

    /// Distance of the mean pose, at least.
    #[inline(always)]
    fn pose(&self, probe: &SketchProbe, shared: &SharedLanes) -> f32 {
        let (first, last) = (&self.ends[0], &self.ends[PARTS]);
        let mut squares = [0f32; LANES];
        for lane in 0..LANES {
            let mean = (last[lane] - first[lane]) * (UNIT * self.per_row);
            let apart = probe.pose[lane] - mean;
            squares[lane] = apart * apart;
        }
        let moved = (self.errors[0][0] + self.errors[PARTS][0]) * self.per_row;
        (masked_sum(&squares, shared).sqrt() - moved).max(0.0)
    }

    /// Distance of the travel, at least.
    #[inline(always)]
    fn travel(&self, probe: &SketchProbe) -> f32 {
        let (first, last) = (&self.ends[0], &self.ends[PARTS]);
        let per_row = self.per_row / ROOT_WEIGHT as f32;
        let mut squares = 0f32;
        for (i, wanted) in probe.travel.iter().enumerate() {
            let mean = (last[ROOT_LANE + i] - first[ROOT_LANE + i]) * (UNIT * per_row);
            squares += (wanted - mean.asinh()).powi(2);
        }
        // The inverse hyperbolic sine is nowhere steeper than 1.
        let moved = (self.errors[0][1] + self.errors[PARTS][1]) * per_row;
        (squares.sqrt() - moved).max(0.0)
    }
}

/// The sum of the lanes of shared bones, by halves.
#[inline(always)]
fn masked_sum(lanes: &[f32; LANES], shared: &SharedLanes) -> f32 {
    let mask = &shared.mask;
    let mut sixteen = [0f32; GLANCE];
    for (i, sum) in sixteen.iter_mut().enumerate() {
        *sum = lanes[i] * mask[i] + lanes[16 + i] * mask[16 + i] + lanes[32 + i] * mask[32 + i];
    }
    sum(&sixteen)
}

/// The sum, by halves.
#[inline(always)]
fn sum(sixteen: &[f32; GLANCE]) -> f32 {
    let eight: [f32; 8] = std::array::from_fn(|i| sixteen[i] + sixteen[8 + i]);
    let four: [f32; 4] = std::array::from_fn(|i| eight[i] + eight[4 + i]);
    (four[0] + four[2]) + (four[1] + four[3])
}
