//! Which joint of a skeleton plays which part of the body.

mod check;
mod find;
mod fingers;
mod languages;
mod limbs;
pub mod mapping;
mod meaning;
mod names;
mod pairs;
pub mod points;
#[doc(hidden)] // What the diagnosis of streams in `morec` shares with the finding of roles.
pub mod proportions;
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

/// A part of the body, a point of a hand or a point of a custom skeleton. A part of the body is played by the joint at its near end (the
/// thigh by the hip joint, the shin by the knee, the hand by the wrist); a finger has four points from its base (1) to its tip. A
/// custom skeleton, of whatever moves and is no person, has the points that a [mapping] says: `Point1` is its root. `Face` is any point
/// straight before the head, where a headset looks: it gives a head and two hands their heading.
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
    LeftPalm,
    #[serde(rename = "left_thumb_1")]
    LeftThumb1,
    #[serde(rename = "left_thumb_2")]
    LeftThumb2,
    #[serde(rename = "left_thumb_3")]
    LeftThumb3,
    LeftThumbTip,
    #[serde(rename = "left_index_1")]
    LeftIndex1,
    #[serde(rename = "left_index_2")]
    LeftIndex2,
    #[serde(rename = "left_index_3")]
    LeftIndex3,
    LeftIndexTip,
    #[serde(rename = "left_middle_1")]
    LeftMiddle1,
    #[serde(rename = "left_middle_2")]
    LeftMiddle2,
    #[serde(rename = "left_middle_3")]
    LeftMiddle3,
    LeftMiddleTip,
    #[serde(rename = "left_ring_1")]
    LeftRing1,
    #[serde(rename = "left_ring_2")]
    LeftRing2,
    #[serde(rename = "left_ring_3")]
    LeftRing3,
    LeftRingTip,
    #[serde(rename = "left_little_1")]
    LeftLittle1,
    #[serde(rename = "left_little_2")]
    LeftLittle2,
    #[serde(rename = "left_little_3")]
    LeftLittle3,
    LeftLittleTip,
    RightPalm,
    #[serde(rename = "right_thumb_1")]
    RightThumb1,
    #[serde(rename = "right_thumb_2")]
    RightThumb2,
    #[serde(rename = "right_thumb_3")]
    RightThumb3,
    RightThumbTip,
    #[serde(rename = "right_index_1")]
    RightIndex1,
    #[serde(rename = "right_index_2")]
    RightIndex2,
    #[serde(rename = "right_index_3")]
    RightIndex3,
    RightIndexTip,
    #[serde(rename = "right_middle_1")]
    RightMiddle1,
    #[serde(rename = "right_middle_2")]
    RightMiddle2,
    #[serde(rename = "right_middle_3")]
    RightMiddle3,
    RightMiddleTip,
    #[serde(rename = "right_ring_1")]
    RightRing1,
    #[serde(rename = "right_ring_2")]
    RightRing2,
    #[serde(rename = "right_ring_3")]
    RightRing3,
    RightRingTip,
    #[serde(rename = "right_little_1")]
    RightLittle1,
    #[serde(rename = "right_little_2")]
    RightLittle2,
    #[serde(rename = "right_little_3")]
    RightLittle3,
    RightLittleTip,
    #[serde(rename = "point_1")]
    Point1,
    #[serde(rename = "point_2")]
    Point2,
    #[serde(rename = "point_3")]
    Point3,
    #[serde(rename = "point_4")]
    Point4,
    #[serde(rename = "point_5")]
    Point5,
    #[serde(rename = "point_6")]
    Point6,
    #[serde(rename = "point_7")]
    Point7,
    #[serde(rename = "point_8")]
    Point8,
    #[serde(rename = "left_point_1")]
    LeftPoint1,
    #[serde(rename = "left_point_2")]
    LeftPoint2,
    #[serde(rename = "left_point_3")]
    LeftPoint3,
    #[serde(rename = "left_point_4")]
    LeftPoint4,
    #[serde(rename = "left_point_5")]
    LeftPoint5,
    #[serde(rename = "left_point_6")]
    LeftPoint6,
    #[serde(rename = "left_point_7")]
    LeftPoint7,
    #[serde(rename = "left_point_8")]
    LeftPoint8,
    #[serde(rename = "right_point_1")]
    RightPoint1,
    #[serde(rename = "right_point_2")]
    RightPoint2,
    #[serde(rename = "right_point_3")]
    RightPoint3,
    #[serde(rename = "right_point_4")]
    RightPoint4,
    #[serde(rename = "right_point_5")]
    RightPoint5,
    #[serde(rename = "right_point_6")]
    RightPoint6,
    #[serde(rename = "right_point_7")]
    RightPoint7,
    #[serde(rename = "right_point_8")]
    RightPoint8,
    Face,
}

