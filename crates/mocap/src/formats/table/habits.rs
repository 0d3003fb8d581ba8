//! Conventions of programs that export tables, tested on small examples.

use super::*;

fn open(text: &str) -> Loaded {
    read(text.as_bytes(), "x", None, &Limits::default())
        .unwrap_or_else(|error| panic!("{error}:\n{text}"))
}

/// Points that stand and walk along X, for exports made by hand: `frame`, `point` to text of three numbers.
fn moving(frame: usize, point: usize, between: &str) -> String {
    let [x, y, z] = [
        0.02 * frame as f64 + 0.1 * point as f64,
        1.0 + 0.1 * (point % 3) as f64,
        0.3 * (point % 5) as f64,
    ];
    format!("{x:.4}{between}{y:.4}{between}{z:.4}")
}

fn row(frame: usize, points: usize, between: &str) -> String {
    let cells: Vec<String> = (0..points).map(|p| moving(frame, p, between)).collect();
    cells.join(between)
}

/// Vicon's sections: what is measured beside the markers is left out, wherever it stands.
#[test]
fn sections_of_nexus() {
    let devices = "Devices\n1000\n,,Plate - Force,,\nFrame,Sub Frame,Fx,Fy,Fz\n,,N,N,N\n1,0,0,0,700\n1,1,0,0,701\n\n";
    let model = "Model Outputs\n100\n,,Anna:LKneeAngles,,\nFrame,Sub Frame,X,Y,Z\n,,deg,deg,deg\n1,0,1,2,3\n\n";
    let mut markers =
        "Trajectories\n100\n,,Anna:LASI,,,Anna:RASI,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n,,mm,mm,mm,mm,mm,mm\n".to_owned();
    for frame in 0..4 {
        markers += &format!("{},0,{}\n", frame + 1, row(frame, 2, ","));
    }
    for text in [
        markers.clone(),
        format!("{devices}{markers}"),
        format!("{markers}\n{model}"),
        format!("{model}{devices}{markers}").replace(',', "\t"),
    ] {
        assert!(looks_so(text.as_bytes()), "{text}");
        let loaded = open(&text);
        let clip = &loaded.clips[0];
        assert_eq!((clip.frames, clip.rate_hz), (4, 100.0), "{text}");
        assert_eq!(clip.skeleton.joints()[1].name, "Anna:RASI");
        assert_eq!(clip.points.as_ref().unwrap().metres_per_unit, Some(0.001));
        assert_eq!(clip.tracks[1].positions[2], Vec3::new(0.14, 1.1, 0.3));
        let told = loaded.warnings.iter().any(|w| w.text.contains("left out"));
        assert_eq!(told, text.len() > markers.len(), "{:?}", loaded.warnings);
    }
    let error = read(model.as_bytes(), "f", None, &Limits::default()).unwrap_err();
    assert!(error.found.contains("export trajectories"), "{error}");
}

/// Qualisys names columns in a row of its own, or not at all, with frames and times before them, or not.
#[test]
fn measurements_of_qualisys() {
    let keys = "NO_OF_FRAMES\t4\nNO_OF_MARKERS\t2\nFREQUENCY\t240\nTIME_STAMP\t2020-01-01, 10:00:00\nDATA_INCLUDED\t3D\n\
        MARKER_NAMES\tL heel\tR heel\nTRAJECTORY_TYPES\tMeasured\tMixed\n";
    let header = "Frame\tTime\tL heel X\tL heel Y\tL heel Z\tR heel X\tR heel Y\tR heel Z\n";
    for (header, before) in [(header, 2), ("", 0), ("", 1), ("", 2)] {
        let mut text = format!("{keys}{header}");
        for frame in 0..4 {
            let first = [
                format!("{}\t", frame + 1),
                format!("{:.5}\t", frame as f64 / 240.0),
            ];
            text += &format!("{}{}\n", first[..before].concat(), row(frame, 2, "\t"));
        }
        assert!(looks_so(text.as_bytes()), "{text}");
        let clip = &open(&text).clips[0];
        assert_eq!((clip.frames, clip.rate_hz), (4, 240.0), "{text}");
        assert_eq!(clip.skeleton.joints()[1].name, "R heel");
        assert_eq!(clip.tracks[1].positions[3], Vec3::new(0.16, 1.1, 0.3));
        assert_eq!(clip.points.as_ref().unwrap().metres_per_unit, Some(0.001));
    }
}

