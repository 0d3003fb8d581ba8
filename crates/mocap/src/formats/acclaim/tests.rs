//! Both readers together, on small files of our own that each show one trap.

use proptest::prelude::*;

use super::*;
use crate::clip::Clip;
use crate::formats::{Limits, Loaded, ParseError, Place};
use crate::kinematics::WorldPose;
use crate::math::{Axis, Quat, Vec3};

const ARM: &[u8] = include_bytes!("../../../testdata/acclaim/arm.asf");
const WAVE: &[u8] = include_bytes!("../../../testdata/acclaim/wave.amc");

fn asf(bytes: &[u8]) -> Asf {
    read_asf(bytes, &Limits::default()).unwrap().0
}

fn amc(skeleton: &Asf, bytes: &[u8]) -> Result<Loaded, ParseError> {
    read_amc(
        bytes,
        "clip",
        skeleton,
        &AmcOptions::default(),
        &Limits::default(),
    )
}

fn clip(skeleton: &Asf, bytes: &[u8]) -> Clip {
    amc(skeleton, bytes).unwrap().clips.remove(0)
}

/// A skeleton of a root and two bones in a line along X, the first with these axes and degrees of freedom.
fn two_bones(axis: &str, dof: &str) -> Asf {
    let text = format!(
        ":units\n angle deg\n:root\n order TX TY TZ RX RY RZ\n:bonedata\nbegin\nname a\ndirection 1 0 0\n\
         length 2\naxis {axis}\n{dof}\nend\nbegin\nname b\ndirection 1 0 0\nlength 1\naxis 0 0 0 XYZ\nend\n\
         :hierarchy\nbegin\nroot a\na b\nend\n"
    );
    asf(text.as_bytes())
}

#[test]
fn joints_sit_at_the_far_end_of_their_parent_bone() {
    let skeleton = asf(ARM).skeleton();
    let names: Vec<_> = skeleton.names().collect();
    assert_eq!(names, ["root", "spine", "upper", "lower", "palm"]);
    let offsets: Vec<_> = skeleton.joints().iter().map(|j| j.offset).collect();
    assert_eq!(offsets[1], Vec3::zeros());
    assert_eq!(offsets[2], Vec3::new(0.0, 3.0, 0.0));
    assert_eq!(offsets[4], Vec3::new(1.5, 0.0, 0.0));
    assert_eq!(skeleton.joints()[4].tip, Some(Vec3::new(0.5, 0.0, 0.0)));
    assert_eq!(skeleton.joints()[3].tip, None);
}

#[test]
fn bvh_and_acclaim_give_the_same_poses() {
    const WAVE_BVH: &[u8] = include_bytes!("../../../testdata/acclaim/wave.bvh");
    let options = crate::formats::bvh::BvhOptions::default();
    let bvh = crate::formats::bvh::read(WAVE_BVH, "wave", &options, &Limits::default())
        .unwrap()
        .clips
        .remove(0);
    let acclaim = clip(&asf(ARM), WAVE);
    assert_eq!((bvh.frames, bvh.rate_hz), (acclaim.frames, acclaim.rate_hz));
    assert_eq!(bvh.skeleton, acclaim.skeleton);
    for frame in 0..bvh.frames {
        let (a, b) = (WorldPose::of(&bvh, frame), WorldPose::of(&acclaim, frame));
        for joint in 0..bvh.skeleton.len() {
            assert!(
                (a.positions[joint] - b.positions[joint]).norm() < 1e-9,
                "frame {frame}, joint {joint}"
            );
            assert!(
                a.rotations[joint].angle_to(&b.rotations[joint]) < 1e-7,
                "frame {frame}, joint {joint}"
            );
        }
        assert!((a.tip(&bvh, 4) - b.tip(&acclaim, 4)).norm() < 1e-9);
    }
}

