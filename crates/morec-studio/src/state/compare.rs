//! Performers beside the one that is shown: a sample against its match, aligned by the warping path.

use std::sync::Arc;

use crate::body::Aligned;
use crate::stretch::Stretch;

/// Placement of companions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Placement {
    #[default]
    Beside,
    OnTop,
}

/// Performers of other clips with the one that is shown.
#[derive(Default)]
pub struct Companions {
    pub all: Vec<Arc<Aligned>>,
    pub placement: Placement,
}

/// Commands for comparing.
#[derive(Debug, Clone, PartialEq)]
pub enum CompareCommand {
    /// A stretch with another, which is its mirror image if `mirrored`.
    With {
        of: Stretch,
        with: Stretch,
        mirrored: bool,
    },
    /// The selected stretch or label with what is most like it.
    Nearest,
    /// A stretch with the nearest label of a class.
    NearestOf {
        of: Stretch,
        class: String,
    },
    /// The chosen moment of a cross-validation with the nearest label of a class; `None` of the class that was recognised.
    Moment(Option<String>),
    /// The selected stretch with itself, rebuilt from so many principal components of its clip's poses.
    Reduced(usize),
    Place(Placement),
    /// Nobody but the performer.
    Clear,
}