#[test]
fn individuals_of_deeplabcut_are_told_apart() {
    let names = [
        "nose",
        "left_shoulder",
        "right_shoulder",
        "left_hip",
        "right_hip",
        "left_knee",
        "right_knee",
    ];
    let mut rows = ["scorer", "individuals", "bodyparts", "coords"].map(str::to_owned);
    for whose in ["anna", "bert"] {
        for name in names {
            for axis in ["x", "y", "z"] {
                for (row, word) in rows.iter_mut().zip(["net", whose, name, axis]) {
                    *row += &format!(",{word}");
                }
            }
        }
    }
    let mut text = rows.join("\n");
    for frame in 0..5 {
        text += &format!("\n{frame},{}", row(frame, 14, ","));
    }
    let clips = open(&text).clips;
    assert_eq!(clips.len(), 2);
    assert_eq!(clips[1].skeleton.len(), 7);
    assert_eq!(clips[1].tracks[0].positions[1].x, 0.02 + 0.7);
}

#[test]
fn whole_points_in_brackets() {
    for (open_with, between, close_with) in [
        ("\"(", ", ", ")\""),
        ("[", " ", "]"),
        ("\"[", ",", ", 0.9]\""),
    ] {
        let mut text = "frame,nose,left hip,right hip\n".to_owned();
        for frame in 0..3 {
            let cells: Vec<String> = (0..3)
                .map(|p| format!("{open_with}{}{close_with}", moving(frame, p, between)))
                .collect();
            text += &format!("{frame},{}\n", cells.join(","));
        }
        assert!(looks_so(text.as_bytes()), "{text}");
        let clip = &open(&text).clips[0];
        assert_eq!(
            (clip.frames, clip.skeleton.joints()[2].name.as_str()),
            (3, "right hip"),
            "{text}"
        );
        assert_eq!(clip.tracks[2].positions[2], Vec3::new(0.24, 1.2, 0.6));
    }
}

/// MSR-Action3D and its kin: a line for each joint, and every twenty lines the next frame.
#[test]
fn a_point_on_each_line() {
    let mut text = String::new();
    for frame in 0..30 {
        for point in 0..20 {
            text += &format!("{}  1.0\n", moving(frame, point, "  "));
        }
    }
    assert!(looks_so(text.as_bytes()));
    let clip = &open(&text).clips[0];
    assert_eq!((clip.frames, clip.skeleton.len()), (30, 20));
    assert_eq!(clip.tracks[7].positions[3], Vec3::new(0.76, 1.1, 0.6));
    let cut = &text[..text.len() - 40];
    assert!(
        read(cut.as_bytes(), "f", None, &Limits::default()).is_err(),
        "a frame without all of its points"
    );
}

#[test]
fn frames_may_begin_with_a_word() {
    let header: Vec<String> = (0..17).map(|p| format!("x_{p},y_{p},z_{p}")).collect();
    let text = format!(
        "label,{}\nwave,{}\nwave,{}\n",
        header.join(","),
        row(0, 17, ","),
        row(1, 17, ",")
    );
    let clip = &open(&text).clips[0];
    assert_eq!((clip.frames, clip.skeleton.len()), (2, 17));
}

#[test]
fn long_tables_by_number_and_by_person() {
    let mut text = "frame,person_id,landmark_index,x,y,z\n".to_owned();
    for frame in 0..4 {
        for person in 0..2 {
            for point in 0..17 {
                text += &format!("{frame},{person},{point},{}\n", moving(frame, point, ","));
            }
        }
    }
    let loaded = open(&text);
    assert_eq!(
        loaded
            .clips
            .iter()
            .map(|clip| clip.skeleton.len())
            .sum::<usize>(),
        34
    );
    let kinect =
        "Time,JointType,X,Y,Z\n0,Head,1,2,3\n0,Neck,1,2,3\n0.1,Head,1,2,3\n0.1,Neck,1,2,3\n";
    assert_eq!(open(kinect).clips[0].skeleton.joints()[1].name, "Neck");
}

/// `femur_r_X` is the right femur's place where there is a left one; `Hips_R_x` alone is a rotation.
#[test]
fn right_sides_are_no_rotations() {
    let sided = open(
        "time\tfemur_r_X\tfemur_r_Y\tfemur_r_Z\tfemur_l_X\tfemur_l_Y\tfemur_l_Z\n0\t1\t2\t3\t4\t5\t6\n0.1\t1\t2\t3\t4\t5\t6\n",
    );
    assert_eq!(sided.clips[0].skeleton.len(), 2);
    let turned = open(
        "time,Hips_T_x,Hips_T_y,Hips_T_z,Hips_R_x,Hips_R_y,Hips_R_z\n0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n",
    );
    assert_eq!(turned.clips[0].skeleton.len(), 1);
    let axis = open(
        "f,Hips-Joint-Posi-x,Hips-Joint-Posi-y,Hips-Joint-Posi-z,Hips-Joint-Quat-0\n0,1,2,3,4\n1,1,2,3,4\n",
    );
    assert_eq!(axis.clips[0].skeleton.joints()[0].name, "Hips");
}

