//! A sample, and what describes it.

use crate::classes::ClassId;
use crate::features::Rows;
use crate::svrdm::{Directions, Gram, SvrdmParams};

/// A sample cut out of its clip.
#[derive(Debug, Clone)]
pub struct ThesisSample {
    /// Number of the class.
    pub class: ClassId,
    /// Number of the person who shows it: the clip where nobody is named.
    pub group: usize,
    /// Its reduced rows, `frames × r`.
    pub rows: Rows,
}

/// The `AᵀA` and directions of a sample's reduced rows; `None` if it does not move at all.
pub(super) fn described(
    rows: &Rows,
    dim: usize,
    stages: &SvrdmParams,
) -> Option<(Gram, Directions)> {
    let gram = Gram::of_rows(rows.values(), dim, stages.chunk_frames);
    let mut directions = Directions::new(stages.eigenvectors, dim);
    directions
        .find(&gram, stages.centring)
        .then_some((gram, directions))
}
