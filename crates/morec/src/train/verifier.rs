//! Training of the verifier.

use std::collections::BTreeMap;

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::classes::ClassId;
use crate::features::Rows;
use crate::math::portable;
use crate::templates::{
    ALARM_RATES, Exemplars, LinearScore, Metric, OperatingPoint, SHAPE_ROWS, Verifier,
    shape_distance, shape_of, squared_distance,
};

use super::examples::VerifierExample;
use super::params::TrainParams;
use super::ridge::{balanced, kernel, linear};
use super::set::{StreamKind, TrainSet, TrainStream};

/// No example weighs more than this times the mean: three samples against hundreds of near misses.
const MOST_WEIGHT: f64 = 20.0;

/// No rate of false alarms accepts scores below this: examples are +1 and -1.
const LEAST_BAR: f64 = -0.5;

/// True for a clip that the user calls background.
fn is_given(stream: &TrainStream) -> bool {
    stream.source == StreamKind::Background
}

/// True if a set may have the near misses that [`learn`] needs.
pub fn has_background(set: &TrainSet, params: &TrainParams) -> bool {
    params.min_negatives == 0 || set.streams.iter().any(is_given)
}

/// Learns a verifier from `examples`, or `None` if there are too few samples, or too few near misses in clips that
/// the user calls background: with none but the unlabelled parts of the labelled clips and made motion to learn
/// from, a verifier lets more unknown motion pass than the plain rule (measured on referee clips).
///
/// 1. A linear score of three ratios that holds for all classes.
/// 2. For each class a kernel ridge regression of what the linear score leaves.
/// 3. The bar, where cross-fitted scores of samples and of background motion part best.
///
/// Cross-fitted means: the score of an example comes from a fit without its group. O(Σ n_c³).
pub fn learn(
    examples: &[VerifierExample],
    set: &TrainSet,
    metric: &Metric,
    threshold: f32,
    reach: f32,
    params: &TrainParams,
) -> Option<Verifier> {
    let targets: Vec<f64> = examples
        .iter()
        .map(|e| if e.positive { 1.0 } else { -1.0 })
        .collect();
    let positives = targets.iter().filter(|t| **t > 0.0).count();
    let given = |e: &&VerifierExample| !e.positive && is_given(&set.streams[e.stream]);
    if positives < params.min_positives
        || examples.iter().filter(given).count() < params.min_negatives
    {
        return None;
    }
    let groups = group_numbers(examples, |e| set.streams[e.stream].group.clone());
    let ratios: Vec<[f64; 3]> = examples
        .iter()
        .map(|e| e.evidence.ratios(f64::from(threshold)))
        .collect();
    let (generic, cross_fitted) = fit_generic(&ratios, &targets, &groups)?;
    let residuals: Vec<f64> = targets
        .iter()
        .zip(&cross_fitted)
        .map(|(t, g)| t - g)
        .collect();
    let problem = ClassProblem {
        examples,
        set,
        metric,
        threshold,
        targets: &targets,
        residuals: &residuals,
        groups: &groups,
    };
    let members = |class: usize| -> Vec<usize> {
        (0..examples.len())
            .filter(|&i| examples[i].class == class)
            .collect()
    };
    let fit = |class: usize| {
        let members = members(class);
        problem
            .fit(class, &members, params)
            .map(|(exemplars, corrections)| (exemplars, members, corrections))
    };
    let fits: Vec<_> = (0..set.classes.len())
        .into_par_iter()
        .filter_map(fit)
        .collect();
    let mut scores = cross_fitted;
    let mut classes = Vec::with_capacity(fits.len());
    for (exemplars, members, corrections) in fits {
        members
            .iter()
            .zip(corrections)
            .for_each(|(&i, c)| scores[i] += c);
        classes.push(exemplars);
    }
    let of = |keep: &dyn Fn(&VerifierExample) -> bool| -> Vec<f64> {
        examples
            .iter()
            .zip(&scores)
            .filter(|(e, _)| keep(e))
            .map(|(_, s)| *s)
            .collect()
    };
    let background = |e: &VerifierExample| !e.positive && set.streams[e.stream].rest_is_background;
    let bar = bar(&of(&|e| e.positive), &of(&background), params);
    Some(Verifier {
        reach,
        bar,
        operating: operating(examples, &scores, set, params),
        generic,
        classes,
    })
}