/// FreeMoCap's tables have the body, its hands, centres of mass and a second solution one below the other, some under the same names.
#[test]
fn the_body_among_other_parts() {
    let mut text = "frame,keypoint,x,y,z,model,trajectory,reprojection_error\n".to_owned();
    let mut types = "frame,row_id,type,landmark_index,x,y,z\n".to_owned();
    for frame in 0..5 {
        for (p, name) in ["nose", "left_hip", "right_hip"].iter().enumerate() {
            let place = moving(frame, p, ",");
            text += &format!("{frame},{name},{place},rtmpose.body,3d_xyz,\n");
        }
        text += &format!("{frame},nose,9,9,9,rtmpose.body,rigid_3d_xyz,\n");
        text += &format!("{frame},head,9,9,9,rtmpose.body,segment_center_of_mass,\n");
        text += &format!("{frame},thumb1,9,9,9,rtmpose.left_hand,3d_xyz,\n");
        for (part, point) in [("face", 0), ("pose", 0), ("pose", 1), ("left_hand", 0)] {
            let place = moving(frame, point, ",");
            types += &format!("{frame},{frame}-{part}-{point},{part},{point},{place}\n");
        }
    }
    for (text, points) in [(text, 3), (types, 2)] {
        let loaded = open(&text);
        let clip = &loaded.clips[0];
        assert_eq!((clip.frames, clip.skeleton.len()), (5, points), "{text}");
        assert_eq!(clip.tracks[0].positions[1], Vec3::new(0.02, 1.0, 0.0));
        let told = |w: &Warning| w.text.contains("hand") && w.text.contains("left out");
        assert!(loaded.warnings.iter().any(told), "{:?}", loaded.warnings);
    }
}

/// Words that are no parts leave no row out.
#[test]
fn types_of_something_else() {
    let mut text = "time,joint,x,y,z,type\n".to_owned();
    for frame in 0..4 {
        for (p, state) in ["tracked", "inferred"].iter().enumerate() {
            text += &format!("{}.0,j{p},{},{state}\n", frame, moving(frame, p, ","));
        }
    }
    assert_eq!(open(&text).clips[0].skeleton.len(), 2);
}

#[test]
fn axes_after_a_word() {
    let mut text =
        "Timestamp, JointID, Position.X, Position.Y, Position.Z, Orientation.X, State\n".to_owned();
    for frame in 0..4 {
        for p in 0..3 {
            text += &format!("{}, {p}, {}, 0, 2\n", 33 * frame, moving(frame, p, ", "));
        }
    }
    assert!(looks_so(text.as_bytes()));
    let clip = &open(&text).clips[0];
    assert_eq!((clip.frames, clip.skeleton.len()), (4, 3));
    assert_eq!(clip.tracks[2].positions[3], Vec3::new(0.26, 1.2, 0.6));
}

/// MediaPipe's holistic model: 33 points of the body, then those of the face and the hands.
#[test]
fn a_face_behind_the_body() {
    let names = |count: usize| -> Vec<String> {
        (1..=count)
            .flat_map(|n| ["x", "y", "z", "v"].map(|axis| format!("{axis}{n}")))
            .collect()
    };
    let row = |frame: usize, points: usize| -> Vec<String> {
        (0..points)
            .map(|p| format!("{},0.9", moving(frame, p, ",")))
            .collect()
    };
    let holistic = |frame: usize| format!("wave,{}", row(frame, 501).join(","));
    let mut text = format!("class,{}\n", names(501).join(","));
    let words = [("Head", 468), ("Pose", 33), ("Hand", 21)];
    let labels = words.iter().flat_map(|&(word, count)| {
        (0..count).flat_map(move |n| ["x", "y", "z", "v"].map(|axis| format!("{word}_{n}_{axis}")))
    });
    let mut worded = format!("{}\n", labels.collect::<Vec<String>>().join(","));
    for frame in 0..5 {
        text += &(holistic(frame) + "\n");
        worded += &(row(frame, 522).join(",") + "\n");
    }
    for text in [text, worded] {
        let loaded = open(&text);
        assert_eq!(
            (loaded.clips[0].frames, loaded.clips[0].skeleton.len()),
            (5, 33)
        );
        let told = loaded
            .warnings
            .iter()
            .any(|w| w.text.contains("hands and face are left out"));
        assert!(told, "{:?}", loaded.warnings);
    }
}

