//! From clips and labels to a model of the thesis's kind: pose rows, principal components, feature vectors, the tree
//! ([`train::svrdm`](crate::train::svrdm)), profiles, and the thresholds of recognition.

mod details;
mod fit;
mod material;
mod options;
mod report;
mod sample;
mod sample_tree;
mod thresholds;

pub use details::SvrdmReport;
pub use options::{Pivots, Setting, SvrdmOptions, SvrdmTrainParams, ThresholdRule};
pub use sample::ThesisSample;
pub use sample_tree::tree_of_samples;
pub use thresholds::Estimated;

use crate::progress::Progress;
use crate::svrdm::SvrdmModel;
use crate::train::{LabelSet, TrainClip, TrainError, TrainingReport};

/// Trains the thesis's recogniser on labelled and background clips (§4.2 to §4.5).
///
/// Pose rows depend on the axes that a rig gave its joints, so made everyday motion, which has a rig of its own, is no
/// background here.
///
/// # Errors
/// Clips that cannot teach, a class without samples; or `progress` cancels.
pub fn train_svrdm(
    clips: &[TrainClip],
    labelling: &LabelSet<'_>,
    options: &SvrdmOptions,
    progress: &dyn Progress,
) -> Result<(SvrdmModel, TrainingReport), TrainError> {
    let params = &options.params;
    let material = material::of_clips(clips, labelling, options)?;
    if progress.cancelled() {
        return Err(TrainError::Cancelled);
    }
    let fitted = fit::fit(&material.samples, &material.classes, &material.pca, params)?;
    let (model, estimated) = match params.thresholds {
        ThresholdRule::Fixed => (fitted.model.clone(), None),
        ThresholdRule::Estimated { folds, other } => {
            let asked = (folds, other);
            let estimated =
                thresholds::estimate(&material, &fitted.model, params, asked, progress)?;
            (estimated.applied_to(&fitted.model), Some(estimated))
        }
    };
    let report = report::of(&material, &fitted, &model, estimated);
    Ok((model, report))
}
