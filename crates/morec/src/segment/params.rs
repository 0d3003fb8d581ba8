//! The parameters of segmentation.

/// Direction in which a clip is passed through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PassDirections {
    /// From start to end: finds where something new begins. What is a part of what came before (standing after
    /// walking) goes unnoticed.
    Forward,
    /// From end to start, which notices just that.
    Backward,
    /// Both, and the cuts of either.
    #[default]
    Both,
}

/// Parameters of cutting. Times are scaled with the rate of the rows.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PpcaParams {
    /// `K₀`: what a segment's first model is made of; no segment is shorter. 150 frames at 120 Hz (thesis §4.3).
    pub first_secs: f64,
    /// `T`: what is held against the model. 150 frames at 120 Hz (thesis §4.3).
    pub ahead_secs: f64,
    /// `Δ`: what the segment grows by from round to round. 10 frames at 120 Hz (thesis §4.3; Algorithm 2 prints T).
    pub step_secs: f64,
    /// Share of a segment's first variance that the model keeps; the number of dimensions then stays until the
    /// next cut. 0.95 (thesis §3.4.1).
    pub quality: f64,
    /// `R`: how far `H` must rise from a valley to a peak, in multiples of `n`, which is what `H` is for rows that fit.
    /// Chosen on the cuts of mixed behaviours and exercises.
    pub rise: f64,
    /// A peak counts once `H` has fallen from it by this share of its rise.
    pub fall: f64,
    /// Directions of the passes.
    pub directions: PassDirections,
    /// A backward cut this near to a forward one is the same. Half of `T`.
    pub same_secs: f64,
    /// No variance is taken for less, so that a frozen sensor does not make the slightest motion a surprise.
    pub least_variance: f64,
}

impl Default for PpcaParams {
    fn default() -> Self {
        Self {
            first_secs: 1.25,
            ahead_secs: 1.25,
            step_secs: 10.0 / 120.0,
            quality: 0.95,
            rise: 6.25,
            fall: 0.5,
            directions: PassDirections::Both,
            same_secs: 0.625,
            least_variance: 1e-10,
        }
    }
}

/// Why rows cannot be cut.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // The messages say it all.
pub enum SegmentError {
    #[error("{0}")]
    Params(String),
    #[error("the rate must be above 0 and at most 100000 rows a second, found {0}")]
    Rate(f64),
    #[error("row {row} contains a value that is not finite")]
    NotFinite { row: usize },
}

impl PpcaParams {
    /// Says what is wrong with these values, if anything is.
    ///
    /// # Errors
    /// A sentence about the first value out of its range.
    pub fn check(&self) -> Result<(), String> {
        let above_0 = [
            ("first_secs", self.first_secs),
            ("ahead_secs", self.ahead_secs),
            ("step_secs", self.step_secs),
            ("rise", self.rise),
            ("least_variance", self.least_variance),
        ];
        if let Some((name, value)) = above_0.iter().find(|(_, v)| !(v.is_finite() && *v > 0.0)) {
            return Err(format!("{name} must be above 0, found {value}"));
        }
        if !(self.quality > 0.0 && self.quality <= 1.0) {
            return Err(format!(
                "quality must be above 0 and at most 1, found {}",
                self.quality
            ));
        }
        if !(0.0..=1.0).contains(&self.fall) {
            return Err(format!("fall must be 0 to 1, found {}", self.fall));
        }
        if !(self.same_secs.is_finite() && self.same_secs >= 0.0) {
            return Err(format!(
                "same_secs must be 0 or more, found {}",
                self.same_secs
            ));
        }
        Ok(())
    }
}
