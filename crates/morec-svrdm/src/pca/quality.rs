//! Variance kept by the number of dimensions.

/// Number of dimensions to keep.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ComponentCount {
    /// As few as hold this share of the variance, above 0 and at most 1 (thesis Eq. 3.8: `f ≥ τ`).
    Quality(f64),
    /// This many, or all if there are fewer.
    Dims(usize),
}

impl ComponentCount {
    /// Dimensions to keep of those with these `eigenvalues`, largest first; at least 1 where there is one.
    ///
    /// Rounding is allowed for: quality 1 stops where what is left is 10⁻¹² of all.
    pub fn dims(self, eigenvalues: &[f64]) -> usize {
        let wanted = match self {
            ComponentCount::Dims(dims) => dims,
            ComponentCount::Quality(share) => {
                let all: f64 = eigenvalues.iter().sum();
                let enough = share.min(1.0 - 1e-12) * all;
                let mut sum = 0.0;
                let fewer = eigenvalues.iter().take_while(|&value| {
                    sum += value;
                    sum < enough
                });
                fewer.count() + 1
            }
        };
        wanted.max(1).min(eigenvalues.len())
    }

    /// Says what is wrong with it, if anything is.
    ///
    /// # Errors
    /// A sentence about the first value out of its range.
    pub fn check(self) -> Result<(), String> {
        match self {
            ComponentCount::Quality(share) if !(share > 0.0 && share <= 1.0) => Err(format!(
                "quality must be above 0 and at most 1, found {share}"
            )),
            ComponentCount::Dims(0) => {
                Err("the number of dimensions must be 1 or more, found 0".to_owned())
            }
            _ => Ok(()),
        }
    }
}

/// A line of the quality table: what is kept with this many dimensions.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct QualityRow {
    /// Dimensions kept, `r`.
    pub dims: usize,
    /// `Σᵢ≤ᵣ λᵢ / Σ λᵢ` (Eq. 3.8).
    pub quality: f64,
    /// The last of them: `λᵣ`, an eigenvalue of `M`.
    pub eigenvalue: f64,
}
