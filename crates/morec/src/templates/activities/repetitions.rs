//! Counts the repetitions of an activity while it continues.

use crate::decode::Repetitions;
use crate::periodicity::{CycleParams, period};

/// Every second row is kept: the shortest repetitions still have four.
const STRIDE: usize = 2;
/// What is looked back at, and the longest repetition, seconds.
const MEMORY_SECS: f64 = 10.0;
const LONGEST_SECS: f64 = 6.0;
/// Values of rows that are compared: those that vary most.
const COLUMNS: usize = 6;
/// In the few rows of a beginning, noise repeats by chance.
const LEAST_CORRELATION: f64 = 0.4;
/// Seconds of motion after which the period is measured again.
const RENEW_SECS: f64 = 0.5;

/// Counts repetitions: each moment counts as its share of the period that the motion has there. The period is that of the
/// autocorrelation of the last ten seconds at most, of the values of rows that vary most.
///
/// Nothing is allocated after construction.
#[derive(Debug, Clone)]
pub(super) struct RepetitionCounter {
    dim: usize,
    tick_hz: f64,
    /// Every second of the last rows, row `n` at slot `n % capacity`.
    rows: Vec<f32>,
    capacity: usize,
    ticks: usize,
    /// Tick at which the activity began, and one past the last that was counted.
    first: usize,
    counted: usize,
    /// Tick at which the period is measured next.
    renewal: usize,
    /// Of what was counted.
    count: f64,
    /// Ticks since the beginning that wait for a first period.
    waiting: usize,
    period_ticks: Option<f64>,
    spreads: Vec<(f32, usize)>,
    chosen: Vec<f32>,
    correlation: Vec<f64>,
}

impl RepetitionCounter {
    /// For rows of `dim` values, `tick_hz` a second.
    pub fn new(dim: usize, tick_hz: f64) -> Self {
        let rows_of = |secs: f64| (secs * tick_hz) as usize / STRIDE;
        let capacity = rows_of(MEMORY_SECS);
        Self {
            dim,
            tick_hz,
            rows: vec![0.0; capacity * dim],
            capacity,
            ticks: 0,
            first: 0,
            counted: 0,
            renewal: 0,
            count: 0.0,
            waiting: 0,
            period_ticks: None,
            spreads: Vec::with_capacity(dim),
            chosen: Vec::with_capacity(capacity * COLUMNS.min(dim)),
            correlation: Vec::with_capacity(rows_of(LONGEST_SECS) + 1),
        }
    }

    pub fn clear(&mut self) {
        self.ticks = 0;
        self.begin(0);
    }

    /// Takes the next tick's row. O(values).
    pub fn push(&mut self, row: &[f32]) {
        if self.ticks.is_multiple_of(STRIDE) {
            let slot = self.ticks / STRIDE % self.capacity;
            self.rows[slot * self.dim..][..self.dim].copy_from_slice(row);
        }
        self.ticks += 1;
    }

    /// An activity begins at tick `first`.
    pub fn begin(&mut self, first: usize) {
        (self.first, self.counted) = (first, first);
        self.renewal = first + self.ticks_of(RENEW_SECS);
        (self.count, self.waiting, self.period_ticks) = (0.0, 0, None);
    }

    /// The activity has gone on to before tick `stop`. Twice a second, O(rows · (values + lags)).
    pub fn advance(&mut self, stop: usize) {
        let stop = stop.min(self.ticks);
        self.waiting += stop.saturating_sub(self.counted);
        self.counted = stop;
        if stop >= self.renewal {
            self.renewal = stop + self.ticks_of(RENEW_SECS);
            self.period_ticks = self.measure().or(self.period_ticks);
        }
        if let Some(period) = self.period_ticks {
            self.count += self.waiting as f64 / period;
            self.waiting = 0;
        }
    }

    /// Those of what was counted and `more` ticks after it.
    pub fn repetitions(&self, more: usize) -> Option<Repetitions> {
        let period = self.period_ticks?;
        let count = self.count + more as f64 / period;
        Some(Repetitions {
            count: count.round().max(1.0) as u32,
            period_secs: period / self.tick_hz,
        })
    }

    /// Repetitions that are over in what was counted, and how many ticks before its end the last of them was over.
    pub fn whole(&self) -> Option<(u32, f64)> {
        let period = self.period_ticks?;
        let whole = self.count.floor();
        (whole >= 1.0).then_some((whole as u32, (self.count - whole) * period))
    }

    fn ticks_of(&self, secs: f64) -> usize {
        (secs * self.tick_hz).round() as usize
    }

