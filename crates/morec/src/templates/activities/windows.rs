//! Statistics of the rows in a window.

use std::ops::Range;

use crate::features::{RowLayout, Rows};

/// Ticks from one window to the next.
pub(crate) const STEP_TICKS: usize = 3;

/// A statistic of a column of rows.
#[derive(Debug, Clone, Copy)]
enum Statistic {
    Mean,
    Spread,
    RootMeanSquare,
}

/// Statistics in their order, each of some columns, with its weight. An instant of root motion says little and weighs little in rows;
/// its mean over seconds says more.
fn parts(layout: RowLayout) -> [(Statistic, Range<usize>, f64); 5] {
    [
        (Statistic::Mean, layout.directions(), 1.0),
        (Statistic::Spread, layout.directions(), 2.0),
        (Statistic::RootMeanSquare, layout.velocities(), 0.6),
        (Statistic::Mean, layout.root(), 5.0 / 3.0),
        (Statistic::Spread, layout.root(), 2.0 / 3.0),
    ]
}

/// Number of statistics of rows of `layout`.
pub(super) fn statistics(layout: RowLayout) -> usize {
    9 * layout.bones() + 2 * RowLayout::ROOT
}

/// Places of the statistics that are left of rows of `layout` when they keep the columns `keep`.
pub(super) fn kept_statistics(layout: RowLayout, keep: &[usize]) -> Vec<usize> {
    let mut first = 0;
    let mut kept = Vec::new();
    for (_, columns, _) in parts(layout) {
        let of_part = keep.iter().filter(|column| columns.contains(column));
        kept.extend(of_part.map(|column| first + column - columns.start));
        first += columns.len();
    }
    kept
}

/// The last rows of a stream, and their sums.
#[derive(Debug, Clone)]
pub(super) struct SlidingWindow {
    layout: RowLayout,
    /// A ring of `most` rows.
    rows: Vec<f32>,
    most: usize,
    /// Rows taken, and of them those that have left.
    taken: usize,
    left: usize,
    sums: Vec<f64>,
    squares: Vec<f64>,
}

impl SlidingWindow {
    /// A window over the last `most` rows.
    pub fn new(layout: RowLayout, most: usize) -> Self {
        let dim = layout.dim();
        Self {
            layout,
            rows: vec![0.0; dim * most],
            most,
            taken: 0,
            left: 0,
            sums: vec![0.0; dim],
            squares: vec![0.0; dim],
        }
    }

    pub fn clear(&mut self) {
        (self.taken, self.left) = (0, 0);
        self.sums.fill(0.0);
        self.squares.fill(0.0);
    }

    /// Takes the next row; the oldest leaves a full window. O(values), no allocation.
    pub fn push(&mut self, row: &[f32]) {
        if self.taken - self.left == self.most {
            self.drop_before(self.left + 1);
        }
        let dim = self.layout.dim();
        let slot = self.taken % self.most;
        self.rows[slot * dim..][..dim].copy_from_slice(row);
        for ((sum, square), value) in self.sums.iter_mut().zip(&mut self.squares).zip(row) {
            let value = f64::from(*value);
            *sum += value;
            *square += value * value;
        }
        self.taken += 1;
    }

    /// Leaves out the rows before row `first` of the stream.
    pub fn drop_before(&mut self, first: usize) {
        let dim = self.layout.dim();
        while self.left < first.min(self.taken) {
            let row = &self.rows[self.left % self.most * dim..][..dim];
            for ((sum, square), value) in self.sums.iter_mut().zip(&mut self.squares).zip(row) {
                let value = f64::from(*value);
                *sum -= value;
                *square -= value * value;
            }
            self.left += 1;
        }
    }

    /// Writes the statistics of the rows, of which there must be one. O(values), no allocation.
    pub fn write(&self, out: &mut [f32]) {
        let count = (self.taken - self.left) as f64;
        let mut out = out.iter_mut();
        for (statistic, columns, weight) in parts(self.layout) {
            for (column, out) in columns.zip(&mut out) {
                let (mean, square) = (self.sums[column] / count, self.squares[column] / count);
                let value = match statistic {
                    Statistic::Mean => mean,
                    // Rounding may take a window of equal rows below zero.
                    Statistic::Spread => (square - mean * mean).max(0.0).sqrt(),
                    Statistic::RootMeanSquare => square.max(0.0).sqrt(),
                };
                *out = (weight * value) as f32;
            }
        }
    }
}

/// The statistics of windows of `window_ticks` in `rows` of `layout`, about every [`STEP_TICKS`]th row; at both ends windows are cut
/// off. O(rows · values).
pub(crate) fn windows_of(rows: &Rows, layout: RowLayout, window_ticks: usize) -> Rows {
    let half = window_ticks / 2;
    let mut window = SlidingWindow::new(layout, 2 * half + 1);
    let mut out = Rows::new(statistics(layout));
    let mut written = vec![0.0; out.dim()];
    let mut taken = 0;
    for centre in (0..rows.len()).step_by(STEP_TICKS) {
        while taken < (centre + half + 1).min(rows.len()) {
            window.push(rows.row(taken));
            taken += 1;
        }
        window.drop_before(centre.saturating_sub(half));
        window.write(&mut written);
        out.push(&written);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::BoneSet;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn windows_have_the_statistics_of_their_rows(values in prop::collection::vec(-2f32..2.0, 16 * 10..16 * 60), half in 0usize..9) {
            let bones = BoneSet::NONE.with(0).with(3);
            let layout = RowLayout::of(bones);
            let rows = Rows::from_values(16, values[..values.len() / 16 * 16].to_vec());
            let found = windows_of(&rows, layout, 2 * half + 1);
            prop_assert_eq!(found.len(), rows.len().div_ceil(STEP_TICKS));
            for (step, window) in found.iter().enumerate() {
                let centre = step * STEP_TICKS;
                let span = centre.saturating_sub(half)..(centre + half + 1).min(rows.len());
                let of = |column: usize, map: &dyn Fn(f64) -> f64| {
                    let of_span = span.clone().map(|t| map(f64::from(rows.row(t)[column])));
                    of_span.sum::<f64>() / span.len() as f64
                };
                let spread = |column: usize| {
                    let mean = of(column, &|v| v);
                    of(column, &|v| (v - mean) * (v - mean)).sqrt()
                };
                let expected: Vec<f64> = (0..6).map(|c| of(c, &|v| v))
                    .chain((0..6).map(|c| 2.0 * spread(c)))
                    .chain((6..12).map(|c| 0.6 * of(c, &|v| v * v).sqrt()))
                    .chain((12..16).map(|c| 5.0 / 3.0 * of(c, &|v| v)))
                    .chain((12..16).map(|c| 2.0 / 3.0 * spread(c)))
                    .collect();
                for (found, expected) in window.iter().zip(expected) {
                    prop_assert!((f64::from(*found) - expected).abs() < 1e-4, "{found} for {expected}");
                }
            }
        }
    }

    #[test]
    fn statistics_of_fewer_bones_are_among_those_of_all() {
        let (all, some) = (BoneSet::BODY, BoneSet::NONE.with(2).with(7));
        let (layout, fewer) = (RowLayout::of(all), RowLayout::of(some));
        let keep = RowLayout::kept_columns(all, some);
        let values = (0..8 * layout.dim()).map(|i| ((i * 37) % 101) as f32 / 50.0);
        let rows = Rows::from_values(layout.dim(), values.collect());
        let kept = windows_of(&rows, layout, 5).columns(&kept_statistics(layout, &keep));
        assert_eq!(kept, windows_of(&rows.columns(&keep), fewer, 5));
    }
}
