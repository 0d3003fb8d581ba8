//! Means and spreads of the stretches of a stream that end now.

use super::kernel;

/// Sums of a stream's rows at each of its last ticks, from which the mean and the spread of any stretch that ends now
/// follow. Two sets of templates that are matched against the same stream share one.
///
/// Nothing is allocated after construction.
#[derive(Debug, Clone)]
pub struct Stretches {
    /// Values of a row and one more, for the sum of squared lengths.
    width: usize,
    mask: usize,
    /// Of rows `0..tick`, at slot `tick & mask`.
    sums: Vec<f64>,
    ticks: usize,
    /// Spread of the stretch of each age, and the tick at which it was computed: many templates' matches begin at the
    /// same tick.
    spreads: Vec<(usize, f32)>,
}

impl Stretches {
    /// For rows of `dim` values and stretches of at most `longest` ticks.
    pub fn new(dim: usize, longest: usize) -> Self {
        let capacity = (longest + 2).next_power_of_two();
        Self {
            width: dim + 1,
            mask: capacity - 1,
            sums: vec![0.0; (dim + 1) * capacity],
            ticks: 0,
            spreads: vec![(0, 0.0); capacity],
        }
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.ticks = 0;
        self.sums[..self.width].fill(0.0);
        self.spreads.fill((0, 0.0));
    }

    /// Takes the next row. O(d).
    pub fn push(&mut self, row: &[f32]) {
        let from = (self.ticks & self.mask) * self.width;
        self.ticks += 1;
        let to = (self.ticks & self.mask) * self.width;
        let mut square = 0.0;
        for (i, value) in row.iter().enumerate() {
            let value = f64::from(*value);
            self.sums[to + i] = self.sums[from + i] + value;
            square += value * value;
        }
        let last = self.width - 1;
        self.sums[to + last] = self.sums[from + last] + square;
    }

    /// Spread of the last `age + 1` rows about their mean. O(d), O(1) when asked for again.
    pub fn spread(&mut self, age: usize) -> f32 {
        let slot = age & self.mask;
        if self.spreads[slot].0 != self.ticks {
            self.spreads[slot] = (self.ticks, self.compute_spread(age));
        }
        self.spreads[slot].1
    }

    fn compute_spread(&self, age: usize) -> f32 {
        let (end, start, share) = self.of(age);
        let last = self.width - 1;
        let square = (end[last] - start[last]) * share;
        let mean = kernel::square_of_mean(&end[..last], &start[..last], share);
        (square - mean).max(0.0) as f32
    }

    /// Squared distance from `point` to the mean of the last `age + 1` rows. O(d).
    pub fn mean_offset(&self, age: usize, point: &[f32]) -> f32 {
        let (end, start, share) = self.of(age);
        let dim = self.width - 1;
        kernel::offset_of_mean(&end[..dim], &start[..dim], share, point) as f32
    }

    /// Sums at the end and before the start of the last `age + 1` rows, and one over their number.
    fn of(&self, age: usize) -> (&[f64], &[f64], f64) {
        let at = |tick: usize| &self.sums[(tick & self.mask) * self.width..][..self.width];
        let start = self.ticks.saturating_sub(age + 1);
        let share = 1.0 / (self.ticks - start).max(1) as f64;
        (at(self.ticks), at(start), share)
    }
}
