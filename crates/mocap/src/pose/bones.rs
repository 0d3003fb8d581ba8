//! The bones whose directions describe a pose, and which of them a skeleton has.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fmt;

use crate::math::Vec3;
use crate::roles::{Role, RoleMap};

use super::KeyPose;
use super::hand::{Hand, lone_left_as_right};

/// What of a bone describes a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoneKind {
    /// Its direction in the heading frame: a bone's length says nothing.
    Direction,
    /// The vector in the heading frame, in the performer's unit of length: tracked points that may come nearer to each other.
    Offset,
    /// The vector from the left palm to the right one, in the heading frame and the performer's unit of length.
    Palms,
    /// The vector in the frame of the palm, in lengths of a finger: how far a finger is bent.
    Finger(Hand),
    /// The direction in which a palm's fingers begin, in the heading frame.
    PalmForward(Hand),
    /// The direction that a palm faces away from, in the heading frame.
    PalmNormal(Hand),
}

/// A line between two role joints that describes a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bone {
    /// Name in reports and index files.
    pub name: &'static str,
    /// Joint at its beginning.
    pub from: Role,
    /// Joint at its end.
    pub to: Role,
    /// What of it counts.
    pub kind: BoneKind,
}

impl Bone {
    /// The hand whose palm's axes it is given in, or is one of.
    pub const fn hand(&self) -> Option<Hand> {
        match self.kind {
            BoneKind::Direction | BoneKind::Offset | BoneKind::Palms => None,
            BoneKind::Finger(hand) | BoneKind::PalmForward(hand) | BoneKind::PalmNormal(hand) => {
                Some(hand)
            }
        }
    }
}

/// Number of bones known.
pub const BONES: usize = 52;
/// Number of those of the body, which come first.
pub const BODY_BONES: usize = 11;

const fn bone(kind: BoneKind, name: &'static str, from: Role, to: Role) -> Bone {
    Bone {
        name,
        from,
        to,
        kind,
    }
}

const fn line(name: &'static str, from: Role, to: Role) -> Bone {
    bone(BoneKind::Direction, name, from, to)
}

const fn offset(name: &'static str, from: Role, to: Role) -> Bone {
    bone(BoneKind::Offset, name, from, to)
}

/// From the root of a custom skeleton to one of its points.
const fn to_point(to: Role) -> Bone {
    offset(to.name(), Role::Point1, to)
}

/// A finger from its base to its tip.
const fn finger(name: &'static str, hand: Hand, number: usize) -> Bone {
    let [base, .., tip] = hand.points().fingers[number];
    bone(BoneKind::Finger(hand), name, base, tip)
}

/// An axis of a palm, along its middle or across it.
const fn axis(name: &'static str, kind: BoneKind) -> Bone {
    let (from, to) = match kind {
        BoneKind::PalmNormal(hand) => {
            let [_, index, .., little] = hand.points().fingers;
            (index[0], little[0])
        }
        BoneKind::PalmForward(Hand::Left) => (Role::LeftHand, Role::LeftMiddle1),
        _ => (Role::RightHand, Role::RightMiddle1),
    };
    bone(kind, name, from, to)
}

/// Every bone: the body's, each hand's, lines between tracked points, a custom skeleton's.
pub const ALL_BONES: [Bone; BONES] = [
    line("left_thigh", Role::LeftThigh, Role::LeftShin),
    line("left_shin", Role::LeftShin, Role::LeftFoot),
    line("right_thigh", Role::RightThigh, Role::RightShin),
    line("right_shin", Role::RightShin, Role::RightFoot),
    line("torso", Role::Hips, Role::Neck),
    line("shoulder_line", Role::LeftArm, Role::RightArm),
    line("left_arm", Role::LeftArm, Role::LeftForearm),
    line("left_forearm", Role::LeftForearm, Role::LeftHand),
    line("right_arm", Role::RightArm, Role::RightForearm),
    line("right_forearm", Role::RightForearm, Role::RightHand),
    line("head", Role::Neck, Role::Head),
    finger("left_thumb", Hand::Left, 0),
    finger("left_index", Hand::Left, 1),
    finger("left_middle", Hand::Left, 2),
    finger("left_ring", Hand::Left, 3),
    finger("left_little", Hand::Left, 4),
    axis("left_palm_forward", BoneKind::PalmForward(Hand::Left)),
    axis("left_palm_normal", BoneKind::PalmNormal(Hand::Left)),
    finger("right_thumb", Hand::Right, 0),
    finger("right_index", Hand::Right, 1),
    finger("right_middle", Hand::Right, 2),
    finger("right_ring", Hand::Right, 3),
    finger("right_little", Hand::Right, 4),
    axis("right_palm_forward", BoneKind::PalmForward(Hand::Right)),
    axis("right_palm_normal", BoneKind::PalmNormal(Hand::Right)),
    bone(
        BoneKind::Palms,
        "palm_line",
        Role::LeftPalm,
        Role::RightPalm,
    ),
    offset("head_to_left_hand", Role::Head, Role::LeftHand),
    offset("head_to_right_hand", Role::Head, Role::RightHand),
    offset("hand_line", Role::LeftHand, Role::RightHand),
    to_point(Role::Point2),
    to_point(Role::Point3),
    to_point(Role::Point4),
    to_point(Role::Point5),
    to_point(Role::Point6),
    to_point(Role::Point7),
    to_point(Role::Point8),
    to_point(Role::LeftPoint1),
    to_point(Role::LeftPoint2),
    to_point(Role::LeftPoint3),
    to_point(Role::LeftPoint4),
    to_point(Role::LeftPoint5),
    to_point(Role::LeftPoint6),
    to_point(Role::LeftPoint7),
    to_point(Role::LeftPoint8),
    to_point(Role::RightPoint1),
    to_point(Role::RightPoint2),
    to_point(Role::RightPoint3),
    to_point(Role::RightPoint4),
    to_point(Role::RightPoint5),
    to_point(Role::RightPoint6),
    to_point(Role::RightPoint7),
    to_point(Role::RightPoint8),
];

