//! How long frames waited: counts that cost next to nothing to keep.

use std::array;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Steps to a doubling.
const STEPS: usize = 8;
/// From a microsecond to a quarter of an hour.
const COUNTS: usize = 30 * STEPS;
const LEAST_SECS: f64 = 1e-6;

/// How many frames waited how long, in steps of a twelfth: what shares of them can be told from.
#[derive(Debug, Clone, PartialEq)]
pub struct LatencyHistogram {
    counts: [u64; COUNTS],
}

impl Default for LatencyHistogram {
    fn default() -> Self {
        Self {
            counts: [0; COUNTS],
        }
    }
}

impl LatencyHistogram {
    /// Frames counted.
    pub fn frames(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// The wait that this share of the frames did not exceed, 0 … 1, seconds, to a twelfth upwards; `None` before the
    /// first frame. Waits below a microsecond count as one.
    pub fn share_secs(&self, share: f64) -> Option<f64> {
        let wanted = (self.frames() as f64 * share.clamp(0.0, 1.0))
            .ceil()
            .max(1.0) as u64;
        let mut frames = 0;
        let at = self.counts.iter().position(|count| {
            frames += count;
            frames >= wanted
        })?;
        Some(LEAST_SECS * 2f64.powf((at + 1) as f64 / STEPS as f64))
    }

    /// The frames counted since `before` was read.
    #[must_use]
    pub fn since(&self, before: &Self) -> Self {
        Self {
            counts: array::from_fn(|i| self.counts[i].saturating_sub(before.counts[i])),
        }
    }
}

/// The counts while a session runs.
#[derive(Debug)]
pub(super) struct WaitCells {
    counts: [AtomicU64; COUNTS],
}

impl Default for WaitCells {
    fn default() -> Self {
        Self {
            counts: array::from_fn(|_| AtomicU64::new(0)),
        }
    }
}

impl WaitCells {
    pub(super) fn add(&self, wait_secs: f64) {
        let step = ((wait_secs / LEAST_SECS).max(1.0).log2() * STEPS as f64) as usize;
        self.counts[step.min(COUNTS - 1)].fetch_add(1, Relaxed);
    }

    pub(super) fn read(&self) -> LatencyHistogram {
        LatencyHistogram {
            counts: array::from_fn(|i| self.counts[i].load(Relaxed)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_told_to_a_twelfth() {
        let cells = WaitCells::default();
        assert_eq!(cells.read().share_secs(0.5), None);
        for n in 1..=1000 {
            cells.add(f64::from(n) * 1e-4);
        }
        let waits = cells.read();
        assert_eq!(waits.frames(), 1000);
        for share in [0.001, 0.5, 0.9, 0.99, 1.0] {
            let exact = share * 0.1;
            let told = waits.share_secs(share).unwrap();
            assert!(
                told >= exact * 0.999 && told <= exact * 1.1,
                "{share}: {told} for {exact}"
            );
        }
        cells.add(0.0);
        cells.add(f64::NAN);
        cells.add(1e9);
        let more = cells.read().since(&waits);
        assert_eq!(more.frames(), 3);
        assert!(more.share_secs(0.5).unwrap() < 2e-6 && more.share_secs(1.0).unwrap() > 900.0);
    }
}
