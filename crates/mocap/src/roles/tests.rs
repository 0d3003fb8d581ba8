//! Roles over the namings that are met in the wild.

use proptest::prelude::*;

use super::mapping::{self, Mapping};
use super::*;
use crate::clip::Joint;
use crate::clip::Skeleton;
use crate::formats::Place;
use crate::math::Vec3;

const SKELETONS: &str = include_str!("../../testdata/roles/skeletons.txt");

struct Case {
    title: String,
    joints: Vec<Joint>,
    expected: RoleMap,
}

impl Case {
    fn skeleton(&self) -> Skeleton {
        Skeleton::new(self.joints.clone()).unwrap()
    }
}

fn cases() -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    for line in SKELETONS.lines().filter(|l| !l.starts_with('#')) {
        if let Some(title) = line.strip_prefix("== ") {
            cases.push(Case {
                title: title.to_owned(),
                joints: Vec::new(),
                expected: RoleMap::default(),
            });
            open.clear();
            continue;
        }
        let case = cases.last_mut().unwrap();
        let depth = (line.len() - line.trim_start().len()) / 2;
        let fields: Vec<&str> = line.trim_start().split('\t').collect();
        let offset: Vec<f64> = fields[1].split(' ').map(|n| n.parse().unwrap()).collect();
        open.truncate(depth);
        assert_eq!(open.len(), depth, "{}: {line}", case.title);
        let joint = case.joints.len();
        case.joints.push(Joint {
            name: fields[0].to_owned(),
            parent: open.last().copied(),
            offset: Vec3::from_column_slice(&offset),
            tip: None,
        });
        for role in fields.get(2).iter().flat_map(|roles| roles.split(',')) {
            case.expected
                .set(Role::from_name(role).unwrap(), Some(joint));
        }
        open.push(joint);
    }
    for case in &mut cases {
        let parents: Vec<_> = case.joints.iter().filter_map(|j| j.parent).collect();
        for (j, joint) in case.joints.iter_mut().enumerate() {
            joint.tip = (!parents.contains(&j)).then(|| joint.offset * 0.3);
        }
    }
    cases
}

/// The roles that differ, as `role: found, expected`.
fn differences(case: &Case, found: &RoleMap) -> Vec<String> {
    let name = |joint: Option<usize>| joint.map_or("-", |j| case.joints[j].name.as_str());
    Role::ALL
        .into_iter()
        .filter(|&role| found.joint(role) != case.expected.joint(role))
        .map(|role| {
            format!(
                "{role}: {}, not {}",
                name(found.joint(role)),
                name(case.expected.joint(role))
            )
        })
        .collect()
}

#[test]
fn every_naming_is_understood() {
    let wrong: Vec<String> = cases()
        .iter()
        .map(|case| (case, differences(case, &RoleMap::find(&case.skeleton()))))
        .filter(|(_, wrong)| !wrong.is_empty())
        .map(|(case, wrong)| format!("{}: {}", case.title, wrong.join("; ")))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(cases().len() >= 50);
}

