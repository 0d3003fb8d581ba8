//! Inference on people made for the test, and on real clips where they are.

use std::path::{Path, PathBuf};

use proptest::prelude::*;

use super::*;
use crate::clip::Clip;
use crate::clip::{Joint, JointTrack, Skeleton};
use crate::formats::{Limits, acclaim, bvh};
use crate::kinematics::WorldPose;
use crate::math::{Axis, Quat, Vec3};
use crate::pose::{BoneSet, Hand};
use crate::roles::Role;
use crate::roles::mapping::Mapping;
use crate::testing::{at_a_desk, clip_of_hands};

/// A person of 1.75 m, Y-up, metres, who swings the right arm forward; `walks` metres a frame along Z.
fn person(frames: usize, walks: f64) -> Clip {
    let joints: [(&str, Option<usize>, [f64; 3]); 15] = [
        ("Hips", None, [0.0, 0.95, 0.0]),
        ("LeftUpLeg", Some(0), [0.09, -0.05, 0.0]),
        ("LeftLeg", Some(1), [0.0, -0.42, 0.0]),
        ("LeftFoot", Some(2), [0.0, -0.4, 0.0]),
        ("RightUpLeg", Some(0), [-0.09, -0.05, 0.0]),
        ("RightLeg", Some(4), [0.0, -0.42, 0.0]),
        ("RightFoot", Some(5), [0.0, -0.4, 0.0]),
        ("Neck", Some(0), [0.0, 0.52, 0.0]),
        ("Head", Some(7), [0.0, 0.1, 0.0]),
        ("LeftArm", Some(0), [0.18, 0.45, 0.0]),
        ("LeftForeArm", Some(9), [0.28, 0.0, 0.0]),
        ("LeftHand", Some(10), [0.25, 0.0, 0.0]),
        ("RightArm", Some(0), [-0.18, 0.45, 0.0]),
        ("RightForeArm", Some(12), [-0.28, 0.0, 0.0]),
        ("RightHand", Some(13), [-0.25, 0.0, 0.0]),
    ];
    let joint = |&(name, parent, [x, y, z]): &(&str, Option<usize>, [f64; 3])| Joint {
        name: name.to_owned(),
        parent,
        offset: Vec3::new(x, y, z),
        tip: (name == "Head").then(|| Vec3::new(0.0, 0.18, 0.0)),
    };
    let skeleton = Skeleton::new(joints.iter().map(joint).collect()).unwrap();
    let mut rotations = Vec::new();
    for frame in 0..frames {
        let mut pose = vec![Quat::identity(); skeleton.len()];
        // Arms hang; the right one swings.
        pose[9] = Axis::Z.rotation(-1.3);
        pose[12] = Axis::X.rotation(-0.02 * frame as f64) * Axis::Z.rotation(1.3);
        pose[1] = Axis::X.rotation(0.1);
        rotations.extend(pose);
    }
    let positions = (0..frames)
        .map(|f| Vec3::new(0.0, 0.95, walks * f as f64))
        .collect();
    Clip {
        name: "person".to_owned(),
        skeleton,
        rate_hz: 60.0,
        rotations,
        tracks: vec![JointTrack {
            joint: 0,
            positions,
        }],
        frames,
        repaired: Vec::new(),
        points: None,
    }
}

fn ready(clip: Clip) -> Take {
    normalize(clip, &ImportOptions::default()).unwrap()
}

#[test]
fn half_a_body_is_a_body() {
    let stated = Mapping::read(b"neck\tTop\n").unwrap();
    for (neck, mapping) in [("Neck", None), ("Top", Some(stated))] {
        let options = ImportOptions {
            mapping,
            ..ImportOptions::default()
        };
        let take = normalize(at_a_desk(neck), &options).unwrap();
        assert_eq!(take.roles.joint(Role::Hips), None, "{neck}");
        assert_eq!(take.roles.joint(Role::Neck), Some(0), "{neck}");
        assert_eq!(take.roles.joint(Role::RightHand), Some(7), "{neck}");
        assert_eq!(take.report.unit, Some("mm"), "{neck}");
        assert_eq!(take.report.doubts, [""; 0], "{neck}");
        assert_eq!(take.report.notes, [""; 0], "{neck}");
        let of_body = take.bones().and(BoneSet::BODY);
        assert_eq!(of_body.len(), 6, "shoulders, arms and head");
    }
    // Z up: the head says so.
    let mut lying = at_a_desk("Neck");
    let turn = |v: Vec3| Vec3::new(v.x, -v.z, v.y);
    lying.skeleton.map_offsets(|_, offset| turn(offset));
    lying.rotations.fill(Quat::identity());
    assert_eq!(ready(lying).report.up.to_string(), "z");
}

