//! Eigenvalues and eigenvectors of symmetric matrices, in a form that repeats.

use nalgebra::{DMatrix, SymmetricEigen};

/// Eigenpairs of a symmetric positive semidefinite `n × n` matrix, the largest first.
#[derive(Debug, Clone, PartialEq)]
pub struct Eigen {
    /// `n` eigenvalues, descending; what rounding made negative is 0.
    pub values: Vec<f64>,
    /// `n` columns, the eigenvectors in the order of their values, each of length 1 and with its sign by
    /// [`canonical_sign`](Eigen::canonical_sign).
    pub vectors: DMatrix<f64>,
}

impl Eigen {
    /// The eigenpairs of `matrix`, of which only symmetric input makes sense. O(n³).
    pub fn of(matrix: DMatrix<f64>) -> Self {
        let dim = matrix.nrows();
        let found = SymmetricEigen::new(matrix);
        let mut order: Vec<usize> = (0..dim).collect();
        order.sort_by(|&a, &b| found.eigenvalues[b].total_cmp(&found.eigenvalues[a]));
        let values = order
            .iter()
            .map(|&i| found.eigenvalues[i].max(0.0))
            .collect();
        let signs: Vec<f64> = order
            .iter()
            .map(|&i| Self::canonical_sign(found.eigenvectors.column(i).iter().copied()))
            .collect();
        let vectors = DMatrix::from_fn(dim, dim, |k, i| {
            signs[i] * found.eigenvectors[(k, order[i])]
        });
        Self { values, vectors }
    }

    /// 1 or −1: what to multiply a vector with so that its component of greatest magnitude is positive; of several
    /// that are as great to one part in 10⁹, the first. An eigenvector has two signs, and this chooses one.
    pub fn canonical_sign(vector: impl Iterator<Item = f64> + Clone) -> f64 {
        let greatest = vector.clone().fold(0.0, |most: f64, v| most.max(v.abs()));
        let first = vector.clone().find(|v| v.abs() >= greatest * (1.0 - 1e-9));
        if first.is_some_and(|v| v < 0.0) {
            -1.0
        } else {
            1.0
        }
    }
}
