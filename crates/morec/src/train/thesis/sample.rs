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

/// A sample with its `AᵀA` and directions; `None` if it does not move at all.
pub(super) fn described<'s>(
    sample: &'s ThesisSample,
    dim: usize,
    stages: &SvrdmParams,
) -> Option<(&'s ThesisSample, Gram, Directions)> {
    let gram = Gram::of_rows(sample.rows.values(), dim, stages.chunk_frames);
    let mut directions = Directions::new(stages.eigenvectors, dim);
    directions
        .find(&gram, stages.centring)
        .then_some((sample, gram, directions))
}