#[test]
fn the_points_of_hands_are_known() {
    const MEDIA_PIPE: &str = "WRIST THUMB_CMC THUMB_MCP THUMB_IP THUMB_TIP INDEX_FINGER_MCP INDEX_FINGER_PIP INDEX_FINGER_DIP \
        INDEX_FINGER_TIP MIDDLE_FINGER_MCP MIDDLE_FINGER_PIP MIDDLE_FINGER_DIP MIDDLE_FINGER_TIP RING_FINGER_MCP RING_FINGER_PIP \
        RING_FINGER_DIP RING_FINGER_TIP PINKY_MCP PINKY_PIP PINKY_DIP PINKY_TIP";
    let side = |hand: Hand| match hand {
        Hand::Left => "Left",
        Hand::Right => "Right",
    };
    let word = |number: usize| MEDIA_PIPE.split_whitespace().nth(number).unwrap();
    let names: [&dyn Fn(Hand, usize) -> String; 5] = [
        &|_, number| number.to_string(),
        &|_, number| word(number).to_owned(),
        &|hand, number| format!("{}_{number}", side(hand)),
        &|hand, number| format!("{}:{}", side(hand), word(number)),
        &|hand, number| format!("hand_{}_{number}", hand as usize),
    ];
    for (at, name) in names.into_iter().enumerate() {
        for hands in [&[Hand::Left][..], &[Hand::Right], &Hand::BOTH] {
            // Two hands of the same names are no points of a clip.
            if at < 2 && hands.len() == 2 {
                continue;
            }
            let take = ready(clip_of_hands(hands, name));
            assert_eq!(take.report.doubts, [""; 0], "{at} {hands:?}");
            assert_eq!(take.roles.missing().count(), 0);
            assert_eq!(
                take.roles.played().count(),
                21 * hands.len(),
                "{at} {hands:?}"
            );
            let told = hands
                .iter()
                .all(|hand| take.roles.joint(hand.points().wrist).is_some());
            assert!(told, "{at} {hands:?}");
        }
    }
    let mut few = clip_of_hands(&[Hand::Left], |_, number| word(number).to_owned());
    few = Clip::of_points(
        "few".into(),
        30.0,
        (few.skeleton.names().take(5).map(str::to_owned))
            .zip(few.tracks.iter().map(|t| t.positions.clone())),
        Default::default(),
    );
    let doubts = ready(few).report.doubts;
    assert!(
        doubts[0].starts_with("the points match no known set"),
        "{doubts:?}"
    );
}

/// Puts a T-pose (all rotations zero) before the motion.
fn with_t_pose(mut clip: Clip) -> Clip {
    let zero = vec![Quat::identity(); clip.skeleton.len()];
    clip.rotations.splice(0..0, zero);
    for track in &mut clip.tracks {
        track.positions.insert(0, track.positions[0]);
    }
    clip.frames += 1;
    clip
}

fn signed(axis: Axis, negative: bool) -> SignedAxis {
    SignedAxis { axis, negative }
}

#[test]
fn a_plain_person_is_left_alone() {
    let clip = person(50, 0.0);
    let imported = ready(clip.clone());
    assert_eq!(imported.clip, clip);
    let facts = &imported.report;
    assert_eq!((facts.up, facts.unit), (SignedAxis::Y, Some("m")));
    assert_eq!((facts.travels, facts.rest_frames.clone()), (false, 0..0));
    assert!((facts.leg_length.unwrap() - 0.82).abs() < 1e-9);
    assert!(
        (facts.body_height.unwrap() - 1.67).abs() < 0.02,
        "{facts:?}"
    );
    assert!(facts.notes.is_empty(), "{facts:?}");
}

#[test]
fn one_joint_is_where_the_whole_pose_has_it() {
    let clip = person(50, 0.02);
    for frame in [0, 49] {
        let pose = WorldPose::of(&clip, frame);
        for joint in 0..clip.skeleton.len() {
            let alone = crate::kinematics::position_of(&clip, frame, joint);
            assert!((alone - pose.positions[joint]).norm() < 1e-12);
        }
    }
}

#[test]
fn whoever_walks_travels() {
    assert!(ready(person(50, 0.02)).report.travels);
    assert!(!ready(person(50, 0.001)).report.travels);
}

