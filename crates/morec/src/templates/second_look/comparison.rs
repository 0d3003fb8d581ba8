//! One comparison of a segment, from end to end, with every taught sample.

use multiversion::multiversion;

use crate::classes::ClassId;
use crate::features::Rows;
use crate::math::portable;
use crate::templates::Metric;

use super::LOOK_COLUMNS;
use super::model::SecondLook;
use super::segment::SEGMENT_ROWS;

/// Rows off the diagonal that the alignment may go.
const BAND: usize = 6;
/// Exponent by which the spread of both segments normalises their distance.
const EXPONENT: f32 = 0.85;
/// Least share of the typical spread that normalises: segments that hardly move must not be near everything.
const LEAST_SPREAD: f32 = 0.05;
/// Of the atlas, the distance that counts is that of its third nearest stretch.
pub const NEAREST_OF_ATLAS: usize = 3;
/// Distances below this are as good as none.
const LEAST_DISTANCE: f32 = 1e-3;
/// Values of a row, padded to whole lanes.
const LANES: usize = 8;
const PADDED: usize = LOOK_COLUMNS.next_multiple_of(LANES);
const SEGMENT: usize = SEGMENT_ROWS * PADDED;

/// What a segment is, and how surely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged {
    /// Class of the nearest sample.
    pub class: ClassId,
    /// `ln(s_T / d₁)`, `ln(c₃ / d₁)`, or their mean: see [`SecondLook`].
    pub score: f32,
}

/// Segments after the metric, each with its spread and its noise.
#[derive(Debug, Clone, Default)]
struct MappedSegments {
    /// [`SEGMENT`] values each.
    values: Vec<f32>,
    spreads: Vec<f32>,
    noises: Vec<f32>,
    /// [`PADDED`] values each.
    means: Vec<f32>,
}

/// A model laid out for comparing. Nothing is allocated after construction.
#[derive(Debug, Clone)]
pub struct Comparison {
    metric: Metric,
    classes: Vec<ClassId>,
    samples: MappedSegments,
    atlas: MappedSegments,
    typical_spread: f32,
    scale: f32,
    has_scale: bool,
    /// Scores from it down need not be exact where the atlas counts.
    bound: f32,
    /// Distances from it on need not be exact, see [`for_reports`](Self::for_reports).
    farthest: f32,
    mapped: Vec<f32>,
    segment: Vec<f32>,
    /// Of the segment.
    noise: f32,
    mean: [f32; PADDED],
    /// Segments by the distance of their means, which is room for the samples and for the atlas.
    order: Vec<(f32, usize)>,
}

impl Comparison {
    /// Maps the segments of `model`. O(samples · d²).
    pub fn new(model: &SecondLook) -> Self {
        let metric = Metric::new(&model.ridged, &model.total);
        let samples = MappedSegments::mapped(&metric, &model.segments);
        let atlas = MappedSegments::mapped(&metric, &model.atlas);
        Self {
            classes: model.classes.clone(),
            typical_spread: median_of(&mut samples.spreads.clone()).max(1e-6),
            order: Vec::with_capacity(samples.spreads.len().max(atlas.spreads.len())),
            mean: [0.0; PADDED],
            atlas,
            samples,
            scale: model.scale,
            has_scale: model.scale > 0.0,
            bound: model.bound,
            farthest: f32::MAX,
            mapped: vec![0.0; SEGMENT_ROWS * metric.dim()],
            segment: vec![0.0; SEGMENT],
            noise: 0.0,
            metric,
        }
    }

    /// The same for deciding alone: the score of a segment that does not exceed the bound may be any that does not.
    pub fn for_reports(model: &SecondLook) -> Self {
        let comparison = Self::new(model);
        let at_bound = model.scale / portable::exp(f64::from(model.bound)) as f32;
        match model.atlas.is_empty() {
            true => Self {
                farthest: at_bound.max(LEAST_DISTANCE),
                ..comparison
            },
            false => comparison,
        }
    }

    /// Judges a segment of [`SEGMENT_ROWS`] rows of the model's columns. O(samples · rows · band · d).
    pub fn judge(&mut self, segment: &[f32]) -> Judged {
        let nobody = Judged {
            class: ClassId(0),
            score: f32::MIN,
        };
        self.judge_among(segment, |_| true).unwrap_or(nobody)
    }

    /// The same among the samples that count; `None` if none does.
    pub fn judge_among(
        &mut self,
        segment: &[f32],
        counts: impl Fn(usize) -> bool,
    ) -> Option<Judged> {
        let spread = self.map(segment);
        let mut best: Option<(f32, ClassId)> = None;
        self.samples.sort_by_mean(&self.mean, &mut self.order);
        let order = self.order.iter().map(|(_, sample)| *sample);
        for sample in order.filter(|sample| counts(*sample)) {
            let most = best.map_or(self.farthest, |(distance, _)| distance.min(self.farthest));
            let distance = self.distance(&self.samples, sample, spread, most);
            if best.is_none() || distance < most {
                best = Some((distance, self.classes[sample]));
            }
        }
        let (nearest, class) = best?;
        let score = self.score(spread, nearest);
        Some(Judged { class, score })
    }

