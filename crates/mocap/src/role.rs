//! Parts of the body, and which joint of a skeleton plays each.

use std::fmt;

/// Makes the roles, each with its name, in the order of their numbers.
macro_rules! roles {
    ($(#[$doc:meta])* $($role:ident $name:literal,)*) => {
        $(#[$doc])*
        #[derive(
            Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
        )]
        #[repr(u8)]
        #[allow(missing_docs)] // The names say it all.
        pub enum Role {
            $(#[serde(rename = $name)] $role,)*
        }

        /// Names of the roles, in the order of their numbers.
        const NAMES: [&str; Role::COUNT] = [$($name),*];

        impl Role {
            /// Every role, in the order of their numbers: the body, the left hand, the right hand, the points of a custom skeleton, the face.
            pub const ALL: [Role; Role::COUNT] = [$(Role::$role),*];
        }
    };
}

roles! {
    /// A part of the body, a point of a hand or a point of a custom skeleton. A part of the body is played by the joint at its near end (the
    /// thigh by the hip joint, the shin by the knee, the hand by the wrist); a finger has four points from its base (1) to its tip. A
    /// custom skeleton, of whatever moves and is no person, has the points that a [mapping](crate::roles::mapping) says: `Point1` is its root. `Face` is any point
    /// straight before the head, where a headset looks: it gives a head and two hands their heading.
    Hips "hips", LeftThigh "left_thigh", LeftShin "left_shin", LeftFoot "left_foot", RightThigh "right_thigh", RightShin "right_shin",
    RightFoot "right_foot", Torso "torso", Neck "neck", Head "head", LeftShoulder "left_shoulder", LeftArm "left_arm",
    LeftForearm "left_forearm", LeftHand "left_hand", RightShoulder "right_shoulder", RightArm "right_arm", RightForearm "right_forearm",
    RightHand "right_hand", LeftPalm "left_palm", LeftThumb1 "left_thumb_1", LeftThumb2 "left_thumb_2", LeftThumb3 "left_thumb_3",
    LeftThumbTip "left_thumb_tip", LeftIndex1 "left_index_1", LeftIndex2 "left_index_2", LeftIndex3 "left_index_3",
    LeftIndexTip "left_index_tip", LeftMiddle1 "left_middle_1", LeftMiddle2 "left_middle_2", LeftMiddle3 "left_middle_3",
    LeftMiddleTip "left_middle_tip", LeftRing1 "left_ring_1", LeftRing2 "left_ring_2", LeftRing3 "left_ring_3",
    LeftRingTip "left_ring_tip", LeftLittle1 "left_little_1", LeftLittle2 "left_little_2", LeftLittle3 "left_little_3",
    LeftLittleTip "left_little_tip", RightPalm "right_palm", RightThumb1 "right_thumb_1", RightThumb2 "right_thumb_2",
    RightThumb3 "right_thumb_3", RightThumbTip "right_thumb_tip", RightIndex1 "right_index_1", RightIndex2 "right_index_2",
    RightIndex3 "right_index_3", RightIndexTip "right_index_tip", RightMiddle1 "right_middle_1", RightMiddle2 "right_middle_2",
    RightMiddle3 "right_middle_3", RightMiddleTip "right_middle_tip", RightRing1 "right_ring_1", RightRing2 "right_ring_2",
    RightRing3 "right_ring_3", RightRingTip "right_ring_tip", RightLittle1 "right_little_1", RightLittle2 "right_little_2",
    RightLittle3 "right_little_3", RightLittleTip "right_little_tip", Point1 "point_1", Point2 "point_2", Point3 "point_3",
    Point4 "point_4", Point5 "point_5", Point6 "point_6", Point7 "point_7", Point8 "point_8", LeftPoint1 "left_point_1",
    LeftPoint2 "left_point_2", LeftPoint3 "left_point_3", LeftPoint4 "left_point_4", LeftPoint5 "left_point_5", LeftPoint6 "left_point_6",
    LeftPoint7 "left_point_7", LeftPoint8 "left_point_8", RightPoint1 "right_point_1", RightPoint2 "right_point_2",
    RightPoint3 "right_point_3", RightPoint4 "right_point_4", RightPoint5 "right_point_5", RightPoint6 "right_point_6",
    RightPoint7 "right_point_7", RightPoint8 "right_point_8", Face "face",
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
/// The lines in which a body is drawn whose joints do not hang together.
pub const BODY_LINES: [(Role, Role); 15] = {
    use Role::*;
    [
        (Hips, LeftThigh),
        (LeftThigh, LeftShin),
        (LeftShin, LeftFoot),
        (Hips, RightThigh),
        (RightThigh, RightShin),
        (RightShin, RightFoot),
        (Hips, Torso),
        (Hips, Neck),
        (Neck, Head),
        (Neck, LeftArm),
        (LeftArm, LeftForearm),
        (LeftForearm, LeftHand),
        (Neck, RightArm),
        (RightArm, RightForearm),
        (RightForearm, RightHand),
    ]
};

impl Role {
    /// Number of roles.
    pub const COUNT: usize = 85;
    /// Number of parts of the body, which come first.
    pub const BODY_COUNT: usize = 18;
    /// Number of parts of the body and points of hands, which come before the points of a custom skeleton.
    pub const HUMAN_COUNT: usize = 60;

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

    /// The role with this [`name`](Self::name); `None` for any other word.
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
    /// No role has a joint.
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

    /// Gives `role` to `joint`, or takes it from all.
    pub fn set(&mut self, role: Role, joint: Option<usize>) {
        self.joints[role.index()] = joint;
    }

    /// The roles that are played, in the order of their numbers, with their joints.
    pub fn played(&self) -> impl Iterator<Item = (Role, usize)> + '_ {
        let joint = |role| Some((role, self.joint(role)?));
        Role::ALL.into_iter().filter_map(joint)
    }
}
