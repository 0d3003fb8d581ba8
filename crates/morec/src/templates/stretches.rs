//! Means and spreads of all stretches that end at the present tick, and the noise of the stream.

use crate::features::{Rows, USUAL_NOISE_GAIN};

use super::kernel::{self, SUMS, SumBlock};

/// Noise is measured at every fourth tick, over the last 64 times: eight seconds, of which motion fills less than half.
const NOISE_STEP: usize = 4;
const NOISE_TIMES: usize = 64;
/// Fewer say nothing.
const LEAST_NOISE_TIMES: usize = 16;
/// Weights of sums of rows in the fourth difference of rows, 1 −4 6 −4 1.
const DIFFERENCE: [f64; 6] = [1.0, -5.0, 10.0, -10.0, 5.0, -1.0];

/// Sums of a stream's rows at each of its last ticks, from which the mean and the spread of any stretch that ends now
/// follow. Two sets of templates that are matched against the same stream share one.
///
/// Noise is the median of the squared fourth differences of the last rows, over what noise of variance 1 leaves in them
/// ([`set_noise_gain`](Self::set_noise_gain)): motion of a few hertz vanishes in them (Rice, Ann. Statist. 12, 1984, has differences as
/// estimators of variance), and the median does not see single jumps.
///
/// Nothing is allocated after construction.
#[derive(Debug, Clone)]
pub struct Stretches {
    /// Blocks of a row.
    width: usize,
    mask: usize,
    /// Of rows `0..tick`, at slot `tick & mask`.
    sums: Vec<SumBlock>,
    /// Of their squared lengths.
    squares: Vec<f64>,
    ticks: usize,
    /// Spread of the stretch of each age, and the tick at which it was computed: many templates' matches begin at the
    /// same tick.
    spreads: Vec<(usize, f32)>,
    noise_gain: f32,
    /// Squared fourth differences of the last rows over the gain.
    jitter: [f32; NOISE_TIMES],
    /// Times that noise was measured.
    times: usize,
    noise: f32,
}

fn median(values: &mut [f32]) -> f32 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f32::total_cmp).1
}

impl Stretches {
    /// For rows of `dim` values and stretches of at most `longest` ticks.
    pub fn new(dim: usize, longest: usize) -> Self {
        let capacity = (longest + 2).max(DIFFERENCE.len()).next_power_of_two();
        let width = dim.div_ceil(SUMS);
        Self {
            width,
            mask: capacity - 1,
            sums: vec![[0.0; SUMS]; width * capacity],
            squares: vec![0.0; capacity],
            ticks: 0,
            spreads: vec![(0, 0.0); capacity],
            noise_gain: USUAL_NOISE_GAIN,
            jitter: [0.0; NOISE_TIMES],
            times: 0,
            noise: 0.0,
        }
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.ticks = 0;
        self.sums[..self.width].fill([0.0; SUMS]);
        self.squares[0] = 0.0;
        self.spreads.fill((0, 0.0));
        (self.times, self.noise) = (0, 0.0);
    }

    /// Takes the next row. O(d).
    pub fn push(&mut self, row: &[f32]) {
        let from = self.ticks & self.mask;
        self.ticks += 1;
        let to = self.ticks & self.mask;
        // Neighbours in the ring, or its last and its first.
        let (before, after) = self.sums.split_at_mut(from.max(to) * self.width);
        let (from_sums, to_sums) = match from < to {
            true => (&before[from * self.width..], &mut after[..self.width]),
            false => (&after[..], &mut before[..self.width]),
        };
        let square = kernel::add_row(from_sums, row, to_sums);
        self.squares[to] = self.squares[from] + square;
        self.measure_noise();
    }

    fn measure_noise(&mut self) {
        if !self.ticks.is_multiple_of(NOISE_STEP) {
            return;
        }
        let Some(square) = self.squared_difference() else {
            return;
        };
        self.jitter[self.times % NOISE_TIMES] = square / self.noise_gain;
        self.times += 1;
        let mut known = self.jitter;
        let known = &mut known[..self.times.min(NOISE_TIMES)];
        if known.len() >= LEAST_NOISE_TIMES {
            self.noise = median(known);
        }
    }

