//! Scatter matrices: of samples within a class, and of all rows.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::features::Rows;
use crate::templates::PackedSymmetric;

use super::align::align;
use super::set::TrainSample;

/// `S_w`: residuals along the alignment of every pair of samples of one class by different people, averaged over
/// pairs, halved (a pair's residual holds both samples' deviations) and averaged over classes.
///
/// If `apart` finds no pair in any class, all pairs of a class count. Zero if no class has two samples.
/// O(pairs · len² · d + pairs · len · d²).
pub fn within_class(
    samples: &[TrainSample],
    classes: usize,
    dim: usize,
    max_pairs: usize,
) -> DMatrix<f64> {
    let apart = sum_over_classes(samples, classes, dim, max_pairs, |a, b| a.group != b.group);
    if apart.1 > 0 {
        return apart.0 / apart.1 as f64;
    }
    let any = sum_over_classes(samples, classes, dim, max_pairs, |_, _| true);
    any.0 / any.1.max(1) as f64
}

fn sum_over_classes(
    samples: &[TrainSample],
    classes: usize,
    dim: usize,
    max_pairs: usize,
    counts: impl Fn(&TrainSample, &TrainSample) -> bool,
) -> (DMatrix<f64>, usize) {
    let mut sum = DMatrix::zeros(dim, dim);
    let mut used = 0;
    for class in 0..classes {
        let of_class: Vec<&TrainSample> = samples
            .iter()
            .filter(|s| s.class.index() == class)
            .collect();
        let pairs: Vec<_> = (0..of_class.len())
            .flat_map(|i| (0..i).map(move |j| (i, j)))
            .filter(|&(i, j)| counts(of_class[i], of_class[j]))
            .collect();
        // Hundreds of samples make tens of thousands of pairs that all say the same: take evenly spread ones.
        let stride = pairs.len().div_ceil(max_pairs).max(1);
        let chosen: Vec<_> = pairs.into_iter().step_by(stride).collect();
        let mut of_pairs = DMatrix::zeros(dim, dim);
        let scatters = chosen
            .par_iter()
            .map(|&(i, j)| residual_scatter(&of_class[i].rows, &of_class[j].rows));
        // Added up one after the other: another order would round otherwise.
        for scatter in scatters.collect::<Vec<_>>() {
            of_pairs += scatter;
        }
        if !chosen.is_empty() {
            sum += of_pairs / (2 * chosen.len()) as f64;
            used += 1;
        }
    }
    (sum, used)
}

/// Mean of `r rᵀ` over the aligned pairs of rows, `r` their difference.
fn residual_scatter(a: &Rows, b: &Rows) -> DMatrix<f64> {
    let path = align(a, b);
    let residuals = DMatrix::from_fn(a.dim(), path.len(), |k, p| {
        f64::from(a.row(path[p].0)[k]) - f64::from(b.row(path[p].1)[k])
    });
    &residuals * residuals.transpose() / path.len().max(1) as f64
}

/// Covariance of all rows of all tables together (divisor: rows − 1).
pub fn covariance<'r>(tables: impl Iterator<Item = &'r Rows> + Clone, dim: usize) -> DMatrix<f64> {
    let rows = || tables.clone().flat_map(Rows::iter);
    let count = rows().count();
    let mut mean = DVector::<f64>::zeros(dim);
    for row in rows() {
        mean.iter_mut()
            .zip(row)
            .for_each(|(m, v)| *m += f64::from(*v));
    }
    mean /= count.max(1) as f64;
    let mut sum = DMatrix::<f64>::zeros(dim, dim);
    // Blocks keep the centred rows small and the products in the matrix kernel.
    let all: Vec<&[f32]> = rows().collect();
    for block in all.chunks(512) {
        let centred = DMatrix::from_fn(dim, block.len(), |k, r| f64::from(block[r][k]) - mean[k]);
        sum += &centred * centred.transpose();
    }
    sum / count.saturating_sub(1).max(1) as f64
}

/// `S_w + ρ tr(S_t)/d · I`.
pub fn ridged(within: &DMatrix<f64>, total: &DMatrix<f64>, rho: f64) -> PackedSymmetric {
    let dim = total.nrows();
    // A stream that never moves has no variance; any positive ridge then gives a usable metric.
    let ridge = (rho * total.trace() / dim.max(1) as f64).max(1e-9);
    PackedSymmetric::pack(&(within + DMatrix::identity(dim, dim) * ridge))
}

/// Covariance of rows about the means of their groups.
pub fn within_groups<G: Ord + Copy>(rows: &Rows, groups: &[G]) -> DMatrix<f64> {
    let means = means_of_groups(rows, groups);
    let mut centred = Rows::new(rows.dim());
    for (row, group) in rows.iter().zip(groups) {
        let apart: Vec<f32> = row.iter().zip(&means[group]).map(|(v, m)| v - m).collect();
        centred.push(&apart);
    }
    covariance(std::iter::once(&centred), rows.dim())
}

/// The mean of the rows of each group; `groups` has a value for each row.
pub fn means_of_groups<G: Ord + Copy>(rows: &Rows, groups: &[G]) -> BTreeMap<G, Vec<f32>> {
    let mut means = BTreeMap::<G, (Vec<f32>, f32)>::new();
    for (row, group) in rows.iter().zip(groups) {
        let start = || (vec![0.0; rows.dim()], 0.0);
        let (sum, count) = means.entry(*group).or_insert_with(start);
        sum.iter_mut()
            .zip(row)
            .for_each(|(sum, value)| *sum += value);
        *count += 1.0;
    }
    let mean = |(sum, count): (Vec<f32>, f32)| sum.iter().map(|sum| sum / count).collect();
    means
        .into_iter()
        .map(|(group, sum)| (group, mean(sum)))
        .collect()
}
