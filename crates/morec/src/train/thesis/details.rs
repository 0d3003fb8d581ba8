//! Training results that only the thesis's method has.

use serde::Serialize;

use crate::pca::QualityRow;
use morec_svrdm::train_tree::BranchReport;

use super::thresholds::Estimated;

/// Training results beyond those of every method.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SvrdmReport {
    /// Values in a reduced row, `r`.
    pub dims: usize,
    /// Share of the variance that they keep (Eq. 3.8).
    pub quality: f64,
    /// Variance kept by fewer or more components.
    pub quality_table: Vec<QualityRow>,
    /// Of each direction, the share of samples whose sign was close to flipping (Alg. 5).
    pub unsure_signs: Vec<f64>,
    /// The branches of the tree, the root first.
    pub branches: Vec<BranchReport>,
    /// `T` in recognition.
    pub accept: f64,
    /// Least confidence that is reported.
    pub min_confidence: f64,
    /// Estimation of these two, if they were estimated.
    pub estimated: Option<Estimated>,
}
