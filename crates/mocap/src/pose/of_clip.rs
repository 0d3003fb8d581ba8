//! The poses of a clip, and the bones that it shows.

use crate::clip::{Clip, Span};
use crate::kinematics::{PartialSkeleton, WorldPose};
use crate::roles::{Role, RoleMap};

use super::{BoneSet, KeyPose, Profile};

/// Calls `each` with the time and pose of every frame of `clip` in turn, as
/// [`for_each_world_pose`](crate::kinematics::for_each_world_pose) shows them.
pub fn for_each_pose(
    clip: &Clip,
    roles: &RoleMap,
    rest: &Span,
    mut each: impl FnMut(f64, &KeyPose),
) {
    let played: Vec<_> = roles.played().collect();
    let part = PartialSkeleton::of(clip, played.iter().map(|(_, joint)| *joint));
    let mut key = KeyPose::default();
    part.for_each_world_pose(rest, |time_secs, world| {
        key.update(world, played.iter().copied());
        each(time_secs, &key);
    });
}

/// The bones that `clip` shows: both ends mapped, and of some length in its first frame of motion. Of these, [those that are
/// used](Profile::usual_bones).
pub fn bones_of_clip(clip: &Clip, roles: &RoleMap, rest: &Span) -> BoneSet {
    Profile::usual_bones(all_bones_of_clip(clip, roles, rest))
}

/// All bones that `clip` shows, of any [profile](Profile), in the first frame that shows one: a hand may come later.
pub fn all_bones_of_clip(clip: &Clip, roles: &RoleMap, rest: &Span) -> BoneSet {
    let mut frames = rest.end.min(clip.frames.saturating_sub(1))..clip.frames;
    let shown = |frame| {
        let bones = BoneSet::of_pose(&KeyPose::of(&WorldPose::of(clip, frame), roles));
        (!bones.is_empty()).then_some(bones)
    };
    match BoneSet::of_roles(roles).is_empty() {
        true => BoneSet::NONE,
        false => frames.find_map(shown).unwrap_or(BoneSet::NONE),
    }
}

/// True if `clip` shows both hip joints in some frame behind `rest`. O(1) where the first of them does.
pub fn shows_hips(clip: &Clip, roles: &RoleMap, rest: &Span) -> bool {
    const HIPS: [Role; 2] = [Role::LeftThigh, Role::RightThigh];
    let in_frame = |frame: usize| {
        let pose = KeyPose::of(&WorldPose::of(clip, frame), roles);
        HIPS.iter().all(|role| pose.get(*role).is_some())
    };
    let mapped = HIPS.iter().all(|role| roles.joint(*role).is_some());
    mapped && (rest.end..clip.frames).any(in_frame)
}
