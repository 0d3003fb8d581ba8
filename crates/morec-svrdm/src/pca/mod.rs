//! Principal component analysis of any number of clips in constant memory (thesis §3.4, §4.2).
//!
//! Notation: `m` rows of `D` values, `r` dimensions kept of them; `M = AᵀA` with the rows of `A` centred on the mean
//! of the whole database, `λ₁ ≥ λ₂ ≥ …` its eigenvalues. Where the thesis has "eigenvalues of A" (Eq. 3.7) it
//! means singular values, `σᵢ = √λᵢ`; the quality of `r` dimensions (Eq. 3.8) is `Σᵢ≤ᵣ λᵢ / Σ λᵢ`.

mod eigen;
mod model;
mod moments;
mod quality;

pub use eigen::Eigen;
pub use model::{Pca, PcaError};
pub use moments::Moments;
pub use quality::{ComponentCount, QualityRow};

#[cfg(test)]
mod tests;
