//! Activities: long labels are searched for by pieces of one or a few repetitions.
//!
//! A label of twenty seconds is like no other as a whole: another person repeats the motion at another pace, and more or less often.

use std::ops::Range;

use morec::features::Rows;
use morec::segment::{CycleParams, cycles};

/// A piece lasts at least this: shorter ones are found by chance. Seconds.
const LEAST_SECS: f64 = 1.0;
/// Pieces of what has no period, seconds: as long as the windows by which activities are recognised.
const USUAL_SECS: f64 = 2.5;

/// Even pieces of a stretch of rows, each of as many whole repetitions as last a second; `ticks` is where the rows lie.
pub fn pieces(rows: &Rows, ticks: &Range<usize>, tick_hz: f64) -> Vec<Range<usize>> {
    let period_secs = cycles(rows, tick_hz, &CycleParams::default())
        .map_or(USUAL_SECS, |cycles| cycles.period_secs);
    let piece_secs = period_secs * (LEAST_SECS / period_secs).ceil();
    let count = ((ticks.len() as f64 / tick_hz / piece_secs) as usize).max(1);
    let bound = |piece: usize| ticks.start + ticks.len() * piece / count;
    (0..count).map(|i| bound(i)..bound(i + 1)).collect()
}
