//! Compares one segment, from end to end, with every training sample.

use std::sync::Arc;

use multiversion::multiversion;

use crate::classes::ClassId;
use crate::math::portable;
use crate::templates::Metric;

use super::bounds::{
    CoarseBasis, CoarseRows, SegmentSketch, TOGETHER, apart, least_costs, sketch_of, smaller,
};
use super::mapped::{
    MappedSegments, divisor, mapped_rows, median_of, noise_of, spread_of, squares, sum,
};
use super::model::SecondLook;
use super::segment::{BAND, LANES, PADDED, SEGMENT, SEGMENT_ROWS};

/// Of the atlas, the distance that counts is that of its third nearest stretch.
pub const NEAREST_OF_ATLAS: usize = 3;
/// Distances below this are as good as none.
const LEAST_DISTANCE: f32 = 1e-3;
/// What a segment is, and how surely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged {
    /// Class of the nearest sample.
    pub class: ClassId,
    /// `ln(s_T / d₁)`, `ln(c₃ / d₁)`, or their mean: see [`SecondLook`].
    pub score: f32,
}

/// A model laid out for comparing. Nothing is allocated after construction; copies share the segments.
#[derive(Debug, Clone)]
pub struct Comparison {
    metric: Metric,
    classes: Arc<[ClassId]>,
    samples: Arc<MappedSegments>,
    atlas: Arc<MappedSegments>,
    typical_spread: f32,
    least_divisor: f32,
    scale: f32,
    /// Scores from it down need not be exact, see [`for_reports`](Self::for_reports).
    bound: f32,
    /// Distances from it on need not be exact either.
    farthest: f32,
    /// Segments whose sketch is this many times as far as the distance that counts are left out; infinite to leave out none.
    reach: f32,
    /// Most blocks of segments that are compared: those with the nearest sketches.
    most_blocks: usize,
    mapped: Vec<f32>,
    segment: Vec<f32>,
    basis: Arc<CoarseBasis>,
    /// Of the segment.
    coarse: Box<CoarseRows>,
    sketch: SegmentSketch,
    noise: f32,
    /// Room for the blocks that may hold a near segment, with the distances of their nearest sketches.
    ranked: Vec<(f32, usize)>,
}

impl Comparison {
    /// Maps the segments of `model`. O(samples · d²).
    pub fn new(model: &SecondLook) -> Self {
        let metric = Metric::new(&model.ridged, &model.total);
        let samples = mapped_rows(&metric, &model.segments);
        let basis = CoarseBasis::of(&samples);
        let mut samples = MappedSegments::of(samples, &basis);
        let mut atlas = MappedSegments::of(mapped_rows(&metric, &model.atlas), &basis);
        let typical_spread = median_of(&mut samples.spreads.clone()).max(1e-6);
        samples.set_tangents(typical_spread);
        atlas.set_tangents(typical_spread);
        let coarse = Box::new(basis.rows(&[]));
        Self {
            classes: model.classes.as_slice().into(),
            typical_spread,
            least_divisor: divisor(0.0),
            sketch: sketch_of(&coarse),
            ranked: vec![(0.0, 0); samples.coarse.len().max(atlas.coarse.len())],
            atlas: atlas.into(),
            samples: samples.into(),
            scale: model.scale,
            bound: f32::MIN,
            farthest: f32::MAX,
            reach: f32::INFINITY,
            most_blocks: usize::MAX,
            mapped: vec![0.0; SEGMENT_ROWS * metric.dim()],
            segment: vec![0.0; SEGMENT],
            coarse,
            basis: Arc::new(basis),
            noise: 0.0,
            metric,
        }
    }

    /// The same for deciding alone: the score of a segment that does not exceed the bound may be any that does not, and segments whose
    /// sketch is far are left out, as are all but the 512 that sketches rank first. A decision costs O(samples) for sketches and
    /// O(rows · band · d) for alignments.
    pub fn for_reports(model: &SecondLook) -> Self {
        let at_bound = model.scale / portable::exp(f64::from(model.bound)) as f32;
        Self {
            bound: model.bound,
            farthest: match model.atlas.is_empty() {
                true => at_bound.max(LEAST_DISTANCE),
                false => f32::MAX,
            },
            reach: SKETCH_REACH,
            most_blocks: MOST_BLOCKS,
            ..Self::new(model)
        }
    }

