//! Documents of every habit.

use super::*;
use serde_json::json;

use crate::pose::Hand;
use crate::roles::Role;
use crate::testing::flat_hand;

fn open(document: &Value) -> Result<Loaded, ParseError> {
    read(
        document.to_string().as_bytes(),
        "f",
        None,
        &Limits::default(),
    )
}

fn landmarks(frame: usize) -> Value {
    let point = |j: usize| json!({"x": 0.01 * j as f64, "y": 0.1 * frame as f64 + 0.5, "z": 0.2, "visibility": 0.9});
    (0..33).map(point).collect()
}

#[test]
fn frames_are_found_wherever_they_are() {
    let list: Value = (0..6)
        .map(|f| json!({"frame": f, "timestamp": f as f64 / 25.0, "landmarks": landmarks(f)}))
        .collect();
    let within = json!({"fps": 50.0, "frames": (0..6).map(|f| json!({
        "pose_landmarks": landmarks(0), "pose_world_landmarks": landmarks(f)})).collect::<Value>()});
    let tasks: Value = (0..6)
        .map(|f| json!({"pose_landmarks": [landmarks(f)]}))
        .collect();
    let arrays = json!({"keypoints": (0..6).map(|f| (0..17)
        .map(|j| json!([0.1 * f as f64, 0.1 * j as f64, 1.0])).collect::<Value>()).collect::<Value>()});
    let named: Value = (0..6)
        .map(|f| json!({"joints": {"nose": [0.1, 1.6, 0.1 * f as f64], "left_hip": [0.1, 1, 0], "right_hip": [0, 1, 0],
            "left_knee": [0.1, 0.5, 0], "right_knee": [0, 0.5, 0]}}))
        .collect();
    for (document, points, rate_hz) in [
        (&list, 33, 25.0),
        (&within, 33, 50.0),
        (&tasks, 33, 30.0),
        (&arrays, 17, 30.0),
        (&named, 5, 30.0),
    ] {
        assert!(looks_so(document.to_string().as_bytes()));
        let clip = &open(document).unwrap().clips[0];
        assert_eq!(
            (clip.frames, clip.skeleton.len()),
            (6, points),
            "{document}"
        );
        assert!((clip.rate_hz - rate_hz).abs() < 0.01, "{}", clip.rate_hz);
        let moves = clip
            .tracks
            .iter()
            .any(|track| track.positions[0] != track.positions[5]);
        assert!(moves, "{document}");
    }
}

fn sum_of_moves(loaded: &Loaded) -> f64 {
    let track =
        |t: &crate::clip::JointTrack| (t.positions[0] - t.positions[t.positions.len() - 1]).norm();
    loaded.clips[0].tracks.iter().map(track).sum()
}

#[test]
fn frames_in_lines_in_numbered_fields_and_in_rows_of_numbers() {
    let lines: Vec<String> = (0..12)
        .map(|f| json!({"t": f as f64 / 20.0, "landmarks": landmarks(f)}).to_string())
        .collect();
    let lines = read(lines.join("\n").as_bytes(), "f", None, &Limits::default()).unwrap();
    let numbered: Map<String, Value> = (0..12)
        .map(|f| (format!("frame_{f}"), json!({"landmarks": landmarks(f)})))
        .collect();
    let numbered = open(&json!({"joints": numbered})).unwrap();
    let row = |f: usize| {
        (0..25)
            .flat_map(move |j| [j as f64, f as f64, 1.0, 0.5])
            .collect::<Vec<f64>>()
    };
    let rows: Value = (0..12)
        .map(|f| json!({"people": [{"pose_keypoints_2d": [1, 2, 0.5], "pose_keypoints_3d": row(f)}]}))
        .collect();
    let rows = open(&rows).unwrap();
    for (loaded, points) in [(lines, 33), (numbered, 33), (rows, 25)] {
        let clip = &loaded.clips[0];
        assert_eq!((clip.frames, clip.skeleton.len()), (12, points));
        // In the order of their numbers: the last is the farthest from the first.
        assert!(
            (sum_of_moves(&loaded) / points as f64 - if points == 33 { 1.1 } else { 11.0 }).abs()
                < 1e-6
        );
    }
}