/// A set of bones of [`ALL_BONES`]: what a skeleton offers, or what an index uses.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(try_from = "Vec<String>", into = "Vec<String>")]
pub struct BoneSet(u64);

impl BoneSet {
    /// No bone.
    pub const NONE: BoneSet = BoneSet(0);
    /// The bones of the body.
    pub const BODY: BoneSet = BoneSet::range(0, 11);
    /// The trunk, the arms and the head.
    pub const UPPER: BoneSet = BoneSet::range(4, 11);
    /// The line of the shoulders and the arms.
    pub const ARMS: BoneSet = BoneSet::range(5, 10);
    /// The left hand, not mirrored.
    pub const LEFT_HAND: BoneSet = BoneSet::range(11, 18);
    /// The right hand, or a hand that is seen alone, a left one as in a mirror.
    pub const HAND: BoneSet = BoneSet::range(18, 25);
    /// Both hands and the line between the palms.
    pub const HANDS: BoneSet = BoneSet::range(11, 26);
    /// The body and both hands.
    pub const BODY_AND_HANDS: BoneSet = BoneSet::range(0, 25);
    /// The line between the palms, which is known where both are.
    pub(super) const PALM_LINE: BoneSet = BoneSet::range(25, 26);
    /// Lines between the head and the hands.
    pub const POINTS3: BoneSet = BoneSet::range(26, 29);
    /// From the root of a custom skeleton to its other points.
    pub const CUSTOM: BoneSet = BoneSet::range(29, BONES);

