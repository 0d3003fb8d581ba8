use super::*;
use crate::clip::Clip;
use crate::pose::Hand;
use crate::roles::Role;
use crate::testing::flat_hand;

fn load(text: &str) -> (Clip, String) {
    let mut loaded = read(text.as_bytes(), "x", None, &Limits::default()).unwrap();
    let said: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    (loaded.clips.remove(0), said.join("\n"))
}

fn fail(text: &str) -> String {
    read(text.as_bytes(), "x", None, &Limits::default())
        .unwrap_err()
        .to_string()
}

fn names(clip: &Clip) -> Vec<&str> {
    clip.skeleton.names().collect()
}

/// Two points, three frames at 20 Hz: hips at (1 + f, 2, 3), head at (4, 5, 6).
fn check(text: &str, expected: [&str; 2]) {
    let (clip, said) = load(text);
    assert_eq!(names(&clip), expected, "{text}");
    assert_eq!((clip.frames, clip.rate_hz), (3, 20.0), "{said}\n{text}");
    assert_eq!(
        clip.tracks[0].positions[2],
        Vec3::new(3.0, 2.0, 3.0),
        "{text}"
    );
    assert_eq!(
        clip.tracks[1].positions[1],
        Vec3::new(4.0, 5.0, 6.0),
        "{text}"
    );
}

const ROWS: &str = "0.00,1,2,3,4,5,6\n0.05,2,2,3,4,5,6\n0.10,3,2,3,4,5,6\n";

#[test]
fn one_joint_in_three_columns() {
    for header in [
        "time,hips_x,hips_y,hips_z,head_x,head_y,head_z",
        "Time (s),hips.X,hips.Y,hips.Z,head.X,head.Y,head.Z",
        "t,hips Tx,hips Ty,hips Tz,head Tx,head Ty,head Tz",
        "timestamp,hipsX,hipsY,hipsZ,headX,headY,headZ",
        "time,x_hips,y_hips,z_hips,x_head,y_head,z_head",
        "time,hips_pos_x,hips_pos_y,hips_pos_z,head_position_x,head_position_y,head_position_z",
        "time_secs,hips-x (m),hips-y (m),hips-z (m),head-x (m),head-y (m),head-z (m)",
        "time,\"hips x\",\"hips y\",\"hips z\",\"head x\",\"head y\",\"head z\"",
    ] {
        let text = format!("{header}\n{ROWS}");
        assert!(looks_so(text.as_bytes()), "{header}");
        check(&text, ["hips", "head"]);
        check(&text.replace(',', "\t"), ["hips", "head"]);
        let (names, rows) = (
            header.replace(',', ";"),
            ROWS.replace(',', ";").replace('.', ","),
        );
        check(&format!("{names}\n{rows}"), ["hips", "head"]);
        check(&text.replace('\n', "\r\n"), ["hips", "head"]);
    }
    let (clip, _) = load(&format!("t,a_x (mm),a_y (mm),a_z (mm),b_x,b_y,b_z\n{ROWS}"));
    assert_eq!(clip.points.unwrap().metres_per_unit, Some(0.001));
}

#[test]
fn other_columns_are_no_positions() {
    let text = "frame,hips_x,hips_y,hips_z,hips_rot_x,hips_rot_y,hips_rot_z,head_x,head_y,head_z,head_score\n\
                7,1,2,3,9,9,9,4,5,6,0.5\n8,2,2,3,9,9,9,4,5,6,0.5\n10,3,2,3,9,9,9,,,,0.5\n";
    let (clip, said) = load(text);
    assert_eq!(names(&clip), ["hips", "head"]);
    // Frame 9 is left out and filled; nothing says the rate.
    assert_eq!((clip.frames, clip.rate_hz), (4, ASSUMED_HZ));
    assert_eq!(clip.tracks[0].positions[2].x, 2.5);
    assert!(said.contains("30 Hz is assumed"), "{said}");
}

