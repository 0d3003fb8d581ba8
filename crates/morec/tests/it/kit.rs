//! Finding and loading real clips, for all tests.

use morec::clip::Clip;
use morec::formats::{Limits, acclaim, bvh};
use morec::roles::{Role, RoleMap};
use morec::train::{StreamKind, TrainClip};

pub use mocap::testing::data;

const PARTS: [(Role, [&str; 2]); 15] = [
    (Role::Hips, ["Hips", "root"]),
    (Role::LeftThigh, ["LeftUpLeg", "lfemur"]),
    (Role::LeftShin, ["LeftLeg", "ltibia"]),
    (Role::LeftFoot, ["LeftFoot", "lfoot"]),
    (Role::RightThigh, ["RightUpLeg", "rfemur"]),
    (Role::RightShin, ["RightLeg", "rtibia"]),
    (Role::RightFoot, ["RightFoot", "rfoot"]),
    (Role::Neck, ["Neck", "lowerneck"]),
    (Role::Head, ["Head", "head"]),
    (Role::LeftArm, ["LeftArm", "lhumerus"]),
    (Role::LeftForearm, ["LeftForeArm", "lradius"]),
    (Role::LeftHand, ["LeftHand", "lwrist"]),
    (Role::RightArm, ["RightArm", "rhumerus"]),
    (Role::RightForearm, ["RightForeArm", "rradius"]),
    (Role::RightHand, ["RightHand", "rwrist"]),
];

fn roles(clip: &Clip) -> RoleMap {
    let mut map = RoleMap::default();
    for (role, names) in PARTS {
        map.set(role, names.iter().find_map(|n| clip.skeleton.find(n)));
    }
    map
}

/// A referee clip; frame 0 is a T-pose that the conversion left there.
pub fn referee(data: &std::path::Path, name: &str, source: StreamKind) -> TrainClip {
    let bytes = std::fs::read(data.join("referee/clips").join(format!("{name}.bvh"))).unwrap();
    let loaded = bvh::read(
        &bytes,
        name,
        &bvh::BvhOptions::default(),
        &Limits::default(),
    )
    .unwrap();
    let clip = loaded.clips.into_iter().next().unwrap();
    TrainClip {
        name: name.into(),
        roles: roles(&clip),
        rest: 0..1,
        clip,
        source,
        person: None,
    }
}

/// An ASF/AMC clip.
pub fn acclaim(
    data: &std::path::Path,
    folder: &str,
    asf: &str,
    name: &str,
    source: StreamKind,
) -> TrainClip {
    let skeleton = std::fs::read(data.join(folder).join(asf)).unwrap();
    let (asf, _) = acclaim::read_asf(&skeleton, &Limits::default()).unwrap();
    let bytes = std::fs::read(data.join(folder).join("clips").join(format!("{name}.amc"))).unwrap();
    let loaded =
        acclaim::read_amc(&bytes, name, &asf, &Default::default(), &Limits::default()).unwrap();
    let clip = loaded.clips.into_iter().next().unwrap();
    TrainClip {
        name: name.into(),
        roles: roles(&clip),
        rest: 0..0,
        clip,
        source,
        person: None,
    }
}
