//! Why a stream cannot be recognised.

use crate::features::{BoneSet, Profile};
use crate::pivots::NoPivots;
use crate::templates::TemplateModelError;

/// An error if nothing of what an index `uses` is `shown`.
pub(super) fn check_shown(uses: BoneSet, shown: BoneSet) -> Result<(), StartError> {
    if !uses.and(shown).is_empty() {
        return Ok(());
    }
    let (index, shown_here) = (
        Profile::words_of(uses),
        Profile::words_of(Profile::usual_bones(shown)),
    );
    match shown.is_empty() || index == shown_here {
        true => Err(TemplateModelError::NoBones.into()),
        false => Err(StartError::OtherProfile {
            index,
            shown: shown_here,
        }),
    }
}

/// Why a stream cannot be recognised with a model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StartError {
    /// The model's parts do not fit together, or the stream shows none of its bones.
    #[error(transparent)]
    Templates(#[from] TemplateModelError),
    /// The model's parts do not fit together.
    #[error(transparent)]
    Svrdm(#[from] crate::svrdm::ModelError),
    /// No skeleton is known yet.
    #[error("the skeleton is unknown: it must be set before the first frame")]
    NoSkeleton,
    /// The stream shows a performer of another kind than the index is of.
    #[error("this index recognises {index}, but the input shows {shown}")]
    OtherProfile {
        /// What the index is of.
        index: &'static str,
        /// What the stream shows.
        shown: &'static str,
    },
    /// The skeleton lacks the pivot that all others hang from, or its rotations are not known.
    #[error(transparent)]
    Pivots(#[from] NoPivots),
}