    /// Square of the fourth difference of the last five rows.
    fn squared_difference(&self) -> Option<f32> {
        if self.ticks + 1 < DIFFERENCE.len() {
            return None;
        }
        let sums = [0, 1, 2, 3, 4, 5].map(|back| self.sums_at(self.ticks - back));
        Some(kernel::square_of_combination(&sums, &DIFFERENCE) as f32)
    }

    /// The squared fourth difference that noise of variance 1 leaves in the rows that come:
    /// [`FeatureStream::noise_gain`](crate::features::FeatureStream::noise_gain).
    pub fn set_noise_gain(&mut self, gain: f32) {
        self.noise_gain = gain;
    }

    /// The squared distance that noise adds to a row; 0 in the first two seconds.
    pub fn noise(&self) -> f32 {
        self.noise
    }

    /// The same of all `rows`, under the shortest filter.
    pub(super) fn noise_of(rows: &Rows) -> f32 {
        let mut stretches = Self::new(rows.dim(), 0);
        let mut difference = |row| {
            stretches.push(row);
            stretches.squared_difference()
        };
        let mut squares: Vec<f32> = rows.iter().filter_map(&mut difference).collect();
        match squares.is_empty() {
            true => 0.0,
            false => median(&mut squares) / USUAL_NOISE_GAIN,
        }
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
        let ([start, end], share) = self.of(age);
        let squares = [start, end].map(|tick| self.squares[tick & self.mask]);
        let square = (squares[1] - squares[0]) * share;
        let mean = kernel::square_of_mean(self.sums_at(end), self.sums_at(start), share);
        (square - mean).max(0.0) as f32
    }

    /// Squared distance from `point`, in [blocks](kernel::blocks), to the mean of the last `age + 1` rows. O(d).
    pub(super) fn mean_offset(&self, age: usize, point: &[[f32; SUMS]]) -> f32 {
        let ([start, end], share) = self.of(age);
        kernel::offset_of_mean(self.sums_at(end), self.sums_at(start), share, point) as f32
    }

    /// Ticks before and after the last `age + 1` rows, and one over their number.
    fn of(&self, age: usize) -> ([usize; 2], f64) {
        let start = self.ticks.saturating_sub(age + 1);
        let share = 1.0 / (self.ticks - start).max(1) as f64;
        ([start, self.ticks], share)
    }

    fn sums_at(&self, tick: usize) -> &[SumBlock] {
        &self.sums[(tick & self.mask) * self.width..][..self.width]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    /// The noise of two values that swing, with white noise of this deviation on each, and jumps.
    fn noise(deviation: f64, swings_hz: f64) -> f32 {
        let mut rng = Rng::new(1);
        let mut stretches = Stretches::new(2, 10);
        // White from row to row: the squares of 1 −4 6 −4 1.
        stretches.set_noise_gain(70.0);
        for tick in 0..200 {
            let swing = (std::f64::consts::TAU * swings_hz * f64::from(tick) / 30.0).sin();
            let jump = if tick % 40 == 0 { 5.0 } else { 0.0 };
            let mut value = |swing: f64| (swing + jump + deviation * rng.normal()) as f32;
            stretches.push(&[value(swing), value(-swing)]);
        }
        stretches.noise()
    }

    #[test]
    fn noise_is_what_it_adds_to_a_row_and_motion_is_none() {
        assert!(noise(0.0, 2.0) < 1e-3);
        // The variances of both values add up to 0.5; a median of 64 squares varies.
        assert!(
            (0.25..0.75).contains(&noise(0.5, 2.0)),
            "{}",
            noise(0.5, 2.0)
        );
        assert!((noise(0.5, 0.0) - noise(0.5, 2.0)).abs() < 0.05);
    }

    #[test]
    fn a_new_stretch_knows_nothing_of_the_noise_before() {
        let mut stretches = Stretches::new(1, 4);
        (0..80).for_each(|tick| stretches.push(&[(tick % 3) as f32]));
        assert!(stretches.noise() > 0.1);
        stretches.reset();
        assert_eq!(stretches.noise(), 0.0);
        assert_eq!(
            Stretches::noise_of(&Rows::from_values(1, vec![0.5; 30])),
            0.0
        );
    }
}
