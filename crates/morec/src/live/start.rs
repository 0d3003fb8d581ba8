//! Why a stream cannot be recognised.

use crate::templates::TemplateModelError;
use crate::thesis::pivots::NoPivots;

/// Why a stream cannot be recognised with a model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StartError {
    /// The model's parts do not fit together, or the stream shows none of its bones.
    #[error(transparent)]
    Templates(#[from] TemplateModelError),
    /// The model's parts do not fit together.
    #[error(transparent)]
    Svrdm(#[from] crate::thesis::svrdm::ModelError),
    /// The skeleton lacks the pivot that all others hang from, or its rotations are not known.
    #[error(transparent)]
    Pivots(#[from] NoPivots),
}
