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

use super::boxes::{BoxView, roots, total};
use super::candidates::{QueryDescriptor, length_cost, pace_range, step, window_lengths};
use super::layout::ROOT_WEIGHT;
use super::rank::probes;
use super::sketch::{LANES, PLACES, ROOT_LANE, Sketch, SketchBytes, SketchLanes, SketchTables};
use super::summary::{MEAN, ROOT, Summary, SummaryDistance, WEIGHTS};
use super::windows::{TRAVEL, X};
use super::{Example, SearchOptions};

/// Octaves that a sketch covers.
const OCTAVES: usize = 3;
/// Lanes that are added up side by side.
const SIDE: usize = 16;
/// Windows that are looked at side by side: their travel fills a vector.
const GROUP: usize = SIDE / TRAVEL;
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
    /// Bones that its rows cover.
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
        .map_init(Workspace::default, |work, clip| {
            query.least(work, &clip, depth, beyond)
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
    octaves: [SketchLanes; OCTAVES],
    pose: SketchLanes,
    travel: [f32; TRAVEL],
    /// Lengths of the octaves of each bone.
    roots: [f32; SIDE],
}

impl SketchProbe {
    fn new(probe: &QueryDescriptor<'_>) -> Self {
        let summary: &Summary = &probe.look.summary;
        let lanes = |from: usize| {
            let mut lanes = SketchLanes::ZERO;
            lanes.0[..X].copy_from_slice(&summary[from..from + X]);
            lanes
        };
        Self {
            bones: probe.bones,
            octaves: std::array::from_fn(|octave| lanes(octave * X)),
            pose: lanes(MEAN),
            travel: std::array::from_fn(|i| summary[ROOT + i]),
            roots: roots(summary),
        }
    }
}

/// Lanes of bones that the example and a clip share, 1 in a mask, and the factor of lengths over them.
struct SharedLanes {
    bones: BoneSet,
    mask: SketchLanes,
    bone_mask: [f32; SIDE],
    scale: f32,
}

impl SharedLanes {
    fn of(bones: BoneSet) -> Self {
        let (mut mask, mut bone_mask) = (SketchLanes::ZERO, [0f32; SIDE]);
        for bone in bones.indices() {
            bone_mask[bone] = 1.0;
            mask.0[RowLayout::BODY.direction(bone)].fill(1.0);
        }
        Self {
            bones,
            mask,
            bone_mask,
            scale: SummaryDistance::over(bones).scale().sqrt(),
        }
    }
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
            let shared = self.probes.iter().map(|p| p.bones.and(clip.bones));
            work.shared = shared.map(SharedLanes::of).collect();
            work.bones = Some(clip.bones);
        }
        if work.shared.iter().any(|shared| shared.bones.is_empty()) {
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
        let excess = if self.whole {
            length_cost(self.rows, rows, 1.4)
        } else {
            0.0
        };
        // The lengths of all windows.
        let mut lengths = [0; 4];
        let mut count = 0;
        if rows >= 3 {
            lengths[..3].copy_from_slice(&window_lengths(self.rows, rows));
            count = 3;
        }
        if self.whole {
            lengths[count] = rows;
            count += 1;
        }
        let lengths = &lengths[..count];
        let mut least = beyond;
        if beyond < f32::INFINITY && self.is_beyond(work, &bytes, lengths, excess, beyond) {
            return Some(least);
        }
        work.sketch.read(&bytes, &self.tables);
        for length in lengths {
            let cost = length_cost(*length, self.rows, pace_range()) + excess;
            let (step, last) = (step(*length), rows - length);
            let mut start = 0;
            while start <= last {
                let count = ((last - start) / step + 1).min(GROUP);
                for at in 0..count {
                    work.windows[at].turn(start + at * step, *length);
                }
                self.compare(work, count, depth, cost, &mut least);
                start += count * step;
            }
        }
        Some(least)
    }

    /// True if no window of these lengths can be as near as `beyond`, by what all windows lie within.
    #[inline(always)]
    fn is_beyond(
        &self,
        work: &Workspace,
        bytes: &SketchBytes<'_>,
        lengths: &[usize],
        excess: f32,
        beyond: f32,
    ) -> bool {
        let within = BoxView::new(bytes.within);
        for at in 0..self.probes.len() {
            let (probe, shared) = (&self.probes[at], &work.shared[at]);
            let pose = within.pose(&probe.pose.0, &shared.mask.0).sqrt();
            let travel = within.travel(&probe.travel).sqrt();
            let still = excess + WEIGHTS.pose * shared.scale * pose + WEIGHTS.travel * travel;
            if still >= beyond {
                continue;
            }
            for length in lengths {
                let cost = length_cost(*length, self.rows, pace_range());
                let octaves = within.octaves(*length, &probe.roots, &shared.bone_mask);
                let motion = WEIGHTS.motion * shared.scale * octaves.sqrt();
                if still + cost + motion < beyond {
                    return false;
                }
            }
        }
        true
    }

    /// Lowers `least` to the least bound of the windows that are turned to, at a cost of their length, if that is less.
    #[inline(always)]
    fn compare(
        &self,
        work: &mut Workspace,
        count: usize,
        depth: BoundDepth,
        cost: f32,
        least: &mut f32,
    ) {
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
            for probe in 0..self.probes.len() {
                let (probe, shared) = (&self.probes[probe], &shared[probe]);
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
                let mut bound = still + weight * window.halves(probe, shared);
                if bound < *least && depth == BoundDepth::Eighths {
                    window.take_eighths(sketch, &self.tables);
                    bound = still + weight * window.eighths(probe, shared);
                }
                *least = least.min(bound);
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

/// A window in a sketch: prefix sums at the ends of its eighths, and their errors.
struct WindowSketch {
    start: usize,
    rows: usize,
    per_row: f32,
    ends: [SketchLanes; PARTS + 1],
    errors: [[f32; 2]; PARTS + 1],
    /// True if what lies between its halves is there.
    halved: bool,
    /// True if all are.
    complete: bool,
}

impl Default for WindowSketch {
    fn default() -> Self {
        Self {
            start: 0,
            rows: 1,
            per_row: 1.0,
            ends: [SketchLanes::ZERO; PARTS + 1],
            errors: [[0.0; 2]; PARTS + 1],
            halved: false,
            complete: false,
        }
    }
}

impl WindowSketch {
    /// Turns to another window.
    #[inline(always)]
    fn turn(&mut self, start: usize, rows: usize) {
        (self.start, self.rows, self.per_row) = (start, rows, 1.0 / rows as f32);
        (self.halved, self.complete) = (false, false);
    }

    /// Takes prefix sums at the beginnings of these parts, or the end of all.
    #[inline(always)]
    fn take<const N: usize>(&mut self, sketch: &Sketch, tables: &SketchTables, parts: [usize; N]) {
        for part in parts {
            self.end(sketch, tables, part);
        }
    }

    /// Takes what lies between the halves.
    #[inline(always)]
    fn take_halves(&mut self, sketch: &Sketch, tables: &SketchTables) {
        if !self.halved {
            self.take(sketch, tables, [PARTS / 2]);
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
            self.take(sketch, tables, [1, 2, 3, 5, 6, 7]);
            self.complete = true;
        }
    }

    #[inline(always)]
    fn end(&mut self, sketch: &Sketch, tables: &SketchTables, part: usize) {
        let (base, place) = (sketch.block(self.place(0)), self.place(part));
        self.errors[part] = sketch.errors(place);
        self.ends[part] = sketch.until(place, base, tables);
    }

    /// Squares of what the deviations in an octave differ by, and of what they may be off.
    #[inline(always)]
    fn octave(&self, octave: usize, probe: &SketchProbe, squares: &mut SketchLanes) -> f32 {
        let (pairs, width) = (1 << octave, PARTS >> octave);
        let per_row = pairs as f32 * self.per_row;
        let mut energy = SketchLanes::ZERO;
        let mut moved = 0f32;
        for pair in 0..pairs {
            let [a, b, c] = [0, width / 2, width].map(|part| pair * width + part);
            let [left, middle, right] = [&self.ends[a].0, &self.ends[b].0, &self.ends[c].0];
            for lane in 0..LANES {
                // Half of what the means of the two halves differ by.
                let h = (2.0 * middle[lane] - left[lane] - right[lane]) * per_row;
                energy.0[lane] += h * h;
            }
            let error = self.errors[a][0] + 2.0 * self.errors[b][0] + self.errors[c][0];
            moved += (error * per_row).powi(2);
        }
        let share = 1.0 / pairs as f32;
        for lane in 0..LANES {
            let apart = probe.octaves[octave].0[lane] - (energy.0[lane] * share).sqrt();
            squares.0[lane] += apart * apart;
        }
        moved * share
    }

    /// Distance of the deviations between the halves, at least.
    #[inline(always)]
    fn halves(&self, probe: &SketchProbe, shared: &SharedLanes) -> f32 {
        let mut squares = SketchLanes::ZERO;
        let moved = self.octave(0, probe, &mut squares);
        (masked_sum(&squares, shared).sqrt() - moved.sqrt()).max(0.0)
    }

    /// Distance of the deviations in the upper octaves, at least: of as many as give most.
    #[inline(always)]
    fn eighths(&self, probe: &SketchProbe, shared: &SharedLanes) -> f32 {
        let (mut squares, mut moved, mut most) = (SketchLanes::ZERO, 0f32, 0f32);
        for octave in 0..OCTAVES {
            moved += self.octave(octave, probe, &mut squares);
            most = most.max(masked_sum(&squares, shared).sqrt() - moved.sqrt());
        }
        most
    }

    /// Distance of the mean pose, at least.
    #[inline(always)]
    fn pose(&self, probe: &SketchProbe, shared: &SharedLanes) -> f32 {
        let (first, last) = (&self.ends[0].0, &self.ends[PARTS].0);
        let mut squares = SketchLanes::ZERO;
        for lane in 0..LANES {
            let mean = (last[lane] - first[lane]) * self.per_row;
            let apart = probe.pose.0[lane] - mean;
            squares.0[lane] = apart * apart;
        }
        let moved = (self.errors[0][0] + self.errors[PARTS][0]) * self.per_row;
        (masked_sum(&squares, shared).sqrt() - moved).max(0.0)
    }

    /// Mean root motion.
    #[inline(always)]
    fn mean_travel(&self) -> [f32; TRAVEL] {
        let (first, last) = (&self.ends[0].0, &self.ends[PARTS].0);
        let per_row = self.per_row / ROOT_WEIGHT as f32;
        let mut mean = [0f32; TRAVEL];
        for i in 0..TRAVEL {
            mean[i] = (last[ROOT_LANE + i] - first[ROOT_LANE + i]) * per_row;
        }
        mean
    }

    /// Distance of the travel, at least; that of the window begins at `at` in `travels`.
    #[inline(always)]
    fn travel(&self, probe: &SketchProbe, travels: &[f32; SIDE], at: usize) -> f32 {
        let mut squares = 0f32;
        for i in 0..TRAVEL {
            let apart = probe.travel[i] - travels[at + i];
            squares += apart * apart;
        }
        // The inverse hyperbolic sine is nowhere steeper than 1; of four values each may be off.
        let per_row = self.per_row / ROOT_WEIGHT as f32;
        let moved = (self.errors[0][1] + self.errors[PARTS][1]) * per_row + 2.0 * ASINH_ERROR;
        (squares.sqrt() - moved).max(0.0)
    }
}

/// The sum of the lanes of shared bones, by halves. Loops and no closures: these would be compiled for the oldest processor.
#[inline(always)]
fn masked_sum(lanes: &SketchLanes, shared: &SharedLanes) -> f32 {
    let (lanes, mask) = (&lanes.0, &shared.mask.0);
    let mut sixteen = [0f32; SIDE];
    for i in 0..SIDE {
        sixteen[i] =
            lanes[i] * mask[i] + lanes[16 + i] * mask[16 + i] + lanes[32 + i] * mask[32 + i];
    }
    total(&sixteen)
}

/// How far [`asinh`] may be off.
const ASINH_ERROR: f32 = 2e-5;

/// Inverse hyperbolic sines of root motion, in few operations and none that branches.
#[inline(always)]
fn asinh(values: &[f32; SIDE]) -> [f32; SIDE] {
    const LN: [f32; 6] = [
        0.030_449,
        -0.283_826_85,
        1.116_09,
        -2.440_029_8,
        3.514_087_3,
        -1.936_759_7,
    ];
    let mut out = [0f32; SIDE];
    for i in 0..SIDE {
        let x = values[i];
        // asinh |x| = ln y = e ln 2 + ln m, of which the last is a polynomial in m, from 1 to 2.
        let y = x.abs() + (x * x + 1.0).sqrt();
        let bits = y.to_bits();
        let exponent = ((bits >> 23) as i32 - 127) as f32;
        let m = f32::from_bits((bits & 0x007F_FFFF) | 0x3F80_0000);
        let ln = ((((LN[0] * m + LN[1]) * m + LN[2]) * m + LN[3]) * m + LN[4]) * m + LN[5];
        out[i] = (exponent * std::f32::consts::LN_2 + ln).copysign(x);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quick_inverse_hyperbolic_sine_is_within_its_error() {
        for i in 0..400_000 {
            let x = (i as f32 / 20_000.0 - 10.0).exp();
            for x in [x, -x, 0.0, 1.0 / x] {
                let exact = f64::from(x).asinh();
                let off = f64::from(asinh(&[x; SIDE])[3]) - exact;
                assert!(off.abs() <= f64::from(ASINH_ERROR), "{x}: {off}");
            }
        }
    }
}