#[test]
fn the_tree_alone_is_enough() {
    // Every skeleton again with numbers for names: arms, legs and head must come out in the same chains, sides
    // by the toes. Where only a name could tell, the role is not asked for.
    let asked = [
        Role::LeftThigh,
        Role::LeftShin,
        Role::LeftFoot,
        Role::RightThigh,
        Role::LeftArm,
        Role::LeftForearm,
        Role::LeftHand,
        Role::RightForearm,
    ];
    // Where nothing moves, halved bones look like whole ones; a mirrored body is another one.
    let blind = [
        "MakeHuman",
        "MakeHuman, default",
        "Rigify DEF- halves",
        "Advanced Skeleton",
        "Mirrored: the names decide",
        "Quaternius, feet on handles",
        "Long collars, short hands",
        "MikuMikuDance",
        "MikuMikuDance, English",
        "DAZ Genesis 8",
        "DAZ Genesis 9",
    ];
    let mut wrong = Vec::new();
    for mut case in cases()
        .into_iter()
        .filter(|case| !blind.contains(&case.title.as_str()))
    {
        case.joints
            .iter_mut()
            .enumerate()
            .for_each(|(j, joint)| joint.name = format!("joint_{j}"));
        let found = find(&case.skeleton());
        let differ = differences(&case, &found.map);
        let is_asked = |d: &&String| asked.iter().any(|role| d.starts_with(&format!("{role}:")));
        let differ: Vec<&String> = differ.iter().filter(is_asked).collect();
        if !differ.is_empty() {
            wrong.push(format!("{}: {differ:?}", case.title));
        }
        assert!(
            found
                .notes
                .iter()
                .any(|n| n.contains("inferred from the toes")),
            "{}",
            case.title
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn what_is_not_there_is_missing_and_nothing_panics() {
    let one = Joint {
        name: "root".to_owned(),
        parent: None,
        offset: Vec3::zeros(),
        tip: None,
    };
    let alone = RoleMap::find(&Skeleton::new(vec![one]).unwrap());
    assert_eq!(alone.missing().count(), Role::BODY_COUNT - 1);
    assert_eq!(
        RoleMap::find(&Skeleton::default()).missing().count(),
        Role::BODY_COUNT
    );
}

#[test]
fn one_armed_people_keep_their_other_limbs() {
    let case = cases()
        .into_iter()
        .find(|c| c.title == "MotionBuilder")
        .unwrap();
    let right_arm = case.expected.joint(Role::RightShoulder).unwrap();
    let skeleton = case.skeleton();
    let gone = |mut j: usize| loop {
        match skeleton.joints()[j].parent {
            _ if j == right_arm => return true,
            Some(p) => j = p,
            None => return false,
        }
    };
    let kept: Vec<usize> = (0..skeleton.len()).filter(|&j| !gone(j)).collect();
    let joints = kept.iter().map(|&j| {
        let joint = skeleton.joints()[j].clone();
        let parent = joint.parent.and_then(|p| kept.iter().position(|&k| k == p));
        Joint { parent, ..joint }
    });
    let skeleton = Skeleton::new(joints.collect()).unwrap();
    let map = RoleMap::find(&skeleton);
    let missing: Vec<Role> = map.missing().collect();
    assert_eq!(
        missing,
        [
            Role::RightShoulder,
            Role::RightArm,
            Role::RightForearm,
            Role::RightHand
        ]
    );
    assert_eq!(map.joint(Role::LeftForearm), skeleton.find("LeftForeArm"));
}

#[test]
fn mapping_files_override_and_come_back() {
    let case = &cases()[0];
    let skeleton = case.skeleton();
    let mut map = RoleMap::find(&skeleton);
    let text = "# mine\r\n\r\nhead\tNeck\r\nleft_shoulder\t-\r\n";
    Mapping::read(text.as_bytes())
        .unwrap()
        .apply(&skeleton, &mut map)
        .unwrap();
    assert_eq!(map.joint(Role::Head), skeleton.find("Neck"));
    assert_eq!(map.joint(Role::LeftShoulder), None);
    assert_eq!(map.joint(Role::LeftArm), case.expected.joint(Role::LeftArm));

    let mut again = RoleMap::default();
    let written = mapping::write(&map, &skeleton);
    Mapping::read(written.as_bytes())
        .unwrap()
        .apply(&skeleton, &mut again)
        .unwrap();
    assert_eq!(again, map);
}

#[test]
fn mistakes_in_mapping_files_are_located() {
    for (text, line, expected) in [
        ("hips Hips\n", 1, "a tab"),
        ("#\nhip\tHips\n", 2, "left_forearm"),
        ("hips\tHips\nhips\t-\n", 2, "once"),
        ("hips\t\n", 1, "a joint's name or -"),
    ] {
        let error = Mapping::read(text.as_bytes()).unwrap_err();
        assert_eq!(error.at, Place::Line(line), "{error}");
        assert!(error.expected.contains(expected), "{error}");
    }
    let mut map = RoleMap::default();
    let mapping = Mapping::read(b"head\t-\nhips\tHip\n").unwrap();
    let error = mapping.apply(&cases()[0].skeleton(), &mut map).unwrap_err();
    assert_eq!((error.at, error.found.as_str()), (Place::Line(2), "`Hip`"));
    assert_eq!(map, RoleMap::default());
}

/// A case in poses that people take: knees, hips, shoulders and elbows bent by angles of their own.
fn moving(case: &Case) -> Vec<Vec<Vec3>> {
    use crate::math::{Axis, Quat};
    let skeleton = case.skeleton();
    let bends = |pose: usize, joint: usize| -> Quat {
        let by = |radians: f64, axis: Axis| axis.rotation(radians);
        // Any angles that differ from pose to pose and from side to side.
        let wave = |shift: f64| 0.5 + 0.5 * (pose as f64 * 1.7 + shift).sin();
        let plays = |role: Role| case.expected.joint(role) == Some(joint);
        Role::ALL
            .into_iter()
            .filter(|&role| plays(role))
            .fold(Quat::identity(), |turn, role| {
                turn * match role {
                    Role::LeftThigh => by(-0.9 * wave(0.0), Axis::X),
                    Role::RightThigh => by(-0.9 * wave(2.0), Axis::X),
                    Role::LeftShin => by(0.15 + 1.1 * wave(0.5), Axis::X),
                    Role::RightShin => by(0.15 + 1.1 * wave(2.5), Axis::X),
                    Role::LeftArm => by(-1.2 * wave(1.0), Axis::Z),
                    Role::RightArm => by(1.2 * wave(3.0), Axis::Z),
                    Role::LeftForearm => by(-0.2 - 1.3 * wave(1.3), Axis::Y),
                    Role::RightForearm => by(0.2 + 1.3 * wave(3.3), Axis::Y),
                    _ => Quat::identity(),
                }
            })
    };
    let pose = |pose: usize| {
        let mut world = crate::kinematics::WorldPose::default();
        for (j, joint) in skeleton.joints().iter().enumerate() {
            world.add(joint.parent, joint.offset, bends(pose, j));
        }
        world.positions
    };
    (0..8).map(pose).collect()
}

/// Roles that follow from the shape of the tree, whatever the joints are called. Collars, and the choice among several
/// joints of a spine or neck, need names.
const STRUCTURAL: [Role; 12] = [
    Role::LeftThigh,
    Role::LeftShin,
    Role::LeftFoot,
    Role::RightThigh,
    Role::RightShin,
    Role::RightFoot,
    Role::LeftArm,
    Role::LeftForearm,
    Role::LeftHand,
    Role::RightArm,
    Role::RightForearm,
    Role::RightHand,
];

/// Without their names feet that hang on handles are no part of a leg, and a mirrored body is another one.
const BLIND_WHEN_MOVING: [&str; 3] = [
    "Quaternius, feet on handles",
    "Mirrored: the names decide",
    // A hand no longer than a finger's bone is a part of the forearm to anybody who cannot read.
    "Long collars, short hands",
];

fn renamed(case: &Case, salt: u64) -> Skeleton {
    let name = |j: usize| format!("q{}x{}", j as u64 * 7 + salt % 97, salt);
    let joints = case.joints.iter().enumerate().map(|(j, joint)| Joint {
        name: name(j),
        ..joint.clone()
    });
    Skeleton::new(joints.collect()).unwrap()
}

#[test]
fn moving_bodies_are_understood_without_any_name() {
    let mut wrong = Vec::new();
    let seen = |case: &&Case| !BLIND_WHEN_MOVING.contains(&case.title.as_str());
    for case in cases().iter().filter(seen) {
        let poses = moving(case);
        let mut found = find_moving(&renamed(case, 5), &poses).map;
        // Of joints that are always in one point, either will do.
        for role in Role::ALL {
            if let (Some(a), Some(b)) = (found.joint(role), case.expected.joint(role))
                && poses.iter().all(|pose| (pose[a] - pose[b]).norm() < 1e-9)
            {
                found.set(role, Some(b));
            }
        }
        let differ: Vec<String> = differences(case, &found)
            .into_iter()
            .filter(|d| {
                STRUCTURAL
                    .iter()
                    .any(|role| d.starts_with(&format!("{role}:")))
            })
            .collect();
        if !differ.is_empty() {
            wrong.push(format!("{}: {}", case.title, differ.join("; ")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn moving_bodies_are_understood_by_name_and_not_doubted() {
    let mut wrong = Vec::new();
    let plain = |case: &&Case| case.title != "Mirrored: the names decide";
    for case in cases().iter().filter(plain) {
        let poses = moving(case);
        let found = find_moving(&case.skeleton(), &poses).map;
        let mut differ = differences(case, &found);
        differ.extend(check(&case.skeleton(), &found, &poses));
        if !differ.is_empty() {
            wrong.push(format!("{}: {}", case.title, differ.join("; ")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

proptest! {
    #[test]
    fn names_that_say_nothing_change_nothing_from_one_to_the_next(at in 0usize..60, salt in any::<u64>()) {
        let cases = cases();
        let case = &cases[at % cases.len()];
        let poses = moving(case);
        let one = find_moving(&renamed(case, 5), &poses).map;
        prop_assert_eq!(one, find_moving(&renamed(case, salt), &poses).map, "{}", case.title);
    }

    #[test]
    fn any_tree_is_answered(
        joints in prop::collection::vec(
            (
                any::<prop::sample::Index>(),
                prop::sample::select(vec![
                    "Hips", "LeftLeg", "LeftUpLeg", "RightFoot", "lfemur", "rradius", "Neck", "head", "LeftShoulder",
                    "R Hand", "L Arm", "spine", "twist", "x", "LeftEye", "",
                ]),
                prop::array::uniform3(-1i8..=1),
            ),
            1..40,
        ),
    ) {
        let joint = |(j, (parent, name, offset)): (usize, &(prop::sample::Index, &str, [i8; 3]))| Joint {
            name: (*name).to_owned(),
            parent: (j > 0).then(|| parent.index(j.max(1))),
            offset: Vec3::from(offset.map(f64::from)),
            tip: None,
        };
        let skeleton = Skeleton::new(joints.iter().enumerate().map(joint).collect()).unwrap();
        let map = RoleMap::find(&skeleton);
        // A root that is the neck or the head is not the hips.
        let is_above = [Role::Neck, Role::Head].map(|role| map.joint(role)).contains(&Some(0));
        prop_assert!(map.joint(Role::Hips).is_some() || is_above);
        let positions: Vec<Vec3> = skeleton.joints().iter().map(|joint| joint.offset).collect();
        let _doubts = check(&skeleton, &map, &[positions]);
        for role in Role::ALL {
            prop_assert!(map.joint(role).is_none_or(|j| j < skeleton.len()));
        }
    }
}
