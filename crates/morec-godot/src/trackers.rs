//! Poses of XR trackers, by the roles of their joints.

use godot::classes::xr_body_tracker::Joint;
use godot::classes::xr_hand_tracker::HandJoint;
use godot::classes::xr_positional_tracker::TrackerHand;
use godot::classes::{XrBodyTracker, XrHandTracker, XrServer, XrTracker};
use godot::prelude::*;
use morec::features::{Hand, KeyPose};
use morec::math::Vec3;
use morec::roles::Role;
use morec::roles::points::numbered_hand;

/// The joints of a tracked body and what they play.
const BODY: [(Joint, Role); 18] = [
    (Joint::HIPS, Role::Hips),
    (Joint::CHEST, Role::Torso),
    (Joint::NECK, Role::Neck),
    (Joint::HEAD, Role::Head),
    (Joint::LEFT_SHOULDER, Role::LeftShoulder),
    (Joint::LEFT_UPPER_ARM, Role::LeftArm),
    (Joint::LEFT_LOWER_ARM, Role::LeftForearm),
    (Joint::LEFT_HAND, Role::LeftHand),
    (Joint::RIGHT_SHOULDER, Role::RightShoulder),
    (Joint::RIGHT_UPPER_ARM, Role::RightArm),
    (Joint::RIGHT_LOWER_ARM, Role::RightForearm),
    (Joint::RIGHT_HAND, Role::RightHand),
    (Joint::LEFT_UPPER_LEG, Role::LeftThigh),
    (Joint::LEFT_LOWER_LEG, Role::LeftShin),
    (Joint::LEFT_FOOT, Role::LeftFoot),
    (Joint::RIGHT_UPPER_LEG, Role::RightThigh),
    (Joint::RIGHT_LOWER_LEG, Role::RightShin),
    (Joint::RIGHT_FOOT, Role::RightFoot),
];

/// The names under which OpenXR's trackers are.
pub fn usual() -> PackedStringArray {
    const NAMES: [&str; 3] = [
        "/user/body_tracker",
        "/user/hand_tracker/left",
        "/user/hand_tracker/right",
    ];
    NAMES.iter().map(|name| GString::from(*name)).collect()
}

/// The current poses of the trackers with these names; lost trackers are left out.
pub fn pose(names: &PackedStringArray) -> KeyPose {
    let mut pose = KeyPose::default();
    let server = XrServer::singleton();
    for name in names.as_slice() {
        let tracker: Option<Gd<XrTracker>> = server.get_tracker(&StringName::from(name));
        let Some(tracker) = tracker else { continue };
        match tracker.try_cast::<XrBodyTracker>() {
            Ok(body) => of_body(&body, &mut pose),
            Err(tracker) => {
                if let Ok(hand) = tracker.try_cast::<XrHandTracker>() {
                    of_hand(&hand, &mut pose);
                }
            }
        }
    }
    pose
}

fn of_body(body: &Gd<XrBodyTracker>, pose: &mut KeyPose) {
    if !body.get_has_tracking_data() {
        return;
    }
    for (joint, role) in BODY {
        pose.set(role, vector(body.get_joint_transform(joint).origin));
    }
}

fn of_hand(tracker: &Gd<XrHandTracker>, pose: &mut KeyPose) {
    if !tracker.get_has_tracking_data() {
        return;
    }
    let hand = match tracker.get_tracker_hand() {
        TrackerHand::LEFT => Hand::Left,
        TrackerHand::RIGHT => Hand::Right,
        _ => return,
    };
    // Godot's joints are OpenXR's, by their numbers.
    let roles = numbered_hand(HandJoint::MAX.ord() as usize, hand);
    for (number, role) in (0..).zip(roles.into_iter().flatten()) {
        if let (Some(role), Some(joint)) = (role, HandJoint::try_from_ord(number)) {
            pose.set(role, vector(tracker.get_hand_joint_transform(joint).origin));
        }
    }
}

/// A position in the engine's units, which are morec's: metres, Y up, right-handed.
pub fn vector(at: Vector3) -> Vec3 {
    Vec3::new(f64::from(at.x), f64::from(at.y), f64::from(at.z))
}