#[test]
fn the_same_motion_written_as_world_positions_comes_out() {
    // The forearm's axes are turned by 90° about X, so that its Z is the world's −Y: −90° about it are 90° about
    // Y, which swings the hand from +X to −Z.
    let arm = asf(ARM);
    let wave = clip(&arm, WAVE);
    let pose = WorldPose::of(&wave, 1);
    let elbow = pose.positions[3];
    assert!((elbow - Vec3::new(2.0, 4.0, 0.0)).norm() < 1e-9, "{elbow}");
    let wrist = pose.positions[4];
    assert!((wrist - Vec3::new(2.0, 4.0, -1.5)).norm() < 1e-9, "{wrist}");
}

#[test]
fn rotations_are_applied_in_the_order_listed_about_the_bones_axes() {
    let skeleton = two_bones("30 0 45 ZYX", "dof rz rx");
    let clip = clip(&skeleton, b":DEGREES\n1\nroot 0 0 0 0 0 0\na 20 50\n");
    let axis = |axis: Axis, degrees: f64| axis.rotation(degrees.to_radians());
    let c = axis(Axis::X, 30.0) * axis(Axis::Y, 0.0) * axis(Axis::Z, 45.0);
    let m = axis(Axis::X, 50.0) * axis(Axis::Z, 20.0);
    assert!(clip.rotations[1].angle_to(&(c * m * c.inverse())) < 1e-9);
}

#[test]
fn radians_are_taken_from_either_file() {
    let degrees = two_bones("0 0 0 XYZ", "dof rx");
    let mut radians = degrees.clone();
    radians.degrees = false;
    let turned = Axis::X.rotation(0.5);
    let said = clip(&degrees, b":radians\n1\nroot 0 0 0 0 0 0\na 0.5\n");
    assert!(said.rotations[1].angle_to(&turned) < 1e-9);
    let implied = clip(&radians, b"1\nroot 0 0 0 0 0 0\na 0.5\n");
    assert!(implied.rotations[1].angle_to(&turned) < 1e-9);
    let overruled = clip(&radians, b":Degrees\n1\nroot 0 0 0 0 0 0\na 90\n");
    assert!(overruled.rotations[1].angle_to(&Axis::X.rotation(90f64.to_radians())) < 1e-9);
}

#[test]
fn a_bone_can_move_and_grow() {
    let skeleton = two_bones("0 0 90 XYZ", "dof l rz tx");
    let clip = clip(&skeleton, b"1\nroot 0 10 0 0 0 0\na 0.5 0 3\n");
    let pose = WorldPose::of(&clip, 0);
    // The bone's own X is the parent's Y.
    assert!((pose.positions[1] - Vec3::new(0.0, 13.0, 0.0)).norm() < 1e-9);
    assert!((pose.positions[2] - Vec3::new(2.5, 13.0, 0.0)).norm() < 1e-9);
}

#[test]
fn root_order_may_be_anything() {
    let mut skeleton = two_bones("0 0 0 XYZ", "");
    skeleton.root.channels = vec![
        AmcChannel::Rotation(Axis::Z),
        AmcChannel::Translation(Axis::Y),
        AmcChannel::Rotation(Axis::X),
        AmcChannel::Translation(Axis::X),
    ];
    let clip = clip(&skeleton, b"1\nroot 90 5 90 7\n");
    assert_eq!(clip.tracks[0].positions[0], Vec3::new(7.0, 5.0, 0.0));
    let quarter = |axis: Axis| axis.rotation(90f64.to_radians());
    assert!(clip.rotations[0].angle_to(&(quarter(Axis::X) * quarter(Axis::Z))) < 1e-9);
}

#[test]
fn odd_encodings_line_ends_and_comments_change_nothing() {
    let plain = asf(ARM);
    let odd = String::from_utf8_lossy(ARM).replace('\n', "  # note\r\n");
    let odd = [b"# X:\\f\xFCr Bonn\r".as_slice(), odd.as_bytes()].concat();
    assert_eq!(asf(&odd), plain);
    let crlf = String::from_utf8_lossy(WAVE).replace('\n', "\r\n# \u{a9}\r\n");
    assert_eq!(clip(&plain, crlf.trim_end().as_bytes()), clip(&plain, WAVE));
}