    /// The period at what was counted last, in ticks.
    fn measure(&mut self) -> Option<f64> {
        let oldest = self.ticks.div_ceil(STRIDE).saturating_sub(self.capacity);
        let rows = self.first.div_ceil(STRIDE).max(oldest)..self.counted.div_ceil(STRIDE);
        self.choose(rows.clone());
        let columns = self.chosen.len() / rows.len().max(1);
        self.correlate(rows.len(), columns);
        let params = CycleParams {
            least_correlation: LEAST_CORRELATION,
            ..CycleParams::default()
        };
        let (period, _) = period(&self.correlation, self.tick_hz / STRIDE as f64, &params)?;
        Some(period * STRIDE as f64)
    }

    /// Sets `chosen` to the values that vary most, about their means.
    fn choose(&mut self, rows: std::ops::Range<usize>) {
        let count = rows.len() as f32;
        let value = |row: usize, column: usize| {
            self.rows[row % self.capacity * self.dim..][..self.dim][column]
        };
        let mean = |column: usize| rows.clone().map(|r| value(r, column)).sum::<f32>() / count;
        let spread = |column: usize| {
            let mean = mean(column);
            let squares = rows.clone().map(|row| (value(row, column) - mean).powi(2));
            squares.sum::<f32>()
        };
        self.spreads.clear();
        self.spreads
            .extend((0..self.dim).map(|column| (spread(column), column)));
        let most = |a: &(f32, usize), b: &(f32, usize)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
        self.spreads.sort_unstable_by(most);
        self.chosen.clear();
        for (_, column) in self.spreads.iter().take(COLUMNS) {
            let mean = mean(*column);
            let centred = rows.clone().map(|row| value(row, *column) - mean);
            self.chosen.extend(centred);
        }
    }

    /// Sets the autocorrelation of `chosen`, up to two thirds of the rows; empty for rows that do not move.
    fn correlate(&mut self, rows: usize, columns: usize) {
        let chosen = &self.chosen;
        let at = |lag: usize| -> f64 {
            let of_column = |column: usize| -> f32 {
                let values = &chosen[column * rows..][..rows];
                let pairs = values[lag..].iter().zip(values);
                pairs.map(|(a, b)| a * b).sum()
            };
            let sum: f32 = (0..columns).map(of_column).sum();
            f64::from(sum) / (rows - lag) as f64
        };
        self.correlation.clear();
        let variance = if rows > 0 { at(0) } else { 0.0 };
        if variance > 1e-9 {
            let lags = (2 * rows / 3 + 1).min(self.correlation.capacity());
            self.correlation
                .extend((0..lags).map(|lag| at(lag) / variance));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// What is counted of `secs` of a wave after as much rest.
    fn counted(period_secs: f64, secs: f64, noise: f64) -> Option<Repetitions> {
        let (hz, ticks) = (30.0, (secs * 30.0) as usize);
        let mut rng = crate::rng::Rng::new(3);
        let mut counter = RepetitionCounter::new(8, hz);
        for tick in 0..2 * ticks {
            let phase = std::f64::consts::TAU * (tick as f64 - ticks as f64) / hz / period_secs;
            let size = if tick < ticks { 0.0 } else { 1.0 };
            let row = [1.0, 0.3, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0].map(|part| {
                let moves = part * size * (phase + part).sin();
                (moves + noise * rng.normal()) as f32
            });
            counter.push(&row);
            if tick == ticks {
                counter.begin(ticks);
            }
            if tick > ticks && tick % 3 == 0 {
                counter.advance(tick);
            }
        }
        counter.advance(2 * ticks);
        counter.repetitions(0)
    }

    proptest! {
        #[test]
        fn a_wave_is_counted(period in 0.4f64..5.0, times in 3f64..25.0, noise in 0f64..0.3) {
            // The period is measured twice a second, and shows after one and a half, in noise perhaps after two.
            prop_assume!(period * times > 2.0);
            let found = counted(period, period * times, noise).unwrap();
            let wrong = f64::from(found.count) - times;
            prop_assert!(wrong.abs() <= 1.0 + 0.04 * times, "{found:?} for {times} of {period}");
            prop_assert!((found.period_secs / period - 1.0).abs() < 0.1, "{found:?} for {period}");
        }
    }

    #[test]
    fn what_does_not_repeat_is_not_counted() {
        assert_eq!(counted(9.0, 8.0, 0.0), None);
        assert_eq!(RepetitionCounter::new(4, 30.0).repetitions(5), None);
    }
}