#[test]
fn a_t_pose_before_the_motion_is_seen_and_kept() {
    let imported = ready(with_t_pose(person(50, 0.01)));
    assert_eq!(imported.report.rest_frames, 0..1);
    assert_eq!(imported.clip.frames, 51);
}

#[test]
fn clips_that_begin_in_motion_have_no_rest_pose() {
    let mut clip = person(50, 0.0);
    assert_eq!(ready(clip.clone()).report.rest_frames, 0..0);
    // A jerk after the first frame of an unsymmetric pose.
    let joints = clip.skeleton.len();
    clip.rotations[12] = Axis::X.rotation(-2.5) * Axis::Z.rotation(1.3);
    clip.rotations[1] = Axis::X.rotation(-1.0);
    assert_eq!(ready(clip.clone()).report.rest_frames, 0..0);
    // Stillness: nothing jumps.
    let still = clip.rotations[..joints].to_vec();
    clip.rotations = still.iter().cycle().take(joints * 50).copied().collect();
    assert_eq!(ready(clip).report.rest_frames, 0..0);
}

#[test]
fn what_a_person_says_counts() {
    let options = ImportOptions {
        up: Some(signed(Axis::Z, false)),
        metres_per_unit: Some(2.0),
        rest_frames: Some(7),
        mapping: Some(Mapping::read(b"neck\t-\n").unwrap()),
        stated: None,
    };
    let imported = normalize(person(20, 0.0), &options).unwrap();
    assert_eq!(imported.report.up, signed(Axis::Z, false));
    assert_eq!(
        (imported.report.metres_per_unit, imported.report.unit),
        (2.0, None)
    );
    assert_eq!(imported.report.rest_frames, 0..7);
    assert_eq!(imported.roles.joint(Role::Neck), None);
    assert!((imported.clip.tracks[0].positions[0] - Vec3::new(0.0, 0.0, -1.9)).norm() < 1e-9);
    let wrong = ImportOptions {
        mapping: Some(Mapping::read(b"neck\tN\n").unwrap()),
        ..Default::default()
    };
    assert!(normalize(person(20, 0.0), &wrong).is_err());
}

#[test]
fn clips_without_frames_or_bodies_are_answered() {
    let empty = ready(person(0, 0.0));
    assert_eq!(empty.clip.frames, 0);
    assert!(!empty.report.notes.is_empty());
    let nobody = Clip {
        skeleton: Skeleton::default(),
        rotations: Vec::new(),
        tracks: Vec::new(),
        ..person(3, 0.0)
    };
    assert_eq!(ready(nobody).roles.missing().count(), Role::BODY_COUNT);
}

proptest! {
    #[test]
    fn any_axes_and_any_known_unit_come_out_the_same(
        axis in prop::sample::select(Axis::ALL.to_vec()),
        negative: bool,
        (name, metres) in prop::sample::select(vec![
            ("m", 1.0), ("cm", 0.01), ("mm", 0.001), ("inch", 0.0254), ("CMU unit (inch / 0.45)", 0.0254 / 0.45),
        ]),
        walks in 0.0f64..0.02,
    ) {
        let expected = person(30, walks);
        // The other way round: from metres and Y-up to the file's.
        let mut file = expected.clone();
        let up = signed(axis, negative);
        let there = Quat::rotation_between(&Vec3::y(), &up.unit()).unwrap_or_else(|| Axis::X.rotation(std::f64::consts::PI));
        let joints = file.skeleton.len();
        for f in 0..file.frames {
            file.rotations[f * joints] = there * file.rotations[f * joints];
        }
        for position in &mut file.tracks[0].positions {
            *position = there * *position / metres;
        }
        file.skeleton.map_offsets(|j, o| if j.parent.is_none() { there * o / metres } else { o / metres });
        file.skeleton.map_tips(|tip| tip / metres);

        let imported = ready(file);
        prop_assert_eq!(imported.report.up, up);
        prop_assert_eq!(imported.report.unit, Some(name));
        for frame in [0, 29] {
            let (a, b) = (WorldPose::of(&expected, frame), WorldPose::of(&imported.clip, frame));
            // Up and lengths are as they were; which way the body faces is not said by "up".
            for (p, q) in a.positions.iter().zip(&b.positions) {
                prop_assert!((p.y - q.y).abs() < 1e-9, "{p} {q}");
                prop_assert!((p.norm() - q.norm()).abs() < 1e-9);
            }
        }
    }
}