#[test]
fn headers_of_several_rows() {
    let text = "scorer,net,net,net,net,net,net\nbodyparts,hips,hips,hips,head,head,head\n\
                coords,x,y,z,x,y,z\n0,1,2,3,4,5,6\n1,2,2,3,4,5,6\n2,3,2,3,nan,5,6\n";
    assert!(looks_so(text.as_bytes()));
    let loaded = read(text.as_bytes(), "x", Some(20.0), &Limits::default()).unwrap();
    assert_eq!(names(&loaded.clips[0]), ["hips", "head"]);
    assert_eq!(
        loaded.clips[0].points.as_ref().unwrap().gaps[0].frames,
        2..3
    );
    // Names above the first of three columns.
    let text =
        "Time,hips,,,head,,\n,x,y,z,x,y,z\n0.00,1,2,3,4,5,6\n0.05,2,2,3,4,5,6\n0.10,3,2,3,4,5,6\n";
    assert_eq!(names(&load(text).0), ["hips", "head"]);
}

#[test]
fn two_dimensions_are_not_enough() {
    let text = "bodyparts,hips,hips,hips\ncoords,x,y,likelihood\n0,1,2,0.9\n1,1,2,0.9\n";
    assert!(fail(text).contains("two dimensions"), "{}", fail(text));
    let text = "frame,a_x,a_y,b_x,b_y\n0,1,2,3,4\n";
    assert!(fail(text).contains("two dimensions"), "{}", fail(text));
}

#[test]
fn places_of_a_low_likelihood_are_gaps() {
    let text = "scorer,net,net,net,net,net,net,net,net\nbodyparts,hips,hips,hips,hips,head,head,head,head\n\
        coords,x,y,z,likelihood,x,y,z,likelihood\n0,1,2,3,0.9,4,5,6,0.59\n1,1,2,3,0.6,4,5,6,0.99\n2,1,2,3,1,4,5,7,1\n";
    let (clip, warnings) = load(text);
    assert_eq!(names(&clip), ["hips", "head"]);
    let said = "1 of 6 places of points have a likelihood below 0.6";
    assert!(warnings.contains(said), "{warnings}");
}

#[test]
fn the_long_form() {
    let mut text = "time,joint,x,y,z\n".to_owned();
    for f in 0..3 {
        let t = 0.05 * f as f64;
        text += &format!("{t:.2},hips,{},2,3\n{t:.2},head,4,5,6\n", 1 + f);
    }
    assert!(looks_so(text.as_bytes()));
    check(&text, ["hips", "head"]);
    let text = "keypoint;frame;x;y;z\nnose;1;0,5;1;2\near;1;1;1;1\nnose;2;1,5;1;2\n";
    let (clip, _) = load(text);
    assert_eq!(clip.tracks[0].positions[1], Vec3::new(1.5, 1.0, 2.0));
    assert_eq!(clip.points.unwrap().gaps.len(), 1);
}

#[test]
fn motive_exports() {
    let text = "Format Version,1.23,Take Name,Take 1,Export Frame Rate,20.000000,Length Units,Meters\n\n\
        ,Type,Bone,Bone,Bone,Bone,Bone,Bone,Bone,Bone,Bone,Bone,Marker,Marker,Marker\n\
        ,Name,Bob:Hip,Bob:Hip,Bob:Hip,Bob:Hip,Bob:Hip,Bob:Hip,Bob:Hip,Bob:Head,Bob:Head,Bob:Head,Bob:M1,Bob:M1,Bob:M1\n\
        ,ID,1,1,1,1,1,1,1,2,2,2,3,3,3\n\
        ,,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Position,Position,Position,Position,Position,Position\n\
        Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,X,Y,Z,X,Y,Z\n\
        0,0.000000,0,0,0,1,1,2,3,4,5,6,9,9,9\n1,0.050000,0,0,0,1,2,2,3,4,5,6,9,9,9\n2,0.100000,0,0,0,1,3,2,3,4,5,6,,,\n";
    assert!(looks_so(text.as_bytes()));
    check(text, ["Bob:Hip", "Bob:Head"]);
    let (clip, said) = load(text);
    assert_eq!(clip.points.unwrap().metres_per_unit, Some(1.0));
    assert!(said.contains("1 markers beside the bones"), "{said}");
}