    /// The same for a model with another scale.
    #[cfg(feature = "train")]
    pub(crate) fn with_scale(self, scale: f32) -> Self {
        Self { scale, ..self }
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
        let mut least = self.farthest;
        let limits = (spread, least);
        let mut ranked = std::mem::take(&mut self.ranked);
        let samples = (&*self.samples, ranked.as_mut_slice());
        self.search(samples, limits, counts, |sample, distance| {
            if best.is_none() || distance < least {
                best = Some((distance, self.classes[sample]));
                least = least.min(distance);
            }
            least
        });
        self.ranked = ranked;
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

    /// The score relative to the distance of other motion.
    fn against_atlas(&mut self, spread: f32, nearest: f32) -> f32 {
        let mut found = [f32::MAX; NEAREST_OF_ATLAS];
        let least = match self.scale > 0.0 {
            true => 2.0 * self.bound - portable::ln(f64::from(self.scale / nearest)) as f32,
            false => self.bound,
        };
        let refused = nearest * portable::exp(f64::from(least)) as f32;
        let mut ranked = std::mem::take(&mut self.ranked);
        self.search(
            (&*self.atlas, ranked.as_mut_slice()),
            (spread, f32::MAX),
            |_| true,
            |_, distance| {
                let [.., third] = &mut found;
                if distance < *third {
                    *third = distance;
                    found.sort_unstable_by(f32::total_cmp);
                }
                // So near to the third, it is refused, however near the rest is.
                match found[NEAREST_OF_ATLAS - 1] {
                    third if third < f32::MAX && third <= refused => f32::MIN,
                    third => third,
                }
            },
        );
        self.ranked = ranked;
        let against = |of: f32| portable::ln(f64::from(of / nearest)) as f32;
        let other = against(found[NEAREST_OF_ATLAS - 1].max(LEAST_DISTANCE));
        match self.scale > 0.0 {
            true => (against(self.scale) + other) / 2.0,
            false => other,
        }
    }

    /// Distances of a segment to every sample, in their order.
    pub fn distances(&mut self, segment: &[f32]) -> Vec<f32> {
        let all: Vec<usize> = (0..self.samples.spreads.len()).collect();
        self.distances_to(segment, &all)
    }

    /// Distances of a segment to some samples.
    pub fn distances_to(&mut self, segment: &[f32], samples: &[usize]) -> Vec<f32> {
        let spread = self.map(segment);
        let distance = |sample: &usize| self.distance(&self.samples, *sample, spread, f32::MAX);
        samples.iter().map(distance).collect()
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
        *self.coarse = self.basis.rows(&self.segment);
        self.sketch = sketch_of(&self.coarse);
        spread_of(&self.segment)
    }

    /// Calls `take` with place and distance of each segment of `of` that `counts` admits, in the order of their blocks' nearest sketches.
    /// Segments are left out by their lower bound and, for reports, by their sketch. `take` returns the distance from which on segments may be
    /// left out, at first `most`; below zero, the search ends.
    fn search(
        &self,
        (of, ranked): (&MappedSegments, &mut [(f32, usize)]),
        (spread, mut most): (f32, f32),
        counts: impl Fn(usize) -> bool,
        mut take: impl FnMut(usize, f32) -> f32,
    ) {
        let count = self.rank(of, ranked, spread, most);
        for (nearest, block) in &ranked[..count.min(self.most_blocks)] {
            if most < 0.0 || *nearest >= self.reach * most {
                return;
            }
            let first = block * TOGETHER;
            let limits = std::array::from_fn(|lane| self.limit(of, first + lane, spread, most));
            let costs = least_costs(&of.coarse[*block], &self.coarse, &limits);
            let mut lanes: [usize; TOGETHER] = std::array::from_fn(|lane| lane);
            lanes.sort_unstable_by(|a, b| costs[*a].total_cmp(&costs[*b]));
            for lane in lanes {
                let place = first + lane;
                if costs[lane] < self.limit(of, place, spread, most) && counts(place) {
                    most = take(place, self.distance(of, place, spread, most));
                }
            }
        }
    }

    /// Puts the blocks of `of` whose nearest sketch is within reach of `most` into `ranked`, the nearest first; gives how many there are.
    fn rank(
        &self,
        of: &MappedSegments,
        ranked: &mut [(f32, usize)],
        spread: f32,
        most: f32,
    ) -> usize {
        let mut count = 0;
        for (block, sketches) in of.sketches.iter().enumerate() {
            let costs = apart(sketches, &self.sketch);
            let places = (block * TOGETHER..of.spreads.len()).zip(costs);
            let distance = |(place, cost)| self.bounded(of, place, spread, cost);
            let nearest = places.map(distance).fold(f32::INFINITY, smaller);
            if nearest < self.reach * most {
                ranked[count] = (nearest, block);
                count += 1;
            }
        }
        ranked[..count].sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        count
    }

    /// Of each class but `except` the distance of its nearest sample. O(samples · rows · band).
    fn nearest_of_classes(&mut self, segment: &[f32], except: ClassId) -> Vec<f32> {
        let spread = self.map(segment);
        let of = &*self.samples;
        let open = [f32::INFINITY; TOGETHER];
        let costs = (of.coarse.iter()).flat_map(|block| least_costs(block, &self.coarse, &open));
        let places = self.classes.iter().zip(costs).enumerate();
        let others = places.filter(|(_, (class, _))| **class != except);
        let mut bounds: Vec<(ClassId, f32, usize)> = others
            .map(|(place, (class, cost))| {
                let bound = self.bounded(of, place, spread, cost / ROUNDING);
                (*class, bound, place)
            })
            .collect();
        bounds.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let of_class = bounds.chunk_by(|a, b| a.0 == b.0);
        let nearest = of_class.map(|bounds| {
            let mut least = f32::MAX;
            for (_, bound, place) in bounds {
                if *bound >= least {
                    break;
                }
                least = least.min(self.distance(of, *place, spread, least));
            }
            least
        });
        nearest.collect()
    }

    /// The cost of an alignment from which on the distance is `most` or more; below every cost where there is no segment.
    fn limit(&self, of: &MappedSegments, place: usize, spread: f32, most: f32) -> f32 {
        if place >= of.spreads.len() {
            return f32::MIN;
        }
        let (noise, divisor) = self.noise_and_divisor(of, place, spread);
        Self::cost_of(most * divisor, noise) * ROUNDING
    }

    /// The segment's noise beyond that of a sample, and an upper bound of what its distance from it is divided by.
    fn noise_and_divisor(&self, of: &MappedSegments, place: usize, spread: f32) -> (f32, f32) {
        let (noise, moved) = self.noise_and_spread(spread, of.noises[place]);
        let (at_own, slope) = of.tangents[place];
        let divisor = at_own + slope * (moved - of.spreads[place]);
        (noise, divisor.max(self.least_divisor))
    }

    /// A distance of the sample that is no larger than its own where `cost` is no larger than that of its alignment.
    fn bounded(&self, of: &MappedSegments, place: usize, spread: f32, cost: f32) -> f32 {
        let (noise, divisor) = self.noise_and_divisor(of, place, spread);
        let mean = cost / PATH_WEIGHT;
        (mean - noise.min(NOISE_SHARE * mean)) / divisor
    }

    /// The segment's noise beyond that of a sample, and its spread without it.
    fn noise_and_spread(&self, spread: f32, noise_of_sample: f32) -> (f32, f32) {
        let noise = (self.noise - noise_of_sample).max(0.0);
        (noise, (spread - noise).max(0.0))
    }

    /// The cost of an alignment whose mean, less the noise, is `mean`.
    fn cost_of(mean: f32, noise: f32) -> f32 {
        (mean + noise).min(mean / (1.0 - NOISE_SHARE)).min(f32::MAX) * PATH_WEIGHT
    }

    /// `D / max(0.05, (V_T + V_S) / 2 V₀)^0.85`, or anything from `most` on if it is not below. What the segment has of noise beyond the
    /// sample's is taken off `V_S`, and off `D`, of which at most half.
    fn distance(&self, of: &MappedSegments, place: usize, spread: f32, most: f32) -> f32 {
        let (noise, moved) = self.noise_and_spread(spread, of.noises[place]);
        let spreads = (of.spreads[place] + moved) / (2.0 * self.typical_spread);
        let norm = divisor(spreads);
        let taught = &of.values[place * SEGMENT..][..SEGMENT];
        // From here on it is not below `most` when the noise is taken off.
        let plain = warped(taught, &self.segment, Self::cost_of(most * norm, noise)) / PATH_WEIGHT;
        (plain - noise.min(NOISE_SHARE * plain)) / norm
    }
}

/// For reports, a segment is left out if its sketch is this many times as far as the distance from which on segments do not count. Chosen on
/// sessions of actions (254 detections) and of gestures (508): with 1 all are the same as with all segments, with 0.7 eight of the 254
/// differ. With 1 the 45 detections of both indexes in `referee`, `cmu`, `everyday` and `exercises` are the same, too.
const SKETCH_REACH: f32 = 1.0;
/// Blocks of segments that are compared for reports at most: 512 segments. Samples of a class are neighbours, so that a block holds about a
/// class. Chosen on made classes with one of six people kept back: for 100 classes (1,346 segments), detections are the same with 16, 32, 64
/// and all blocks; for 500 classes (6,839 segments), three of 454 differ from those with all, and F1 is the same.
const MOST_BLOCKS: usize = 32;
/// The bound and the cost are rounded differently: by less than this.
const ROUNDING: f32 = 1.001;
/// Sum of the weights along an alignment.
const PATH_WEIGHT: f32 = (2 * SEGMENT_ROWS) as f32;
/// At most this share of a distance is taken for noise.
const NOISE_SHARE: f32 = 0.5;
/// Samples that the scale is measured on at most.
const MEASURED: usize = 96;

impl SecondLook {
    /// `s_T` of the samples: the median over samples of the median distance from other classes, each at its nearest sample; 0 of one class.
    /// Of many samples evenly spaced ones count. O(samples² · rows · band · d).
    pub fn measured_scale(&self) -> f32 {
        self.scale_by(&mut Comparison::new(self))
    }

