//! Motions as a few principal components of their poses have them.

use std::ops::Range;

use morec::clip::Clip;
use morec::pca::{ComponentCount, Moments, Pca};
use morec::pivots::{PivotMap, PivotSet, PoseParams, clip_of_pose_rows, pose_rows_of_clip};
use morec::roles::RoleMap;

use crate::OperationError;

/// Each clip (with its roles and the frames that a conversion left at its start) rebuilt from the first `dims` principal components of
/// the poses of all of them (Bucur 2009, Eq. 3.10). O(frames · pivots² + pivots³).
///
/// # Errors
/// A clip without rotations or without a root, fewer than two poses, or more dimensions than poses have.
pub fn rebuilt_from(
    clips: &[(&Clip, &RoleMap, Range<usize>)],
    dims: usize,
) -> Result<Vec<Clip>, OperationError> {
    let (set, params) = (PivotSet::thesis(), PoseParams::default());
    let mut moments = Moments::new(set.row_dim());
    let mut posed = Vec::with_capacity(clips.len());
    for (clip, roles, rest) in clips {
        let map = PivotMap::of_clip(&set, clip, roles).map_err(|source| {
            let clip = clip.name.clone();
            OperationError::NoPivots { clip, source }
        })?;
        let rows = pose_rows_of_clip(clip, &set, &map, rest, &params);
        moments.push_rows(&rows);
        posed.push((map, rows));
    }
    let pca = Pca::fit(&moments, ComponentCount::Dims(dims))?;
    let rebuilt = clips.iter().zip(posed).map(|((clip, ..), (map, rows))| {
        let rows = pca.reconstruct(&pca.project(&rows));
        clip_of_pose_rows(clip, &set, &map, &rows, &params)
    });
    Ok(rebuilt.collect())
}
