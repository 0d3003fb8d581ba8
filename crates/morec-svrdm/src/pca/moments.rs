//! Mean and scatter of rows that come piece by piece.

use nalgebra::DMatrix;

use morec_features::Rows;

/// Count, mean and centred scatter `M = Σ (x − x̄)(x − x̄)ᵀ` of rows of `D` values, in double precision and O(D²)
/// memory however many rows there are.
///
/// Pieces are centred on their own mean and joined by the update of Chan, Golub and LeVeque (1983), so that a mean far
/// from 0 costs no digits. This is `M = Σ Mᵢ` of thesis Eq. 4.3 in one pass.
#[derive(Debug, Clone, PartialEq)]
pub struct Moments {
    count: u64,
    mean: Vec<f64>,
    /// `D × D`, row-major; the lower triangle alone is kept up.
    scatter: Vec<f64>,
}

/// Rows that are centred together: few enough to stay in the cache.
const BLOCK: usize = 64;

impl Moments {
    /// Of no rows, `dim` values each.
    pub fn new(dim: usize) -> Self {
        Self {
            count: 0,
            mean: vec![0.0; dim],
            scatter: vec![0.0; dim * dim],
        }
    }

    /// Values in a row, `D`.
    pub fn dim(&self) -> usize {
        self.mean.len()
    }

    /// Rows so far, `m`.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The mean of the rows; zeros if there are none.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Sum of squared distances of the rows from their mean, `tr M`.
    pub fn total(&self) -> f64 {
        let dim = self.dim();
        (0..dim).map(|i| self.scatter[i * dim + i]).sum()
    }

    /// Adds every row of `rows`, which must be of this width. O(rows · D²).
    ///
    /// # Panics
    /// The rows have another width.
    pub fn push_rows(&mut self, rows: &Rows) {
        assert_eq!(rows.dim(), self.dim(), "rows of another width");
        self.push_values(rows.values());
    }

    /// Adds rows given as their values in either precision, one row after the other; what is no whole row at the end
    /// is left out.
    pub fn push_values<V: Copy + Into<f64>>(&mut self, values: &[V]) {
        let dim = self.dim().max(1);
        let whole = values.len() / dim * dim;
        for block in values[..whole].chunks(BLOCK * dim) {
            self.push_block(block);
        }
    }

    fn push_block<V: Copy + Into<f64>>(&mut self, block: &[V]) {
        let (dim, rows) = (self.dim(), block.len() / self.dim());
        let mut mean = vec![0.0; dim];
        for row in block.chunks_exact(dim) {
            mean.iter_mut()
                .zip(row)
                .for_each(|(m, v)| *m += (*v).into() / rows as f64);
        }
        let mut centred = vec![0.0; dim];
        for row in block.chunks_exact(dim) {
            (0..dim).for_each(|k| centred[k] = row[k].into() - mean[k]);
            add_outer(&mut self.scatter, &centred, 1.0);
        }
        self.shift(rows as u64, &mean);
    }

    /// Joins the rows that `other` has seen. O(D²).
    ///
    /// # Panics
    /// The other rows have another width.
    pub fn merge(&mut self, other: &Moments) {
        assert_eq!(other.dim(), self.dim(), "rows of another width");
        self.scatter
            .iter_mut()
            .zip(&other.scatter)
            .for_each(|(a, b)| *a += b);
        self.shift(other.count, &other.mean);
    }

    /// Scatter from the distance between the means of two parts, once their own scatters are in.
    fn shift(&mut self, rows: u64, mean: &[f64]) {
        if rows == 0 {
            return;
        }
        let all = self.count + rows;
        let apart: Vec<f64> = mean
            .iter()
            .zip(&self.mean)
            .map(|(new, old)| new - old)
            .collect();
        add_outer(
            &mut self.scatter,
            &apart,
            self.count as f64 * rows as f64 / all as f64,
        );
        let share = rows as f64 / all as f64;
        self.mean
            .iter_mut()
            .zip(&apart)
            .for_each(|(m, d)| *m += share * d);
        self.count = all;
    }

    /// `M`, the `D × D` scatter about the mean. O(D²).
    pub fn scatter(&self) -> DMatrix<f64> {
        let dim = self.dim();
        DMatrix::from_fn(dim, dim, |i, j| self.scatter[i.max(j) * dim + i.min(j)])
    }

    /// `S = M / (m − 1)`, the sample covariance (thesis Eq. 3.14 as corrected: of centred rows), `D × D`; zeros of fewer than two rows.
    pub fn covariance(&self) -> DMatrix<f64> {
        self.scatter() / self.count.saturating_sub(1).max(1) as f64
    }
}

/// Adds `weight · v vᵀ` to the lower triangle of `matrix`.
fn add_outer(matrix: &mut [f64], v: &[f64], weight: f64) {
    let dim = v.len();
    for i in 0..dim {
        let scaled = weight * v[i];
        let row = &mut matrix[i * dim..i * dim + i + 1];
        row.iter_mut()
            .zip(v)
            .for_each(|(m, value)| *m += scaled * value);
    }
}