/// Both legs, left first: thigh, shin, foot.
pub const LEGS: [[Role; 3]; 2] = [
    [Role::LeftThigh, Role::LeftShin, Role::LeftFoot],
    [Role::RightThigh, Role::RightShin, Role::RightFoot],
];
/// Both arms, left first: upper arm, forearm, hand.
pub const ARMS: [[Role; 3]; 2] = [
    [Role::LeftArm, Role::LeftForearm, Role::LeftHand],
    [Role::RightArm, Role::RightForearm, Role::RightHand],
];

/// Names of the roles, in the order of their numbers.
const NAMES: [&str; Role::COUNT] = [
    "hips",
    "left_thigh",
    "left_shin",
    "left_foot",
    "right_thigh",
    "right_shin",
    "right_foot",
    "torso",
    "neck",
    "head",
    "left_shoulder",
    "left_arm",
    "left_forearm",
    "left_hand",
    "right_shoulder",
    "right_arm",
    "right_forearm",
    "right_hand",
    "left_palm",
    "left_thumb_1",
    "left_thumb_2",
    "left_thumb_3",
    "left_thumb_tip",
    "left_index_1",
    "left_index_2",
    "left_index_3",
    "left_index_tip",
    "left_middle_1",
    "left_middle_2",
    "left_middle_3",
    "left_middle_tip",
    "left_ring_1",
    "left_ring_2",
    "left_ring_3",
    "left_ring_tip",
    "left_little_1",
    "left_little_2",
    "left_little_3",
    "left_little_tip",
    "right_palm",
    "right_thumb_1",
    "right_thumb_2",
    "right_thumb_3",
    "right_thumb_tip",
    "right_index_1",
    "right_index_2",
    "right_index_3",
    "right_index_tip",
    "right_middle_1",
    "right_middle_2",
    "right_middle_3",
    "right_middle_tip",
    "right_ring_1",
    "right_ring_2",
    "right_ring_3",
    "right_ring_tip",
    "right_little_1",
    "right_little_2",
    "right_little_3",
    "right_little_tip",
    "point_1",
    "point_2",
    "point_3",
    "point_4",
    "point_5",
    "point_6",
    "point_7",
    "point_8",
    "left_point_1",
    "left_point_2",
    "left_point_3",
    "left_point_4",
    "left_point_5",
    "left_point_6",
    "left_point_7",
    "left_point_8",
    "right_point_1",
    "right_point_2",
    "right_point_3",
    "right_point_4",
    "right_point_5",
    "right_point_6",
    "right_point_7",
    "right_point_8",
    "face",
];

impl Role {
    /// Number of roles.
    pub const COUNT: usize = 85;
    /// Number of parts of the body, which come first.
    pub const BODY_COUNT: usize = 18;
    /// Number of parts of the body and points of hands, which come before the points of a custom skeleton.
    pub const HUMAN_COUNT: usize = 60;

