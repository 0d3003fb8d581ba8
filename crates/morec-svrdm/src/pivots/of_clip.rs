//! A whole clip through the same door as a live stream.

use mocap::clip::{Clip, Span};
use mocap::kinematics::for_each_world_pose;
use morec_features::Rows;

use super::{PivotMap, PivotPose, PivotSet, PoseParams, PoseStream};

/// Calls `each` with the time and pivots of every frame of `clip` in turn, frame `f` at `f / rate_hz`.
///
/// Frames in `rest` show the first pose after them, as in [`for_each_pose`](morec_features::for_each_pose).
pub fn for_each_pivot_pose(
    clip: &Clip,
    map: &PivotMap,
    rest: &Span,
    mut each: impl FnMut(f64, &PivotPose),
) {
    for_each_world_pose(clip, rest, |time_secs, world| {
        each(time_secs, &map.pose(world))
    });
}

/// The pose rows of a clip, `frames × 4 pivots` at the rate of `params`; row `i` is the pose at `i / rate_hz`
/// seconds. O(frames · joints).
pub fn pose_rows_of_clip(
    clip: &Clip,
    set: &PivotSet,
    map: &PivotMap,
    rest: &Span,
    params: &PoseParams,
) -> Rows {
    let mut stream = PoseStream::new(set, params);
    let mut rows = Rows::new(stream.dim());
    for_each_pivot_pose(clip, map, rest, |time_secs, pose| {
        stream.push(time_secs, pose, &mut |row| rows.push(row));
    });
    stream.finish(&mut |row| rows.push(row));
    rows
}
