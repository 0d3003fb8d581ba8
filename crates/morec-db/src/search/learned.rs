//! A metric learned from labelled samples: differences between classes count, variation within them does not.
//!
//! Summaries and lengths of accepted samples, their principal components, and linear discriminants of these (Fisher
//! 1936; Rao 1948) with the covariance within classes shrunk towards a multiple of the identity (Friedman, *Regularized
//! discriminant analysis*, 1989, Eq. 18): `Σ = (1 − γ) S_w + γ tr(S_w)/p I`; the space is spanned by the eigenvectors of
//! `Σ^(−1/2) S_b Σ^(−1/2)`, at most one less than there are classes.
//!
//! It is learned when it is asked for, so that nothing can be stale.

use std::collections::BTreeMap;

use morec::features::BoneSet;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::SearchIndex;
use super::summary::{SUMMARY, Summary, SummaryDistance, bone_of};
use crate::labels::{DbSample, SampleState};
use crate::{ClipId, DbError};

/// Values that are learned from: a summary and the logarithm of its length.
const INPUT: usize = SUMMARY + 1;
/// Principal components at most.
const COMPONENTS: usize = 80;
/// Share of the identity in the covariance within classes, `γ`.
const SHRINKAGE: f64 = 0.3;
/// Pairs that say how long learned distances are, at most this many squared.
const SCALED_ON: usize = 200;

/// A learned metric: a projection.
#[derive(Debug, Clone)]
pub struct LearnedMetric {
    classes: Vec<String>,
    samples: usize,
    mean: Vec<f64>,
    /// `discriminants × INPUT`, scaled so that learned distances of samples are as long as those of their summaries.
    projection: DMatrix<f64>,
}

/// Place of a stretch in the learned space.
#[derive(Debug, Clone)]
pub struct Embedding(Vec<f32>);

impl Embedding {
    /// Euclidean.
    pub fn distance(&self, other: &Self) -> f32 {
        self.0
            .iter()
            .zip(&other.0)
            .map(|(a, b)| (a - b) * (a - b))
            .sum::<f32>()
            .sqrt()
    }
}

/// A sample to learn from.
struct LabelledStretch {
    class: usize,
    summary: Summary,
    rows: usize,
    bones: BoneSet,
}

impl SearchIndex {
    /// Learns from the accepted ones of `samples` that lie in clips of this index. O(samples · 203² + 203³).
    ///
    /// # Errors
    ///
    /// [`DbError::Invalid`] unless two classes at least have two samples at least: nothing else says what varies
    /// within a class, and what between classes.
    pub fn learn(&self, samples: &[DbSample]) -> Result<LearnedMetric, DbError> {
        let clips: BTreeMap<ClipId, usize> = self
            .clips
            .iter()
            .enumerate()
            .map(|(at, clip)| (clip.clip, at))
            .collect();
        let mut counts: BTreeMap<&str, Vec<&DbSample>> = BTreeMap::new();
        for sample in samples
            .iter()
            .filter(|s| s.state == SampleState::Accepted && clips.contains_key(&s.clip))
        {
            counts.entry(&sample.class).or_default().push(sample);
        }
        counts.retain(|_, of_class| of_class.len() > 1);
        if counts.len() < 2 {
            return Err(DbError::Invalid(format!(
                "too few samples to learn a metric: expected at least 2 classes with 2 accepted samples each, found {} such \
                 classes",
                counts.len()
            )));
        }
        let classes: Vec<String> = counts.keys().map(|name| (*name).to_owned()).collect();
        let seen: Vec<LabelledStretch> = counts
            .into_values()
            .enumerate()
            .flat_map(|(class, of_class)| of_class.into_iter().map(move |sample| (class, sample)))
            .filter_map(|(class, sample)| self.seen(class, sample, clips[&sample.clip]))
            .collect();
        LearnedMetric::of(&seen, classes).ok_or_else(|| {
            DbError::Invalid(
                "no metric can be learned: the labelled samples do not differ".to_owned(),
            )
        })
    }

    fn seen(&self, class: usize, sample: &DbSample, clip: usize) -> Option<LabelledStretch> {
        let clip = &self.clips[clip];
        let span = (sample.span()).frames_among(clip.laid.rows.len(), self.tick_hz);
        let bones = clip.laid.bones;
        (span.len() >= 3).then(|| LabelledStretch {
            class,
            rows: span.len(),
            summary: clip.sums.octaves(&span),
            bones,
        })
    }
}

impl LearnedMetric {
    /// Names of the classes it tells apart.
    pub fn classes(&self) -> &[String] {
        &self.classes
    }

    /// Samples that it was learned from.
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// Place of a stretch of this many rows. Bones that it does not show are taken to be average.
    pub fn place(&self, summary: &Summary, rows: usize, bones: BoneSet) -> Embedding {
        let input = input(summary, rows, bones, &self.mean);
        Embedding(
            (&self.projection * input)
                .iter()
                .map(|v| *v as f32)
                .collect(),
        )
    }

    fn of(seen: &[LabelledStretch], classes: Vec<String>) -> Option<Self> {
        let mean = mean(seen);
        let inputs: Vec<DVector<f64>> = seen
            .iter()
            .map(|s| input(&s.summary, s.rows, s.bones, &mean))
            .collect();
        let components = components(&inputs)?;
        let reduced: Vec<DVector<f64>> = inputs.iter().map(|x| components.tr_mul(x)).collect();
        let discriminants = discriminants(&reduced, seen, classes.len())?;
        let projection = discriminants.transpose() * components.transpose();
        let mut metric = Self {
            classes,
            samples: seen.len(),
            mean,
            projection,
        };
        metric.projection *= metric.length(seen)?;
        Some(metric)
    }

