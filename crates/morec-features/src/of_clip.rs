//! A whole clip through the same door as a live stream.

use mocap::clip::{Clip, Span};
use mocap::roles::RoleMap;

use crate::{BoneSet, FeatureParams, FeatureStream, Rows, for_each_pose};

/// The feature rows of a clip over `bones`, with the fingers of its skeleton if they are among them; row `i` ends at `(i + 1) / tick_hz` seconds.
pub fn rows_of_clip(
    clip: &Clip,
    roles: &RoleMap,
    rest: &Span,
    bones: BoneSet,
    params: &FeatureParams,
) -> Rows {
    let roles = &roles.for_bones(&clip.skeleton, bones);
    let mut stream = FeatureStream::new(bones, params);
    let mut rows = Rows::new(stream.dim());
    for_each_pose(clip, roles, rest, |time_secs, pose| {
        stream.push(time_secs, pose, &mut |row| rows.push(row));
    });
    stream.finish(&mut |row| rows.push(row));
    rows
}