/// The score above which background motion came at each of [`ALARM_RATES`], of each two seconds the highest. Cross-fitted scores, as
/// new motion would get. Empty without background.
fn operating(
    examples: &[VerifierExample],
    scores: &[f64],
    set: &TrainSet,
    params: &TrainParams,
) -> Vec<OperatingPoint> {
    let counts = |stream: &TrainStream| stream.source != StreamKind::Labelled;
    let ticks: usize = set
        .streams
        .iter()
        .filter(|s| counts(s))
        .map(|s| s.rows.len())
        .sum();
    let minutes = ticks as f64 / (60.0 * params.features.tick_hz());
    let mut highest: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    for (example, score) in examples.iter().zip(scores) {
        if !example.positive && counts(&set.streams[example.stream]) {
            let of_piece = highest
                .entry(example.piece(false))
                .or_insert(f64::NEG_INFINITY);
            *of_piece = of_piece.max(*score);
        }
    }
    let mut highest: Vec<f64> = highest.into_values().collect();
    highest.sort_by(|a, b| b.total_cmp(a));
    let point = |alarms_per_minute: f64| {
        let allowed = (alarms_per_minute * minutes) as usize;
        let score = highest.get(allowed).or(highest.last())?;
        Some(OperatingPoint {
            alarms_per_minute,
            threshold: score.max(LEAST_BAR) as f32,
        })
    };
    ALARM_RATES.into_iter().filter_map(point).collect()
}

fn group_numbers<K: Ord>(
    examples: &[VerifierExample],
    key: impl Fn(&VerifierExample) -> K,
) -> Vec<usize> {
    let mut numbers = BTreeMap::new();
    let number = |e: &VerifierExample| {
        let next = numbers.len();
        *numbers.entry(key(e)).or_insert(next)
    };
    examples.iter().map(number).collect()
}

/// The linear score, and for each example its score from a fit without its group.
fn fit_generic(
    ratios: &[[f64; 3]],
    targets: &[f64],
    groups: &[usize],
) -> Option<(LinearScore, Vec<f64>)> {
    let n = ratios.len() as f64;
    let mean: [f64; 3] = std::array::from_fn(|k| ratios.iter().map(|r| r[k]).sum::<f64>() / n);
    let deviation: [f64; 3] = std::array::from_fn(|k| {
        (ratios.iter().map(|r| (r[k] - mean[k]).powi(2)).sum::<f64>() / n).sqrt() + 1e-9
    });
    let weights = balanced(targets, f64::INFINITY);
    let standard: Vec<[f64; 3]> = ratios
        .iter()
        .map(|r| std::array::from_fn(|k| (r[k] - mean[k]) / deviation[k]))
        .collect();
    let fit = |keep: &dyn Fn(usize) -> bool| -> Option<LinearScore> {
        let kept: Vec<usize> = (0..targets.len()).filter(|&i| keep(i)).collect();
        let both = kept.iter().any(|&i| targets[i] > 0.0) && kept.iter().any(|&i| targets[i] < 0.0);
        let pick = |v: &[f64]| kept.iter().map(|&i| v[i]).collect::<Vec<f64>>();
        let rows: Vec<[f64; 3]> = kept.iter().map(|&i| standard[i]).collect();
        let found = linear(&rows, &pick(targets), &pick(&weights), 0.01).filter(|_| both)?;
        Some(LinearScore {
            mean,
            deviation,
            weights: [found[0], found[1], found[2], found[3]],
        })
    };
    let whole = fit(&|_| true)?;
    let mut scores: Vec<f64> = ratios.iter().map(|r| whole.score(r)).collect();
    for group in 0..=groups.iter().copied().max().unwrap_or(0) {
        if let Some(without) = fit(&|i| groups[i] != group) {
            let members = (0..groups.len()).filter(|&i| groups[i] == group);
            members.for_each(|i| scores[i] = without.score(&ratios[i]));
        }
    }
    Some((whole, scores))
}

/// State common to the kernel regressions of all classes.
struct ClassProblem<'a> {
    examples: &'a [VerifierExample],
    set: &'a TrainSet,
    metric: &'a Metric,
    threshold: f32,
    targets: &'a [f64],
    residuals: &'a [f64],
    groups: &'a [usize],
}

