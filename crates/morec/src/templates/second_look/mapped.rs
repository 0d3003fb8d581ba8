//! Training segments and stretches of other motion, laid out for fast comparison.

use crate::features::Rows;
use crate::math::portable;
use crate::templates::Metric;

use super::bounds::{CoarseBasis, CoarseBlock, SketchBlock};
use super::segment::{LANES, PADDED, SEGMENT, SEGMENT_ROWS};

/// Exponent by which the spread of both segments normalises their distance.
const EXPONENT: f32 = 0.85;
/// Least share of the typical spread that normalises: segments that hardly move must not be near everything.
const LEAST_SPREAD: f32 = 0.05;

/// Segments after the metric, each with its spread and its noise.
#[derive(Debug, Clone, Default)]
pub struct MappedSegments {
    /// [`SEGMENT`] values each.
    pub values: Vec<f32>,
    pub spreads: Vec<f32>,
    pub noises: Vec<f32>,
    pub coarse: Vec<CoarseBlock>,
    pub sketches: Vec<SketchBlock>,
    /// Of each segment the tangent of its [`divisor`] where both spreads are its own: value and slope.
    pub tangents: Vec<(f32, f32)>,
}

impl MappedSegments {
    pub fn of(values: Vec<f32>, basis: &CoarseBasis) -> Self {
        let segments = || values.chunks_exact(SEGMENT);
        let (coarse, sketches) = basis.blocks(&values);
        Self {
            spreads: segments().map(spread_of).collect(),
            noises: segments().map(noise_of).collect(),
            tangents: Vec::new(),
            coarse,
            sketches,
            values,
        }
    }

    /// Sets the tangents, for spreads that are shares of `typical`.
    pub fn set_tangents(&mut self, typical: f32) {
        let of_spread = |spread: &f32| {
            // A power below 1 is concave, so its tangents lie above it.
            let share = (spread / typical).max(LEAST_SPREAD);
            let at_own = divisor(share);
            let slope = EXPONENT * at_own / (2.0 * share * typical);
            (at_own, slope)
        };
        self.tangents = self.spreads.iter().map(of_spread).collect();
    }
}

/// Rows after the metric, padded.
pub fn mapped_rows(metric: &Metric, rows: &Rows) -> Vec<f32> {
    let dim = metric.dim();
    let mapped = metric.apply_all(rows);
    let mut values = vec![0.0; rows.len() * PADDED];
    for (row, out) in mapped.iter().zip(values.chunks_exact_mut(PADDED)) {
        out[..dim].copy_from_slice(row);
    }
    values
}

/// Mean squared distance of a segment's rows from their mean.
pub fn spread_of(segment: &[f32]) -> f32 {
    let mut mean = [0.0f64; PADDED];
    let mut square = 0.0f64;
    for row in segment.chunks_exact(PADDED) {
        for (mean, value) in mean.iter_mut().zip(row) {
            *mean += f64::from(*value);
            square += f64::from(*value) * f64::from(*value);
        }
    }
    let rows = SEGMENT_ROWS as f64;
    let mean = mean.iter().map(|m| (m / rows) * (m / rows));
    (square / rows - mean.sum::<f64>()).max(0.0) as f32
}

/// What noise of variance 1 leaves in the squared fourth difference of rows: the squares of 1 −4 6 −4 1.
const NOISE_GAIN: f32 = 70.0;

/// The squared distance that noise adds to a row: the median of the squared fourth differences, in which motion of a few hertz
/// vanishes (Rice, *Bandwidth choice for nonparametric regression*, 1984).
pub fn noise_of(segment: &[f32]) -> f32 {
    let rows = || segment.chunks_exact(PADDED);
    let mut squares = [0.0f32; SEGMENT_ROWS - 4];
    let rows = [0, 1, 2, 3, 4].map(|skipped| rows().skip(skipped));
    let [a, b, c, d, e] = rows;
    let windows = a.zip(b).zip(c.zip(d)).zip(e);
    for (square, (((a, b), (c, d)), e)) in squares.iter_mut().zip(windows) {
        for k in 0..PADDED {
            let difference = a[k] - 4.0 * b[k] + 6.0 * c[k] - 4.0 * d[k] + e[k];
            *square += difference * difference / NOISE_GAIN;
        }
    }
    median_of(&mut squares)
}

/// `max(0.05, share)^0.85`.
pub fn divisor(share: f32) -> f32 {
    portable::powf(f64::from(share.max(LEAST_SPREAD)), f64::from(EXPONENT)) as f32
}

/// Of every lane the sum of the squared differences of two rows.
#[inline(always)]
pub fn squares(a: &[f32], b: &[f32]) -> [f32; LANES] {
    let mut sums = [0.0f32; LANES];
    let (a, _) = a.as_chunks::<LANES>();
    let (b, _) = b.as_chunks::<LANES>();
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            let apart = a[lane] - b[lane];
            sums[lane] += apart * apart;
        }
    }
    sums
}

/// The sum of all lanes.
#[inline(always)]
pub fn sum([a, b, c, d, e, f, g, h]: [f32; LANES]) -> f32 {
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// The median, between two of an even number; 0 of none.
pub fn median_of(values: &mut [f32]) -> f32 {
    values.sort_by(f32::total_cmp);
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[n / 2],
        n => (values[n / 2 - 1] + values[n / 2]) / 2.0,
    }
}
