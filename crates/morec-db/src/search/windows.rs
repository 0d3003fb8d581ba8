//! Prefix sums over rows, and the small summary that finds copies: O(columns) each, however long the window.

use std::ops::Range;

use morec::features::{BODY_BONES, RowLayout, Rows};

use super::layout::ROOT_WEIGHT;

/// Coordinates of directions.
pub const X: usize = RowLayout::BODY.directions().end;
/// Values of root motion.
pub const TRAVEL: usize = RowLayout::ROOT;
/// Values in a summary: means and standard deviations of directions, mean root motion.
pub const SUMMARY: usize = 2 * X + TRAVEL;

/// Running sums over rows; entry `i` is over the rows before `i`.
#[derive(Debug, Clone)]
pub struct Sums {
    /// Directions, then root: `X + TRAVEL` values for each entry.
    sums: Vec<f64>,
    /// Squares of directions.
    squares: Vec<f64>,
}

impl Sums {
    pub fn of(rows: &Rows) -> Self {
        let (mut sum, mut square) = ([0f64; X + TRAVEL], [0f64; X]);
        let mut sums = sum.to_vec();
        let mut squares = square.to_vec();
        for row in rows.iter() {
            let directions = &row[RowLayout::BODY.directions()];
            let root = &row[RowLayout::BODY.root()];
            for (i, value) in directions.iter().chain(root).enumerate() {
                sum[i] += f64::from(*value);
            }
            for (i, value) in directions.iter().enumerate() {
                square[i] += f64::from(*value).powi(2);
            }
            sums.extend(sum);
            squares.extend(square);
        }
        Self { sums, squares }
    }

    /// Sums of the coordinates of directions over the rows before `at`, which may lie within a row.
    pub fn until(&self, at: f64, out: &mut [f64; X]) {
        let width = X + TRAVEL;
        let row = at.floor() as usize;
        let share = at - at.floor();
        let below = &self.sums[row * width..row * width + X];
        // The end of the last row has none after it.
        let above = self
            .sums
            .get((row + 1) * width..(row + 1) * width + X)
            .unwrap_or(below);
        for ((out, below), above) in out.iter_mut().zip(below).zip(above) {
            *out = below + share * (above - below);
        }
    }

    /// Mean and variance of the coordinates over `span`, not empty, and the root's sums.
    pub fn moments(&self, span: &Range<usize>) -> ([f64; X], [f64; X], [f64; TRAVEL]) {
        let (width, n) = (X + TRAVEL, span.len() as f64);
        let sum = |i: usize| self.sums[span.end * width + i] - self.sums[span.start * width + i];
        let square = |i: usize| self.squares[span.end * X + i] - self.squares[span.start * X + i];
        let means: [f64; X] = std::array::from_fn(|i| sum(i) / n);
        let variances = std::array::from_fn(|i| (square(i) / n - means[i] * means[i]).max(0.0));
        (means, variances, std::array::from_fn(|i| sum(X + i)))
    }

    /// The summary of rows `span`, which is not empty: `[mean x; 2 std x; 2 tanh(mean root)]`. `shown` are coordinates of shared bones.
    pub fn summary(&self, span: &Range<usize>, out: &mut [f32; SUMMARY]) {
        let (means, variances, root) = self.moments(span);
        for i in 0..X {
            out[i] = means[i] as f32;
            out[X + i] = 2.0 * variances[i].sqrt() as f32;
        }
        for (out, sum) in out[2 * X..].iter_mut().zip(root) {
            // Rows hold root motion weighted; the summary wants it in leg lengths a second.
            *out = 2.0 * ((sum / span.len() as f64 / ROOT_WEIGHT).tanh() as f32);
        }
    }
}

/// Squared distance of two summaries over the coordinates of shared bones, as if all bones were shared.
pub fn distance(a: &[f32; SUMMARY], b: &[f32; SUMMARY], shown: &[bool; X], share: f32) -> f32 {
    let mut sum = 0.0;
    for i in 0..X {
        if shown[i] {
            sum += (a[i] - b[i]).powi(2) + (a[X + i] - b[X + i]).powi(2);
        }
    }
    let root: f32 = (2 * X..SUMMARY).map(|i| (a[i] - b[i]).powi(2)).sum();
    sum / share + root
}

/// Coordinates of the bones of the set, and the set's share of all.
pub fn shown(bones: morec::features::BoneSet) -> ([bool; X], f32) {
    let mut shown = [false; X];
    for bone in bones.indices() {
        shown[RowLayout::BODY.direction(bone)].fill(true);
    }
    (shown, bones.len().max(1) as f32 / BODY_BONES as f32)
}
