//! The metric, which suppresses the differences between people who perform the same motion.

use std::sync::Arc;

use nalgebra::{DMatrix, SymmetricEigen};

use crate::features::Rows;
use crate::math::portable;

use super::kernel;

/// A symmetric `dim` × `dim` matrix, its lower triangle packed row by row: what an index file stores.
#[derive(Debug, Clone, PartialEq)]
pub struct PackedSymmetric {
    dim: usize,
    packed: Vec<f32>,
}

impl PackedSymmetric {
    /// Packs the lower triangle of a square matrix.
    pub(crate) fn pack(matrix: &DMatrix<f64>) -> Self {
        let dim = matrix.nrows();
        let lower = (0..dim).flat_map(|i| (0..=i).map(move |j| (i, j)));
        Self {
            dim,
            packed: lower.map(|(i, j)| matrix[(i, j)] as f32).collect(),
        }
    }

    /// From packed values; `None` unless there are `dim (dim + 1) / 2` finite ones.
    pub fn from_packed(dim: usize, packed: Vec<f32>) -> Option<Self> {
        let fits = packed.len() == dim * (dim + 1) / 2 && packed.iter().all(|v| v.is_finite());
        fits.then_some(Self { dim, packed })
    }

    /// The packed lower triangle.
    pub fn packed(&self) -> &[f32] {
        &self.packed
    }

    /// Number of rows and columns.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Sum of the diagonal.
    pub fn trace(&self) -> f64 {
        let diagonal = (0..self.dim).map(|i| i * (i + 1) / 2 + i);
        diagonal.map(|at| f64::from(self.packed[at])).sum()
    }

    pub(crate) fn unpack(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.dim, self.dim, |i, j| {
            let (row, column) = if i >= j { (i, j) } else { (j, i) };
            f64::from(self.packed[row * (row + 1) / 2 + column])
        })
    }

    /// The rows and columns in `keep`.
    #[must_use]
    pub fn restricted(&self, keep: &[usize]) -> Self {
        let full = self.unpack();
        Self::pack(&DMatrix::from_fn(keep.len(), keep.len(), |i, j| {
            full[(keep[i], keep[j])]
        }))
    }
}

/// A linear map `A` of feature rows, after which squared Euclidean distance says how unlike two poses are.
#[derive(Debug, Clone, PartialEq)]
pub struct Metric {
    dim: usize,
    /// `A`, row-major; symmetric. Rows are padded to a multiple of [`kernel::COLUMNS`].
    map: Arc<[f32]>,
}

impl Metric {
    /// `A = (S_w + ρ tr(S_t)/d · I)^(−1/2)`, scaled so that `tr(A S_t Aᵀ) = tr(S_t)`: distances stay on the scale
    /// they had. `ridged` is the matrix in the brackets, `total` is `S_t`. O(d³).
    ///
    /// (Within-class whitening as in Hastie and Tibshirani 1996; the ridge is what keeps directions in which
    /// few samples happen to agree from taking over.)
    pub fn new(ridged: &PackedSymmetric, total: &PackedSymmetric) -> Self {
        let dim = ridged.dim();
        let eigen = SymmetricEigen::new(ridged.unpack());
        // Packing to single precision can push the smallest eigenvalue below zero; it then counts as tiny.
        let floor = eigen.eigenvalues.amax() * 1e-9 + f64::MIN_POSITIVE;
        let scaled = DMatrix::from_fn(dim, dim, |i, j| {
            eigen.eigenvectors[(i, j)] * portable::powf(eigen.eigenvalues[j].max(floor), -0.5)
        });
        let map = product(&scaled, &eigen.eigenvectors.transpose());
        let total = total.unpack();
        let after = product(&map, &total).dot(&map);
        let scale = if after > 0.0 {
            (total.trace() / after).sqrt()
        } else {
            1.0
        };
        let padded = dim.next_multiple_of(kernel::COLUMNS);
        let at = |i: usize, j: usize| map.get((i, j)).map_or(0.0, |v| (v * scale) as f32);
        Self {
            dim,
            map: (0..dim)
                .flat_map(|i| (0..padded).map(move |j| (i, j)))
                .map(|(i, j)| at(i, j))
                .collect(),
        }
    }

    /// Values in a row.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// `out = A row`. O(d²), no allocation.
    pub fn apply(&self, row: &[f32], out: &mut [f32]) {
        self.apply_each(&row[..self.dim], &mut out[..self.dim]);
    }

    /// The same of each of `rows`, one after the other, as many as `out` has room for. Faster than one by one, and as exact.
    pub fn apply_each(&self, rows: &[f32], out: &mut [f32]) {
        const TOGETHER: usize = 4;
        // A is symmetric: adding its rows, scaled, runs along memory and vectorises.
        let dim = self.dim.max(1);
        let (mut rows, mut outs) = (
            rows.chunks_exact(TOGETHER * dim),
            out.chunks_exact_mut(TOGETHER * dim),
        );
        for (rows, out) in rows.by_ref().zip(outs.by_ref()) {
            kernel::combinations::<TOGETHER, { kernel::COLUMNS }>(&self.map, rows, out);
        }
        let outs = outs.into_remainder().chunks_exact_mut(dim);
        for (row, out) in rows.remainder().chunks_exact(dim).zip(outs) {
            // A row alone needs more columns at a time, as each sum waits for its last addition.
            kernel::combinations::<1, { 4 * kernel::COLUMNS }>(&self.map, row, out);
        }
    }

    /// Every row mapped.
    pub fn apply_all(&self, rows: &Rows) -> Rows {
        let mut out = vec![0.0; rows.values().len()];
        self.apply_each(rows.values(), &mut out);
        Rows::from_values(self.dim, out)
    }
}

/// `a b`, column by column. `nalgebra`'s own product fuses multiplications with sums where the processor can, and its bits differ with it.
fn product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(a.nrows(), b.ncols());
    for (mut column, of_b) in out.column_iter_mut().zip(b.column_iter()) {
        column.gemv(1.0, a, &of_b, 0.0);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whitening_makes_the_within_class_spread_round_and_keeps_the_total() {
        let within = DMatrix::from_row_slice(2, 2, &[4.0, 1.0, 1.0, 2.0]);
        let total = DMatrix::from_row_slice(2, 2, &[9.0, 0.5, 0.5, 3.0]);
        let metric = Metric::new(
            &PackedSymmetric::pack(&within),
            &PackedSymmetric::pack(&total),
        );
        let columns = [[1.0, 0.0], [0.0, 1.0]].map(|unit| {
            let mut column = [0.0; 2];
            metric.apply(&unit, &mut column);
            column.map(f64::from)
        });
        let map = DMatrix::from_columns(&columns.map(|column| column.to_vec().into()));
        let round = &map * &within * map.transpose();
        assert!((round[(0, 0)] - round[(1, 1)]).abs() < 1e-5 && round[(0, 1)].abs() < 1e-5);
        assert!(((&map * &total * map.transpose()).trace() - total.trace()).abs() < 1e-4);
    }
}