    /// The sets that have names.
    pub const NAMED: [(&'static str, BoneSet); 9] = [
        ("all", Self::BODY),
        ("upper", Self::UPPER),
        ("arms", Self::ARMS),
        ("hand", Self::HAND),
        ("left_hand", Self::LEFT_HAND),
        ("hands", Self::HANDS),
        ("body_and_hands", Self::BODY_AND_HANDS),
        ("points3", Self::POINTS3),
        ("custom", Self::CUSTOM),
    ];

    const fn range(start: usize, end: usize) -> Self {
        BoneSet((1 << end) - (1 << start))
    }

    /// True if bone `index` of [`ALL_BONES`] is in the set.
    pub fn contains(self, index: usize) -> bool {
        self.0 >> index & 1 == 1
    }

    /// The set with bone `index` of [`ALL_BONES`] in it too.
    #[must_use]
    pub fn with(self, index: usize) -> Self {
        debug_assert!(index < BONES);
        BoneSet(self.0 | 1 << index)
    }

    /// The bones in both sets.
    #[must_use]
    pub fn and(self, other: BoneSet) -> Self {
        BoneSet(self.0 & other.0)
    }

    /// The bones shared by the largest group of skeletons, from the bones and the weight of each skeleton. The bones with the most weight
    /// are intersected with the others in order of weight; a skeleton that shares none of them belongs to another group, such as a
    /// hand among bodies. O(skeletons · log skeletons).
    #[must_use]
    pub fn most_common(shown: impl IntoIterator<Item = (BoneSet, usize)>) -> Self {
        let mut kinds: BTreeMap<BoneSet, usize> = BTreeMap::new();
        for (bones, weight) in shown.into_iter().filter(|(bones, _)| !bones.is_empty()) {
            *kinds.entry(bones).or_default() += weight;
        }
        let mut kinds: Vec<(BoneSet, usize)> = kinds.into_iter().collect();
        kinds.sort_by_key(|(_, weight)| Reverse(*weight));
        let shared = kinds.into_iter().map(|(bones, _)| bones);
        let common = shared.reduce(|common, bones| match common.and(bones) {
            Self::NONE => common,
            shared => shared,
        });
        common.unwrap_or(Self::NONE)
    }

    /// The bones in either set.
    #[must_use]
    pub fn or(self, other: BoneSet) -> Self {
        BoneSet(self.0 | other.0)
    }

    /// Number of bones in the set.
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// True if there is none.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Indices into [`ALL_BONES`], increasing.
    pub fn indices(self) -> impl Iterator<Item = usize> + Clone {
        (0..BONES).filter(move |&b| self.contains(b))
    }

    /// From the first bone of the set to behind its last.
    pub fn span(self) -> std::ops::Range<usize> {
        match self.0 {
            0 => 0..0,
            bits => {
                bits.trailing_zeros() as usize..u64::BITS as usize - bits.leading_zeros() as usize
            }
        }
    }

    /// The bones whose points are mapped. A left hand alone counts as a right one, too.
    pub fn of_roles(roles: &RoleMap) -> Self {
        Self::of_seen(|role| roles.joint(role).is_some())
    }

    /// The bones whose points are those for which `is_seen` holds. A left hand alone counts as a right one, too.
    pub fn of_seen(is_seen: impl Fn(Role) -> bool) -> Self {
        let shown = Self::where_(&is_seen, |_| true);
        let hands = Hand::BOTH.map(|hand| is_seen(hand.points().fingers[1][0]));
        match hands {
            [true, false] => {
                let image = Self::where_(|role| is_seen(role.opposite()), |_| true);
                shown.or(image.and(Self::HAND))
            }
            _ => shown,
        }
    }

    /// The bones that can be measured in `pose`: a bone of no length has no direction. A left hand alone counts as a right one, too.
    pub fn of_pose(pose: &KeyPose) -> Self {
        let shown = |pose: &KeyPose| {
            Self::where_(
                |role| pose.get(role).is_some(),
                |bone| match (bone.kind, bone.hand()) {
                    (_, Some(hand)) => hand.palm_frame(pose).is_some(),
                    (BoneKind::Palms, _) => true,
                    _ => match (pose.get(bone.from), pose.get(bone.to)) {
                        (Some(from), Some(to)) => has_length(&(to - from)),
                        _ => false,
                    },
                },
            )
        };
        match lone_left_as_right(pose) {
            Some(image) => shown(pose).or(shown(&image).and(Self::HAND)),
            None => shown(pose),
        }
    }

    fn where_(known: impl Fn(Role) -> bool, holds: impl Fn(&Bone) -> bool) -> Self {
        let has_palm = |hand: Hand| {
            let points = hand.points();
            let [_, index, .., little] = points.fingers;
            (known(points.palm) || known(points.wrist)) && known(index[0]) && known(little[0])
        };
        let is_known = |bone: &Bone| match bone.kind {
            BoneKind::Direction | BoneKind::Offset => known(bone.from) && known(bone.to),
            BoneKind::Palms => Hand::BOTH.into_iter().all(has_palm),
            BoneKind::Finger(hand) => known(bone.from) && known(bone.to) && has_palm(hand),
            BoneKind::PalmForward(hand) | BoneKind::PalmNormal(hand) => has_palm(hand),
        };
        (0..BONES)
            .filter(|&b| is_known(&ALL_BONES[b]) && holds(&ALL_BONES[b]))
            .fold(Self::NONE, BoneSet::with)
    }
}

impl fmt::Display for BoneSet {
    /// Its name in [`NAMED`](Self::NAMED), or those of its bones, as text is read.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match Self::NAMED.iter().find(|(_, bones)| bones == self) {
            Some((name, _)) => f.write_str(name),
            None => f.write_str(&Vec::<String>::from(*self).join(",")),
        }
    }
}

impl std::str::FromStr for BoneSet {
    type Err = String;

    /// Names of [sets](Self::NAMED) and of bones, separated by commas.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut set = Self::NONE;
        for name in text.split(',').map(str::trim) {
            let named = Self::NAMED.iter().find(|(known, _)| *known == name);
            set = set.or(match named {
                Some((_, bones)) => *bones,
                None => Self::try_from(vec![name.to_owned()]).map_err(|error| {
                    let sets = Self::NAMED.map(|(name, _)| name).join(", ");
                    let bones = ALL_BONES.map(|bone| bone.name).join(", ");
                    format!("{error}; the sets are {sets}, the bones {bones}")
                })?,
            });
        }
        Ok(set)
    }
}

fn has_length(bone: &Vec3) -> bool {
    bone.norm().is_finite() && bone.norm() > 1e-6
}

impl From<&BoneSet> for BoneSet {
    fn from(set: &BoneSet) -> Self {
        *set
    }
}

impl From<BoneSet> for Vec<String> {
    fn from(set: BoneSet) -> Self {
        set.indices()
            .map(|b| ALL_BONES[b].name.to_owned())
            .collect()
    }
}

impl TryFrom<Vec<String>> for BoneSet {
    type Error = String;

    fn try_from(names: Vec<String>) -> Result<Self, String> {
        names.iter().try_fold(Self::NONE, |set, name| {
            let index = ALL_BONES.iter().position(|b| b.name == name);
            index
                .map(|i| set.with(i))
                .ok_or_else(|| format!("no bone is called {name:?}"))
        })
    }
}
