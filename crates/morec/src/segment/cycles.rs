//! Cycles: the length of one repetition, and the number of repetitions in a stretch.

use crate::features::Rows;
pub use crate::periodicity::CycleParams;
use crate::periodicity::period;

/// The repetitions of a stretch.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Cycles {
    /// Length of one, seconds.
    pub period_secs: f64,
    /// Number of repetitions in the stretch: its length over the period.
    pub count: f64,
    /// Correlation of one with the next, 1 for the same.
    pub correlation: f64,
}

impl Cycles {
    /// Whole repetitions: the nearest number, at least one.
    pub fn whole(&self) -> usize {
        self.count.round().max(1.0) as usize
    }

    /// Bounds of repetitions if a stretch of this many seconds is divided evenly: one more than there are.
    pub fn bounds(&self, secs: f64) -> Vec<f64> {
        let n = self.whole();
        (0..=n).map(|i| secs * i as f64 / n as f64).collect()
    }
}

/// The period and number of repetitions in rows of which `rate_hz` make a second; `None` where nothing repeats, or less
/// than one and a half times. From the first high peak of the autocorrelation, placed between rows by a parabola.
/// O(rows² · values).
pub fn cycles(rows: &Rows, rate_hz: f64, params: &CycleParams) -> Option<Cycles> {
    let correlation = autocorrelation(rows)?;
    let (period, correlation) = period(&correlation, rate_hz, params)?;
    Some(Cycles {
        period_secs: period / rate_hz,
        count: rows.len() as f64 / period,
        correlation,
    })
}

/// For each lag up to two thirds of the rows: the mean product of rows so far apart, about their mean, over the
/// variance. `None` for rows that do not move.
fn autocorrelation(rows: &Rows) -> Option<Vec<f64>> {
    let (n, dim) = (rows.len(), rows.dim());
    let mut mean = vec![0f64; dim];
    for row in rows.iter() {
        mean.iter_mut()
            .zip(row)
            .for_each(|(m, v)| *m += f64::from(*v) / n as f64);
    }
    let centred: Vec<f32> = rows
        .iter()
        .flat_map(|row| row.iter().zip(&mean).map(|(v, m)| v - *m as f32))
        .collect();
    let at = |lag: usize| {
        let (a, b) = (&centred[..(n - lag) * dim], &centred[lag * dim..]);
        a.iter().zip(b).map(|(a, b)| f64::from(a * b)).sum::<f64>() / (n - lag) as f64
    };
    let variance = if n > 0 { at(0) } else { 0.0 };
    (variance > 1e-9).then(|| (0..=2 * n / 3).map(|lag| at(lag) / variance).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_wave_is_counted(period in 8f64..40.0, times in 2f64..9.0, second in -1f64..1.0) {
            let n = (period * times) as usize;
            let rows: Vec<f32> = (0..n)
                .flat_map(|t| {
                    let phase = std::f64::consts::TAU * t as f64 / period;
                    [phase.sin() as f32, (phase + 1.0).cos() as f32 + 0.5 * (second * (2.0 * phase).sin()) as f32]
                })
                .collect();
            let found = cycles(&Rows::from_values(2, rows), 30.0, &CycleParams::default()).unwrap();
            prop_assert!((found.period_secs * 30.0 / period - 1.0).abs() < 0.06, "{found:?} for {period}");
        }
    }

    #[test]
    fn stillness_and_a_single_move_have_no_period() {
        let still = Rows::from_values(1, vec![1.0; 90]);
        assert_eq!(cycles(&still, 30.0, &CycleParams::default()), None);
        let ramp = Rows::from_values(1, (0..90).map(|t| t as f32).collect());
        assert_eq!(cycles(&ramp, 30.0, &CycleParams::default()), None);
        assert_eq!(cycles(&Rows::new(1), 30.0, &CycleParams::default()), None);
    }
}