#[test]
fn azure_kinect_has_names_beside_its_frames_and_several_bodies() {
    let names: Vec<String> = (0..8).map(|j| format!("JOINT_{j}X")).collect();
    let body = |f: usize| {
        json!({"body_id": 1, "joint_orientations": vec![[1.0, 0.0, 0.0, 0.0]; 8],
        "joint_positions": (0..8).map(|j| json!([j, f, 2000])).collect::<Value>()})
    };
    let document = json!({"joint_names": names, "bone_list": [["A", "B"]],
        "frames": (0..6).map(|f| json!({"bodies": [body(f), body(f + 100)], "timestamp_usec": f * 33_333})).collect::<Value>()});
    let loaded = open(&document).unwrap();
    let clip = &loaded.clips[0];
    assert_eq!(clip.skeleton.joints()[3].name, "JOINT_3X");
    assert_eq!(clip.tracks[3].positions[4], Vec3::new(3.0, 4.0, 2000.0));
    assert!((clip.rate_hz - 30.0).abs() < 0.01);
    assert!(
        loaded.warnings.iter().any(|w| w.text.contains("2 bodies")),
        "{:?}",
        loaded.warnings
    );
}

#[test]
fn two_dimensions_are_told() {
    let row: Vec<f64> = (0..51).map(f64::from).collect();
    for document in [
        json!([{"image_id": "1.jpg", "keypoints": row}]),
        json!({"keypoints": vec![vec![json!({"x": 1, "y": 2, "score": 0.5}); 17]; 3]}),
        json!([vec![[1.0, 2.0]; 17]]),
    ] {
        let error = open(&document).unwrap_err();
        assert!(error.found.contains("two dimensions"), "{error}");
    }
}

#[test]
fn other_documents_are_refused() {
    for document in [
        json!([]),
        json!({"landmarks": []}),
        json!({"pose": {"x": 1, "y": 2, "z": 3}}),
        json!([{"landmarks": [{"x": 1, "y": 2}, {"x": 1, "y": 2}]}]),
    ] {
        assert!(open(&document).is_err(), "{document}");
    }
    assert!(read(b"{\"landmarks\": [", "f", None, &Limits::default()).is_err());
}

/// The CMU Panoptic Studio: four numbers for each joint, times in milliseconds.
#[test]
fn joints_in_a_row_by_their_count() {
    let row = |f: usize| -> Vec<f64> {
        let point = |j: usize| {
            let sure = if (j, f) == (2, 3) { 0.0 } else { 0.8 };
            [j as f64, f as f64, 1.0, sure]
        };
        (0..19).flat_map(point).collect()
    };
    let frames: Value = (0..6)
        .map(|f| json!({"univTime": 1e5 + 40.0 * f as f64, "bodies": [{"id": 0, "joints19": row(f)}]}))
        .collect();
    let loaded = open(&frames).unwrap();
    let clip = &loaded.clips[0];
    assert_eq!((clip.frames, clip.skeleton.len()), (6, 19));
    assert!((clip.rate_hz - 25.0).abs() < 1e-6, "{}", clip.rate_hz);
    // What was not seen is interpolated.
    assert_eq!(clip.repaired, [3..4]);
    assert_eq!(clip.tracks[2].positions[3], Vec3::new(2.0, 3.0, 1.0));
}

/// A row of numbers for each frame, in a field that says that they are in space: a frame's own, those of all frames, those of
/// its bodies.
#[test]
fn rows_of_numbers_in_space_are_points() {
    let row = |f: usize, width: usize| -> Vec<f64> {
        let point = |j: usize| [j as f64, f as f64, 2.0, 0.9].into_iter().take(width);
        (0..17).flat_map(point).collect()
    };
    let frames = |frame: &dyn Fn(usize) -> Value| -> Value { (0..6).map(frame).collect() };
    for width in [3, 4] {
        for document in [
            json!({"keypoints3d": frames(&|f| json!(row(f, width)))}),
            json!({"fps": 30, "data": {"keypoints_3d": frames(&|f| json!([row(f, width)]))}}),
            frames(&|f| json!({"id": f, "keypoints3d": [row(f, width)]})),
            frames(&|f| json!({"people": [{"pose_keypoints_3d": row(f, width)}]})),
        ] {
            let clip = open(&document).unwrap().clips.remove(0);
            assert_eq!((clip.frames, clip.skeleton.len()), (6, 17), "{document}");
            assert_eq!(clip.tracks[3].positions[4], Vec3::new(3.0, 4.0, 2.0));
        }
    }
}

#[test]
fn rows_of_other_lengths_are_points_if_there_are_names_and_else_are_told() {
    let rows: Vec<Vec<usize>> = (0..6).map(|f| (0..33).map(|i| i * f).collect()).collect();
    let names: Vec<String> = (0..11).map(|j| format!("part {j}")).collect();
    let named = json!({"joint_names": names, "positions_3d": rows});
    let clip = open(&named).unwrap().clips.remove(0);
    assert_eq!((clip.frames, clip.skeleton.len()), (6, 11));
    assert_eq!(clip.skeleton.joints()[10].name, "part 10");
    let unknown: Vec<&[usize]> = rows.iter().map(|row| &row[..32]).collect();
    let error = open(&json!({"keypoints3d": unknown})).unwrap_err();
    assert!(error.found.starts_with("32 numbers in a row"), "{error}");
    // Angles are not places, and what says nothing may be in a picture.
    for other in ["rotations_3d", "keypoints"] {
        let rows = vec![(0..51).collect::<Vec<usize>>(); 6];
        assert!(open(&json!({other: rows})).is_err(), "{other}");
    }
}

