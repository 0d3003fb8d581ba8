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
/// The squared length at places without a row. Some of it can be summed.
const FAR_SQUARE: f32 = 1e36;
/// Segments that are bounded together: as many numbers as the widest registers hold.
pub const TOGETHER: usize = 16;
/// Squared lengths are taken this much shorter, so that rounding never makes a squared distance too large: the sum of
/// [`DIRECTIONS`] products is off by less than 2⁻²⁰ of both squared lengths.
const SHORTER: f32 = 1.0 - 1.0 / 262_144.0;

/// The same value of [`TOGETHER`] segments.
pub type SegmentLanes = [f32; TOGETHER];

/// The rows of [`TOGETHER`] segments in those directions; what is left of the last ones is zero.
#[derive(Debug, Clone)]
pub struct CoarseBlock {
    /// Times −2: their products with other rows are what the squared distance has beside both squared lengths.
    rows: [[SegmentLanes; DIRECTIONS]; SEGMENT_ROWS],
    squares: [SegmentLanes; SEGMENT_ROWS],
}

/// Rows of one segment in those directions, with [`BAND`] places before and behind them that are far from every row.
#[derive(Debug, Clone)]
pub struct CoarseRows {
    rows: [[f32; DIRECTIONS]; SEGMENT_ROWS + 2 * BAND],
    squares: [f32; SEGMENT_ROWS + 2 * BAND],
}

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
    for (row, values) in rows.rows[BAND..][..SEGMENT_ROWS].iter().enumerate() {
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
        let mut coarse = CoarseRows {
            rows: [[0.0; DIRECTIONS]; SEGMENT_ROWS + 2 * BAND],
            squares: [FAR_SQUARE; SEGMENT_ROWS + 2 * BAND],
        };
        project(&self.parts, segment, &mut coarse);
        coarse
    }

    /// The parts of the rows of all segments, [`TOGETHER`] in a block, and their sketches.
    pub fn blocks(&self, segments: &[f32]) -> (Vec<CoarseBlock>, Vec<SketchBlock>) {
        let of_block = |segments: &[f32]| {
            let mut block = CoarseBlock {
                rows: [[[0.0; TOGETHER]; DIRECTIONS]; SEGMENT_ROWS],
                squares: [[0.0; TOGETHER]; SEGMENT_ROWS],
            };
            let mut sketches = [[0.0; TOGETHER]; PARTS * SKETCHED];
            for (lane, segment) in segments.chunks_exact(SEGMENT).enumerate() {
                let coarse = self.rows(segment);
                for row in 0..SEGMENT_ROWS {
                    block.squares[row][lane] = coarse.squares[BAND + row];
                    let values = coarse.rows[BAND + row].iter();
                    for (value, lanes) in values.zip(&mut block.rows[row]) {
                        lanes[lane] = -2.0 * value;
                    }
                }
                for (value, lanes) in sketch_of(&coarse).into_iter().zip(&mut sketches) {
                    lanes[lane] = value;
                }
            }
            (block, sketches)
        };
        segments.chunks(TOGETHER * SEGMENT).map(of_block).unzip()
    }
}

/// Puts the parts of a segment's rows in each direction, and their squared lengths, behind the places before the first of `coarse`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn project(parts: &[[f32; DIRECTIONS]], segment: &[f32], coarse: &mut CoarseRows) {
    let places = coarse.rows.iter_mut().zip(&mut coarse.squares).skip(BAND);
    for (row, (out, square)) in segment.chunks_exact(PADDED).zip(places) {
        let mut sums = [0.0; DIRECTIONS];
        for (value, parts) in row.iter().zip(parts) {
            for (sum, part) in sums.iter_mut().zip(parts) {
                *sum += value * part;
            }
        }
        *out = sums;
        *square = SHORTER * sums.iter().map(|v| v * v).sum::<f32>();
    }
}

/// The squared distances of a sketch from those of a block.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn apart(block: &SketchBlock, sketch: &SegmentSketch) -> SegmentLanes {
    let mut sums = [0.0; TOGETHER];
    for (values, other) in block.iter().zip(sketch) {
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
    for (i, (values, squares)) in block.rows.iter().zip(&block.squares).enumerate() {
        // A cell's sum is done before the next begins: together, cells are compiled to gathered lanes, which takes eight times as long.
        let costs: [SegmentLanes; CELLS] = std::array::from_fn(|cell| {
            let mut sums = *squares;
            for sum in &mut sums {
                *sum += rows.squares[i + cell];
            }
            for (values, other) in values.iter().zip(&rows.rows[i + cell]) {
                for lane in 0..TOGETHER {
                    sums[lane] += values[lane] * other;
                }
            }
            sums
        });
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
