//! The verifier: a learned examination of each candidate as a whole stretch.
//!
//! Warping finds where a class could be and is generous with it. The verifier compares the whole stretch, at eight
//! even steps, with stretches that were the class and stretches that only came near it, and weighs how near the
//! class is against how near everything else is.

use std::sync::Arc;

use crate::classes::ClassId;
use crate::decode::Candidate;
use crate::features::Rows;
use crate::math::portable;

use super::Metric;
use super::OperatingPoint;
use super::kernel::{self, LANES, Lanes, interleaved};

/// Rows that a stretch is resampled to.
pub const SHAPE_ROWS: usize = 8;

/// Distances below this share of the threshold count as equally good: people trained on are alike, new ones are
/// not, and nearer than near must not be held against anybody.
const NEAR_ENOUGH: f64 = 0.6;
/// Distances are cut off here: beyond it everything is equally far.
const CUT: f64 = 6.0;
/// Missing distances (no other class, no negatives) count as this.
const NOTHING_NEAR: f64 = 9.0;

/// Distances of a stretch from a class and from what it should not be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// Smallest distance to the class's templates.
    pub distance: f64,
    /// Smallest distance to another class's templates around its end.
    pub other: f64,
    /// Smallest distance to a negative template around its end.
    pub negative: f64,
}

impl Evidence {
    /// Distances from here on count alike.
    pub const REACH: f32 = NOTHING_NEAR as f32;

    /// What the verifier looks at in a candidate.
    pub fn of(candidate: &Candidate) -> Self {
        let Candidate {
            distance,
            other,
            negative,
            ..
        } = *candidate;
        Self {
            distance: distance.into(),
            other: other.into(),
            negative: negative.into(),
        }
    }

    /// Three logarithmic ratios, each bounded: to the threshold, to other classes, to negatives.
    pub fn ratios(&self, threshold: f64) -> [f64; 3] {
        let bounded =
            |ratio: f64| portable::ln(ratio.max(1e-3)).clamp(portable::ln(NEAR_ENOUGH), 2.0);
        let (other, negative) = (
            self.other.clamp(1e-3, NOTHING_NEAR),
            self.negative.clamp(1e-3, NOTHING_NEAR),
        );
        [
            bounded(self.distance / threshold),
            bounded(self.distance / other),
            bounded(self.distance / negative),
        ]
    }

    /// Four values beside the shape in the class kernels.
    pub fn beside_shape(&self, threshold: f64) -> [f64; 4] {
        let (other, negative) = (
            self.other.clamp(0.1, NOTHING_NEAR),
            self.negative.min(NOTHING_NEAR),
        );
        [
            self.distance.max(NEAR_ENOUGH * threshold).min(CUT),
            (self.distance / other).clamp(NEAR_ENOUGH, CUT),
            negative.min(CUT),
            (self.distance / negative.max(0.1)).clamp(NEAR_ENOUGH, CUT),
        ]
    }
}

/// `rows` at [`SHAPE_ROWS`] even steps from first to last, linearly between rows, one after the other into `out`
/// (`SHAPE_ROWS · dim` values). `row(i)` gives row `i` of `len`, which must be positive.
pub fn shape_of<'r>(len: usize, row: impl Fn(usize) -> &'r [f32], out: &mut [f32]) {
    let dim = row(0).len();
    for (step, out) in out.chunks_exact_mut(dim).enumerate() {
        let at = step as f32 * (len - 1) as f32 / (SHAPE_ROWS - 1) as f32;
        let before = (at as usize).min(len.saturating_sub(2));
        let (a, b, t) = (
            row(before),
            row((before + 1).min(len - 1)),
            at - before as f32,
        );
        for ((o, a), b) in out.iter_mut().zip(a).zip(b) {
            *o = a * (1.0 - t) + b * t;
        }
    }
}

/// Common weights of evidence for all classes: a linear score of standardised ratios, bounded to ±1.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LinearScore {
    /// Mean of each ratio in training.
    pub mean: [f64; 3],
    /// Standard deviation of each ratio in training.
    pub deviation: [f64; 3],
    /// Constant and a weight for each ratio.
    pub weights: [f64; 4],
}

impl LinearScore {
    /// The score: above 0 for, below 0 against.
    pub fn score(&self, ratios: &[f64; 3]) -> f64 {
        let mut sum = self.weights[0];
        for k in 0..3 {
            sum += self.weights[k + 1] * (ratios[k] - self.mean[k]) / self.deviation[k];
        }
        sum.clamp(-1.0, 1.0)
    }
}

/// One class's stretches that were and that were not it, and what each says of a stretch like it.
#[derive(Debug, Clone, PartialEq)]
pub struct Exemplars {
    /// The class that they decide about.
    pub class: ClassId,
    /// Shapes, before the metric: `SHAPE_ROWS` rows for each exemplar.
    pub shapes: Rows,
    /// [`Evidence::beside_shape`] of each exemplar.
    pub beside: Vec<[f32; 4]>,
    /// Weight of each exemplar.
    pub weights: Vec<f32>,
    /// `1 / (2 s²)` of the Gaussian kernel.
    pub sharpness: f32,
}

impl Exemplars {
    /// Number of exemplars.
    pub fn len(&self) -> usize {
        self.weights.len()
    }

    /// True if there is none.
    pub fn is_empty(&self) -> bool {
        self.weights.is_empty()
    }
}