#[cfg(feature = "files")]
#[test]
fn a_frame_is_told_from_a_clip() {
    let one = |document: Value| is_one_frame(document.to_string().as_bytes());
    let row: Vec<f64> = (0..75).map(f64::from).collect();
    for frame in [
        json!({"people": []}),
        json!({"people": [{"pose_keypoints_2d": row}]}),
        json!([{"id": 0, "keypoints3d": vec![[1.0, 2.0, 3.0, 0.5]; 25]}]),
        json!({"landmarks": landmarks(0)}),
        json!([]),
    ] {
        assert!(one(frame.clone()), "{frame}");
    }
    let clip: Value = (0..20)
        .map(|f| json!({"landmarks": landmarks(f)}))
        .collect();
    for other in [clip, json!({"a": 1}), json!([1, 2, 3]), json!("x")] {
        assert!(!one(other.clone()), "{other}");
    }
}

/// Points that have several places, places within a field, a list for each point, and lists without a word.
#[test]
fn places_of_every_spelling() {
    let place = |f: usize, j: usize| [0.1 * f as f64, 0.1 * j as f64, 2.0];
    let list = |each: &dyn Fn(usize, usize) -> Value| -> Value {
        (0..6)
            .map(|f| json!({"joints": (0..20).map(|j| each(f, j)).collect::<Value>()}))
            .collect()
    };
    let kinect = list(&|f, j| {
        let [x, y, z] = place(f, j);
        json!({"depthX": 0.5, "depthY": 0.5, "cameraX": x, "cameraY": y, "cameraZ": z})
    });
    let within = list(&|f, j| {
        let [x, y, z] = place(f, j);
        json!({"name": format!("j{j}a"), "Position": {"X": x, "Y": y, "Z": z}, "State": "Tracked"})
    });
    let unity = list(&|f, j| {
        let [x, y, z] = place(f, j);
        json!({"jointName": format!("j{j}a"), "px": x, "py": y, "pz": z})
    });
    let tracks: Map<String, Value> = (0..20)
        .map(|j| {
            (
                format!("joint_{j}"),
                (0..6).map(|f| json!(place(f, j))).collect(),
            )
        })
        .collect();
    let bare: Value = (0..6)
        .map(|f| (0..20).map(|j| json!(place(f, j))).collect::<Value>())
        .collect();
    for document in [kinect, within, unity, Value::Object(tracks), bare] {
        assert!(looks_so(document.to_string().as_bytes()), "{document}");
        let clip = &open(&document).unwrap().clips[0];
        assert_eq!((clip.frames, clip.skeleton.len()), (6, 20));
        let is_there = |point: &crate::clip::JointTrack| {
            (point.positions[3] - Vec3::new(0.3, 0.7, 2.0)).norm() < 1e-9
        };
        assert!(clip.tracks.iter().any(is_there), "{document}");
    }
}

/// Records of a table, with times in milliseconds.
#[test]
fn records_of_a_table() {
    let record = |f: usize| -> Value {
        let axes = (0..6).flat_map(|j| ["x", "y", "z"].map(|axis| (j, axis)));
        let mut record: Map<String, Value> = axes
            .map(|(j, axis)| (format!("nose{j}_{axis}"), json!(0.1 * f as f64)))
            .collect();
        record.insert("nose_x_confidence".into(), json!(0.9));
        record.insert(
            "timestamp".into(),
            json!(1_700_000_000_000u64 + 40 * f as u64),
        );
        Value::Object(record)
    };
    let document: Value = (0..6).map(record).collect();
    let text = document.to_string().replace("nose0_", "nose_");
    assert!(looks_so(text.as_bytes()));
    let loaded = read(text.as_bytes(), "f", None, &Limits::default()).unwrap();
    let clip = &loaded.clips[0];
    assert_eq!((clip.frames, clip.skeleton.len()), (6, 6));
    assert!((clip.rate_hz - 25.0).abs() < 1e-6, "{}", clip.rate_hz);
}