#[test]
fn numbers_alone_are_known_by_their_count() {
    let row = |f: usize| {
        let cells: Vec<String> = (0..51).map(|c| format!("{}.5", c + f)).collect();
        format!("{f},{}\n", cells.join(","))
    };
    let text: String = (0..5).map(row).collect();
    let (clip, said) = load(&text);
    assert_eq!((clip.skeleton.len(), clip.frames), (17, 5));
    assert!(said.contains("x, y and z of 17 points"), "{said}");
}

#[test]
fn tables_of_something_else() {
    for text in [
        "clip\tclass\tstart\tstop\na\twave\t1\t2\n",
        "a,b,c\n1,2,3\n",
        "hello\n",
        "1,2,3\n4,5,6\n",
    ] {
        assert!(!looks_so(text.as_bytes()), "{text}");
        assert!(
            fail(text).contains("columns of x, y and z"),
            "{}",
            fail(text)
        );
    }
    assert!(fail("").contains("an empty file"));
    assert!(fail("time,a_x,a_y,a_z,b_x,b_y,b_z\n").contains("frames below"));
}

#[test]
fn times_of_every_unit() {
    for (header, scale) in [
        ("time_ms", 1e3),
        ("timestamp", 1e9),
        ("timestamp", 1e7),
        ("timestamp", 1e6),
        ("time", 1e3),
    ] {
        let mut text = format!("{header},a_x,a_y,a_z,b_x,b_y,b_z\n");
        for f in 0..9 {
            text += &format!(
                "{},1,2,3,4,5,6\n",
                1_700_000.0 * scale + f as f64 * 0.05 * scale
            );
        }
        assert_eq!(load(&text).0.rate_hz, 20.0, "{header} {scale}");
    }
}

#[test]
fn cut_or_altered_tables_never_panic() {
    let text = format!("time,hips_x,hips_y,hips_z,head_x,head_y,head_z\n{ROWS}");
    for at in 0..text.len() {
        let _ = read(&text.as_bytes()[..at], "x", None, &Limits::default());
        for value in [b',', b'\n', b';', b'x', b'"', b'9', 0xFF] {
            let mut bytes = text.as_bytes().to_vec();
            bytes[at] = value;
            let _ = looks_so(&bytes);
            let _ = read(&bytes, "x", None, &Limits::default());
        }
    }
}

#[test]
fn exports_of_motive_without_words_before_their_rows() {
    let text = "Format Version,1.22,Take Name,t,Capture Frame Rate,120.000000,Length Units,Meters\n\n\
        ,,Rigid Body Marker,Rigid Body Marker,Rigid Body Marker,Marker,Marker,Marker,Marker,Marker,Marker\n\
        ,,S:M1,S:M1,S:M1,S:M1,S:M1,S:M1,S:M2,S:M2,S:M2\n\
        ,,Position,Position,Position,Position,Position,Position,Position,Position,Position\n\
        Frame,Time (Seconds),X,Y,Z,X,Y,Z,X,Y,Z\n\
        0,0.0,9,9,9,1,2,3,4,5,6\n1,0.008333,9,9,9,1,2,4,4,5,7\n";
    let loaded = read(text.as_bytes(), "t", None, &Limits::default()).unwrap();
    let clip = &loaded.clips[0];
    let names: Vec<&str> = clip.skeleton.names().collect();
    assert_eq!(names, ["S:M1", "S:M2"]);
    assert_eq!(clip.tracks[0].positions[1], Vec3::new(1.0, 2.0, 4.0));
    assert_eq!(clip.rate_hz, 120.0);
}