#[test]
fn holes_are_filled_and_said() {
    let skeleton = two_bones("0 0 0 XYZ", "dof rx");
    let loaded = amc(
        &skeleton,
        b"5\nroot 0 0 0 0 0 0\na 0\n7\nroot 2 0 0 0 0 0\na 20\n8\nroot 3 0 0 0 0 0\n9\nroot 4 0 0 0 0 0\na 40\n",
    )
    .unwrap();
    let clip = &loaded.clips[0];
    assert_eq!((clip.frames, clip.repaired.clone()), (5, vec![1..2, 3..4]));
    assert_eq!(clip.tracks[0].positions[1], Vec3::new(1.0, 0.0, 0.0));
    let turns: Vec<f64> = (0..5)
        .map(|f| clip.frame_rotations(f)[1].angle().to_degrees().round())
        .collect();
    assert_eq!(turns, [0.0, 10.0, 20.0, 30.0, 40.0]);
    assert!(
        loaded
            .warnings
            .iter()
            .any(|w| w.at == Place::Line(4) && w.text.contains("missing before frame 7"))
    );
}

#[test]
fn unreadable_rows_are_interpolated_and_located() {
    let skeleton = two_bones("0 0 0 XYZ", "dof rx");
    let text =
        "1\nroot 0 0 0 0 0 0\na 0\n2\nroot 0 0 0 0 0 0\na nan\n3\nroot 0 0 0 0 0 0\na 2e+001\n";
    let loaded = amc(&skeleton, text.as_bytes()).unwrap();
    assert!(
        loaded
            .warnings
            .iter()
            .any(|w| w.at == Place::Line(6) && w.text.contains("`nan`"))
    );
    assert!((loaded.clips[0].frame_rotations(1)[1].angle().to_degrees() - 10.0).abs() < 1e-6);
}

#[test]
fn a_frame_that_is_cut_off_is_left_out() {
    let arm = asf(ARM);
    let whole = clip(&arm, WAVE);
    let end = WAVE.windows(6).rposition(|w| w == b"\nlower").unwrap();
    let cut = amc(&arm, &WAVE[..end]).unwrap();
    assert_eq!(cut.clips[0].frames, whole.frames - 1);
    assert!(cut.warnings.iter().any(|w| w.text.contains("incomplete")));
    assert_eq!(
        cut.clips[0].rotations[..],
        whole.rotations[..cut.clips[0].rotations.len()]
    );
}

#[test]
fn what_is_no_motion_is_refused_with_a_reason() {
    let arm = asf(ARM);
    for (text, expected) in [
        ("This is a toy file, not a motion at all.\n", "frame number"),
        ("", "frames"),
        (":FULLY-SPECIFIED\n:DEGREES\n", "frames"),
        ("1\n2\n3\n", "rows of the skeleton's bones"),
        ("1\nhip 1 2 3\nknee 4\n", "rows of the skeleton's bones"),
        ("1\nroot 1 2 3\n2\nroot 4 5 6\n", "6 numbers for bone root"),
    ] {
        let error = amc(&arm, text.as_bytes()).unwrap_err();
        assert!(error.expected.contains(expected), "{text:?}: {error}");
    }
}

#[test]
fn what_is_no_skeleton_is_refused_where_it_goes_wrong() {
    let text = String::from_utf8_lossy(ARM).into_owned();
    for (from, to, line, expected) in [
        ("upper lower", "upper wing", 49, "a bone of `:bonedata`"),
        ("spine upper", "spine spine", 48, "one parent"),
        ("name palm", "name LOWER", 39, "a name for each bone"),
        ("direction 0 1 0", "direction 0 one 0", 18, "a direction"),
        ("dof rz", "dof rq", 37, "tx, ty, tz"),
        ("    spine upper", "    palm upper", 48, "hang on the root"),
    ] {
        let broken = text.replacen(from, to, 1);
        assert_ne!(broken, text, "{from}");
        let error = read_asf(broken.as_bytes(), &Limits::default()).unwrap_err();
        assert!(error.expected.contains(expected), "{to}: {error}");
        assert_eq!(error.at, Place::Line(line), "{to}: {error}");
    }
}

