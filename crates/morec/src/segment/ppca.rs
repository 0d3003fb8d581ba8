//! A Gaussian of few dimensions and noise in all others.

use crate::pca::{ComponentCount, Eigen, Moments};

/// Probabilistic principal components: rows as a Gaussian whose covariance is
/// `C = V diag(λ₁ … λᵣ, λ … λ) Vᵀ`, `λ` the mean of the eigenvalues left out (thesis Eq. 3.13, 3.15).
#[derive(Debug, Clone, PartialEq)]
pub struct Ppca {
    mean: Vec<f64>,
    /// `r × q`, row-major, an eigenvector a row.
    axes: Vec<f64>,
    /// `1/λᵢ` of each axis.
    precisions: Vec<f64>,
    /// `1/λ` of the directions that are left out.
    noise_precision: f64,
}

impl Ppca {
    /// The model of the rows that `moments` has seen, with the eigenvalues of their covariance (Eq. 3.14 as corrected:
    /// of rows centred on their own mean). O(q³).
    ///
    /// `space` is the number of dimensions `n` that the rows have in truth: more than the `q` of `moments` if
    /// dimensions in which nothing varies were left out. No variance is taken for less than `least`.
    pub fn fit(moments: &Moments, keep: ComponentCount, space: usize, least: f64) -> Self {
        let eigen = Eigen::of(moments.covariance());
        let dims = keep.dims(&eigen.values).min(space.saturating_sub(1));
        let noise = eigen.values[dims..].iter().sum::<f64>() / (space - dims).max(1) as f64;
        let noise = noise.max(least);
        let axes =
            (0..dims).flat_map(|i| eigen.vectors.column(i).iter().copied().collect::<Vec<_>>());
        Self {
            mean: moments.mean().to_vec(),
            axes: axes.collect(),
            precisions: eigen.values[..dims]
                .iter()
                .map(|value| 1.0 / value.max(noise))
                .collect(),
            noise_precision: 1.0 / noise,
        }
    }

    /// Dimensions that are modelled one by one, `r`.
    pub fn dims(&self) -> usize {
        self.precisions.len()
    }

    /// `(x − x̄)ᵀ C⁻¹ (x − x̄)`, the squared Mahalanobis distance of thesis Eq. 3.16 as corrected (printed with `C` in
    /// place of its inverse), in closed form: axes apart, all else by its length. O(q · r).
    pub fn distance(&self, row: &[f64]) -> f64 {
        let centred = || row.iter().zip(&self.mean).map(|(x, m)| x - m);
        let mut rest: f64 = centred().map(|d| d * d).sum();
        let mut sum = 0.0;
        for (axis, precision) in self
            .axes
            .chunks_exact(self.mean.len().max(1))
            .zip(&self.precisions)
        {
            let along: f64 = axis.iter().zip(centred()).map(|(a, d)| a * d).sum();
            sum += precision * along * along;
            rest -= along * along;
        }
        sum + self.noise_precision * rest.max(0.0)
    }

    /// `H`: the mean distance of rows given one after the other (Eq. 3.16). O(rows · q · r).
    pub fn mean_distance(&self, rows: &[f64]) -> f64 {
        let dim = self.mean.len().max(1);
        let count = (rows.len() / dim).max(1);
        rows.chunks_exact(dim)
            .map(|row| self.distance(row))
            .sum::<f64>()
            / count as f64
    }

    /// The covariance `C` itself, `q × q`.
    #[cfg(test)]
    pub(crate) fn covariance(&self) -> nalgebra::DMatrix<f64> {
        let dim = self.mean.len();
        let noise = 1.0 / self.noise_precision;
        let mut c = nalgebra::DMatrix::identity(dim, dim) * noise;
        for (axis, precision) in self.axes.chunks_exact(dim.max(1)).zip(&self.precisions) {
            let axis = nalgebra::DVector::from_row_slice(axis);
            c += &axis * axis.transpose() * (1.0 / precision - noise);
        }
        c
    }
}
