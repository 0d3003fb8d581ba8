//! The bones whose directions describe a pose, and which of them a skeleton offers.

use crate::math::Vec3;
use crate::roles::{Role, RoleMap};

use super::KeyPose;

/// A line between two role joints whose direction is a feature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bone {
    /// Name in reports and index files.
    pub name: &'static str,
    /// Joint at its beginning.
    pub from: Role,
    /// Joint at its end.
    pub to: Role,
    /// Weight of its direction in a distance between poses.
    pub weight: f64,
}

/// Number of bones known.
pub const BONES: usize = 11;

const fn bone(name: &'static str, from: Role, to: Role, weight: f64) -> Bone {
    Bone {
        name,
        from,
        to,
        weight,
    }
}

/// Every bone, in the order of feature columns. The weights were chosen on referee signals: arms tell gestures
/// apart, legs matter less, the head's direction is noisy.
pub const ALL_BONES: [Bone; BONES] = [
    bone("left_thigh", Role::LeftThigh, Role::LeftShin, 0.8),
    bone("left_shin", Role::LeftShin, Role::LeftFoot, 0.8),
    bone("right_thigh", Role::RightThigh, Role::RightShin, 0.8),
    bone("right_shin", Role::RightShin, Role::RightFoot, 0.8),
    bone("torso", Role::Hips, Role::Neck, 1.0),
    bone("shoulder_line", Role::LeftArm, Role::RightArm, 0.6),
    bone("left_arm", Role::LeftArm, Role::LeftForearm, 1.0),
    bone("left_forearm", Role::LeftForearm, Role::LeftHand, 1.0),
    bone("right_arm", Role::RightArm, Role::RightForearm, 1.0),
    bone("right_forearm", Role::RightForearm, Role::RightHand, 1.0),
    bone("head", Role::Neck, Role::Head, 0.3),
];

/// A set of bones of [`ALL_BONES`]: what a skeleton offers, or what an index uses.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(try_from = "Vec<String>", into = "Vec<String>")]
pub struct BoneSet(u16);

impl BoneSet {
    /// Every bone.
    pub const ALL: BoneSet = BoneSet((1 << BONES) - 1);
    /// No bone.
    pub const NONE: BoneSet = BoneSet(0);
    /// The trunk, the arms and the head.
    pub const UPPER: BoneSet = BoneSet(0b111_1111_0000);
    /// The line of the shoulders and the arms.
    pub const ARMS: BoneSet = BoneSet(0b011_1110_0000);

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

    /// The bones of which both ends are mapped.
    pub fn of_roles(roles: &RoleMap) -> Self {
        Self::where_(|bone| roles.joint(bone.from).is_some() && roles.joint(bone.to).is_some())
    }

    /// The bones that have a length in `pose`; a bone of no length has no direction.
    pub fn of_pose(pose: &KeyPose) -> Self {
        Self::where_(|bone| match (pose.get(bone.from), pose.get(bone.to)) {
            (Some(from), Some(to)) => has_length(&(to - from)),
            _ => false,
        })
    }

    fn where_(holds: impl Fn(&Bone) -> bool) -> Self {
        (0..BONES)
            .filter(|&b| holds(&ALL_BONES[b]))
            .fold(Self::NONE, BoneSet::with)
    }
}

impl std::str::FromStr for BoneSet {
    type Err = String;

    /// `all`, `upper`, `arms`, or names of bones, separated by commas.
    fn from_str(text: &str) -> Result<Self, String> {
        match text.trim() {
            "all" => Ok(Self::ALL),
            "upper" => Ok(Self::UPPER),
            "arms" => Ok(Self::ARMS),
            names => {
                let names: Vec<String> = names.split(',').map(|n| n.trim().to_owned()).collect();
                Self::try_from(names).map_err(|error| {
                    let known = Vec::from(Self::ALL).join(", ");
                    format!("{error}; there are all, upper, arms, {known}")
                })
            }
        }
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