#[test]
fn limits_hold() {
    let few = Limits {
        joints: 3,
        ..Limits::default()
    };
    assert!(
        read_asf(ARM, &few)
            .unwrap_err()
            .expected
            .contains("3 joints")
    );
    let shallow = Limits {
        depth: 3,
        ..Limits::default()
    };
    assert!(
        read_asf(ARM, &shallow)
            .unwrap_err()
            .expected
            .contains("3 joints")
    );
    let short = Limits {
        frames: 1,
        ..Limits::default()
    };
    let error = read_amc(WAVE, "w", &asf(ARM), &AmcOptions::default(), &short).unwrap_err();
    assert!(error.expected.contains("1 frames"));
}

#[test]
fn the_rate_is_assumed_aloud_or_given() {
    let arm = asf(ARM);
    let assumed = amc(&arm, WAVE).unwrap();
    assert_eq!(assumed.clips[0].rate_hz, 120.0);
    assert!(
        assumed
            .warnings
            .iter()
            .any(|w| w.text.contains("120 Hz is assumed"))
    );
    let options = AmcOptions {
        rate_hz: Some(60.0),
    };
    let given = read_amc(WAVE, "w", &arm, &options, &Limits::default()).unwrap();
    assert_eq!(given.clips[0].rate_hz, 60.0);
    assert!(given.warnings.is_empty(), "{:?}", given.warnings);
}

#[test]
fn cut_or_damaged_at_any_byte_nothing_panics() {
    let arm = asf(ARM);
    for cut in 0..ARM.len() {
        let _ = read_asf(&ARM[..cut], &Limits::default());
    }
    for cut in 0..WAVE.len() {
        let _ = amc(&arm, &WAVE[..cut]);
    }
    for at in 0..ARM.len() {
        for byte in [b' ', b'\n', b'#', b':', b'-', 0xFF, b'9'] {
            let mut damaged = ARM.to_vec();
            damaged[at] = byte;
            if let Ok((skeleton, _)) = read_asf(&damaged, &Limits::default()) {
                assert_eq!(skeleton.skeleton().len(), skeleton.bones.len() + 1);
                let _ = amc(&skeleton, WAVE);
            }
        }
    }
}

