//! Similarity of two motions by their principal directions.

use nalgebra::DMatrix;

use crate::features::Rows;
use crate::pca::Eigen;

/// Scaling of `kWAS`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum KwasForm {
    /// Eq. 3.17. With `k` below the number of dimensions a motion is a little less than 1 like itself.
    #[default]
    Printed,
    /// Divided by what two motions of these eigenvalues reach when their directions agree: a motion is 1 like itself.
    Normalised,
}

/// When two samples are alike. Thesis §4.4.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct KwasParams {
    /// Eigenpairs that count, at most all there are.
    pub k: usize,
    /// Two samples are alike if their similarity is above this, τ.
    ///
    /// For rows centred on the database. Tables 5.2–5.4 of the thesis come nearer to uncentred rows (`morec group
    /// --method kwas --centre none`), where 0.995 is best on referee samples.
    pub tau: f64,
    /// Scaling of the similarity.
    pub form: KwasForm,
}

impl Default for KwasParams {
    /// As printed: `k = 12`, `τ = 0.95` (thesis §4.4).
    fn default() -> Self {
        Self {
            k: 12,
            tau: 0.95,
            form: KwasForm::Printed,
        }
    }
}

/// Input of kWAS for a sample: the eigenpairs of its `M = AᵀA`.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// All eigenvalues over their sum, descending; zeros if every row is the mean.
    shares: Vec<f64>,
    /// Eigenvectors, a column each, in the order of their values.
    vectors: DMatrix<f64>,
}

impl Spectrum {
    /// Of a sample's rows, `m × n`, as they are. O(m n² + n³).
    ///
    /// Thesis §4.2 centres rows on the mean of the database, as [`Pca::project`](crate::pca::Pca::project) does; §3.6 does
    /// not say. The numbers of classes in Tables 5.2–5.4 (2, 3 and 14) are those of rows that are not centred, whose
    /// first direction is the mean pose: on referee samples 1, 4 and 11 against 60, 81 and 94.
    pub fn of_rows(rows: &Rows) -> Self {
        let a = DMatrix::from_fn(rows.dim(), rows.len(), |k, i| f64::from(rows.row(i)[k]));
        Self::of_matrix(&a * a.transpose())
    }

    /// Of `M` itself, symmetric `n × n`. O(n³).
    pub(crate) fn of_matrix(m: DMatrix<f64>) -> Self {
        let eigen = Eigen::of(m);
        let sum: f64 = eigen.values.iter().sum();
        let share = |value: &f64| if sum > 0.0 { value / sum } else { 0.0 };
        Self {
            shares: eigen.values.iter().map(share).collect(),
            vectors: eigen.vectors,
        }
    }

    /// Share of the first `k` eigenvalues in all.
    fn held(&self, k: usize) -> f64 {
        self.shares.iter().take(k).sum()
    }
}

/// `½ Σᵢ≤ₖ (σᵢ/Σσ + λᵢ/Σλ) |uᵢ · vᵢ|`, Eq. 3.17: 0 to 1. Spectra must be of the same number of dimensions. O(k n).
pub fn kwas(a: &Spectrum, b: &Spectrum, k: usize, form: KwasForm) -> f64 {
    let k = k.min(a.shares.len()).min(b.shares.len());
    let pair = |i: usize| {
        (a.shares[i] + b.shares[i]) * a.vectors.column(i).dot(&b.vectors.column(i)).abs()
    };
    let printed = (0..k).map(pair).sum::<f64>() / 2.0;
    let best = (a.held(k) + b.held(k)) / 2.0;
    match form {
        KwasForm::Printed => printed,
        KwasForm::Normalised if best > 0.0 => printed / best,
        KwasForm::Normalised => 0.0,
    }
}
