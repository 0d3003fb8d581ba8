//! Distances of a clip to each class, the common result of both ways of comparison.

/// Distances of a clip from every class.
pub struct ClipDistances {
    /// By class, as a share of the distance that is just accepted; infinite where nothing comes near.
    pub classes: Vec<f32>,
    /// The verifier's score of the nearest class, where there is a verifier.
    pub verified: Option<f64>,
}