proptest! {
    #[test]
    fn any_rotation_survives_being_written_in_a_bones_own_axes(
        axes in prop::array::uniform3(-180.0f64..180.0),
        angles in prop::array::uniform3(-180.0f64..180.0),
        order in prop::sample::select(vec!["xyz", "xzy", "yxz", "yzx", "zxy", "zyx"]),
    ) {
        let dof: Vec<String> = order.chars().map(|c| format!("r{c}")).collect();
        let skeleton = two_bones(
            &format!("{} {} {} XYZ", axes[0], axes[1], axes[2]),
            &format!("dof {}", dof.join(" ")),
        );
        let row = format!("1\nroot 0 0 0 0 0 0\na {} {} {}\n", angles[0], angles[1], angles[2]);
        let read = clip(&skeleton, row.as_bytes()).rotations[1];

        // The obvious way: matrices, one after the other.
        let about = |letter: char, degrees: f64| {
            let (s, c) = degrees.to_radians().sin_cos();
            match letter {
                'x' => nalgebra::Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c),
                'y' => nalgebra::Matrix3::new(c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c),
                _ => nalgebra::Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0),
            }
        };
        let c = about('z', axes[2]) * about('y', axes[1]) * about('x', axes[0]);
        let m = order.chars().zip(angles).fold(nalgebra::Matrix3::identity(), |m, (l, a)| about(l, a) * m);
        let expected = c * m * c.transpose();
        prop_assert!((read.to_rotation_matrix().into_inner() - expected).norm() < 1e-9);
    }

    #[test]
    fn signs_are_continuous_and_rotations_unit(steps in prop::collection::vec(-170.0f64..170.0, 2..20)) {
        let skeleton = two_bones("10 20 30 XYZ", "dof rz rx");
        let rows: String = steps
            .iter()
            .enumerate()
            .map(|(f, a)| format!("{}\nroot 0 0 0 {a} 0 0\na {a} {}\n", f + 1, -a))
            .collect();
        let clip = clip(&skeleton, rows.as_bytes());
        for f in 1..clip.frames {
            for (a, b) in clip.frame_rotations(f - 1).iter().zip(clip.frame_rotations(f)) {
                prop_assert!(a.coords.dot(&b.coords) >= 0.0);
                prop_assert!((b.norm() - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn any_bytes_are_answered(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = read_asf(&bytes, &Limits::default());
        let _ = amc(&two_bones("0 0 0 XYZ", "dof rx"), &bytes);
    }
}

#[test]
fn a_presetting_of_the_root_moves_everything() {
    let mut skeleton = two_bones("0 0 0 XYZ", "");
    skeleton.root.position = Vec3::new(0.0, 1.0, 0.0);
    skeleton.root.orientation = Quat::from_axis_angle(&Vec3::y_axis(), 90f64.to_radians());
    let pose = WorldPose::of(&clip(&skeleton, b"1\nroot 1 0 0 0 0 0\n"), 0);
    assert!((pose.positions[2] - Vec3::new(0.0, 1.0, -3.0)).norm() < 1e-9);
}

/// World positions by an independent reader (numpy, C·R·C⁻¹ as quaternions), in the files' own unit.
const REAL: [(&str, &str, usize, &str, [f64; 3]); 10] = [
    (
        "exercises/skeleton.asf",
        "exercises/clips/13_29.amc",
        0,
        "lwrist",
        [7.664488, 15.629520, 4.326834],
    ),
    (
        "exercises/skeleton.asf",
        "exercises/clips/13_29.amc",
        0,
        "rtoes",
        [-3.024529, 0.941005, 4.216080],
    ),
    (
        "exercises/skeleton.asf",
        "exercises/clips/13_29.amc",
        1000,
        "lwrist",
        [2.530879, 22.577220, -4.658270],
    ),
    (
        "exercises/skeleton.asf",
        "exercises/clips/13_29.amc",
        4591,
        "head",
        [-4.281199, 27.786891, 5.072620],
    ),
    (
        "exercises/skeleton.asf",
        "exercises/clips/13_29.amc",
        4591,
        "rtoes",
        [-6.113474, 1.400627, 4.775795],
    ),
    (
        "segmentation/86.asf",
        "segmentation/clips/86_01.amc",
        0,
        "head",
        [16.495963, 27.278906, -0.123190],
    ),
    (
        "segmentation/86.asf",
        "segmentation/clips/86_01.amc",
        1000,
        "lwrist",
        [27.262833, 24.541776, -6.076791],
    ),
    (
        "segmentation/86.asf",
        "segmentation/clips/86_01.amc",
        1000,
        "rtoes",
        [20.858093, 5.637588, -0.297873],
    ),
    (
        "segmentation/86.asf",
        "segmentation/clips/86_01.amc",
        4578,
        "root",
        [27.662600, 18.041800, -6.123110],
    ),
    (
        "segmentation/86.asf",
        "segmentation/clips/86_01.amc",
        4578,
        "lwrist",
        [26.928068, 20.106111, -2.460078],
    ),
];

#[test]
fn real_motions_pose_as_an_independent_reader_poses_them() {
    let Some(data) = crate::testing::data() else {
        return;
    };
    let mut read = std::collections::HashMap::new();
    for (skeleton, motion, frame, joint, expected) in REAL {
        let clip = read.entry(motion).or_insert_with(|| {
            let skeleton = asf(&std::fs::read(data.join(skeleton)).unwrap());
            let loaded = amc(&skeleton, &std::fs::read(data.join(motion)).unwrap()).unwrap();
            assert_eq!(
                loaded.warnings.len(),
                1,
                "only the rate: {:?}",
                loaded.warnings
            );
            loaded.clips.into_iter().next().unwrap()
        });
        let pose = WorldPose::of(clip, frame);
        let at = pose.positions[clip.skeleton.find(joint).unwrap()];
        assert!(
            (at - Vec3::from(expected)).norm() < 2e-6,
            "{motion} frame {frame} {joint}: {at}"
        );
    }
}
