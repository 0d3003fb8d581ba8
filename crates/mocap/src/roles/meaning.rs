//! Meanings of joint names: side and part of the body.

/// A side of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
}

impl Side {
    pub(super) fn other(self) -> Self {
        match self {
            Side::Left => Side::Right,
            Side::Right => Side::Left,
        }
    }
}

/// Part of the body that a name suggests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NameMeaning {
    /// Pelvis, hips, or a hip without a side.
    Hips,
    /// A hip with a side: the thigh, or a joint before it.
    Hip,
    /// A joint between hips and thigh that is not the thigh: `LHipJoint`, `lButtock`.
    HipJoint,
    Thigh,
    Shin,
    /// `LeftLeg`: shin or thigh.
    Leg,
    Foot,
    Toe,
    Spine,
    Neck,
    Head,
    Collar,
    /// `LeftShoulder`: collar or upper arm.
    Shoulder,
    UpperArm,
    /// `LeftArm`: nearly always the upper arm.
    Arm,
    Forearm,
    Hand,
    Finger,
    /// A joint that shares a limb's bone: twist and roll joints.
    Twist,
    /// A part that animals have and people do not: tails, wings, hooves.
    Animal,
    /// Nothing of the body: ends, handles, faces, props.
    Other,
    /// The name says nothing.
    Unknown,
}

impl NameMeaning {
    /// True if the word belongs to the leg.
    pub(super) fn is_leg(self) -> bool {
        use NameMeaning::*;
        matches!(self, Hip | HipJoint | Thigh | Shin | Leg | Foot | Toe)
    }

    /// True if the word belongs to the arm.
    pub(super) fn is_arm(self) -> bool {
        use NameMeaning::*;
        matches!(
            self,
            Collar | Shoulder | UpperArm | Arm | Forearm | Hand | Finger
        )
    }
}