fn clips_in(folder: &Path) -> Vec<(String, Clip)> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    files.sort();
    let skeletons: Vec<PathBuf> = std::fs::read_dir(folder.join(".."))
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "asf"))
        .collect();
    let limits = Limits::default();
    let read = |path: &PathBuf| {
        let bytes = std::fs::read(path).unwrap();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let loaded = match skeletons.first() {
            None => bvh::read(&bytes, &name, &bvh::BvhOptions::default(), &limits),
            Some(asf) => {
                let asf = acclaim::read_asf(&std::fs::read(asf).unwrap(), &limits)
                    .unwrap()
                    .0;
                acclaim::read_amc(
                    &bytes,
                    &name,
                    &asf,
                    &acclaim::AmcOptions::default(),
                    &limits,
                )
            }
        };
        (name, loaded.unwrap().clips.remove(0))
    };
    files.iter().map(read).collect()
}

#[test]
fn real_clips_are_understood() {
    let Some(data) = crate::testing::data() else {
        return;
    };
    use Role::*;
    let collars = [LeftShoulder, RightShoulder];
    for (folder, missing, unit, rest) in [
        ("referee", vec![], "CMU unit (inch / 0.45)", 0..1),
        ("exercises", vec![], "CMU unit (inch / 0.45)", 0..0),
        ("segmentation", vec![], "CMU unit (inch / 0.45)", 0..0),
        ("everyday", vec![], "cm", 0..0),
        ("gestures", [&[Torso][..], &collars].concat(), "mm", 0..0),
    ] {
        let mut wrong = Vec::new();
        for (name, clip) in clips_in(&data.join(folder).join("clips")) {
            let imported = ready(clip);
            let facts = &imported.report;
            let lacks: Vec<Role> = imported.roles.missing().collect();
            let right = lacks == missing
                && facts.unit == Some(unit)
                && facts.up == SignedAxis::Y
                && facts.rest_frames == rest;
            if !right {
                wrong.push(format!("{name}: lacks {lacks:?}; {facts:?}"));
            }
        }
        println!("{folder}: {} wrong", wrong.len());
        assert!(wrong.is_empty(), "{folder}:\n{}", wrong.join("\n"));
    }
}

/// Every frame twice, as a change of 30 to 60 Hz without interpolation leaves it.
fn doubled(mut clip: Clip) -> Clip {
    let joints = clip.skeleton.len();
    let frames = clip.rotations.chunks(joints);
    clip.rotations = frames.flat_map(|frame| [frame, frame].concat()).collect();
    for track in &mut clip.tracks {
        track.positions = track.positions.iter().flat_map(|p| [*p, *p]).collect();
    }
    clip.frames *= 2;
    clip
}

#[test]
fn doubled_frames_do_not_hide_the_rest_pose() {
    let imported = ready(doubled(with_t_pose(person(50, 0.01))));
    assert_eq!(imported.report.rest_frames, 0..2);
    assert_eq!(ready(doubled(person(50, 0.01))).report.rest_frames, 0..0);
}

/// Turns the whole person about an axis, frame by frame.
fn turned(mut clip: Clip, turn: impl Fn(usize) -> Quat) -> Clip {
    let joints = clip.skeleton.len();
    for frame in 0..clip.frames {
        let root = &mut clip.rotations[frame * joints];
        *root = turn(frame) * *root;
    }
    clip
}

#[test]
fn who_turns_over_or_stands_on_the_hands_still_has_the_floor_below() {
    // Cartwheels: the mean of feet to head is nearly nothing, and the lowest joint is always on the floor.
    let mut wheels = turned(person(60, 0.0), |frame| {
        Axis::Z.rotation(frame as f64 * 0.1047)
    });
    for frame in 0..wheels.frames {
        let pose = WorldPose::of(&wheels, frame).positions;
        let lowest = pose.iter().map(|p| p.y).fold(f64::MAX, f64::min);
        wheels.tracks[0].positions[frame].y -= lowest;
    }
    assert_eq!(ready(wheels.clone()).report.up, SignedAxis::Y);
    for (turn, up) in [
        (signed(Axis::Z, false), signed(Axis::Z, true)),
        (signed(Axis::Z, true), signed(Axis::Z, false)),
        (signed(Axis::X, false), signed(Axis::X, true)),
        (signed(Axis::Y, true), signed(Axis::Y, true)),
    ] {
        let mut other = wheels.clone();
        axes::turn_up(&mut other, turn);
        assert_eq!(ready(other).report.up, up, "{turn}");
    }
}

