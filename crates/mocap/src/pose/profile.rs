//! Profiles: kinds of performers, which determine the values of feature rows.

use crate::math::Vec3;
use crate::roles::{Role, RoleMap};

use super::KeyPose;
use super::bones::BoneSet;
use super::hand::{Hand, HandPoints};

/// What a set of bones describes: it follows from the bones, and says where the root is, what lengths are measured in, and which
/// parameters of rows are usual.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// A body or a part of it, perhaps with hands.
    #[default]
    Body,
    /// One hand, right or mirrored.
    Hand,
    /// Hands that are kept apart, or both.
    Hands,
    /// A head and two hands as tracked points.
    Points3,
    /// What moves and is no person: a root and points that somebody [named](crate::roles::mapping).
    Custom,
}

impl Profile {
    /// Of the rows over `bones`.
    pub fn of(bones: BoneSet) -> Self {
        let has = |set: BoneSet| !bones.and(set).is_empty();
        if has(BoneSet::BODY) || bones.is_empty() {
            Profile::Body
        } else if has(BoneSet::CUSTOM) {
            Profile::Custom
        } else if has(BoneSet::POINTS3) {
            Profile::Points3
        } else if bones.and(BoneSet::HAND) == bones {
            Profile::Hand
        } else {
            Profile::Hands
        }
    }

    /// Of a performer whose roles are seen for which `is_seen` holds: a custom skeleton has its root, a body hips or shoulders.
    pub fn of_seen(is_seen: impl Fn(Role) -> bool) -> Self {
        use Role::{Head, Hips, LeftArm, LeftHand, LeftThigh, RightArm, RightHand, RightThigh};
        let any = |roles: &[Role]| roles.iter().any(|role| is_seen(*role));
        let hands = Hand::BOTH.map(|hand| any(&hand.beside_wrist()));
        match hands {
            _ if is_seen(Role::Point1) => Profile::Custom,
            _ if any(&[Hips, LeftThigh, RightThigh, LeftArm, RightArm]) => Profile::Body,
            [true, true] => Profile::Hands,
            [true, false] | [false, true] => Profile::Hand,
            _ if [Head, LeftHand, RightHand].into_iter().all(is_seen) => Profile::Points3,
            _ => Profile::Body,
        }
    }

    /// The roles that a performer has of whom those are seen for which `is_seen` holds: every part of a body, every point of the hands
    /// that are seen at all, the points of a custom skeleton that are seen. A palm stands for a wrist that is not seen. No allocation.
    pub fn expected(self, is_seen: impl Fn(Role) -> bool) -> impl Iterator<Item = Role> {
        let of_hand = Hand::BOTH.map(|hand| {
            let HandPoints { wrist, palm, .. } = hand.points();
            let seen = hand.beside_wrist().into_iter().any(&is_seen);
            let has_palm_alone = is_seen(palm) && !is_seen(wrist);
            let absent = if has_palm_alone { wrist } else { palm };
            (hand, absent, seen)
        });
        let expects = move |role: &Role| match self {
            Profile::Body => role.is_of_body(),
            Profile::Hand | Profile::Hands => of_hand.iter().any(|(hand, absent, seen)| {
                *seen && Hand::of(*role) == Some(*hand) && role != absent
            }),
            Profile::Points3 => matches!(role, Role::Head | Role::LeftHand | Role::RightHand),
            Profile::Custom => role.is_custom() && is_seen(*role),
        };
        Role::ALL.into_iter().filter(expects)
    }

    /// What it is called where an index or a stream is described.
    pub fn words(self) -> &'static str {
        match self {
            Profile::Body => "a body",
            Profile::Hand => "a hand",
            Profile::Hands => "both hands",
            Profile::Points3 => "a head and two hands",
            Profile::Custom => "a custom skeleton",
        }
    }

    /// What a set of bones describes, in [words](Self::words): a left hand is named as one.
    pub fn words_of(bones: BoneSet) -> &'static str {
        match !bones.is_empty() && bones.and(BoneSet::LEFT_HAND) == bones {
            true => "a left hand",
            false => Profile::of(bones).words(),
        }
    }

    /// Of the bones that a source shows, those that are used unless others are asked for: a custom skeleton's where there are any, the
    /// body's, both hands', one hand's, the lines of tracked points.
    pub fn usual_bones(shown: BoneSet) -> BoneSet {
        // Of a lone left hand, which counts as a right one too, the line between the palms is not known.
        let is_pair = !shown.and(BoneSet::PALM_LINE).is_empty();
        let hands = match is_pair {
            true => [BoneSet::HANDS, BoneSet::HANDS],
            false => [BoneSet::HAND, BoneSet::LEFT_HAND],
        };
        let [first, second] = hands;
        let sets = [
            BoneSet::CUSTOM,
            BoneSet::BODY,
            first,
            second,
            BoneSet::POINTS3,
        ];
        let mut usual = sets.into_iter();
        usual
            .find_map(|set| Some(shown.and(set)).filter(|bones| !bones.is_empty()))
            .unwrap_or(BoneSet::NONE)
    }

    /// The hands whose palms are the root, of a profile without a body.
    fn rooted_in(self) -> &'static [Hand] {
        match self {
            Profile::Body | Profile::Points3 | Profile::Custom => &[],
            Profile::Hand => &[Hand::Right],
            Profile::Hands => &Hand::BOTH,
        }
    }

    /// Place of the root of a profile without a body: the palm, the middle of both, the head, the first point.
    pub fn root(self, pose: &KeyPose) -> Option<Vec3> {
        match self {
            Profile::Points3 => return pose.get(Role::Head),
            Profile::Custom => return pose.get(Role::Point1),
            Profile::Body | Profile::Hand | Profile::Hands => {}
        }
        let places = self.rooted_in().iter().filter_map(|hand| hand.root(pose));
        let (sum, count) = places.fold((Vec3::zeros(), 0.0), |(sum, n), at| (sum + at, n + 1.0));
        (count > 0.0).then(|| sum / count)
    }

    /// [`Hand::length`] of the first hand that `pose` shows, in the pose's unit.
    pub fn hand_length(self, pose: &KeyPose) -> Option<f64> {
        let hands = self.rooted_in().iter();
        hands.into_iter().find_map(|hand| hand.length(pose))
    }
}

impl RoleMap {
    /// What kind of performer these are the roles of.
    pub fn profile(&self) -> Profile {
        Profile::of_seen(|role| self.joint(role).is_some())
    }

    /// The roles that such a performer [has](Profile::expected).
    pub fn expected(&self) -> impl Iterator<Item = Role> + '_ {
        self.profile().expected(|role| self.joint(role).is_some())
    }

    /// Those of them that no joint plays.
    pub fn missing(&self) -> impl Iterator<Item = Role> + '_ {
        self.expected().filter(|role| self.joint(*role).is_none())
    }
}