/// A row of units below the names, clocks for times, a rate in a comment, words among the numbers, and no brackets around points.
#[test]
fn what_spreadsheets_and_cameras_write() {
    let names = ["nose", "hip"];
    let axes = |between: &str| {
        names
            .map(|n| ["x", "y", "z"].map(|a| format!("{n}_{a}")).join(between))
            .join(between)
    };
    let units = format!("Frame,Time,{}\n-,s,mm,mm,mm,mm,mm,mm\n", axes(","));
    let clocks = format!("time,{}\n", axes(","));
    let rate = format!("# made by hand\n# fps: 50\nframe,{}\n", axes(","));
    let keys = format!("Frame Rate,50\nframe,{}\n", axes(","));
    let states = names.map(|n| format!("{n}_x,{n}_y,{n}_z,{n}_state,{n}_kind"));
    let states = format!("frame,{}\n", states.join(","));
    let row = |f: usize| row(f, 2, ",");
    let with = |head: &str, line: &dyn Fn(usize) -> String| {
        head.to_owned() + &(0..6).map(|f| line(f) + "\n").collect::<String>()
    };
    let worded = |f: usize| {
        let point = |p| format!("{},Tracked,Good", moving(f, p, ","));
        format!("{f},{},{}", point(0), point(1))
    };
    let bare = |f: usize| format!("{f}\t{}\t{}", moving(f, 0, " "), moving(f, 1, " "));
    for (text, rate_hz, unit) in [
        (
            with(&units, &|f| {
                format!("{f},{:.2},{}", f as f64 / 50.0, row(f))
            }),
            50.0,
            Some(0.001),
        ),
        (
            with(&clocks, &|f| {
                format!("2024-02-01 10:59:59.{:03},{}", 20 * f, row(f))
            }),
            50.0,
            None,
        ),
        (with(&rate, &|f| format!("{f},{}", row(f))), 50.0, None),
        (with(&keys, &|f| format!("{f},{}", row(f))), 50.0, None),
        (with(&states, &worded), 30.0, None),
        (with("frame\tnose\thip\n", &bare), 30.0, None),
    ] {
        assert!(looks_so(text.as_bytes()), "{text}");
        let clip = &open(&text).clips[0];
        assert_eq!((clip.frames, clip.skeleton.len()), (6, 2), "{text}");
        assert!(
            (clip.rate_hz - rate_hz).abs() < 1e-6,
            "{} {text}",
            clip.rate_hz
        );
        assert_eq!(
            clip.points.as_ref().unwrap().metres_per_unit,
            unit,
            "{text}"
        );
        assert_eq!(
            clip.tracks[1].positions[2],
            Vec3::new(0.14, 1.1, 0.3),
            "{text}"
        );
    }
}

#[test]
fn names_above_every_third_column() {
    let names: Vec<String> = (0..20).map(|p| format!("joint{}", 19 - p)).collect();
    let mut text = format!("Frame,{},,\n", names.join(",,,"));
    for frame in 0..6 {
        text += &format!("{frame},{}\n", row(frame, 20, ","));
    }
    let clip = &open(&text).clips[0];
    assert_eq!(clip.skeleton.joints()[0].name, "joint19");
    assert_eq!(clip.skeleton.len(), 20);
}

#[test]
fn what_is_no_position_is_said() {
    for (head, said) in [
        ("time,Knee_angle,Hip_angle\n", "angles"),
        ("time,a_qx,a_qy,a_qz,a_qw\n", "rotations"),
        (
            "time,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z\n",
            "sensor readings",
        ),
        (
            "Format Version,1.25,Take Name,a\n\n,Type,Bone,Bone\n,Name,a,a\n,,Rotation,Rotation\nFrame,Time,X,Y\n",
            "export positions",
        ),
    ] {
        let rows: String = (0..6).map(|f| format!("{f},1,2,3,4,5,6\n")).collect();
        let text = format!("{head}{rows}");
        let error = read(text.as_bytes(), "x", None, &Limits::default()).unwrap_err();
        assert!(error.found.contains(said), "{head}: {error}");
    }
}

