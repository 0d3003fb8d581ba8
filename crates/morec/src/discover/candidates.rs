//! Candidates for repeated motions: stretches from one moment of low speed to a later one.

use std::ops::Range;

use crate::features::{RowLayout, Rows};

/// Widths of the Gaussians at whose minima of speed a motion may begin or end, seconds.
const WIDTHS_SECS: [f64; 3] = [0.05, 0.1, 0.2];
/// Bounds ahead, of the same width, up to which a candidate reaches.
const AHEAD: usize = 4;
/// Lengths of a candidate, seconds.
const LENGTHS_SECS: std::ops::RangeInclusive<f64> = 0.25..=5.0;
/// A candidate moves for this long.
const LEAST_MOVING_SECS: f64 = 0.15;
/// A candidate moves for this share of its time.
const LEAST_MOVING_SHARE: f64 = 0.35;
/// No longer rest lies inside a candidate.
const LONGEST_REST_SECS: f64 = 0.7;
/// A rest: a smaller share of moving than this …
const REST_SHARE: f64 = 0.2;
/// … for this long.
const LEAST_REST_SECS: f64 = 5.0 / 30.0;

/// A stretch of a clip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MovingStretch {
    pub(super) clip: usize,
    /// First tick.
    pub(super) start: usize,
    /// Tick behind the last.
    pub(super) stop: usize,
    /// Its time weighted by how fast it is: seconds of moving.
    pub(super) moving_secs: f64,
}

impl MovingStretch {
    pub(super) fn ticks(&self) -> usize {
        self.stop - self.start
    }

    /// True if both have more than a tick of one clip in common.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.clip == other.clip && self.stop.min(other.stop) > self.start.max(other.start) + 1
    }

    /// True if their lengths differ by less than this factor.
    pub(super) fn as_long(&self, other: &Self, factor: f64) -> bool {
        let ratio = self.ticks() as f64 / other.ticks().max(1) as f64;
        ratio < factor && ratio > 1.0 / factor
    }
}

/// How a clip moves, tick by tick.
pub(super) struct Movement {
    tick_hz: f64,
    /// Weighted speed of the bones' directions, radians a second.
    speed: Vec<f64>,
    /// The same, smoothed over the shortest width.
    smooth: Vec<f64>,
    /// Seconds of moving before each tick, and in all.
    before_secs: Vec<f64>,
    rests: Vec<Range<usize>>,
}

impl Movement {
    pub(super) fn of(rows: &Rows, layout: RowLayout, tick_hz: f64) -> Self {
        let speed = speed(rows, layout, tick_hz);
        let smooth = smoothed(&speed, WIDTHS_SECS[0] * tick_hz);
        let share: Vec<f64> = smooth.iter().map(|s| s * s / (s * s + 1.0)).collect();
        let mut before_secs = Vec::with_capacity(share.len() + 1);
        before_secs.push(0.0);
        let mut sum = 0.0;
        for share in &share {
            sum += share / tick_hz;
            before_secs.push(sum);
        }
        let least = (LEAST_REST_SECS * tick_hz).round() as usize;
        Self {
            tick_hz,
            speed,
            smooth,
            before_secs,
            rests: rests(&share, least),
        }
    }

    /// Seconds of moving in all.
    pub(super) fn moving_secs(&self) -> f64 {
        self.moving_between(0, self.speed.len())
    }

    fn moving_between(&self, start: usize, stop: usize) -> f64 {
        self.before_secs[stop] - self.before_secs[start]
    }

    /// Candidates of the clip, by start and stop. 7 to 12 a second of motion.
    pub(super) fn candidates(&self, clip: usize) -> Vec<MovingStretch> {
        let mut spans = Vec::new();
        for width in WIDTHS_SECS {
            let bounds = self.bounds(width * self.tick_hz);
            for (i, &start) in bounds.iter().enumerate() {
                spans.extend(
                    bounds[i + 1..]
                        .iter()
                        .take(AHEAD)
                        .map(|&stop| (start, stop)),
                );
            }
        }
        spans.sort_unstable();
        spans.dedup();
        let stretch = |(start, stop)| MovingStretch {
            clip,
            start,
            stop,
            moving_secs: self.moving_between(start, stop),
        };
        let stretches = spans.into_iter().map(stretch);
        stretches.filter(|s| self.may_be(s)).collect()
    }

