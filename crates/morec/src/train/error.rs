//! Errors of training.

use crate::templates::TemplateModelError;

/// Why nothing could be trained.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrainError {
    /// There is no sample to train on.
    #[error("no sample to train on: no label lies inside its clip")]
    NoSamples,
    /// Labelled clips of which none shows a body.
    #[error(
        "no body to train on in {0}: its joints include neither a limb nor a head (`morec inspect` lists them); faces and \
         objects alone cannot be learned"
    )]
    NoBody(String),
    /// Labelled clips that show bodies, but no bone in common.
    #[error("no bone to train on: the labelled clips have none in common")]
    NoCommonBone,
    /// More classes than an index numbers.
    #[error("{0} classes; an index can have at most 65535")]
    TooManyClasses(usize),
    /// A class that an index must know well enough to show is not shown.
    #[error(
        "class {class}: none of its samples can be used; each needs some motion inside its clip"
    )]
    NoSample {
        /// Name of the class.
        class: String,
    },
    /// A clip cannot serve.
    #[error("clip {clip}: {problem}")]
    Clip {
        /// Name of the clip.
        clip: String,
        /// What is wrong, as the end of a sentence.
        problem: String,
    },
    /// Options that make no sense, alone or with these clips.
    #[error("{0}")]
    Params(String),
    /// Parts came out unusable.
    #[error(transparent)]
    Svrdm(#[from] crate::svrdm::ModelError),
    /// Parts came out unusable.
    #[error(transparent)]
    Model(#[from] TemplateModelError),
    /// The listener asked to stop.
    #[error("cancelled")]
    Cancelled,
}