    /// Factor that brings the median of learned distances to that of the summaries, over pairs of samples.
    fn length(&self, seen: &[LabelledStretch]) -> Option<f64> {
        let stride = seen.len().div_ceil(SCALED_ON);
        let some: Vec<&LabelledStretch> = seen.iter().step_by(stride).collect();
        let places: Vec<Embedding> = some
            .iter()
            .map(|s| self.place(&s.summary, s.rows, s.bones))
            .collect();
        let (mut plain, mut learned) = (Vec::new(), Vec::new());
        for i in 0..some.len() {
            for j in 0..i {
                let over = SummaryDistance::over(some[i].bones.and(some[j].bones));
                plain.push(over.distance(&some[i].summary, &some[j].summary));
                learned.push(places[i].distance(&places[j]));
            }
        }
        let (plain, learned) = (median(plain)?, median(learned)?);
        (learned > 1e-6 && plain > 0.0).then(|| f64::from(plain / learned))
    }
}

/// Means over the samples that show each value's bone.
fn mean(seen: &[LabelledStretch]) -> Vec<f64> {
    let shown =
        |s: &LabelledStretch, i: usize| bone_of(i).is_none_or(|bone| s.bones.contains(bone));
    let of = |i: usize| {
        let values: Vec<f64> = seen
            .iter()
            .filter(|s| shown(s, i))
            .map(|s| f64::from(s.summary[i]))
            .collect();
        values.iter().sum::<f64>() / values.len().max(1) as f64
    };
    let length = seen.iter().map(|s| (s.rows as f64).ln()).sum::<f64>() / seen.len().max(1) as f64;
    (0..SUMMARY).map(of).chain([length]).collect()
}

/// Values less their means; 0 for those of bones that are not shown.
fn input(summary: &Summary, rows: usize, bones: BoneSet, mean: &[f64]) -> DVector<f64> {
    let value = |i: usize| match bone_of(i) {
        Some(bone) if !bones.contains(bone) => 0.0,
        _ => f64::from(summary[i]) - mean[i],
    };
    let length = (rows.max(1) as f64).ln() - mean[SUMMARY];
    DVector::from_iterator(INPUT, (0..SUMMARY).map(value).chain([length]))
}

/// `INPUT × p`: directions of greatest variance.
fn components(inputs: &[DVector<f64>]) -> Option<DMatrix<f64>> {
    let mut scatter = DMatrix::zeros(INPUT, INPUT);
    for x in inputs {
        scatter.ger(1.0 / inputs.len() as f64, x, x, 1.0);
    }
    let eigen = SymmetricEigen::new(scatter);
    let mut order: Vec<usize> = (0..INPUT).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let least = 1e-9 * eigen.eigenvalues.max();
    order.retain(|&i| eigen.eigenvalues[i] > least.max(1e-12));
    order.truncate(COMPONENTS);
    (!order.is_empty()).then(|| eigen.eigenvectors.select_columns(&order))
}

/// `p × (classes − 1)`, or fewer: see above.
fn discriminants(
    reduced: &[DVector<f64>],
    seen: &[LabelledStretch],
    classes: usize,
) -> Option<DMatrix<f64>> {
    let p = reduced.first()?.len();
    let mut means = vec![DVector::<f64>::zeros(p); classes];
    let mut counts = vec![0.0; classes];
    for (x, s) in reduced.iter().zip(seen) {
        means[s.class] += x;
        counts[s.class] += 1.0;
    }
    means
        .iter_mut()
        .zip(&counts)
        .for_each(|(mean, count)| *mean /= f64::max(*count, 1.0));
    let mut within = DMatrix::zeros(p, p);
    for (x, s) in reduced.iter().zip(seen) {
        let off = x - &means[s.class];
        within.ger(1.0 / reduced.len() as f64, &off, &off, 1.0);
    }
    // Inputs are less their mean: that of all is 0 but for bones that some lack.
    let mut between = DMatrix::zeros(p, p);
    for (mean, count) in means.iter().zip(&counts) {
        between.ger(count / reduced.len() as f64, mean, mean, 1.0);
    }
    let spread = SHRINKAGE * within.trace() / p as f64;
    within *= 1.0 - SHRINKAGE;
    // Samples that repeat to the last digit leave nothing to scale by.
    let floor = 1e-6 * between.trace() / p as f64;
    for i in 0..p {
        within[(i, i)] += spread + floor.max(1e-12);
    }
    let whitening = inverse_root(within);
    let eigen = SymmetricEigen::new(&whitening * between * &whitening);
    let mut order: Vec<usize> = (0..p).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    order.truncate(classes - 1);
    order.retain(|&i| eigen.eigenvalues[i] > 1e-9);
    (!order.is_empty()).then(|| whitening * eigen.eigenvectors.select_columns(&order))
}

/// `M^(−1/2)` of a positive definite matrix.
fn inverse_root(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let eigen = SymmetricEigen::new(matrix);
    let roots = eigen.eigenvalues.map(|v| 1.0 / v.max(1e-12).sqrt());
    &eigen.eigenvectors * DMatrix::from_diagonal(&roots) * eigen.eigenvectors.transpose()
}

fn median(mut values: Vec<f32>) -> Option<f32> {
    values.sort_by(f32::total_cmp);
    values.get(values.len() / 2).copied()
}