#[test]
fn numbers_alone_may_say_how_sure_they_are() {
    // MSRC-12: a time in ticks, then x, y, z and a confidence for each of 20 joints.
    let row = |f: usize| {
        let joint = |j: usize| format!("{} {} {} 1", 0.01 * j as f64, 0.1 * f as f64 + 0.5, 2.0);
        let joints: Vec<String> = (0..20).map(joint).collect();
        format!("{} {}\n", 1000 + 33 * f, joints.join(" "))
    };
    let text: String = (0..8).map(row).collect();
    let clip = &read(text.as_bytes(), "t", None, &Limits::default())
        .unwrap()
        .clips[0];
    assert_eq!((clip.frames, clip.skeleton.len()), (8, 20));
}

#[test]
fn a_row_of_nothing_but_a_vertical_tab_is_blank() {
    for text in ["\x0b\n", "\x0b\u{3000}\n1 2 3\n4 5 6\n"] {
        fail(text);
    }
}

/// SHREC's rows: palm, three points of the thumb, four of each finger, each with a rotation; and rows of MediaPipe's points by hand.
#[test]
fn rows_of_a_hand() {
    let hand = Hand::Left;
    let points = hand.points();
    let [thumb, fingers @ ..] = points.fingers;
    let shrec: Vec<Role> = [points.palm, thumb[0], thumb[1], thumb[3]]
        .into_iter()
        .chain(fingers.into_iter().flatten())
        .collect();
    let row = |frame: usize| {
        let pose = flat_hand(hand, 0.1 * frame as f64, 1.0);
        let cells = shrec.iter().flat_map(|role| {
            let at = pose.get(*role).unwrap_or_default();
            [at.x, at.y, at.z, 0.0, 0.6, 0.0, 0.8].map(|v| format!("{v:.6}"))
        });
        cells.collect::<Vec<String>>()
    };
    let lines = |before: &dyn Fn(usize) -> String, end: &str| -> String {
        (0..8)
            .map(|f| format!("{}{}{end}\n", before(f), row(f).join(";")))
            .collect()
    };
    for text in [
        lines(&|_| String::new(), ""),
        lines(&|_| String::new(), ";"),
        lines(&|f| format!("{f};{:.2};", 0.05 * f as f64), ""),
    ] {
        assert!(looks_so(text.as_bytes()), "{text}");
        let (clip, said) = load(&text);
        assert_eq!((clip.frames, clip.skeleton.len()), (8, 20));
        assert!(said.contains("rotations, which are left out"), "{said}");
        let take = crate::Take::new(clip).unwrap();
        assert_eq!(take.report.point_set, Some("SHREC hand (20)"));
        assert_eq!(take.roles.joint(points.palm), Some(0));
        assert_eq!(take.roles.joint(points.fingers[4][3]), Some(19));
    }
    let mut text = "frame,handedness,landmark,x,y,z\n".to_owned();
    for frame in 0..8 {
        for (hand, side) in [(Hand::Right, "Right"), (Hand::Left, "Left")] {
            let points = hand.points();
            let roles = std::iter::once(points.wrist).chain(points.fingers.into_iter().flatten());
            let pose = flat_hand(hand, 0.1 * frame as f64, 1.0);
            for (number, role) in roles.enumerate() {
                let at = pose.get(role).unwrap_or_default();
                text += &format!("{frame},{side},{number},{},{},{}\n", at.x, at.y, at.z);
            }
        }
    }
    let (clip, said) = load(&text);
    assert_eq!((clip.frames, clip.skeleton.len()), (8, 42), "{said}");
    let take = crate::Take::new(clip).unwrap();
    assert_eq!(take.roles.joint(Role::RightIndexTip), Some(8));
    assert_eq!(take.roles.joint(Role::LeftIndexTip), Some(29));
}
