//! Which joint of a skeleton plays which part of the body.

mod check;
mod find;
mod languages;
mod limbs;
pub mod mapping;
mod meaning;
mod names;
mod pairs;
pub mod points;
pub(crate) mod proportions;
mod sides;
mod tree;
mod trunk;
mod words;

pub use check::check;
#[cfg(feature = "formats")]
pub(crate) use check::check_named;
pub use find::{find, find_moving};
#[cfg(feature = "formats")]
pub(crate) use find::{find_named, zero_pose};
#[cfg(feature = "formats")]
pub(crate) use names::JointNames;
pub use pairs::RolesFound;

use std::fmt;

/// A body part that recognition knows; played by the joint at its near end (the thigh by the hip joint, the
/// shin by the knee, the hand by the wrist).
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
#[allow(missing_docs)] // The names say it all.
pub enum Role {
    Hips,
    LeftThigh,
    LeftShin,
    LeftFoot,
    RightThigh,
    RightShin,
    RightFoot,
    Torso,
    Neck,
    Head,
    LeftShoulder,
    LeftArm,
    LeftForearm,
    LeftHand,
    RightShoulder,
    RightArm,
    RightForearm,
    RightHand,
}

/// Both legs, left first: thigh, shin, foot.
pub(crate) const LEGS: [[Role; 3]; 2] = [
    [Role::LeftThigh, Role::LeftShin, Role::LeftFoot],
    [Role::RightThigh, Role::RightShin, Role::RightFoot],
];
/// Both arms, left first: upper arm, forearm, hand.
pub(crate) const ARMS: [[Role; 3]; 2] = [
    [Role::LeftArm, Role::LeftForearm, Role::LeftHand],
    [Role::RightArm, Role::RightForearm, Role::RightHand],
];

impl Role {
    /// Number of roles.
    pub const COUNT: usize = 18;

    /// Every role, in the order of their numbers.
    pub const ALL: [Role; Role::COUNT] = [
        Role::Hips,
        Role::LeftThigh,
        Role::LeftShin,
        Role::LeftFoot,
        Role::RightThigh,
        Role::RightShin,
        Role::RightFoot,
        Role::Torso,
        Role::Neck,
        Role::Head,
        Role::LeftShoulder,
        Role::LeftArm,
        Role::LeftForearm,
        Role::LeftHand,
        Role::RightShoulder,
        Role::RightArm,
        Role::RightForearm,
        Role::RightHand,
    ];

    /// Its number, 0 to 17.
    pub fn index(self) -> usize {
        self as usize
    }

    /// The same part on the other side of the body; itself in the middle.
    pub fn opposite(self) -> Self {
        match self {
            Role::Hips | Role::Torso | Role::Neck | Role::Head => self,
            Role::LeftThigh => Role::RightThigh,
            Role::LeftShin => Role::RightShin,
            Role::LeftFoot => Role::RightFoot,
            Role::RightThigh => Role::LeftThigh,
            Role::RightShin => Role::LeftShin,
            Role::RightFoot => Role::LeftFoot,
            Role::LeftShoulder => Role::RightShoulder,
            Role::LeftArm => Role::RightArm,
            Role::LeftForearm => Role::RightForearm,
            Role::LeftHand => Role::RightHand,
            Role::RightShoulder => Role::LeftShoulder,
            Role::RightArm => Role::LeftArm,
            Role::RightForearm => Role::LeftForearm,
            Role::RightHand => Role::LeftHand,
        }
    }

    /// Its name in mapping files and reports, `left_forearm`.
    pub fn name(self) -> &'static str {
        match self {
            Role::Hips => "hips",
            Role::LeftThigh => "left_thigh",
            Role::LeftShin => "left_shin",
            Role::LeftFoot => "left_foot",
            Role::RightThigh => "right_thigh",
            Role::RightShin => "right_shin",
            Role::RightFoot => "right_foot",
            Role::Torso => "torso",
            Role::Neck => "neck",
            Role::Head => "head",
            Role::LeftShoulder => "left_shoulder",
            Role::LeftArm => "left_arm",
            Role::LeftForearm => "left_forearm",
            Role::LeftHand => "left_hand",
            Role::RightShoulder => "right_shoulder",
            Role::RightArm => "right_arm",
            Role::RightForearm => "right_forearm",
            Role::RightHand => "right_hand",
        }
    }

    /// The role of this name.
    pub fn from_name(name: &str) -> Option<Role> {
        Role::ALL.into_iter().find(|r| r.name() == name)
    }
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// For each role, the joint that plays it, if there is one.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RoleMap {
    joints: [Option<usize>; Role::COUNT],
}

impl RoleMap {
    /// The joint that plays `role`.
    pub fn joint(&self, role: Role) -> Option<usize> {
        self.joints[role.index()]
    }

    /// Gives `role` to `joint`, or to nobody.
    pub fn set(&mut self, role: Role, joint: Option<usize>) {
        self.joints[role.index()] = joint;
    }

    /// The roles that no joint plays.
    pub fn missing(&self) -> impl Iterator<Item = Role> + '_ {
        Role::ALL.into_iter().filter(|r| self.joint(*r).is_none())
    }
}

#[cfg(test)]
mod tests;
