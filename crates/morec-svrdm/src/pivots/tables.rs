//! Pivot sets that come with the library.

use mocap::roles::Role;

use super::{Pivot, PivotSet};

/// Pivot, parent, the same joint in an ASF skeleton, role. Thesis Table 4.2; roles and ASF names are ours.
const THESIS: [(&str, &str, &str, Option<Role>); 16] = [
    ("Hips", "", "root", Some(Role::Hips)),
    ("LHipJoint", "Hips", "lhipjoint", None),
    ("LeftUpLeg", "LHipJoint", "lfemur", Some(Role::LeftThigh)),
    ("LeftLeg", "LeftUpLeg", "ltibia", Some(Role::LeftShin)),
    ("RHipJoint", "Hips", "rhipjoint", None),
    ("RightUpLeg", "RHipJoint", "rfemur", Some(Role::RightThigh)),
    ("RightLeg", "RightUpLeg", "rtibia", Some(Role::RightShin)),
    ("LowerBack", "Hips", "lowerback", None),
    ("Spine", "LowerBack", "upperback", Some(Role::Torso)),
    ("Spine1", "Spine", "thorax", None),
    (
        "LeftShoulder",
        "Spine1",
        "lclavicle",
        Some(Role::LeftShoulder),
    ),
    ("LeftArm", "LeftShoulder", "lhumerus", Some(Role::LeftArm)),
    ("LeftForeArm", "LeftArm", "lradius", Some(Role::LeftForearm)),
    (
        "RightShoulder",
        "Spine1",
        "rclavicle",
        Some(Role::RightShoulder),
    ),
    (
        "RightArm",
        "RightShoulder",
        "rhumerus",
        Some(Role::RightArm),
    ),
    (
        "RightForeArm",
        "RightArm",
        "rradius",
        Some(Role::RightForearm),
    ),
];

/// The roles that do what Table 4.2 does, and their parents: no hands, feet or head.
const ROLES: [(Role, Option<Role>); 12] = [
    (Role::Hips, None),
    (Role::LeftThigh, Some(Role::Hips)),
    (Role::LeftShin, Some(Role::LeftThigh)),
    (Role::RightThigh, Some(Role::Hips)),
    (Role::RightShin, Some(Role::RightThigh)),
    (Role::Torso, Some(Role::Hips)),
    (Role::LeftShoulder, Some(Role::Torso)),
    (Role::LeftArm, Some(Role::LeftShoulder)),
    (Role::LeftForearm, Some(Role::LeftArm)),
    (Role::RightShoulder, Some(Role::Torso)),
    (Role::RightArm, Some(Role::RightShoulder)),
    (Role::RightForearm, Some(Role::RightArm)),
];

impl PivotSet {
    /// The 16 pivots of thesis Table 4.2, by the names of the CMU skeleton in BVH and ASF files; on other
    /// skeletons by their roles, as far as they go.
    pub fn thesis() -> Self {
        let pivots = THESIS.iter().map(|&(name, parent, asf, role)| Pivot {
            name: name.to_owned(),
            parent: (!parent.is_empty()).then(|| parent.to_owned()),
            joints: vec![name.to_owned(), asf.to_owned()],
            role,
        });
        Self::known_good(pivots.collect())
    }

    /// Twelve pivots by roles alone, so that every skeleton whose parts are known has them, whatever its names:
    /// hips, thighs, shins, torso, collars, upper arms and forearms.
    pub fn roles() -> Self {
        let pivots = ROLES.iter().map(|&(role, parent)| Pivot {
            name: role.name().to_owned(),
            parent: parent.map(|p| p.name().to_owned()),
            joints: Vec::new(),
            role: Some(role),
        });
        Self::known_good(pivots.collect())
    }
}
