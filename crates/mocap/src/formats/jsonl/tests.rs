use super::*;
use crate::kinematics::WorldPose;

fn load(text: &str) -> Loaded {
    read(text.as_bytes(), "x", None, &Limits::default()).unwrap()
}

#[test]
fn positions_are_a_clip_of_points() {
    let mut text = String::new();
    for f in 0..20 {
        let t = 100.0 + f as f64 * 0.02;
        let head = if (5..8).contains(&f) {
            "null".to_owned()
        } else {
            format!("[0, {f}, 0]")
        };
        text += &format!(
            "{{\"t\": {t}, \"positions\": {{\"hips\": [0, 0.9, 0], \"head\": {head}}}, \"note\": 1}}\n"
        );
    }
    let loaded = load(&text);
    let clip = &loaded.clips[0];
    assert_eq!(
        (clip.frames, clip.rate_hz, clip.has_rotations()),
        (20, 50.0, false)
    );
    assert_eq!(clip.repaired, [5..8]);
    assert_eq!(clip.tracks[0].positions[6].y, 6.0);
    assert_eq!(clip.skeleton.joints()[0].name, "head");
}

#[test]
fn irregular_lines_are_interpolated() {
    let mut text = String::new();
    for f in 0..60 {
        let t = f as f64 * 0.05 + if f % 2 == 0 { 0.0 } else { 0.03 };
        text += &format!("{{\"t\": {t}, \"positions\": {{\"hips\": [{t}, 0, 0]}}}}\n");
    }
    let loaded = load(&text);
    assert!(
        loaded.warnings[0].text.contains("irregular"),
        "{:?}",
        loaded.warnings
    );
    let clip = &loaded.clips[0];
    for (f, at) in clip.tracks[0].positions.iter().enumerate() {
        assert!((at.x - f as f64 / clip.rate_hz).abs() < 1e-9);
    }
}

#[test]
fn rotations_turn_a_standard_body() {
    // A quarter turn about Z lifts the left arm, which points to +X.
    let s = std::f64::consts::FRAC_1_SQRT_2;
    let line = |t: f64| {
        format!(
            "{{\"t\": {t}, \"root\": [1, 2, 3], \"rotations\": {{\"left_arm\": [0, 0, {s}, {s}]}}}}\n"
        )
    };
    let clip = load(&(line(0.0) + &line(0.1) + &line(0.2))).clips.remove(0);
    assert_eq!((clip.rate_hz, clip.has_rotations()), (10.0, true));
    let pose = WorldPose::of(&clip, 1);
    let at = |name: &str| pose.positions[clip.skeleton.find(name).unwrap()];
    assert_eq!(at("hips"), Vec3::new(1.0, 2.0, 3.0));
    let arm = at("left_forearm") - at("left_arm");
    assert!(arm.y > 0.2 && arm.x.abs() < 1e-9, "{arm}");
    let other = at("right_forearm") - at("right_arm");
    assert!(other.x < -0.2 && other.y.abs() < 1e-9, "{other}");
}

#[test]
fn performers_are_clips_and_broken_lines_are_said() {
    let text = "{\"t\":0,\"actor\":2,\"positions\":{\"a\":[0,1,0]}}\nnonsense\n\
                {\"t\":0,\"actor\":5,\"positions\":{\"a\":[0,1,0]}}\n{\"t\":1}\n";
    let loaded = load(text);
    let names: Vec<&str> = loaded.clips.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["x.1", "x.2"]);
    assert!(
        loaded.warnings[0]
            .to_string()
            .starts_with("line 2: 2 lines without a pose")
    );
    for bad in ["", "{}", "[1]", "{\"positions\":{\"a\":[1,2]}}"] {
        assert!(
            read(bad.as_bytes(), "x", None, &Limits::default()).is_err(),
            "{bad}"
        );
    }
}

#[test]
fn written_lines_are_read_again() {
    let track = |p: f64| (0..10).map(|f| Vec3::new(p, f as f64 / 3.0, 0.1)).collect();
    let points = [("a".to_owned(), track(1.0)), ("b".to_owned(), track(2.0))];
    let clip = Clip::of_points("x".into(), 60.0, points, Default::default());
    let mut bytes = Vec::new();
    write(&clip, &mut bytes).unwrap();
    assert_eq!(load(std::str::from_utf8(&bytes).unwrap()).clips[0], clip);
}

#[test]
fn cut_or_altered_lines_never_panic() {
    let text =
        "{\"t\":0,\"positions\":{\"a\":[0,1,0]}}\n{\"t\":0.1,\"rotations\":{\"hips\":[0,1,0,1]}}\n";
    for at in 0..text.len() {
        let _ = read(&text.as_bytes()[..at], "x", None, &Limits::default());
        for value in [b'0', b'9', b'"', b'}', b'e', b'-', 0xFF] {
            let mut bytes = text.as_bytes().to_vec();
            bytes[at] = value;
            let _ = read(&bytes, "x", None, &Limits::default());
        }
    }
}

/// Lines about a hand: by names without a side, by numbers, of one hand and of both.
#[test]
fn hands_are_named_by_their_lines() {
    let names = |line: &str| -> Vec<String> {
        let mut all = Vec::new();
        for clip in load(&format!("{line}\n{line}\n")).clips {
            all.extend(clip.skeleton.names().map(str::to_owned));
        }
        all
    };
    let list = |count: usize| vec!["[0,1,2]"; count].join(",");
    let named = r#"{"hand": "left", "positions": {"index_tip": [0,1,2], "WRIST": [0,0,0], "note": [1,1,1]}}"#;
    assert_eq!(names(named), ["left_hand", "left_index_tip", "note"]);
    let web = names(&format!(r#"{{"hand": "right", "points": [{}]}}"#, list(25)));
    assert_eq!(web.len(), 21, "{web:?}");
    assert!(web.iter().all(|name| name.starts_with("right_")));
    let both = format!(
        r#"{{"t": 0, "points": {{"left": [{0}], "right": [{0}]}}}}"#,
        list(21)
    );
    assert_eq!(names(&both).len(), 42);
    let told = names(&format!(r#"{{"t": 0, "points": [{}]}}"#, list(33)));
    assert_eq!((told.len(), told[0].as_str()), (33, "0"));
    // Each hand's lines are a clip.
    let hands = format!("{named}\n{}\n", named.replace("left", "right"));
    assert_eq!(load(&hands.repeat(2)).clips.len(), 2);
    let wrong = format!(r#"{{"hand": "left", "points": [{}]}}"#, list(7));
    let error = read(wrong.as_bytes(), "x", None, &Limits::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("7 points of a hand, where 20, 21, 22, 25, 26 are known"),
        "{error}"
    );
}