/// Weighs candidates: kernel ridge regression on top of the generic score.
#[derive(Debug, Clone, PartialEq)]
pub struct Verifier {
    /// Candidates farther than this are not looked at.
    pub reach: f32,
    /// Scores must be above this.
    pub bar: f64,
    /// The bar for other rates of false alarms: each point's threshold is a score. Empty in indexes of older versions.
    pub operating: Vec<OperatingPoint>,
    /// The part common to all classes.
    pub generic: LinearScore,
    /// The parts of single classes.
    pub classes: Vec<Exemplars>,
}

/// Evidence is measured in deviations, so that weights are a few at most.
const LARGEST_WEIGHT: f32 = 1e4;

impl Verifier {
    /// Says which part does not fit the others, if one does not.
    ///
    /// # Errors
    /// The name of the part that does not fit.
    pub fn check(&self, classes: usize) -> Result<(), String> {
        for exemplars in &self.classes {
            let n = exemplars.len();
            if exemplars.class.index() >= classes {
                return Err(format!(
                    "exemplars of class {}, of {classes}",
                    exemplars.class.0
                ));
            }
            if exemplars.shapes.len() != n * SHAPE_ROWS || exemplars.beside.len() != n {
                return Err(format!(
                    "exemplars of class {}: shapes and weights differ in number",
                    exemplars.class.0
                ));
            }
            let mut weights = exemplars.weights.iter();
            if let Some(weight) = weights.find(|w| w.is_nan() || w.abs() > LARGEST_WEIGHT) {
                return Err(format!(
                    "exemplars of class {}: weights must be within {LARGEST_WEIGHT}, found {weight}",
                    exemplars.class.0
                ));
            }
            if !(exemplars.sharpness.is_finite() && exemplars.sharpness > 0.0) {
                return Err(format!(
                    "exemplars of class {}: sharpness {}",
                    exemplars.class.0, exemplars.sharpness
                ));
            }
        }
        let sane = self.reach > 0.0
            && self.bar.abs() < 1.0
            && self.generic.deviation.iter().all(|d| *d > 0.0);
        if sane {
            Ok(())
        } else {
            Err(format!("verifier: reach {}, bar {}", self.reach, self.bar))
        }
    }
}

/// A verifier laid out for streaming; copies share the exemplars.
#[derive(Debug, Clone)]
pub struct CandidateScorer {
    verifier: Arc<Verifier>,
    /// Mapped shapes of each class's exemplars, [`interleaved`].
    shapes: Arc<[Vec<Lanes>]>,
    threshold: f64,
    /// Distances from the exemplars of a class.
    apart: Vec<Lanes>,
    shape: Vec<f32>,
    mapped: Vec<f32>,
}

impl CandidateScorer {
    /// Maps all exemplars with `metric`.
    pub fn new(verifier: &Verifier, metric: &Metric, threshold: f32) -> Self {
        let len = SHAPE_ROWS * metric.dim();
        let mapped = |exemplars: &Exemplars| {
            let rows = metric.apply_all(&exemplars.shapes);
            interleaved(
                exemplars.len(),
                len,
                rows.values().chunks_exact(len).enumerate(),
            )
        };
        let most = verifier
            .classes
            .iter()
            .map(Exemplars::len)
            .max()
            .unwrap_or(0);
        Self {
            shapes: verifier.classes.iter().map(mapped).collect(),
            apart: vec![[0.0; LANES]; most.div_ceil(LANES)],
            verifier: Arc::new(verifier.clone()),
            threshold: f64::from(threshold),
            shape: vec![0.0; len],
            mapped: vec![0.0; len],
        }
    }

    /// Score of the stretch of `len` rows that `row` gives, before the metric: above 0 is accepted, 1 is certain.
    /// O(exemplars of the class · shape), no allocation.
    pub fn score<'r>(
        &mut self,
        class: ClassId,
        evidence: &Evidence,
        metric: &Metric,
        len: usize,
        row: impl Fn(usize) -> &'r [f32],
    ) -> f64 {
        let mut score = self
            .verifier
            .generic
            .score(&evidence.ratios(self.threshold));
        if let Some(place) = self.verifier.classes.iter().position(|c| c.class == class) {
            shape_of(len, row, &mut self.shape);
            metric.apply_each(&self.shape, &mut self.mapped);
            let beside = evidence.beside_shape(self.threshold).map(|v| v as f32);
            kernel::squared_distances(&self.shapes[place], &self.mapped, &mut self.apart);
            score += kernel_sum(
                &self.verifier.classes[place],
                self.apart.as_flattened(),
                &beside,
            );
        }
        (score - self.verifier.bar) / (1.0 - self.verifier.bar)
    }
}

/// `apart` holds the squared distance of every exemplar's shape.
fn kernel_sum(exemplars: &Exemplars, apart: &[f32], beside: &[f32; 4]) -> f64 {
    let all = apart.iter().zip(&exemplars.beside).zip(&exemplars.weights);
    all.map(|((apart, other), weight)| {
        let distance = apart / SHAPE_ROWS as f32 + squared_distance(other, beside);
        f64::from(weight * portable::exp(-exemplars.sharpness * distance))
    })
    .sum()
}

/// Mean over the steps of a shape of the squared distance of its rows.
pub fn shape_distance(a: &[f32], b: &[f32]) -> f32 {
    squared_distance(a, b) / SHAPE_ROWS as f32
}

/// |a − b|².
pub fn squared_distance(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum()
}
