//! A whole clip through the same door as a live stream.

use crate::clip::{Clip, Span};
use crate::kinematics::WorldPose;
use crate::roles::RoleMap;

use super::{BoneSet, FeatureParams, FeatureStream, KeyPose, Rows};

/// Calls `each` with the time and pose of every frame of `clip` in turn, frame `f` at `f / rate_hz`.
///
/// Frames in `rest` (the T-pose that a conversion left at the start) show the first pose after them instead:
/// times stay those of the file, and the jump out of the T-pose is not taken for motion.
pub fn for_each_pose(clip: &Clip, roles: &RoleMap, rest: &Span, mut each: impl FnMut(f64, &KeyPose)) {
    let mut world = WorldPose::default();
    for frame in 0..clip.frames {
        let shown = if rest.contains(&frame) { rest.end.min(clip.frames - 1) } else { frame };
        world.set(clip, shown);
        each(frame as f64 / clip.rate_hz, &KeyPose::of(&world, roles));
    }
}

/// The bones that `clip` shows: both ends mapped, and of some length in its first frame of motion.
pub fn bones_of_clip(clip: &Clip, roles: &RoleMap, rest: &Span) -> BoneSet {
    if clip.frames == 0 {
        return BoneSet::NONE;
    }
    let world = WorldPose::of(clip, rest.end.min(clip.frames - 1));
    BoneSet::of_roles(roles).and(BoneSet::of_pose(&KeyPose::of(&world, roles)))
}

/// The feature rows of a clip over `bones`; row `i` ends at `(i + 1) / tick_hz` seconds.
pub fn rows_of_clip(
    clip: &Clip,
    roles: &RoleMap,
    rest: &Span,
    bones: BoneSet,
    params: &FeatureParams,
) -> Rows {
    let mut stream = FeatureStream::new(bones, params);
    let mut rows = Rows::new(stream.dim());
    for_each_pose(clip, roles, rest, |time_secs, pose| {
        stream.push(time_secs, pose, &mut |row| rows.push(row));
    });
    stream.finish(&mut |row| rows.push(row));
    rows
}
