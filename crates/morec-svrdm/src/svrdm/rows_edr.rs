//! Edit distance between runs of rows, with a graded cost: ours, beside the thesis's on one value a frame.
//!
//! The thesis compares segments by one value a frame, which matches or does not (§3.8). Different motions may look
//! alike along one direction, and where much matches, a whole neighbourhood of segments is equally near. Here whole
//! rows are compared, as edit distance on real sequences was defined for (Chen, Özsu and Oria 2005), and a pair costs
//! `min(1, ‖a − b‖² / ε²)`. Leaving a row out costs 1, as there.

use multiversion::multiversion;

use super::edr::least_ratio;

/// Cells of a diagonal that are computed together.
const LANES: usize = 16;

/// Rows side by side: for each value of a row, that of all rows, the last row first.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownRows {
    values: Vec<f32>,
    rows: usize,
}

impl KnownRows {
    /// Bytes of its memory.
    pub fn bytes(&self) -> usize {
        4 * self.values.len()
    }

    /// Rows of `width` values, laid end to end.
    pub fn new(rows: &[f32], width: usize) -> Self {
        let count = rows.len() / width.max(1);
        let mut known = Self {
            values: vec![0.0; (count + LANES) * width],
            rows: count,
        };
        for (at, row) in rows.chunks_exact(width.max(1)).rev().enumerate() {
            for (value, x) in row.iter().enumerate() {
                known.values[value * (count + LANES) + at] = *x;
            }
        }
        known
    }
}

/// The dynamic program, with its memory: nothing is allocated after construction.
///
/// It runs along the diagonals that go up and right, where cells do not depend on each other and so fill lanes.
#[derive(Debug, Clone)]
pub struct RowsEdr {
    width: usize,
    per_square: f32,
    longest: usize,
    /// The first sequence side by side: for each value of a row, that of all rows.
    first: Vec<f32>,
    rows: usize,
    /// For three diagonals, by place in the first sequence, the cost of the cheapest path and its steps; a cell of room
    /// before each.
    costs: [Vec<f32>; 3],
    steps: [Vec<f32>; 3],
}

impl RowsEdr {
    /// For sequences of at most `longest` rows of `width` values, of which a pair at distance `epsilon` costs as much
    /// as leaving a row out.
    pub fn new(width: usize, epsilon: f32, longest: usize) -> Self {
        let diagonals = || std::array::from_fn(|_| vec![0.0; longest + 3 + LANES]);
        // Rows that may not differ at all: a difference costs what it can cost.
        let per_square = (1.0 / (epsilon * epsilon)).min(f32::MAX);
        let width = width.max(1);
        Self {
            width,
            per_square,
            longest,
            first: vec![0.0; (longest + LANES) * width],
            rows: 0,
            costs: diagonals(),
            steps: diagonals(),
        }
    }

    /// Bytes of its memory.
    pub fn bytes(&self) -> usize {
        let diagonals = self.costs.iter().chain(&self.steps);
        4 * (self.first.len() + diagonals.map(Vec::len).sum::<usize>())
    }

    /// Takes the first sequence, rows laid end to end.
    pub fn set(&mut self, rows: &[f32]) {
        let stride = self.longest + LANES;
        self.rows = rows.len() / self.width;
        for (at, row) in rows.chunks_exact(self.width).enumerate() {
            for (value, x) in row.iter().enumerate() {
                self.first[value * stride + at] = *x;
            }
        }
    }