    /// Every role, in the order of their numbers: the body, the left hand, the right hand, the points of a custom skeleton, the face.
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
        Role::LeftPalm,
        Role::LeftThumb1,
        Role::LeftThumb2,
        Role::LeftThumb3,
        Role::LeftThumbTip,
        Role::LeftIndex1,
        Role::LeftIndex2,
        Role::LeftIndex3,
        Role::LeftIndexTip,
        Role::LeftMiddle1,
        Role::LeftMiddle2,
        Role::LeftMiddle3,
        Role::LeftMiddleTip,
        Role::LeftRing1,
        Role::LeftRing2,
        Role::LeftRing3,
        Role::LeftRingTip,
        Role::LeftLittle1,
        Role::LeftLittle2,
        Role::LeftLittle3,
        Role::LeftLittleTip,
        Role::RightPalm,
        Role::RightThumb1,
        Role::RightThumb2,
        Role::RightThumb3,
        Role::RightThumbTip,
        Role::RightIndex1,
        Role::RightIndex2,
        Role::RightIndex3,
        Role::RightIndexTip,
        Role::RightMiddle1,
        Role::RightMiddle2,
        Role::RightMiddle3,
        Role::RightMiddleTip,
        Role::RightRing1,
        Role::RightRing2,
        Role::RightRing3,
        Role::RightRingTip,
        Role::RightLittle1,
        Role::RightLittle2,
        Role::RightLittle3,
        Role::RightLittleTip,
        Role::Point1,
        Role::Point2,
        Role::Point3,
        Role::Point4,
        Role::Point5,
        Role::Point6,
        Role::Point7,
        Role::Point8,
        Role::LeftPoint1,
        Role::LeftPoint2,
        Role::LeftPoint3,
        Role::LeftPoint4,
        Role::LeftPoint5,
        Role::LeftPoint6,
        Role::LeftPoint7,
        Role::LeftPoint8,
        Role::RightPoint1,
        Role::RightPoint2,
        Role::RightPoint3,
        Role::RightPoint4,
        Role::RightPoint5,
        Role::RightPoint6,
        Role::RightPoint7,
        Role::RightPoint8,
        Role::Face,
    ];

    /// The parts of the body.
    pub const BODY: [Role; Role::BODY_COUNT] = {
        let mut body = [Role::Hips; Role::BODY_COUNT];
        let mut at = 0;
        while at < Role::BODY_COUNT {
            body[at] = Role::ALL[at];
            at += 1;
        }
        body
    };

    /// Its number, 0 to 84.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// True of points of hands beside the wrist.
    pub const fn is_of_hand(self) -> bool {
        self.index() >= Role::BODY_COUNT && self.index() < Role::HUMAN_COUNT
    }

    /// True of parts of the body.
    pub const fn is_of_body(self) -> bool {
        self.index() < Role::BODY_COUNT
    }

    /// True of points of a custom skeleton.
    pub const fn is_custom(self) -> bool {
        self.index() >= Role::HUMAN_COUNT && self.index() < Role::Face.index()
    }

    /// The same part on the other side of the body; itself in the middle.
    pub const fn opposite(self) -> Self {
        let (left, right) = (Role::LeftPalm.index(), Role::RightPalm.index());
        let at = self.index();
        let other = match self {
            Role::Hips | Role::Torso | Role::Neck | Role::Head | Role::Face => at,
            Role::LeftThigh | Role::LeftShin | Role::LeftFoot => at + 3,
            Role::RightThigh | Role::RightShin | Role::RightFoot => at - 3,
            Role::LeftShoulder | Role::LeftArm | Role::LeftForearm | Role::LeftHand => at + 4,
            Role::RightShoulder | Role::RightArm | Role::RightForearm | Role::RightHand => at - 4,
            _ if at < right => at - left + right,
            _ if at < Role::HUMAN_COUNT => at - right + left,
            _ if at < Role::LeftPoint1.index() => at,
            _ if at < Role::RightPoint1.index() => at + 8,
            _ => at - 8,
        };
        Role::ALL[other]
    }

    /// Its name in mapping files and reports, `left_forearm`, `right_index_tip`.
    pub const fn name(self) -> &'static str {
        NAMES[self.index()]
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
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RoleMap {
    joints: [Option<usize>; Role::COUNT],
}

impl Default for RoleMap {
    /// Nobody plays anything.
    fn default() -> Self {
        Self {
            joints: [None; Role::COUNT],
        }
    }
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

    /// The roles that are played, in the order of their numbers, with their joints.
    pub fn played(&self) -> impl Iterator<Item = (Role, usize)> + '_ {
        let joint = |role| Some((role, self.joint(role)?));
        Role::ALL.into_iter().filter_map(joint)
    }
}

#[cfg(test)]
mod tests;