impl ClassProblem<'_> {
    /// The class's exemplars and each member's cross-fitted correction.
    fn fit(
        &self,
        class: usize,
        members: &[usize],
        params: &TrainParams,
    ) -> Option<(Exemplars, Vec<f64>)> {
        let targets: Vec<f64> = members.iter().map(|&i| self.targets[i]).collect();
        let positives = targets.iter().filter(|t| **t > 0.0).count();
        if positives < params.min_positives || positives == targets.len() {
            return None;
        }
        let shapes = self.shapes(members);
        let mapped = self.metric.apply_all(&shapes);
        let beside: Vec<[f32; 4]> = members
            .iter()
            .map(|&i| {
                self.examples[i]
                    .evidence
                    .beside_shape(f64::from(self.threshold))
                    .map(|v| v as f32)
            })
            .collect();
        let distances = pairwise(&mapped, &beside);
        let sharpness = 1.0 / (2.0 * spread(&distances));
        let matrix = distances.map(|d| portable::exp(-sharpness * d));
        let residuals: Vec<f64> = members.iter().map(|&i| self.residuals[i]).collect();
        let weights = balanced(&targets, MOST_WEIGHT);
        let fit = kernel(
            matrix,
            &residuals,
            &weights,
            params.verifier_ridge,
            &self.groups_of(members),
        )?;
        let exemplars = Exemplars {
            class: ClassId(class as u16),
            shapes,
            beside,
            weights: fit.weights.iter().map(|w| *w as f32).collect(),
            sharpness: sharpness as f32,
        };
        Some((exemplars, fit.left_out))
    }

    /// Groups to leave out: people or clips; pieces of streams where all samples are one group's.
    fn groups_of(&self, members: &[usize]) -> Vec<usize> {
        let of_positives = members
            .iter()
            .filter(|&&i| self.targets[i] > 0.0)
            .map(|&i| self.groups[i]);
        let groups: std::collections::BTreeSet<usize> = of_positives.collect();
        if groups.len() > 1 {
            return members.iter().map(|&i| self.groups[i]).collect();
        }
        let examples: Vec<VerifierExample> =
            members.iter().map(|&i| self.examples[i].clone()).collect();
        group_numbers(&examples, |e| e.piece(false))
    }

    fn shapes(&self, members: &[usize]) -> Rows {
        let dim = self.metric.dim();
        let mut values = vec![0.0; members.len() * SHAPE_ROWS * dim];
        for (&i, out) in members
            .iter()
            .zip(values.chunks_exact_mut(SHAPE_ROWS * dim))
        {
            let example = &self.examples[i];
            let rows = &self.set.streams[example.stream].rows;
            shape_of(
                example.ticks.len(),
                |k| rows.row(example.ticks.start + k),
                out,
            );
        }
        Rows::from_values(dim, values)
    }
}

/// Squared distances between all exemplars, shape and what stands beside it together.
fn pairwise(mapped: &Rows, beside: &[[f32; 4]]) -> DMatrix<f64> {
    let shapes: Vec<&[f32]> = mapped
        .values()
        .chunks_exact(SHAPE_ROWS * mapped.dim())
        .collect();
    let mut distances = DMatrix::zeros(beside.len(), beside.len());
    for i in 0..beside.len() {
        for j in 0..i {
            let distance =
                shape_distance(shapes[i], shapes[j]) + squared_distance(&beside[i], &beside[j]);
            distances[(i, j)] = f64::from(distance);
            distances[(j, i)] = f64::from(distance);
        }
    }
    distances
}

/// Mean squared distance from the mean: half the mean squared distance between pairs, a point and itself included.
fn spread(distances: &DMatrix<f64>) -> f64 {
    distances.mean() / 2.0 + 1e-9
}

/// The lowest score where the share of positives above it exceeds the share of negatives above it most.
fn bar(positives: &[f64], negatives: &[f64], params: &TrainParams) -> f64 {
    let (low, high) = params.bar_range;
    let above = |scores: &[f64], bar: f64| {
        scores.iter().filter(|s| **s > bar).count() as f64 / scores.len().max(1) as f64
    };
    let mut best = (f64::NEG_INFINITY, low);
    for step in 0..=65 {
        let at = -0.5 + 0.02 * f64::from(step);
        let gain = above(positives, at) - above(negatives, at);
        if gain > best.0 + 1e-12 {
            best = (gain, at);
        }
    }
    best.1.clamp(low, high)
}