    /// Cost a step of the cheapest path from the first sequence to `s`, 0 … 1; `None` if it is not below `bound`.
    /// O(rows of both · width).
    pub fn normalised(&mut self, s: &KnownRows, bound: f64) -> Option<f64> {
        let (m, n) = (self.rows, s.rows);
        if least_ratio(m, n) >= bound {
            return None;
        }
        let most = (bound * (m + n) as f64) as f32;
        let (stride, known_stride) = (self.longest + LANES, n + LANES);
        let mut before_least = 0.0;
        for d in 0..=m + n {
            // The cells (i, d − i) of the table; the cell i stands at i + 1.
            let (first, last) = (d.saturating_sub(n), d.min(m));
            let (from, to) = (first.max(1), last.min(d.saturating_sub(1)));
            if from <= to {
                let pairs = RowPairs {
                    first: &self.first[from - 1..],
                    stride,
                    known: &s.values[n + from - d..],
                    known_stride,
                    width: self.width,
                    per_square: self.per_square,
                };
                let [now, before, earlier] = &mut self.costs;
                let [now_steps, before_steps, earlier_steps] = &mut self.steps;
                let step = DiagonalStep {
                    before: (&before[from..], &before_steps[from..]),
                    earlier: (&earlier[from..], &earlier_steps[from..]),
                };
                let now = (&mut now[from + 1..], &mut now_steps[from + 1..]);
                advance(&pairs, &step, now, to - from + 1);
            }
            let border = |costs: &mut f32, steps: &mut f32| (*costs, *steps) = (d as f32, d as f32);
            if first == 0 {
                border(&mut self.costs[0][1], &mut self.steps[0][1]);
            }
            if last == d {
                border(&mut self.costs[0][d + 1], &mut self.steps[0][d + 1]);
            }
            let costs = &mut self.costs[0];
            let least = costs[first + 1..=last + 1]
                .iter()
                .fold(f32::INFINITY, |a, b| if *b < a { *b } else { a });
            // A path passes one of two neighbouring diagonals and has at most m + n steps; what it has cost it keeps.
            if least > most && before_least > most {
                return None;
            }
            before_least = least;
            // What the next diagonals read beyond this one's ends.
            costs[first] = f32::INFINITY;
            costs[last + 2] = f32::INFINITY;
            self.costs.rotate_right(1);
            self.steps.rotate_right(1);
        }
        let ratio = f64::from(self.costs[1][m + 1]) / f64::from(self.steps[1][m + 1].max(1.0));
        Some(ratio).filter(|ratio| *ratio < bound)
    }
}

/// Rows of both sequences that meet on a diagonal.
struct RowPairs<'a> {
    first: &'a [f32],
    stride: usize,
    known: &'a [f32],
    known_stride: usize,
    width: usize,
    per_square: f32,
}

/// Costs and steps of the two diagonals before, from the cell before the first on.
struct DiagonalStep<'a> {
    before: (&'a [f32], &'a [f32]),
    earlier: (&'a [f32], &'a [f32]),
}