/// ARKit's matrices, columns first, and those of engines, rows first; as lists of lists or 16 numbers.
#[test]
fn joints_as_matrices() {
    let names = [
        "hips_joint",
        "left_leg_joint",
        "right_leg_joint",
        "head_joint",
        "neck_1_joint",
    ];
    let place = |frame: usize, point: usize| [0.1 * frame as f64, 0.2 * point as f64, 0.5];
    let columns =
        |[x, y, z]: [f64; 3]| json!([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [x, y, z, 1]]);
    let rows = |[x, y, z]: [f64; 3]| json!([1, 0, 0, x, 0, 0, -1, y, 0, 1, 0, z, 0, 0, 0, 1]);
    let written: [&dyn Fn(usize, usize) -> Value; 3] = [
        &|f, p| json!({"name": names[p], "transform": columns(place(f, p))}),
        &|f, p| json!({"name": names[p], "modelTransform": {"columns": columns(place(f, p))}}),
        &|f, p| json!({"name": names[p], "matrix": rows(place(f, p))}),
    ];
    for joint in written {
        let frame = |f: usize| {
            let joints: Vec<Value> = (0..5).map(|p| joint(f, p)).collect();
            json!({"Timestamp": 0.05 * f as f64, "joints": joints})
        };
        let document = json!({"frames": (0..8).map(frame).collect::<Vec<Value>>()});
        assert!(looks_so(document.to_string().as_bytes()));
        let loaded = read(
            document.to_string().as_bytes(),
            "x",
            None,
            &Limits::default(),
        );
        let clip = &loaded.unwrap().clips[0];
        assert_eq!((clip.frames, clip.skeleton.len()), (8, 5), "{document}");
        assert!((clip.rate_hz - 20.0).abs() < 1e-6, "{}", clip.rate_hz);
        let known = |f: usize, p: usize| Vec3::from(place(f, p));
        assert!((clip.tracks[3].positions[2] - known(2, 3)).norm() < 1e-9);
    }
    let named = |f: usize| -> Value {
        let joints = (0..5).map(|p| (names[p].to_owned(), rows(place(f, p))));
        Value::Object(joints.collect())
    };
    let document =
        json!({"frames": (0..8).map(|f| json!({"joints": named(f)})).collect::<Vec<Value>>()});
    let loaded = read(
        document.to_string().as_bytes(),
        "x",
        None,
        &Limits::default(),
    )
    .unwrap();
    assert_eq!(loaded.clips[0].skeleton.len(), 5);
}

/// Frames of hands, whose sides are given by names of fields, by a label of each, or by a list beside them.
#[test]
fn hands_have_their_sides() {
    let points = |hand: Hand, frame: usize| -> Value {
        let pose = flat_hand(hand, 0.1 * frame as f64, 1.0);
        let places = media_pipe(hand).map(|role| pose.get(role).unwrap_or_default());
        places
            .map(|p| json!({"x": p.x, "y": p.y, "z": p.z}))
            .collect()
    };
    let (left, right) = (Hand::Left, Hand::Right);
    let fields = |f: usize| {
        json!({"t": f as f64 / 20.0, "left_hand_landmarks": points(right, 0), "left_hand_world_landmarks": points(left, f),
            "right_hand_landmarks": points(right, f)})
    };
    let labels = |f: usize| {
        let hand = |of, name| json!({"handedness": [{"categoryName": name, "score": 0.9}], "landmarks": points(of, f)});
        json!({"timestamp_ms": 50 * f, "hands": [hand(right, "Right"), hand(left, "Left")]})
    };
    let lists = |f: usize| {
        json!({"time": f as f64 / 20.0, "handedness": [[{"displayName": "Left"}], [{"displayName": "Right"}]],
            "landmarks": [points(right, 0), points(left, 0)], "worldLandmarks": [points(left, f), points(right, f)]})
    };
    let forms: [&dyn Fn(usize) -> Value; 3] = [&fields, &labels, &lists];
    for form in forms {
        let document: Value = (0..8).map(form).collect();
        assert!(looks_so(document.to_string().as_bytes()), "{document}");
        let loaded = open(&document).unwrap();
        let clip = &loaded.clips[0];
        assert_eq!(
            (clip.skeleton.len(), clip.rate_hz),
            (42, 20.0),
            "{:?}",
            loaded.warnings
        );
        for hand in Hand::BOTH {
            let name = if hand == left { "left_8" } else { "right_8" };
            let joint = clip.skeleton.find(name).unwrap();
            let tip = flat_hand(hand, 0.5, 1.0)
                .get(hand.points().fingers[1][3])
                .unwrap();
            assert!(
                (clip.tracks[joint].positions[5] - tip).norm() < 1e-9,
                "{name}"
            );
        }
        assert_eq!(loaded.warnings, []);
    }
}

/// The roles of MediaPipe's points.
fn media_pipe(hand: Hand) -> impl Iterator<Item = Role> {
    let points = hand.points();
    std::iter::once(points.wrist).chain(points.fingers.into_iter().flatten())
}
