//! Kernel change points: cuts that make segments as uniform as possible, at a penalty for each cut.
//!
//! The cost of a segment is the spread of its rows in the space of a cosine kernel, `n − |Σ u|² / n` over unit rows `u`:
//! with prefix sums O(values) for any segment. The best sequence of cuts is found exactly (Killick, Fearnhead, Eckley:
//! *Optimal detection of changepoints with a linear computational cost*, 2012; kernels as in Harchaoui and Cappé,
//! *Retrospective multiple change-point estimation with kernels*, 2007).

use crate::features::{FeatureParams, Rows};

use super::params::SegmentError;
use super::windows::window_rows;

/// Parameters of [`kernel_cuts`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct KernelParams {
    /// Length of the windows whose statistics are compared.
    pub window_secs: f64,
    /// Cost of a cut; a segment of rows at right angles costs one a row.
    pub penalty: f64,
    /// No segment is shorter.
    pub least_secs: f64,
    /// Ticks from one window to the next.
    pub hop: usize,
}

impl Default for KernelParams {
    /// Chosen on 35 cuts of everyday motion and exercises: ten windows a second.
    fn default() -> Self {
        Self {
            window_secs: 2.0,
            penalty: 4.0,
            least_secs: 2.0,
            hop: 3,
        }
    }
}

impl KernelParams {
    /// Says what is wrong with these values, if anything is.
    ///
    /// # Errors
    /// A sentence about the first value out of its range.
    pub fn check(&self) -> Result<(), String> {
        let figures = [
            ("window_secs", self.window_secs, 0.1, 60.0),
            ("penalty", self.penalty, 0.0, 1e6),
            ("least_secs", self.least_secs, 0.0, 3600.0),
        ];
        for (name, value, least, most) in figures {
            if !(least..=most).contains(&value) {
                return Err(format!("{name} must be {least} to {most}, found {value}"));
            }
        }
        if !(1..=1000).contains(&self.hop) {
            return Err(format!("hop must be 1 to 1000, found {}", self.hop));
        }
        Ok(())
    }
}

/// Change points of a clip's behaviour, seconds from the first row, from feature rows made with `features`.
/// O(windows · values) where segments come up regularly, O(windows²) at worst.
///
/// # Errors
/// Parameters beyond all use.
pub fn kernel_cuts(
    rows: &Rows,
    features: &FeatureParams,
    params: &KernelParams,
) -> Result<Vec<f64>, SegmentError> {
    params.check().map_err(SegmentError::Params)?;
    let windows = window_rows(rows, features, params.window_secs, params.hop);
    let least = (params.least_secs * windows.rate_hz).round() as usize;
    let cuts = change_points(&windows.rows, params.penalty, least);
    Ok(cuts
        .into_iter()
        .map(|row| row as f64 / windows.rate_hz)
        .collect())
}

/// First rows of all segments but the first in the cheapest division of `rows`: the sum of the segments' costs and
/// `penalty` for each cut. Segments have `least` rows or more, unless there are fewer than twice as many.
pub fn change_points(rows: &Rows, penalty: f64, least: usize) -> Vec<usize> {
    let (n, least) = (rows.len(), least.max(1));
    if n < 2 * least {
        return Vec::new();
    }
    let costs = Costs::of(rows);
    // best[t]: price of the best division of rows before t; from[t]: its last segment's first row.
    let mut best = vec![f64::INFINITY; n + 1];
    let mut from = vec![0; n + 1];
    best[0] = -penalty;
    // Starts that may still be best, and the row from which they no longer can be.
    let mut open: Vec<(usize, usize)> = vec![(0, usize::MAX)];
    for t in least..=n {
        if t >= 2 * least {
            open.push((t - least, usize::MAX));
        }
        open.retain(|(_, until)| t < *until);
        for &(start, _) in &open {
            let price = best[start] + costs.cost(start, t) + penalty;
            if price < best[t] {
                (best[t], from[t]) = (price, start);
            }
        }
        // Splitting never costs more than the parts: a start worse than t now is worse than t as soon as t may start.
        for (start, until) in open.iter_mut().filter(|(_, until)| *until == usize::MAX) {
            if best[*start] + costs.cost(*start, t) > best[t] + 1e-9 {
                *until = t + least;
            }
        }
    }
    let mut cuts = Vec::new();
    let mut t = n;
    while from[t] > 0 {
        t = from[t];
        cuts.push(t);
    }
    cuts.reverse();
    cuts
}

/// Prefix sums of unit rows.
struct Costs {
    dim: usize,
    sums: Vec<f64>,
}

impl Costs {
    fn of(rows: &Rows) -> Self {
        let dim = rows.dim();
        let mut sums = vec![0.0; dim];
        for (t, row) in rows.iter().enumerate() {
            let norm = row
                .iter()
                .map(|v| f64::from(*v).powi(2))
                .sum::<f64>()
                .sqrt()
                .max(1e-12);
            for (i, value) in row.iter().enumerate() {
                sums.push(sums[t * dim + i] + f64::from(*value) / norm);
            }
        }
        Self { dim, sums }
    }

    fn cost(&self, start: usize, stop: usize) -> f64 {
        let n = (stop - start) as f64;
        let (a, b) = (
            &self.sums[start * self.dim..],
            &self.sums[stop * self.dim..(stop + 1) * self.dim],
        );
        n - b.iter().zip(a).map(|(b, a)| (b - a).powi(2)).sum::<f64>() / n
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Every division tried, by the recurrence without pruning.
    fn plain(rows: &Rows, penalty: f64, least: usize) -> f64 {
        let costs = Costs::of(rows);
        let n = rows.len();
        let mut best = vec![f64::INFINITY; n + 1];
        best[0] = -penalty;
        for t in 1..=n {
            for start in 0..t {
                if t - start >= least {
                    best[t] = best[t].min(best[start] + costs.cost(start, t) + penalty);
                }
            }
        }
        best[n]
    }

    fn price(rows: &Rows, cuts: &[usize], penalty: f64) -> f64 {
        let costs = Costs::of(rows);
        let mut ends = cuts.to_vec();
        ends.push(rows.len());
        let mut start = 0;
        let mut sum = penalty * cuts.len() as f64;
        for end in ends {
            sum += costs.cost(start, end);
            start = end;
        }
        sum
    }

    proptest! {
        #[test]
        fn pruning_loses_nothing(
            values in prop::collection::vec(-1f32..1.0, 6..180),
            penalty in 0.01f64..3.0,
            least in 1usize..9,
        ) {
            let rows = Rows::from_values(3, values);
            prop_assume!(rows.len() >= 2 * least);
            let cuts = change_points(&rows, penalty, least);
            prop_assert!((price(&rows, &cuts, penalty) - plain(&rows, penalty, least)).abs() < 1e-6);
            let mut ends = vec![0];
            ends.extend(&cuts);
            ends.push(rows.len());
            prop_assert!(ends.windows(2).all(|pair| pair[1] - pair[0] >= least));
        }
    }

    #[test]
    fn a_change_is_cut_where_it_is() {
        let mut rows = Rows::new(2);
        for t in 0..60 {
            rows.push(if (20..45).contains(&t) {
                &[0.0, 1.0]
            } else {
                &[2.0, 0.1]
            });
        }
        assert_eq!(change_points(&rows, 1.0, 5), [20, 45]);
        assert!(change_points(&rows, 100.0, 5).is_empty());
        assert!(change_points(&Rows::new(2), 1.0, 5).is_empty());
    }
}