/// One diagonal of `count` cells; what stands after them is of no meaning.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn advance(pairs: &RowPairs, step: &DiagonalStep, now: (&mut [f32], &mut [f32]), count: usize) {
    for at in (0..count).step_by(LANES) {
        let mut squares = [0.0f32; LANES];
        for value in 0..pairs.width {
            let a = &pairs.first[value * pairs.stride + at..][..LANES];
            let b = &pairs.known[value * pairs.known_stride + at..][..LANES];
            for lane in 0..LANES {
                squares[lane] += (a[lane] - b[lane]) * (a[lane] - b[lane]);
            }
        }
        let (both, both_steps) = (
            &step.earlier.0[at..][..LANES],
            &step.earlier.1[at..][..LANES],
        );
        let (up, up_steps) = (&step.before.0[at..][..LANES], &step.before.1[at..][..LANES]);
        let (left, left_steps) = (
            &step.before.0[at + 1..][..LANES],
            &step.before.1[at + 1..][..LANES],
        );
        let costs = &mut now.0[at..][..LANES];
        let steps = &mut now.1[at..][..LANES];
        for lane in 0..LANES {
            let square = squares[lane] * pairs.per_square;
            // As comparisons: `f32::min` minds values that are no numbers.
            let pair = if square < 1.0 { square } else { 1.0 };
            let (mut cost, mut count) = (both[lane] + pair, both_steps[lane]);
            let left_out = up[lane] + 1.0;
            (cost, count) = if left_out < cost {
                (left_out, up_steps[lane])
            } else {
                (cost, count)
            };
            let left_out = left[lane] + 1.0;
            (cost, count) = if left_out < cost {
                (left_out, left_steps[lane])
            } else {
                (cost, count)
            };
            (costs[lane], steps[lane]) = (cost, count + 1.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The definition: least cost over all paths, by recursion.
    fn slow(r: &[[f32; 2]], s: &[[f32; 2]], epsilon: f32) -> f64 {
        let (Some(a), Some(b)) = (r.last(), s.last()) else {
            return (r.len() + s.len()) as f64;
        };
        let (before_r, before_s) = (&r[..r.len() - 1], &s[..s.len() - 1]);
        let square = (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
        let pair =
            slow(before_r, before_s, epsilon) + f64::from((square / (epsilon * epsilon)).min(1.0));
        pair.min(slow(before_r, s, epsilon) + 1.0)
            .min(slow(r, before_s, epsilon) + 1.0)
    }

    fn ratio(edr: &mut RowsEdr, r: &[f32], s: &[f32], bound: f64) -> Option<f64> {
        edr.set(r);
        edr.normalised(&KnownRows::new(s, edr.width), bound)
    }

    /// The table cell by cell, row by row: cost and steps to the bit.
    fn cell_by_cell(r: &[[f32; 3]], s: &[[f32; 3]], epsilon: f32) -> f64 {
        let per_square = 1.0 / (epsilon * epsilon);
        let mut above: Vec<(f32, f32)> = (0..=s.len()).map(|j| (j as f32, j as f32)).collect();
        for (i, a) in r.iter().enumerate() {
            let mut row = vec![((i + 1) as f32, (i + 1) as f32)];
            for (j, b) in s.iter().enumerate() {
                let square: f32 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
                let mut best = (
                    above[j].0 + (square * per_square).min(1.0),
                    above[j].1 + 1.0,
                );
                for from in [above[j + 1], row[j]] {
                    if from.0 + 1.0 < best.0 {
                        best = (from.0 + 1.0, from.1 + 1.0);
                    }
                }
                row.push(best);
            }
            above = row;
        }
        f64::from(above[s.len()].0) / f64::from(above[s.len()].1)
    }

    fn long_run() -> impl Strategy<Value = Vec<[f32; 3]>> {
        prop::collection::vec(prop::array::uniform3(-1.0f32..1.0), 1..50)
    }

    fn run() -> impl Strategy<Value = Vec<[f32; 2]>> {
        prop::collection::vec([-1.0f32..1.0, -1.0f32..1.0], 1..6)
    }

    proptest! {
        #[test]
        fn the_cost_is_the_least_of_all_paths(r in run(), s in run(), epsilon in 0.1f32..2.0) {
            let ratio = ratio(&mut RowsEdr::new(2, epsilon, 8), r.as_flattened(), s.as_flattened(), 2.0).unwrap();
            let cost = slow(&r, &s, epsilon);
            // Steps of the path are between those of pairs alone and of none.
            let (least, most) = (r.len().max(s.len()) as f64, (r.len() + s.len()) as f64);
            prop_assert!(ratio <= cost / least + 1e-5 && ratio >= cost / most - 1e-5, "{ratio} of {cost}");
        }

        #[test]
        fn diagonals_give_the_table_to_the_bit(
            runs in prop::collection::vec((long_run(), long_run(), 0.3f32..3.0), 1..4),
        ) {
            // One after the other: nothing of a pair is left for the next.
            for (r, s, epsilon) in &runs {
                let mut edr = RowsEdr::new(3, *epsilon, 50);
                for (r, s) in [(r, s), (s, r)] {
                    let found = ratio(&mut edr, r.as_flattened(), s.as_flattened(), 2.0);
                    prop_assert_eq!(found, Some(cell_by_cell(r, s, *epsilon)));
                }
            }
        }

        #[test]
        fn a_bound_changes_nothing_below_it(r in run(), s in run(), bound in 0.0f64..1.0) {
            let mut edr = RowsEdr::new(2, 0.7, 8);
            let whole = ratio(&mut edr, r.as_flattened(), s.as_flattened(), 2.0).unwrap();
            let bounded = ratio(&mut edr, r.as_flattened(), s.as_flattened(), bound);
            prop_assert_eq!(bounded, Some(whole).filter(|w| *w < bound));
        }
    }

    #[test]
    fn alike_is_nothing_and_a_difference_grows_to_one() {
        let mut edr = RowsEdr::new(1, 2.0, 8);
        assert_eq!(
            ratio(&mut edr, &[1.0, 2.0, 3.0], &[1.0, 2.0, 3.0], 1.0),
            Some(0.0)
        );
        // A quarter of the way in squares, one of two steps.
        assert_eq!(ratio(&mut edr, &[1.0, 2.0], &[1.0, 3.0], 1.0), Some(0.125));
        assert_eq!(ratio(&mut edr, &[1.0], &[9.0], 2.0), Some(1.0));
        let mut strict = RowsEdr::new(1, 0.0, 8);
        assert_eq!(ratio(&mut strict, &[1.0, 2.0], &[1.0, 2.0], 1.0), Some(0.0));
        assert_eq!(ratio(&mut strict, &[1.0, 2.0], &[1.0, 2.1], 1.0), Some(0.5));
    }
}