    /// The same with a comparison of this model.
    pub(crate) fn scale_by(&self, comparison: &mut Comparison) -> f32 {
        let count = self.classes.len();
        let measured = (0..count.min(MEASURED)).map(|k| k * count / count.min(MEASURED));
        let median = |sample: usize| {
            let class = self.classes[sample];
            let mut others = comparison.nearest_of_classes(self.segment(sample), class);
            (!others.is_empty()).then(|| median_of(&mut others))
        };
        let mut medians: Vec<f32> = measured.filter_map(median).collect();
        median_of(&mut medians)
    }
}

/// Cost of the cheapest path that aligns all rows of both segments: steps that go on in both count twice, in one of them once (Sakoe and
/// Chiba 1978, symmetric weights), within [`BAND`] rows of the diagonal. `f32::MAX` where every path costs `limit` or more.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn warped(a: &[f32], b: &[f32], limit: f32) -> f32 {
    const CELLS: usize = 2 * BAND + 1;
    const OUTSIDE: f32 = f32::INFINITY;
    // Of the row before, at place `j - i + BAND`; the place behind them stays outside.
    let mut before = [OUTSIDE; CELLS + 1];
    for i in 0..SEGMENT_ROWS {
        let row = &a[i * PADDED..][..PADDED];
        let cells = BAND.saturating_sub(i)..CELLS.min(SEGMENT_ROWS + BAND - i);
        let others = b[(i + cells.start - BAND) * PADDED..].chunks_exact(PADDED);
        // Summed apart from the sums of lanes: together they are compiled to half the lanes.
        let mut lanes = [[0.0; LANES]; CELLS];
        for (lanes, other) in lanes[cells.clone()].iter_mut().zip(others) {
            *lanes = squares(row, other);
        }
        let mut costs = [OUTSIDE; CELLS];
        for (cost, lanes) in costs[cells.clone()].iter_mut().zip(&lanes[cells]) {
            *cost = sum(*lanes);
        }
        let (mut reached, mut least) = (OUTSIDE, OUTSIDE);
        for (k, cost) in costs.into_iter().enumerate() {
            let both = smaller(before[k] + 2.0 * cost, before[k + 1] + cost);
            reached = match (i, k) {
                (0, BAND) => 2.0 * cost,
                _ => smaller(both, reached + cost),
            };
            least = smaller(least, reached);
            before[k] = reached;
        }
        if least >= limit {
            return f32::MAX;
        }
    }
    before[BAND]
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
