//! Parameters of pose rows.

/// Representation of the root.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RootForm {
    /// `q_W(t+Δ) q_W*(t)`, as printed (thesis §4.2): the turn to the next frame in the world's axes. Its yaw part does
    /// not depend on where the performer faces, its pitch and roll parts do.
    #[default]
    World,
    /// `q_W*(t) q_W(t+Δ)`: the same turn in the body's axes, free of heading altogether.
    Body,
}

/// Selects one of the two quaternions of a rotation for a row. Either way a frame's signs depend on it and on frames
/// before it, never on later ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum QuaternionSign {
    /// A stretch's first frame has `w ≥ 0`, every other the sign nearer to the frame before it: nothing jumps.
    #[default]
    Continuous,
    /// Every frame has `w ≥ 0`: rows do not depend on where a stretch began, and jump where a pivot turns by more
    /// than half a turn from its parent.
    Hemisphere,
}

/// The parameters of pose rows. An index keeps the values it was trained with.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PoseParams {
    /// Rows a second; every source is resampled to it. The root's Δ is one such frame.
    pub rate_hz: f64,
    /// Representation of the root.
    pub root: RootForm,
    /// Signs of the pivots below the root; the root's turn is near none and always has `w ≥ 0`.
    pub signs: QuaternionSign,
}

impl Default for PoseParams {
    /// As printed: thesis §4.2, 120 Hz.
    fn default() -> Self {
        Self {
            rate_hz: 120.0,
            root: RootForm::World,
            signs: QuaternionSign::Continuous,
        }
    }
}

impl PoseParams {
    /// Says what is wrong with these values, if anything is.
    ///
    /// # Errors
    /// A sentence about the first value out of its range.
    pub fn check(&self) -> Result<(), String> {
        // A push makes every frame since the one before: a rate without bounds would be a push without end.
        match self.rate_hz {
            rate if (10.0..=1000.0).contains(&rate) => Ok(()),
            rate => Err(format!("rate_hz must be 10 to 1000, found {rate}")),
        }
    }
}
