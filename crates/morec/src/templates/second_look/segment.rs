//! Finds where a motion begins and ends around a match, and its rows.

use std::ops::Range;

use crate::features::Rows;

use super::body::BodyTrack;
use super::extent::LookExtent;
use super::{LOOK_COLUMNS, body};

/// Rows of a segment, whatever its length.
pub const SEGMENT_ROWS: usize = 32;
/// Numbers that vector instructions take together.
pub const LANES: usize = 8;
/// Values of a row, padded to whole lanes.
pub const PADDED: usize = LOOK_COLUMNS.next_multiple_of(LANES);
/// Values of a segment of such rows.
pub const SEGMENT: usize = SEGMENT_ROWS * PADDED;
/// Rows off the diagonal that an alignment may go.
pub const BAND: usize = 6;
/// Ticks that growing inwards leaves of an extent.
const SHORTEST_TICKS: i64 = 8;
/// Columns of the places, of which half of the segment's mean is taken off: what remains is where the motion is performed.
const PLACES: usize = 3 * body::POINTS;

/// How far an extent grows: while the pace exceeds a share of its mean over the match, at most this many ticks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth {
    pub share: f32,
    pub ticks: i64,
}

/// The movement that the match is part of.
pub const SHORT: Growth = Growth {
    share: 0.4,
    ticks: 20,
};
/// The movement with those that lead to it and from it.
pub const LONG: Growth = Growth {
    share: 0.25,
    ticks: 45,
};

/// The end of a growth, if it is known yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GrownExtent {
    /// The motion has ended.
    To(LookExtent),
    /// The motion still goes on.
    GoesOn,
}

/// The whole motion around a match: both ends go out while the pace exceeds the growth's share of its mean over the match, then in
/// while it is below it. The pace is taken as known up to `known` ticks; at the end of a stream that is all of it, and nothing goes on.
/// O(match + reach).
pub fn grow(
    body: &BodyTrack,
    matched: LookExtent,
    growth: Growth,
    known: i64,
    ended: bool,
) -> GrownExtent {
    let level = growth.share * body.mean_pace(matched);
    let LookExtent {
        mut start,
        mut stop,
    } = matched;
    let last = if ended { body.ticks() } else { known };
    while start > body.first()
        && matched.start - start < growth.ticks
        && body.pace(start - 1) > level
    {
        start -= 1;
    }
    loop {
        if stop - matched.stop >= growth.ticks {
            break;
        }
        if stop >= last {
            match ended {
                true => break,
                false => return GrownExtent::GoesOn,
            }
        }
        if body.pace(stop) <= level {
            break;
        }
        stop += 1;
    }
    while start < stop - SHORTEST_TICKS && body.pace(start) < level {
        start += 1;
    }
    while stop > start + SHORTEST_TICKS && body.pace(stop - 1) < level {
        stop -= 1;
    }
    GrownExtent::To(LookExtent { start, stop })
}

/// Writes the rows of an extent to `out`, of [`SEGMENT_ROWS`] × [`LOOK_COLUMNS`] values: half of the mean off the places, resampled
/// linearly. O(extent).
pub fn write_segment(body: &BodyTrack, extent: LookExtent, out: &mut [f32]) {
    let count = extent.len().max(1);
    let mut row = [0.0f32; LOOK_COLUMNS];
    let mut mean = [0.0f32; PLACES];
    for tick in extent.start..extent.start + count {
        for (mean, value) in mean.iter_mut().zip(body.places(tick)) {
            *mean += value;
        }
    }
    mean.iter_mut().for_each(|mean| *mean *= 0.5 / count as f32);
    let mut at = i64::MIN;
    let mut next = [0.0f32; LOOK_COLUMNS];
    for (k, out) in out.chunks_exact_mut(LOOK_COLUMNS).enumerate() {
        let place = k as f64 * (count - 1) as f64 / (SEGMENT_ROWS - 1) as f64;
        let before = (place as i64).clamp(0, (count - 2).max(0));
        if before != at {
            body.row(extent.start + before, &mut row);
            body.row(extent.start + (before + 1).min(count - 1), &mut next);
            at = before;
        }
        let share = (place - before as f64) as f32;
        for ((out, a), b) in out.iter_mut().zip(&row).zip(&next) {
            *out = a * (1.0 - share) + b * share;
        }
        out.iter_mut()
            .zip(&mean)
            .for_each(|(out, mean)| *out -= mean);
    }
}

/// The rows of `ticks` in the `columns` of a model.
pub fn segment_of(body: &BodyTrack, ticks: Range<usize>, columns: &[usize]) -> Rows {
    let mut full = vec![0.0; SEGMENT_ROWS * LOOK_COLUMNS];
    let extent = LookExtent {
        start: ticks.start as i64,
        stop: ticks.end as i64,
    };
    write_segment(body, extent, &mut full);
    Rows::from_values(LOOK_COLUMNS, full).columns(columns)
}

/// The motion within a taught stretch, in ticks of it: from 3 % to 97 % of the path of what exceeds the tenth percentile of `pace` and
/// 15 % of the range above it, two ticks more on each side; all of it where nothing moves.
pub fn sample_span(pace: &[f32]) -> Range<usize> {
    let n = pace.len();
    let mut sorted = pace.to_vec();
    sorted.sort_by(f32::total_cmp);
    let Some(most) = sorted.last() else {
        return 0..0;
    };
    // As `numpy.percentile`: linear between neighbours.
    let place = 0.1 * (n - 1) as f32;
    let (at, share) = (place as usize, place.fract());
    let low = sorted[at] + share * (sorted[(at + 1).min(n - 1)] - sorted[at]);
    let floor = low + 0.15 * (most - low);
    let mut path = Vec::with_capacity(n);
    let mut sum = 0.0f32;
    for pace in pace {
        sum += (pace - floor).max(0.0);
        path.push(sum);
    }
    if sum <= 0.0 {
        return 0..n;
    }
    let first = path.partition_point(|p| p / sum < 0.03);
    let last = path.partition_point(|p| p / sum < 0.97);
    let (start, stop) = (first.saturating_sub(2), (last + 3).min(n));
    match stop - start >= SHORTEST_TICKS as usize {
        true => start..stop,
        false => start.saturating_sub(4)..(stop + 4).min(n),
    }
}

/// The growths of `ticks` in a stream that is known to its end: the short one, and the long one.
#[cfg(feature = "train")]
pub fn grown_of(body: &BodyTrack, ticks: &Range<usize>) -> [Range<usize>; 2] {
    let matched = LookExtent {
        start: ticks.start as i64,
        stop: ticks.end as i64,
    };
    [SHORT, LONG].map(
        |growth| match grow(body, matched, growth, body.ticks(), true) {
            GrownExtent::To(extent) => extent.start as usize..extent.stop as usize,
            GrownExtent::GoesOn => ticks.clone(),
        },
    )
}
