//! The figures of training.

use crate::decode::DecodeParams;
use crate::features::FeatureParams;

/// How templates are trained.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TrainParams {
    /// How rows are made.
    pub features: FeatureParams,
    /// How distances become detections.
    pub decode: DecodeParams,
    /// Ridge of the metric, as a share of the mean variance; .15 to .5 are alike.
    pub rho: f64,
    /// Sample pairs a class's scatter is estimated from at most.
    pub max_pairs: usize,
    /// The threshold is this times the smallest distance from a template to background motion.
    pub background_share: f64,
    /// The threshold where there is no background at all.
    pub fallback_threshold: f64,
    /// Stretches nearer than this to a template may become negatives.
    pub negative_below: f64,
    /// Unlabelled stretches of labelled clips nearer than this times the threshold are left alone: they are
    /// probably samples that nobody labelled.
    pub suspicious_below: f64,
    /// Negatives kept at most.
    pub max_negatives: usize,
    /// Whether negatives are looked for at all.
    pub mine_negatives: bool,
}

impl Default for TrainParams {
    fn default() -> Self {
        Self { features: FeatureParams::default(), decode: DecodeParams::default(), ..Self::reference() }
    }
}

impl TrainParams {
    /// The values of the reference prototype.
    pub fn reference() -> Self {
        Self {
            features: FeatureParams::reference(),
            decode: DecodeParams::reference(),
            rho: 0.3,
            max_pairs: 200,
            background_share: 0.85,
            fallback_threshold: 2.0,
            negative_below: 2.6,
            suspicious_below: 0.7,
            max_negatives: 60,
            mine_negatives: true,
        }
    }
}
