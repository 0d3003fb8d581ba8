//! Principal component analysis of any number of clips in constant memory (thesis §3.4, §4.2).
//!
//! Notation: `m` rows of `D` values, `r` dimensions kept of them; `M = AᵀA` with the rows of `A` centred on the mean
//! of the whole database, `λ₁ ≥ λ₂ ≥ …` its eigenvalues. Where the thesis has "eigenvalues of A" (Eq. 3.7) it
//! means singular values, `σᵢ = √λᵢ`; the quality of `r` dimensions (Eq. 3.8) is `Σᵢ≤ᵣ λᵢ / Σ λᵢ`.
//!
//! ```
//! use morec_features::Rows;
//! use morec_svrdm::pca::{ComponentCount, Moments, Pca};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let rows = Rows::from_values(2, vec![0.0, 0.0, 1.0, 2.0, 2.0, 4.0, 3.0, 6.0]);
//! let mut moments = Moments::new(2);
//! moments.push_rows(&rows);                        // as many rows as there are, a block at a time
//! let pca = Pca::fit(&moments, ComponentCount::Quality(0.95))?;
//! assert_eq!(pca.dims(), 1);                       // they lie on a line
//! assert!((pca.reconstruct(&pca.project(&rows)).values()[3] - 2.0).abs() < 1e-5);
//! # Ok(())
//! # }
//! ```

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
