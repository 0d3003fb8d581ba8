//! Ridge regression, linear and with a kernel, and its predictions for each sample with the sample's group left out.

use std::collections::BTreeSet;

use nalgebra::{Cholesky, DMatrix, DVector};

/// Weights for each of `targets` so that those above 0 and those below weigh one half of the number of targets
/// each, and none more than `most`.
pub fn balanced(targets: &[f64], most: f64) -> Vec<f64> {
    let n = targets.len() as f64;
    let positive = targets.iter().filter(|t| **t > 0.0).count() as f64;
    let weight = |t: &f64| {
        if *t > 0.0 {
            0.5 * n / positive
        } else {
            0.5 * n / (n - positive)
        }
    };
    targets.iter().map(|t| weight(t).min(most)).collect()
}

/// Constant and coefficients of the weighted linear ridge regression of `targets` on `rows`, the constant free:
/// minimises the weighted mean of squared errors plus `ridge` times the squared coefficients. `None` if the
/// system cannot be solved.
pub fn linear<const N: usize>(
    rows: &[[f64; N]],
    targets: &[f64],
    weights: &[f64],
    ridge: f64,
) -> Option<Vec<f64>> {
    let mut normal = DMatrix::zeros(N + 1, N + 1);
    let mut right = DVector::zeros(N + 1);
    let total: f64 = weights.iter().sum();
    for ((row, target), weight) in rows.iter().zip(targets).zip(weights) {
        let extended =
            DVector::from_iterator(N + 1, std::iter::once(1.0).chain(row.iter().copied()));
        normal += &extended * extended.transpose() * (weight / total);
        right += extended * (target * weight / total);
    }
    for k in 1..=N {
        normal[(k, k)] += ridge;
    }
    Some(Cholesky::new(normal)?.solve(&right).as_slice().to_vec())
}

/// Kernel ridge regression `α = (K + diag(λ / w))⁻¹ y`, and for each sample the fit without its group.
pub struct KernelFit {
    /// `α`, one for each sample.
    pub weights: Vec<f64>,
    /// For sample `i` of group `G`: the fit at `i` from all samples outside `G`, in closed form:
    /// `y_G − (H_GG)⁻¹ α_G` with `H` the inverse above (Rifkin and Lippert 2007, §4, for blocks).
    pub left_out: Vec<f64>,
}

/// Fits `targets` on the symmetric kernel matrix. O(n³). `None` if the matrix cannot be factored.
pub fn kernel(
    mut kernel: DMatrix<f64>,
    targets: &[f64],
    weights: &[f64],
    lambda: f64,
    groups: &[usize],
) -> Option<KernelFit> {
    for (i, weight) in weights.iter().enumerate() {
        kernel[(i, i)] += lambda / weight;
    }
    let inverse = Cholesky::new(kernel)?.inverse();
    let alpha = &inverse * DVector::from_column_slice(targets);
    let mut left_out = targets.to_vec();
    for group in groups.iter().collect::<BTreeSet<_>>() {
        let members: Vec<usize> = (0..groups.len()).filter(|i| groups[*i] == *group).collect();
        let block = DMatrix::from_fn(members.len(), members.len(), |i, j| {
            inverse[(members[i], members[j])]
        });
        let part = DVector::from_iterator(members.len(), members.iter().map(|&i| alpha[i]));
        let correction = Cholesky::new(block)?.solve(&part);
        for (k, &i) in members.iter().enumerate() {
            left_out[i] -= correction[k];
        }
    }
    Some(KernelFit {
        weights: alpha.as_slice().to_vec(),
        left_out,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn left_out_fits_are_those_of_training_without_the_group() {
        let xs = [0.0f64, 0.3, 0.5, 1.1, 1.4, 2.0, 2.2];
        let targets = [1.0, 1.0, -1.0, -1.0, 1.0, -1.0, 0.5];
        let weights = [1.0, 2.0, 1.0, 0.5, 1.0, 1.0, 3.0];
        let groups = [0, 0, 1, 1, 2, 2, 2];
        let k = |a: f64, b: f64| (-(a - b).powi(2)).exp();
        let matrix =
            |of: &[usize]| DMatrix::from_fn(of.len(), of.len(), |i, j| k(xs[of[i]], xs[of[j]]));
        let all: Vec<usize> = (0..xs.len()).collect();
        let fit = kernel(matrix(&all), &targets, &weights, 0.1, &groups).unwrap();
        for group in 0..3 {
            let rest: Vec<usize> = all
                .iter()
                .copied()
                .filter(|i| groups[*i] != group)
                .collect();
            let pick = |v: &[f64]| rest.iter().map(|&i| v[i]).collect::<Vec<_>>();
            let without = kernel(
                matrix(&rest),
                &pick(&targets),
                &pick(&weights),
                0.1,
                &vec![0; rest.len()],
            )
            .unwrap();
            for i in all.iter().filter(|i| groups[**i] == group) {
                let direct: f64 = rest
                    .iter()
                    .zip(&without.weights)
                    .map(|(&j, alpha)| alpha * k(xs[*i], xs[j]))
                    .sum();
                assert!((fit.left_out[*i] - direct).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_line_is_found_and_halves_weigh_the_same() {
        let rows: Vec<[f64; 1]> = (0..10).map(|i| [f64::from(i)]).collect();
        let targets: Vec<f64> = rows.iter().map(|r| 2.0 * r[0] - 5.0).collect();
        let found = linear(&rows, &targets, &[1.0; 10], 1e-12).unwrap();
        assert!((found[0] + 5.0).abs() < 1e-6 && (found[1] - 2.0).abs() < 1e-6);
        let weights = balanced(&[1.0, -1.0, -1.0, -1.0], 20.0);
        assert_eq!(weights[0], weights[1..].iter().sum::<f64>());
    }
}