/// Exports of inertial units: their readings have x, y and z, but are no places.
#[test]
fn readings_of_sensors_are_no_positions() {
    let rows = |values: &str| -> String { (0..6).map(|f| format!("{f},{values}\n")).collect() };
    let inertial = "Timestamp (us),Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s),\
        Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g)\n";
    let magnetic = "Timestamp (us),X Axis (a.u.),Y Axis (a.u.),Z Axis (a.u.)\n";
    let turned = "Timestamp (us),W Element,X Element,Y Element,Z Element\n";
    let limbs = "t,foot_w,foot_x,foot_y,foot_z,hand_w,hand_x,hand_y,hand_z\n";
    for text in [
        inertial.to_owned() + &rows("1,2,3,4,5,6"),
        magnetic.to_owned() + &rows("1,2,3"),
        turned.to_owned() + &rows("0.6,0,0.8,0"),
        limbs.to_owned() + &rows("1,0,0,0,0.6,0,0.8,0"),
    ] {
        assert!(!looks_so(text.as_bytes()), "{text}");
        let error = read(text.as_bytes(), "x", None, &Limits::default()).unwrap_err();
        assert!(error.at == Place::Line(1), "{error}");
    }
    // Four numbers that are no rotation are left out.
    let sure = limbs.to_owned() + &rows("0.9,1,2,3,0.9,4,5,6");
    assert_eq!(open(&sure).clips[0].skeleton.len(), 2);
    let both =
        "t,hip_x,hip_y,hip_z,hip_rot_w,hip_rot_x,hip_rot_y,hip_rot_z,foot_w,foot_x,foot_y,foot_z\n";
    let loaded = open(&(both.to_owned() + &rows("1,2,3,1,0,0,0,0.6,0,0.8,0")));
    assert_eq!(loaded.clips[0].skeleton.len(), 1);
    assert!(
        loaded
            .warnings
            .iter()
            .any(|w| w.text.contains("`foot` has x, y, z and w")),
        "{:?}",
        loaded.warnings
    );
}

/// D-Flow writes the plates' forces beside the markers.
#[test]
fn channels_of_plates_are_no_markers() {
    let head = "TimeStamp\tFrameNumber\tLHEE.PosX\tLHEE.PosY\tLHEE.PosZ\tRHEE.PosX\tRHEE.PosY\tRHEE.PosZ\t\
        FP1.CopX\tFP1.CopY\tFP1.CopZ\tFP1.ForX\tFP1.ForY\tFP1.ForZ\tFP1.MomX\tFP1.MomY\tFP1.MomZ\n";
    let line = |f: usize| {
        format!(
            "{:.2}\t{f}\t{}\t0\t0\t0\t1\t2\t700\t3\t2\t1\n",
            0.01 * f as f64,
            row(f, 2, "\t")
        )
    };
    let text = head.to_owned() + &(0..6).map(line).collect::<String>();
    let clip = &open(&text).clips[0];
    assert_eq!(clip.skeleton.names().collect::<Vec<_>>(), ["LHEE", "RHEE"]);
    assert!((clip.rate_hz - 100.0).abs() < 1e-6);
}

/// Columns whose names say what they are do not become points because there are as many as a set of landmarks needs.
#[test]
fn names_are_not_left_out_for_numbers_alone() {
    let named = ["nose", "tail", "paw", "ear", "back", "neck", "hip", "toe"];
    let cameras = |name: &str| format!("{name}_cam1_X,{name}_cam1_Y,{name}_cam2_X,{name}_cam2_Y");
    let views: Vec<String> = (0..12)
        .map(|n| cameras(&format!("{}{n}", named[n % 8])))
        .collect();
    let other: Vec<String> = (0..48).map(|n| format!("{} {n}", named[n % 8])).collect();
    let bare: Vec<String> = (0..51).map(|n| format!("col_{n}")).collect();
    for (head, columns, said) in [
        (views.join(","), 48, Some("two dimensions")),
        (other.join(","), 48, Some("nose 0, tail 1")),
        (bare.join(","), 51, None),
    ] {
        let line = |f: usize| {
            let cells: Vec<String> = (0..columns).map(|c| format!("{}.5", c + f)).collect();
            cells.join(",") + "\n"
        };
        let text = format!("{head}\n{}", (0..6).map(line).collect::<String>());
        match (read(text.as_bytes(), "x", None, &Limits::default()), said) {
            (Err(error), Some(said)) => assert!(error.found.contains(said), "{error}"),
            (Ok(loaded), None) => assert_eq!(loaded.clips[0].skeleton.len(), 17),
            (other, _) => panic!("{head}: {other:?}"),
        }
    }
}
