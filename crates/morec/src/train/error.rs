//! Why nothing could be trained.

use crate::templates::TemplateModelError;

/// Why nothing could be trained.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrainError {
    /// There is no sample to learn from.
    #[error("no sample to learn from: no label lies inside its clip")]
    NoSamples,
    /// Labelled clips of which none shows a body.
    #[error(
        "no body to learn from in {0}: no limb and no head is found among the joints (`morec inspect` shows what is); faces \
         and things alone cannot be learned"
    )]
    NoBody(String),
    /// Labelled clips that show bodies, but no bone in common.
    #[error("no bone to learn from: the labelled clips show none in common")]
    NoCommonBone,
    /// More classes than an index numbers.
    #[error("{0} classes; an index can have at most 65535")]
    TooManyClasses(usize),
    /// A class that an index must know well enough to show is not shown.
    #[error(
        "class {class}: no sample of it can be described; each needs some motion inside its clip"
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
