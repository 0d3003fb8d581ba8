//! The version, and body parts by number and by name.

use std::ffi::{CStr, c_char};

use morec::roles::Role;

use crate::memory;

/// A body part, named for the joint at its near end: the hip joint has the role thigh, the knee shin, the wrist hand. Torso is
/// the first joint of the spine above the hips.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // The names say it all.
pub enum MorecRole {
    /// No role: a joint that recognition does not use.
    None = -1,
    Hips = 0,
    LeftThigh = 1,
    LeftShin = 2,
    LeftFoot = 3,
    RightThigh = 4,
    RightShin = 5,
    RightFoot = 6,
    Torso = 7,
    Neck = 8,
    Head = 9,
    LeftShoulder = 10,
    LeftArm = 11,
    LeftForearm = 12,
    LeftHand = 13,
    RightShoulder = 14,
    RightArm = 15,
    RightForearm = 16,
    RightHand = 17,
}

/// Number of body parts; they are numbered from 0.
pub const MOREC_ROLE_COUNT: u32 = 18;

/// Number of body parts, points of both hands, points of a custom skeleton and `face` together; they are numbered from 0.
pub const MOREC_POINT_COUNT: u32 = 85;

const _: () = assert!(MOREC_POINT_COUNT as usize == Role::COUNT);
const _: () = assert!(
    MOREC_ROLE_COUNT as usize == Role::BODY_COUNT
        && MorecRole::RightHand as usize + 1 == Role::BODY_COUNT
);

const NAMES: [&CStr; Role::COUNT] = [
    c"hips",
    c"left_thigh",
    c"left_shin",
    c"left_foot",
    c"right_thigh",
    c"right_shin",
    c"right_foot",
    c"torso",
    c"neck",
    c"head",
    c"left_shoulder",
    c"left_arm",
    c"left_forearm",
    c"left_hand",
    c"right_shoulder",
    c"right_arm",
    c"right_forearm",
    c"right_hand",
    c"left_palm",
    c"left_thumb_1",
    c"left_thumb_2",
    c"left_thumb_3",
    c"left_thumb_tip",
    c"left_index_1",
    c"left_index_2",
    c"left_index_3",
    c"left_index_tip",
    c"left_middle_1",
    c"left_middle_2",
    c"left_middle_3",
    c"left_middle_tip",
    c"left_ring_1",
    c"left_ring_2",
    c"left_ring_3",
    c"left_ring_tip",
    c"left_little_1",
    c"left_little_2",
    c"left_little_3",
    c"left_little_tip",
    c"right_palm",
    c"right_thumb_1",
    c"right_thumb_2",
    c"right_thumb_3",
    c"right_thumb_tip",
    c"right_index_1",
    c"right_index_2",
    c"right_index_3",
    c"right_index_tip",
    c"right_middle_1",
    c"right_middle_2",
    c"right_middle_3",
    c"right_middle_tip",
    c"right_ring_1",
    c"right_ring_2",
    c"right_ring_3",
    c"right_ring_tip",
    c"right_little_1",
    c"right_little_2",
    c"right_little_3",
    c"right_little_tip",
    c"point_1",
    c"point_2",
    c"point_3",
    c"point_4",
    c"point_5",
    c"point_6",
    c"point_7",
    c"point_8",
    c"left_point_1",
    c"left_point_2",
    c"left_point_3",
    c"left_point_4",
    c"left_point_5",
    c"left_point_6",
    c"left_point_7",
    c"left_point_8",
    c"right_point_1",
    c"right_point_2",
    c"right_point_3",
    c"right_point_4",
    c"right_point_5",
    c"right_point_6",
    c"right_point_7",
    c"right_point_8",
    c"face",
];

/// The role of this number, if it is one.
pub(crate) fn role(number: i32) -> Option<Role> {
    usize::try_from(number)
        .ok()
        .and_then(|index| Role::ALL.get(index).copied())
}

/// Version of the library, such as `0.1.0`. The text is valid for ever.
#[unsafe(no_mangle)]
pub extern "C" fn morec_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// The name of a `MorecRole` or a point of a hand or of a custom skeleton, as in `left_forearm`, `right_index_tip` and `point_1`;
/// null for a number without a name. The text is valid for ever.
#[unsafe(no_mangle)]
pub extern "C" fn morec_role_name(role: i32) -> *const c_char {
    self::role(role).map_or(std::ptr::null(), |role| NAMES[role.index()].as_ptr())
}

/// The `MorecRole` of this name, or the number of a point of a hand or of a custom skeleton; `MOREC_ROLE_NONE` if there is no
/// such name, or `name` is null.
///
/// # Safety
/// `name` is null or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_role_from_name(name: *const c_char) -> i32 {
    // SAFETY: as promised to this function.
    let name = unsafe { memory::text(name, "name") };
    let role = name.ok().and_then(Role::from_name);
    role.map_or(MorecRole::None as i32, |role| role.index() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roles_have_the_numbers_and_names_of_the_library() {
        for known in Role::ALL {
            let number = known.index() as i32;
            assert_eq!(role(number), Some(known));
            assert_eq!(NAMES[known.index()].to_str(), Ok(known.name()));
            // SAFETY: a text that ends with a zero.
            let named = unsafe { morec_role_from_name(NAMES[known.index()].as_ptr()) };
            assert_eq!(named, number);
        }
        assert_eq!((role(-1), role(85), role(i32::MIN)), (None, None, None));
    }
}