    /// The score of a segment of this spread whose nearest sample is `nearest` away.
    fn score(&mut self, spread: f32, nearest: f32) -> f32 {
        let nearest = nearest.max(LEAST_DISTANCE);
        match self.atlas.spreads.is_empty() {
            true => portable::ln(f64::from(self.scale / nearest)) as f32,
            false => self.against_atlas(spread, nearest),
        }
    }

    /// Distances of a segment to every sample, in their order, and its score.
    pub fn distances_and_score(&mut self, segment: &[f32]) -> (Vec<f32>, f32) {
        let distances = self.distances(segment);
        let nearest = distances.iter().copied().fold(f32::MAX, f32::min);
        let score = self.score(spread_of(&self.segment), nearest);
        (distances, score)
    }

    /// The score beside what other motion is at.
    fn against_atlas(&mut self, spread: f32, nearest: f32) -> f32 {
        let mut found = [f32::MAX; NEAREST_OF_ATLAS];
        let least = match self.has_scale {
            true => 2.0 * self.bound - portable::ln(f64::from(self.scale / nearest)) as f32,
            false => self.bound,
        };
        let refused = nearest * portable::exp(f64::from(least)) as f32;
        self.atlas.sort_by_mean(&self.mean, &mut self.order);
        for (_, stretch) in &self.order {
            let most = found[NEAREST_OF_ATLAS - 1];
            let distance = self.distance(&self.atlas, *stretch, spread, most);
            if distance < most {
                found[NEAREST_OF_ATLAS - 1] = distance;
                found.sort_unstable_by(f32::total_cmp);
                // As near to so much other motion it is refused, whatever the rest is at.
                let third = found[NEAREST_OF_ATLAS - 1];
                if third < f32::MAX && third <= refused {
                    break;
                }
            }
        }
        let against = |of: f32| portable::ln(f64::from(of / nearest)) as f32;
        let other = against(found[NEAREST_OF_ATLAS - 1].max(LEAST_DISTANCE));
        match self.has_scale {
            true => (against(self.scale) + other) / 2.0,
            false => other,
        }
    }

    /// Distances of a segment to every sample, in their order.
    pub fn distances(&mut self, segment: &[f32]) -> Vec<f32> {
        let spread = self.map(segment);
        let distance = |sample| self.distance(&self.samples, sample, spread, f32::MAX);
        (0..self.samples.spreads.len()).map(distance).collect()
    }

    /// Takes a segment through the metric; gives its spread.
    fn map(&mut self, segment: &[f32]) -> f32 {
        let dim = self.metric.dim();
        self.metric.apply_each(segment, &mut self.mapped);
        for (row, out) in self
            .mapped
            .chunks_exact(dim)
            .zip(self.segment.chunks_exact_mut(PADDED))
        {
            out[..dim].copy_from_slice(row);
        }
        self.noise = noise_of(&self.segment);
        self.mean = mean_of(&self.segment);
        spread_of(&self.segment)
    }

    /// `D / max(0.05, (V_T + V_S) / 2 V₀)^0.85`, or anything from `most` on if it is not below. What the segment has of noise beyond the
    /// sample's is taken off `V_S`, and off `D`, of which at most half.
    fn distance(&self, of: &MappedSegments, place: usize, spread: f32, most: f32) -> f32 {
        let noise = (self.noise - of.noises[place]).max(0.0);
        let moved = (spread - noise).max(0.0);
        let spreads = (of.spreads[place] + moved) / (2.0 * self.typical_spread);
        let norm = portable::powf(f64::from(spreads.max(LEAST_SPREAD)), f64::from(EXPONENT)) as f32;
        let taught = &of.values[place * SEGMENT..][..SEGMENT];
        // From here on it is not below `most` when the noise is taken off.
        let least = most * norm;
        let limit = (least + noise).min(least / (1.0 - NOISE_SHARE));
        let plain = warped(taught, &self.segment, limit.min(f32::MAX) * PATH_WEIGHT) / PATH_WEIGHT;
        (plain - noise.min(NOISE_SHARE * plain)) / norm
    }
}

/// Sum of the weights along an alignment.
const PATH_WEIGHT: f32 = (2 * SEGMENT_ROWS) as f32;
/// At most this share of a distance is taken for noise.
const NOISE_SHARE: f32 = 0.5;
/// What noise of variance 1 leaves in the squared fourth difference of rows: the squares of 1 −4 6 −4 1.
const NOISE_GAIN: f32 = 70.0;

