//! Determines whether the body moves along the floor.

use crate::clip::{Clip, Span};
use crate::kinematics::position_of;
use crate::math::Vec3;
use crate::roles::{Role, RoleMap};

/// Hips that stay within this circle, metres, stay in place: swaying takes less, a step more.
const IN_PLACE: f64 = 0.25;

/// True if the hips leave the place where they began, in a clip in metres and Y-up.
pub(super) fn travels(clip: &Clip, map: &RoleMap, rest: &Span) -> bool {
    let hips = map.joint(Role::Hips).unwrap_or(0);
    if clip.skeleton.is_empty() {
        return false;
    }
    let mut first: Option<Vec3> = None;
    (rest.end..clip.frames).step_by(8).any(|frame| {
        let mut floor = position_of(clip, frame, hips);
        floor.y = 0.0;
        (floor - *first.get_or_insert(floor)).norm() > IN_PLACE
    })
}
