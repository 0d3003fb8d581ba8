//! What a training run is asked to do beyond the figures of the method.

use super::params::TrainParams;

/// How to train from clips.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainOptions {
    /// The figures of the method.
    pub params: TrainParams,
    /// Whether unlabelled parts of labelled clips are background.
    pub unlabelled_is_background: bool,
    /// Whether made everyday motion is background too, and from which seed.
    pub everyday: Option<u64>,
}

impl Default for TrainOptions {
    fn default() -> Self {
        Self { params: TrainParams::default(), unlabelled_is_background: true, everyday: Some(EVERYDAY_SEED) }
    }
}

/// Seed of the everyday motion that indexes are trained with unless told otherwise.
pub const EVERYDAY_SEED: u64 = 2009;