/// The squared distance that noise adds to a row: the median of the squared fourth differences, in which motion of a few hertz
/// vanishes (Rice, *Bandwidth choice for nonparametric regression*, 1984).
fn noise_of(segment: &[f32]) -> f32 {
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

/// Samples that the scale is measured on at most.
const MEASURED: usize = 96;

impl SecondLook {
    /// `s_T` of the samples: the median over samples of the median distance from other classes, each at its nearest sample; 0 of one class.
    /// Of many samples evenly spaced ones count. O(samples² · rows · band · d).
    pub fn measured_scale(&self) -> f32 {
        let mut comparison = Comparison::new(self);
        let mut medians = Vec::new();
        let count = self.classes.len();
        for k in 0..count.min(MEASURED) {
            let sample = k * count / count.min(MEASURED);
            let distances = comparison.distances(self.segment(sample));
            let mut nearest = std::collections::BTreeMap::<ClassId, f32>::new();
            for (class, distance) in self.classes.iter().zip(distances) {
                if *class != self.classes[sample] {
                    let least = nearest.entry(*class).or_insert(f32::MAX);
                    *least = least.min(distance);
                }
            }
            let mut others: Vec<f32> = nearest.into_values().collect();
            if !others.is_empty() {
                medians.push(median_of(&mut others));
            }
        }
        median_of(&mut medians)
    }
}

impl MappedSegments {
    fn mapped(metric: &Metric, rows: &Rows) -> Self {
        let dim = metric.dim();
        let mapped = metric.apply_all(rows);
        let mut values = vec![0.0; rows.len() * PADDED];
        for (row, out) in mapped.iter().zip(values.chunks_exact_mut(PADDED)) {
            out[..dim].copy_from_slice(row);
        }
        let spreads = values.chunks_exact(SEGMENT).map(spread_of).collect();
        let noises = values.chunks_exact(SEGMENT).map(noise_of).collect();
        let means = values.chunks_exact(SEGMENT).flat_map(mean_of).collect();
        Self {
            values,
            spreads,
            noises,
            means,
        }
    }

    /// Writes the places of all segments to `order`, the one whose mean is the nearest to `mean` first: the nearest segments come early, and
    /// most others are given up after a few rows.
    fn sort_by_mean(&self, mean: &[f32; PADDED], order: &mut Vec<(f32, usize)>) {
        let means = self.means.chunks_exact(PADDED).enumerate();
        order.clear();
        order.extend(means.map(|(place, of)| (squared(of, mean), place)));
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }
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

/// Mean of a segment's rows.
fn mean_of(segment: &[f32]) -> [f32; PADDED] {
    let mut mean = [0.0; PADDED];
    for row in segment.chunks_exact(PADDED) {
        for (mean, value) in mean.iter_mut().zip(row) {
            *mean += value / SEGMENT_ROWS as f32;
        }
    }
    mean
}

/// Mean squared distance of a segment's rows from their mean.
fn spread_of(segment: &[f32]) -> f32 {
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

/// Cost of the cheapest path that aligns all rows of both segments: steps that go on in both count twice, in one of them once (Sakoe and
/// Chiba 1978, symmetric weights), within [`BAND`] rows of the diagonal. `f32::MAX` where every path costs `limit` or more.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn warped(a: &[f32], b: &[f32], limit: f32) -> f32 {
    const WIDTH: usize = 2 * BAND + 1;
    const OUTSIDE: f32 = f32::MAX;
    // Of the row before, at place `j - i + BAND`; one more on each side stays outside.
    let mut before = [OUTSIDE; WIDTH + 2];
    for i in 0..SEGMENT_ROWS {
        let mut here = [OUTSIDE; WIDTH + 2];
        let row = &a[i * PADDED..][..PADDED];
        let mut least = OUTSIDE;
        for k in 0..WIDTH {
            let Some(j) = (i + k).checked_sub(BAND).filter(|j| *j < SEGMENT_ROWS) else {
                continue;
            };
            let cost = squared(row, &b[j * PADDED..][..PADDED]);
            let total = match (i, j) {
                (0, 0) => 2.0 * cost,
                _ => {
                    let both = before[k + 1] + 2.0 * cost;
                    both.min(before[k + 2] + cost).min(here[k] + cost)
                }
            };
            here[k + 1] = total;
            least = least.min(total);
        }
        if least >= limit {
            return OUTSIDE;
        }
        before = here;
    }
    before[BAND + 1]
}

#[inline(always)]
fn squared(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0f32; LANES];
    let (a, _) = a.as_chunks::<LANES>();
    let (b, _) = b.as_chunks::<LANES>();
    for (a, b) in a.iter().zip(b) {
        let apart: [f32; LANES] = std::array::from_fn(|lane| a[lane] - b[lane]);
        sums = std::array::from_fn(|lane| sums[lane] + apart[lane] * apart[lane]);
    }
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// The cost of aligning rows of one value each.
#[cfg(test)]
pub(super) fn warped_rows(a: &[f64], b: &[f64]) -> f32 {
    let spread = |values: &[f64]| {
        let mut rows = vec![0.0f32; SEGMENT];
        for (row, value) in rows.chunks_exact_mut(PADDED).zip(values) {
            row[0] = *value as f32;
        }
        rows
    };
    warped(&spread(a), &spread(b), f32::MAX)
}