#[test]
fn the_unit_is_that_of_the_skeleton_however_somebody_crouches() {
    for (name, metres) in [
        ("CMU unit (inch / 0.45)", 0.0254 / 0.45),
        ("inch", 0.0254),
        ("cm", 0.01),
        ("mm", 0.001),
        ("dm", 0.1),
        ("m", 1.0),
    ] {
        for size in [0.8, 1.0, 1.15] {
            let mut clip = person(50, 0.0);
            units::scale(&mut clip, size / metres);
            // Folded up: hips to the ground, trunk level.
            let joints = clip.skeleton.len();
            for frame in 0..clip.frames {
                clip.rotations[frame * joints] = Axis::X.rotation(1.5);
            }
            let facts = ready(clip).report;
            assert_eq!(facts.unit, Some(name), "{size}: {facts:?}");
        }
    }
}

#[test]
fn lengths_that_a_program_took_for_metres_and_wrote_in_centimetres_are_understood() {
    let mut clip = person(50, 0.0);
    units::scale(&mut clip, 100.0 * 0.45 / 0.0254);
    let stated = ImportOptions {
        stated: Some(Stated {
            up: "y".parse().unwrap(),
            metres_per_unit: 0.01,
        }),
        ..ImportOptions::default()
    };
    let report = normalize(clip, &stated).unwrap().report;
    assert!(
        (report.metres_per_unit / (0.01 * 0.0254 / 0.45) - 1.0).abs() < 1e-9,
        "{report:?}"
    );
    assert!(report.doubts.is_empty(), "{:?}", report.doubts);
    assert!(
        report.notes[0].contains("exported them as metres"),
        "{:?}",
        report.notes
    );
}

#[test]
fn legs_of_nobody_are_doubted() {
    let options = ImportOptions {
        metres_per_unit: Some(10.0),
        ..ImportOptions::default()
    };
    let doubts = normalize(person(20, 0.0), &options).unwrap().report.doubts;
    assert!(
        doubts.iter().any(|d| d.contains("do not fit a person")),
        "{doubts:?}"
    );
    assert!(ready(person(20, 0.0)).report.doubts.is_empty());
}

#[test]
fn what_a_format_states_counts_where_the_body_does_not_say_otherwise() {
    let stated = |up: &str, metres_per_unit| ImportOptions {
        stated: Some(Stated {
            up: up.parse().unwrap(),
            metres_per_unit,
        }),
        ..ImportOptions::default()
    };
    // Somebody who lies on the back for half of the clip: the format knows.
    let lying = turned(person(40, 0.0), |frame| {
        Axis::X.rotation(if frame % 2 == 0 { -1.57 } else { 0.0 })
    });
    let report = normalize(lying, &stated("y", 1.0)).unwrap().report;
    assert_eq!((report.up, report.unit), (SignedAxis::Y, Some("m")));
    // Somebody who lies on the floor all the time.
    let mut lying = turned(person(40, 0.0), |_| Axis::Z.rotation(-1.57));
    for frame in 0..lying.frames {
        let pose = WorldPose::of(&lying, frame).positions;
        let lowest = pose.iter().map(|p| p.y).fold(f64::MAX, f64::min);
        lying.tracks[0].positions[frame].y -= lowest;
    }
    let report = normalize(lying.clone(), &stated("y", 1.0)).unwrap().report;
    assert_eq!(report.up, SignedAxis::Y, "{:?}", report.notes);
    let of_unit = report.notes.iter().any(|note| note.contains("unit"));
    assert!(!of_unit, "{:?}", report.notes);
    // Where nothing is stated, the floor tells.
    let facts = ready(lying).report;
    assert_eq!(facts.up, SignedAxis::Y, "{:?}", facts.notes);
    // In a picture Y points down, and the head is near its upper edge.
    let mut picture = turned(person(40, 0.0), |_| Axis::X.rotation(std::f64::consts::PI));
    for frame in 0..picture.frames {
        let pose = WorldPose::of(&picture, frame).positions;
        let lowest = pose.iter().map(|p| p.y).fold(f64::MAX, f64::min);
        picture.tracks[0].positions[frame] += Vec3::new(0.0, 0.1 - lowest, 0.5);
    }
    assert_eq!(ready(picture).report.up, signed(Axis::Y, true));
    // Somebody who stands along Y in a file that says Z and millimetres.
    let report = normalize(person(40, 0.0), &stated("z", 0.001))
        .unwrap()
        .report;
    assert_eq!((report.up, report.unit), (SignedAxis::Y, Some("m")));
    assert_eq!(report.notes.len(), 2, "{:?}", report.notes);
}
