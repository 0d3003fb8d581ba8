//! Parameters of the cross-validation of widths.

use serde::{Deserialize, Serialize};

use mocap::math::portable;

/// Parameters of the cross-validation of widths.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CrossParams {
    /// Outputs from here on accept: 0.92 (thesis, §4.6.5).
    pub accept: f64,
    /// At most this many parts, into which whole groups are dealt.
    pub folds: usize,
    /// Widths of the kernel between feature vectors, as multiples of the median distance within a side.
    pub full: Multiples,
    /// Widths in the plane, likewise.
    pub reduced: Multiples,
    /// Cost of accepting all background, relative to accepting all samples.
    pub background_cost: f64,
    /// Cost of accepting all samples on the wrong side.
    pub other_cost: f64,
}

impl Default for CrossParams {
    fn default() -> Self {
        Self {
            accept: 0.92,
            folds: 8,
            full: Multiples {
                low: 0.25,
                high: 2.0,
                count: 5,
            },
            reduced: Multiples {
                low: 0.1,
                high: 3.0,
                count: 9,
            },
            background_cost: 3.0,
            other_cost: 2.0,
        }
    }
}

/// Multiples in even ratios.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Multiples {
    /// The smallest value tried.
    pub low: f64,
    /// The largest value tried.
    pub high: f64,
    /// Number of values tried.
    pub count: usize,
}

impl Multiples {
    pub(super) fn of(self, unit: f64) -> impl Iterator<Item = f64> {
        let last = self.count.saturating_sub(1).max(1) as f64;
        (0..self.count.max(1))
            .map(move |i| unit * self.low * portable::powf(self.high / self.low, i as f64 / last))
    }
}
