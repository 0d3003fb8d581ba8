//! Signs of eigenvectors.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Estimation of a sign vector.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SignRule {
    /// The direction in which the eigenvectors spread most about their mean (Alg. 5). The mean, and so the outcome,
    /// depends on the signs the eigenvectors come with.
    #[default]
    Centred,
    /// The direction they have most in common, `Σ (w·v)²` greatest: no sign matters to it, and products with it are
    /// seldom near 0.
    Common,
}

/// A sign vector and how sure it is.
#[derive(Debug, Clone, PartialEq)]
pub struct SignVector {
    /// Eigenvectors `v` with `w · v < 0` are turned round. Unit length; its largest value is positive.
    pub direction: Vec<f64>,
    /// `w · v` of each sample's eigenvector, as it came: near 0, a small change turns it round.
    pub products: Vec<f64>,
}

impl SignVector {
    /// Share of samples with `|w · v|` below `margin`: those close to flipping.
    pub fn unsure(&self, margin: f64) -> f64 {
        let close = self.products.iter().filter(|p| p.abs() < margin).count();
        close as f64 / self.products.len().max(1) as f64
    }
}

/// The sign vector of the eigenvectors `v_j` (unit length, of equal dimension `r`) of all samples, for one `j`.
/// `None` without samples. O(m r² + r³).
pub fn sign_vector(eigenvectors: &[&[f64]], rule: SignRule) -> Option<SignVector> {
    let dim = eigenvectors.first()?.len();
    let m = eigenvectors.len();
    let mut rows = DMatrix::from_fn(m, dim, |i, j| eigenvectors[i][j]);
    if rule == SignRule::Centred {
        let mean = rows.row_mean();
        rows.row_iter_mut().for_each(|mut row| row -= &mean);
    }
    let eigen = SymmetricEigen::new(rows.tr_mul(&rows));
    let mut direction: DVector<f64> = eigen
        .eigenvectors
        .column(eigen.eigenvalues.imax())
        .into_owned();
    // An eigenvector comes with either sign; the same data shall give the same vector.
    if direction[direction.iamax()] < 0.0 {
        direction.neg_mut();
    }
    let product = |v: &&[f64]| v.iter().zip(&direction).map(|(v, w)| v * w).sum();
    let products = eigenvectors.iter().map(product).collect();
    Some(SignVector {
        direction: direction.as_slice().to_vec(),
        products,
    })
}
