//! Recognises the rest pose of avatars that have no tracker.

use morec::math::Vec3;
use morec::roles::Role;

/// Arms are stretched out to the side as exactly as this (2°): people who try are farther off with some part.
const ARMS: f64 = 0.999_39;
/// Legs hang down as exactly as this (8°).
const LEGS: f64 = 0.990_27;

/// True if body parts at these positions are in a T-pose, too exact to be a person's: what a sender shows that has lost its tracker.
pub fn is_t_pose(position: impl Fn(Role) -> Option<Vec3>) -> bool {
    let along = |from, to| (position(to)? - position(from)?).try_normalize(1e-6);
    let check = || -> Option<bool> {
        let left = along(Role::RightThigh, Role::LeftThigh)?;
        let is = |from, to, direction: Vec3, exact: f64| {
            along(from, to).is_some_and(|bone: Vec3| bone.dot(&direction) > exact)
        };
        let arms = is(Role::LeftArm, Role::LeftForearm, left, ARMS)
            && is(Role::LeftForearm, Role::LeftHand, left, ARMS)
            && is(Role::RightArm, Role::RightForearm, -left, ARMS)
            && is(Role::RightForearm, Role::RightHand, -left, ARMS);
        let down = -Vec3::y();
        let legs = is(Role::LeftThigh, Role::LeftShin, down, LEGS)
            && is(Role::RightThigh, Role::RightShin, down, LEGS);
        Some(arms && legs)
    };
    check().unwrap_or(false)
}
