//! A lower bound of the cost of aligning two segments, which saves the alignment of most samples.

use multiversion::multiversion;

use crate::pca::{Eigen, Moments};

use super::segment::{BAND, PADDED, SEGMENT, SEGMENT_ROWS};

/// Directions that the bound looks at; on Kinect actions they hold .54 of a distance from the nearest sample.
const DIRECTIONS: usize = 16;
/// Rows that the directions are found from at most.
const ROWS_OF_BASIS: usize = 1024;
/// Cells of a row's band.
const CELLS: usize = 2 * BAND + 1;
/// Of places without a row. Squares of it can be summed.
const FAR_VALUE: f32 = 1e18;
/// Segments that are bounded together.
pub const TOGETHER: usize = 8;

/// The same value of [`TOGETHER`] segments.
pub type SegmentLanes = [f32; TOGETHER];
/// The rows of [`TOGETHER`] segments in those directions; what is left of the last ones is zero.
pub type CoarseBlock = [[SegmentLanes; DIRECTIONS]; SEGMENT_ROWS];
/// Rows of one segment in those directions, with [`BAND`] places before and behind them that are far from every row.
pub type CoarseRows = [[f32; DIRECTIONS]; SEGMENT_ROWS + 2 * BAND];

/// Parts of a segment, one after the other, and directions whose means over each of them make its sketch.
const PARTS: usize = 4;
const SKETCHED: usize = 8;
/// Rows of a part.
const PART_ROWS: usize = SEGMENT_ROWS / PARTS;
/// Means of the parts of a segment, scaled so that squared distances of two sketches are at most what aligning row by row costs.
pub type SegmentSketch = [f32; PARTS * SKETCHED];
/// The sketches of [`TOGETHER`] segments.
pub type SketchBlock = [SegmentLanes; PARTS * SKETCHED];

/// The sketch of a segment with these rows.
pub fn sketch_of(rows: &CoarseRows) -> SegmentSketch {
    // In each row, both segments go on by one: its cost counts twice.
    let scale = (2.0 / PART_ROWS as f32).sqrt();
    let mut sketch = [0.0; PARTS * SKETCHED];
    for (row, values) in rows[BAND..][..SEGMENT_ROWS].iter().enumerate() {
        let part = &mut sketch[row / PART_ROWS * SKETCHED..][..SKETCHED];
        for (sum, value) in part.iter_mut().zip(values) {
            *sum += value * scale;
        }
    }
    sketch
}

/// The directions in which rows of segments vary most: principal components.
#[derive(Debug)]
pub struct CoarseBasis {
    /// Of each value of a row its part in every direction.
    parts: Vec<[f32; DIRECTIONS]>,
}

impl CoarseBasis {
    /// Of segments after the metric. O(d³).
    pub fn of(segments: &[f32]) -> Self {
        let step = (segments.len() / PADDED).div_ceil(ROWS_OF_BASIS).max(1);
        let mut moments = Moments::new(PADDED);
        for row in segments.chunks_exact(PADDED).step_by(step) {
            moments.push_values(row);
        }
        let eigen = Eigen::of(moments.scatter());
        let part = |i: usize, k: usize| eigen.vectors[(i, k)] as f32;
        Self {
            parts: (0..PADDED)
                .map(|i| std::array::from_fn(|k| part(i, k)))
                .collect(),
        }
    }

    /// The parts of a segment's rows.
    pub fn rows(&self, segment: &[f32]) -> CoarseRows {
        let mut rows = [[FAR_VALUE; DIRECTIONS]; SEGMENT_ROWS + 2 * BAND];
        for (row, out) in segment.chunks_exact(PADDED).zip(&mut rows[BAND..]) {
            *out = [0.0; DIRECTIONS];
            for (value, parts) in row.iter().zip(&self.parts) {
                for (out, part) in out.iter_mut().zip(parts) {
                    *out += value * part;
                }
            }
        }
        rows
    }

    /// The parts of the rows of all segments, [`TOGETHER`] in a block, and their sketches.
    pub fn blocks(&self, segments: &[f32]) -> (Vec<CoarseBlock>, Vec<SketchBlock>) {
        let of_block = |segments: &[f32]| {
            let mut block = [[[0.0; TOGETHER]; DIRECTIONS]; SEGMENT_ROWS];
            let mut sketches = [[0.0; TOGETHER]; PARTS * SKETCHED];
            for (lane, segment) in segments.chunks_exact(SEGMENT).enumerate() {
                let rows = self.rows(segment);
                for (row, out) in rows[BAND..].iter().zip(&mut block) {
                    for (value, lanes) in row.iter().zip(out) {
                        lanes[lane] = *value;
                    }
                }
                for (value, lanes) in sketch_of(&rows).into_iter().zip(&mut sketches) {
                    lanes[lane] = value;
                }
            }
            (block, sketches)
        };
        segments.chunks(TOGETHER * SEGMENT).map(of_block).unzip()
    }
}

/// The squared distances of a sketch from those of a block.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn apart(block: &SketchBlock, sketch: &SegmentSketch) -> SegmentLanes {
    squares_of_lanes(block, sketch)
}

/// Of each lane the sum of the squared differences from `others`.
#[inline(always)]
fn squares_of_lanes<const N: usize>(values: &[SegmentLanes; N], others: &[f32; N]) -> SegmentLanes {
    let mut sums = [0.0; TOGETHER];
    for (values, other) in values.iter().zip(others) {
        for lane in 0..TOGETHER {
            let apart = values[lane] - other;
            sums[lane] += apart * apart;
        }
    }
    sums
}

/// What aligning each segment of a block with the one of `rows` costs in those directions alone, within the band, but for rounding. The
/// recurrence is that of the comparison itself. Infinite for all if each is at its limit or above it.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn least_costs(block: &CoarseBlock, rows: &CoarseRows, limits: &SegmentLanes) -> SegmentLanes {
    const OUTSIDE: SegmentLanes = [f32::INFINITY; TOGETHER];
    // Of the row before, at place `j - i + BAND`; the place behind them stays infinite.
    let mut before = [OUTSIDE; CELLS + 1];
    for (i, values) in block.iter().enumerate() {
        // A cell's sum is done before the next begins: together, cells are compiled to gathered lanes, which takes eight times as long.
        let costs: [SegmentLanes; CELLS] =
            std::array::from_fn(|cell| squares_of_lanes(values, &rows[i + cell]));
        let (mut reached, mut least) = (OUTSIDE, OUTSIDE);
        for cell in 0..CELLS {
            for lane in 0..TOGETHER {
                let cost = costs[cell][lane];
                let behind = smaller(
                    before[cell][lane] + 2.0 * cost,
                    before[cell + 1][lane] + cost,
                );
                let total = match (i, cell) {
                    (0, BAND) => 2.0 * cost,
                    _ => smaller(behind, reached[lane] + cost),
                };
                reached[lane] = total;
                least[lane] = smaller(least[lane], total);
                before[cell][lane] = total;
            }
        }
        if least
            .iter()
            .zip(limits)
            .all(|(least, limit)| least >= limit)
        {
            return OUTSIDE;
        }
    }
    before[BAND]
}

/// The smaller one: of numbers as `f32::min`, in a single instruction.
#[inline(always)]
pub fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}