    fn may_be(&self, of: &MovingStretch) -> bool {
        let secs = of.ticks() as f64 / self.tick_hz;
        if !LENGTHS_SECS.contains(&secs)
            || of.moving_secs < LEAST_MOVING_SECS
            || of.moving_secs < LEAST_MOVING_SHARE * secs
        {
            return false;
        }
        let first = self.rests.partition_point(|rest| rest.end <= of.start);
        let inside = self.rests[first..]
            .iter()
            .take_while(|rest| rest.start < of.stop);
        inside
            .map(|rest| rest.end.min(of.stop) - rest.start.max(of.start))
            .all(|ticks| ticks as f64 <= LONGEST_REST_SECS * self.tick_hz)
    }

    /// Minima of speed at a width in ticks, moved to the nearest slow one of the shortest width; ends of rests and of the clip.
    fn bounds(&self, width: f64) -> Vec<usize> {
        let ticks = self.speed.len();
        let fine = self.minima(&self.smooth);
        let mut bounds: Vec<usize> = self.minima(&smoothed(&self.speed, width));
        for bound in &mut bounds {
            *bound = self.refined(*bound, &fine, 1.5 * width);
        }
        bounds.extend(self.rests.iter().flat_map(|rest| [rest.start, rest.end]));
        bounds.extend([0, ticks]);
        bounds.sort_unstable();
        bounds.dedup();
        bounds
    }

    /// Minima that do not lie inside a rest.
    fn minima(&self, speed: &[f64]) -> Vec<usize> {
        let inside = |tick: usize| {
            let at = self.rests.partition_point(|rest| rest.end <= tick + 1);
            self.rests.get(at).is_some_and(|rest| rest.start < tick)
        };
        let is_least = |w: &[f64]| w[1] <= w[0] && w[1] < w[2];
        let least = speed.windows(3).zip(1..).filter(|(w, _)| is_least(w));
        least
            .map(|(_, tick)| tick)
            .filter(|&tick| !inside(tick))
            .collect()
    }

    /// The minimum of `fine` that is near and slow: a tick of distance counts as half a radian a second.
    fn refined(&self, bound: usize, fine: &[usize], reach: f64) -> usize {
        let price = |at: usize| at.abs_diff(bound) as f64 + 2.0 * self.smooth[at];
        let right = fine.partition_point(|&at| at < bound);
        let beside = [right.checked_sub(1), (right < fine.len()).then_some(right)];
        let beside = beside.into_iter().flatten().map(|i| fine[i]);
        let Some(near) = beside.min_by_key(|at| at.abs_diff(bound)) else {
            return bound;
        };
        if near.abs_diff(bound) as f64 > reach {
            return bound;
        }
        // Nothing farther than the nearest one's price can be cheaper.
        let most = price(near).ceil() as usize;
        let first = fine.partition_point(|&at| at + most < bound);
        let within = fine[first..].iter().take_while(|&&at| at <= bound + most);
        let cheapest = within
            .copied()
            .min_by(|&a, &b| price(a).total_cmp(&price(b)));
        cheapest.unwrap_or(near)
    }
}

/// Root of the summed squares of the directions' changes a second.
fn speed(rows: &Rows, layout: RowLayout, tick_hz: f64) -> Vec<f64> {
    let at = |tick: usize| -> f64 {
        let (before, after) = (rows.row(tick - 1), rows.row(tick + 1));
        let squares = layout
            .directions()
            .map(|k| f64::from(after[k] - before[k]).powi(2));
        squares.sum::<f64>().sqrt() * tick_hz / 2.0
    };
    match rows.len() {
        few @ 0..3 => vec![0.0; few],
        ticks => (0..ticks)
            .map(|tick| at(tick.clamp(1, ticks - 2)))
            .collect(),
    }
}

/// Convolution with a Gaussian of this width in ticks, up to three widths away; ends go on as they are.
fn smoothed(values: &[f64], width: f64) -> Vec<f64> {
    let reach = (3.0 * width).ceil() as usize;
    let weights: Vec<f64> = (0..=2 * reach)
        .map(|i| (i as f64 - reach as f64) / width)
        .map(|x| crate::math::portable::exp(-0.5 * x * x))
        .collect();
    let sum: f64 = weights.iter().sum();
    let last = values.len().saturating_sub(1);
    let at = |tick: usize| {
        let near = weights.iter().enumerate();
        let weighted = near.map(|(i, w)| w * values[(tick + i).saturating_sub(reach).min(last)]);
        weighted.sum::<f64>() / sum
    };
    (0..values.len()).map(at).collect()
}

/// Stretches of `least` ticks or more with less than [`REST_SHARE`] of moving.
fn rests(share: &[f64], least: usize) -> Vec<Range<usize>> {
    let mut rests = Vec::new();
    let mut start = 0;
    for tick in 0..=share.len() {
        if share.get(tick).is_none_or(|share| *share >= REST_SHARE) {
            if tick - start >= least {
                rests.push(start..tick);
            }
            start = tick + 1;
        }
    }
    rests
}
