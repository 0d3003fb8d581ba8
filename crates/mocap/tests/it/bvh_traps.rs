//! One small file for each way in which BVH files differ or are broken, and what is read from it.

use std::path::PathBuf;

use mocap::clip::Clip;
use mocap::formats::bvh::{self, BvhOptions, PositionChannels};
use mocap::formats::{Limits, Loaded, ParseError, Place};
use mocap::math::{Axis, Quat, Vec3, slerp};

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("testdata/bvh")
}

fn bytes(file: &str) -> Vec<u8> {
    std::fs::read(folder().join(format!("{file}.bvh"))).unwrap_or_else(|e| panic!("{file}: {e}"))
}

fn read_bytes(bytes: &[u8]) -> Result<Loaded, ParseError> {
    bvh::read(bytes, "clip", &BvhOptions::default(), &Limits::default())
}

fn try_read(file: &str) -> Result<Loaded, ParseError> {
    read_bytes(&bytes(file))
}

fn read(file: &str) -> Loaded {
    try_read(file).unwrap_or_else(|e| panic!("{file}: {e}"))
}

fn read_with(file: &str, options: BvhOptions) -> Clip {
    bvh::read(&bytes(file), "clip", &options, &Limits::default())
        .unwrap()
        .clips
        .remove(0)
}

/// The one clip of a file, all of whose warnings are listed: the line (0: the file) and a part of the text.
fn clip(file: &str, warnings: &[(u64, &str)]) -> Clip {
    let mut loaded = read(file);
    assert_eq!(loaded.clips.len(), 1, "{file}");
    let said = &loaded.warnings;
    let right = said.len() == warnings.len()
        && said
            .iter()
            .zip(warnings)
            .all(|(w, (line, text))| w.at == place(*line) && w.text.contains(text));
    assert!(right, "{file}: expected {warnings:?}, found {said:#?}");
    loaded.clips.remove(0)
}

fn place(line: u64) -> Place {
    if line == 0 {
        Place::File
    } else {
        Place::Line(line)
    }
}

fn plain() -> Clip {
    clip("plain", &[])
}

fn turn(angles: &[(Axis, f64)]) -> Quat {
    angles.iter().fold(Quat::identity(), |q, (axis, degrees)| {
        q * axis.rotation(degrees.to_radians())
    })
}

fn names(clip: &Clip) -> Vec<&str> {
    clip.skeleton.names().collect()
}

#[test]
fn the_plain_file_is_what_it_says() {
    use Axis::{X, Y, Z};
    let clip = plain();
    assert_eq!(
        (clip.frames, clip.rate_hz, clip.name.as_str()),
        (4, 30.0, "clip")
    );
    assert_eq!(names(&clip), ["Hips", "Spine", "Head"]);
    let joints = clip.skeleton.joints();
    assert_eq!(
        joints.iter().map(|j| j.parent).collect::<Vec<_>>(),
        [None, Some(0), Some(1)]
    );
    assert_eq!(
        (joints[2].offset, joints[2].tip),
        (Vec3::new(0.0, 20.0, -1.5), Some(Vec3::new(0.0, 10.0, 0.0)))
    );
    assert_eq!(clip.tracks.len(), 1);
    assert_eq!(clip.tracks[0].positions[3], Vec3::new(1.5, 90.5, 0.75));
    let expected = [
        turn(&[(Z, 3.0), (X, -6.0), (Y, 13.0)]),
        turn(&[(Z, 13.0), (X, 1.5), (Y, 0.0)]),
        turn(&[(Z, 0.5), (X, 8.0), (Y, -4.5)]),
    ];
    for (q, e) in clip.frame_rotations(3).iter().zip(expected) {
        assert!((q.coords - e.coords).norm() < 1e-14);
    }
}

#[test]
fn spellings_that_change_nothing() {
    for file in [
        "line-ends-crlf",
        "line-ends-cr",
        "line-ends-mixed",
        "no-final-newline",
        "blanks-at-line-ends",
        "blank-lines-in-motion",
        "tabs-and-many-blanks",
        "frames-with-blank-before-colon",
        "frames-without-colon",
        "frame-time-before-frames",
        "keywords-in-any-case",
        "braces-on-one-line",
        "all-on-one-line",
        "end-site-numbered",
        "end-site-named",
        "byte-order-mark",
        "nul-padding",
        "exponents",
        "point-first",
        "channels-rotation-first",
    ] {
        assert_eq!(clip(file, &[]), plain(), "{file}");
    }
}

#[test]
fn what_is_understood_with_a_warning() {
    for (file, warnings) in [
        (
            "stray-brace-before-hierarchy",
            &[(1, "before HIERARCHY")][..],
        ),
        ("junk-before-hierarchy", &[(1, "`exported`")]),
        ("hierarchy-keyword-missing", &[(1, "no HIERARCHY")]),
        (
            "comments",
            &[
                (1, "before HIERARCHY"),
                (
                    7,
                    "comment skipped (and 5 more like it, the last on line 32)",
                ),
            ],
        ),
        ("junk-after-motion", &[(29, "`END OF FILE`")]),
        (
            "decimal-commas",
            &[
                (8, "decimal comma in `10,5`"),
                (24, "decimal commas read as points"),
            ],
        ),
        (
            "glued-numbers",
            &[(24, "`0.0-7.5` (and 1 more like it, the last on line 25)")],
        ),
        ("wrapped-lines", &[(24, "one sequence")]),
        (
            "frames-declared-too-few",
            &[(23, "1 frames declared, 4 found")],
        ),
        (
            "frames-declared-too-many",
            &[(23, "101 frames declared, 4 found")],
        ),
        (
            "frames-declared-zero",
            &[(23, "0 frames declared, 4 found")],
        ),
        (
            "frames-declared-garbage",
            &[(22, "`many`"), (23, "no frame count")],
        ),
        (
            "frames-missing",
            &[(22, "no frame count declared, 4 found")],
        ),
        (
            "last-line-incomplete",
            &[(28, "incomplete last line is dropped")],
        ),
        ("channel-count-wrong", &[(5, "declares 3 but names 6")]),
        ("unknown-header-line", &[(23, "frame rate:")]),
        ("two-offsets", &[(9, "second OFFSET")]),
    ] {
        assert_eq!(clip(file, warnings), plain(), "{file}");
    }
}

#[test]
fn frame_times() {
    for (file, rate, warnings) in [
        ("frame-time-cmu", 120.0, &[][..]),
        ("frame-time-119.88", 120_000.0 / 1001.0, &[]),
        ("frame-time-zero", 30.0, &[(23, "30 Hz assumed")]),
        (
            "frame-time-missing",
            30.0,
            &[(21, "no Frame Time, 30 Hz assumed")],
        ),
        (
            "frame-time-garbage",
            30.0,
            &[(23, "`fast`"), (23, "no Frame Time")],
        ),
        ("frame-time-one", 1.0, &[(23, "unlikely")]),
        ("frame-time-three-tenths", 1.0 / 0.3, &[(23, "unlikely")]),
    ] {
        assert_eq!(
            clip(file, warnings),
            Clip {
                rate_hz: rate,
                ..plain()
            },
            "{file}"
        );
    }
    let options = BvhOptions {
        rate_hz: Some(59.94),
        ..Default::default()
    };
    assert_eq!(read_with("frame-time-zero", options).rate_hz, 59.94);
    let options = BvhOptions {
        rate_hz: Some(0.0),
        ..Default::default()
    };
    assert!(bvh::read(&bytes("plain"), "clip", &options, &Limits::default()).is_err());
}

#[test]
fn joint_names() {
    let named = |file, warnings| -> Vec<String> {
        names(&clip(file, warnings))
            .into_iter()
            .map(Into::into)
            .collect()
    };
    assert_eq!(
        named("names-namespaced", &[]),
        ["mixamorig:Hips", "mixamorig7:Spine", "Head"]
    );
    assert_eq!(
        named("names-with-blanks", &[]),
        ["Hips", "Bip01 L Thigh", "Body Controller.001"]
    );
    assert_eq!(
        named("names-odd", &[]),
        ["TORSO#", "finger2-1.l", "左足 // head"]
    );
    assert_eq!(
        named("names-latin-1", &[(1, "Latin-1")]),
        ["Hips", "Hüfte", "Head"]
    );
    assert_eq!(
        named("names-shift-jis", &[(1, "Shift-JIS")]),
        ["Hips", "ボーン", "左足ボ"]
    );
    assert_eq!(
        named(
            "names-twice",
            &[(6, "called Hips too, this one is now Hips.001 (and 1")]
        ),
        ["Hips", "Hips.001", "Hips.002"]
    );
    assert_eq!(
        named("names-missing", &[(6, "joint1")]),
        ["Hips", "joint1", "Head"]
    );
}

#[test]
fn any_channels_in_any_order() {
    use Axis::{X, Y, Z};
    let clip = clip("channels-mixed-orders", &[]);
    let expected = [
        turn(&[(X, 10.0), (Y, 20.0), (Z, 30.0)]),
        turn(&[(Z, 40.0), (Y, 50.0), (Z, 60.0)]),
        turn(&[(Y, 70.0)]),
        Quat::identity(),
        turn(&[(Y, 80.0), (X, 90.0)]),
    ];
    for (q, e) in clip.rotations.iter().zip(expected) {
        assert!(q.angle_to(&e) < 1e-7);
    }
    assert_eq!(clip.tracks[0].positions, [Vec3::new(3.0, 1.0, 2.0)]);
    assert_eq!(clip.rate_hz, 25.0);
}

#[test]
fn a_root_without_channels_is_a_fixed_joint() {
    let clip = clip("root-without-channels", &[]);
    assert_eq!(names(&clip), ["__0", "Hips", "Spine", "Head"]);
    assert_eq!(clip.rotations[0], Quat::identity());
    assert_eq!(clip.tracks[0].joint, 1);
    assert_eq!(clip.tracks[0].positions, plain().tracks[0].positions);
    assert!(
        clip.rotations
            .chunks(4)
            .zip(plain().rotations.chunks(3))
            .all(|(a, b)| a[1..] == *b)
    );
}

#[test]
fn each_root_is_a_clip() {
    let loaded = read("two-roots");
    let [first, second] = loaded.clips.as_slice() else {
        panic!("{} clips", loaded.clips.len())
    };
    assert_eq!(
        first,
        &Clip {
            name: "clip.1".into(),
            ..plain()
        }
    );
    assert_eq!(names(second), ["Hips2", "Spine", "Head"]);
    assert_eq!(
        (second.name.as_str(), &second.rotations),
        ("clip.2", &plain().rotations)
    );
    assert_eq!(
        second.tracks[0].positions[1],
        Vec3::new(100.5, 190.5, 100.25)
    );
    assert!(
        loaded.warnings[0]
            .text
            .contains("2 roots, a clip for each: Hips, Hips2")
    );
}

#[test]
fn incomplete_joints() {
    let leaf = clip("leaf-without-end-site", &[]);
    assert_eq!(
        (leaf.skeleton.joints()[2].tip, &leaf.rotations),
        (None, &plain().rotations)
    );
    let offset = clip("offset-missing", &[(6, "Spine has no OFFSET")]);
    assert_eq!(offset.skeleton.joints()[1].offset, Vec3::zeros());
    let nan = clip("offset-nan", &[(8, "not a number")]);
    assert_eq!(nan.skeleton.joints()[1].offset, Vec3::new(0.0, 10.5, 0.0));
}

#[test]
fn positions_below_the_root() {
    let replace = [(
        0,
        "in place of OFFSET (2 joints stay near their OFFSET, 0 near 0)",
    )];
    assert_eq!(clip("positions-replace", &replace), plain());
    let y = |clip: &Clip| -> Vec<f64> { (0..4).map(|f| clip.local_position(f, 1).y).collect() };
    let moving = clip("positions-replace-moving", &replace);
    assert_eq!(y(&moving), [10.5, 10.6, 10.7, 10.8]);
    assert_eq!(
        moving.tracks.iter().map(|t| t.joint).collect::<Vec<_>>(),
        [0, 1]
    );
    let added = clip(
        "positions-add",
        &[(
            0,
            "added to OFFSET (0 joints stay near their OFFSET, 2 near 0)",
        )],
    );
    assert_eq!(y(&added), [10.5, 10.5 + 0.1, 10.5 + 0.2, 10.5 + 0.3]);

    let options = |positions| BvhOptions {
        positions: Some(positions),
        ..Default::default()
    };
    assert_eq!(
        y(&read_with(
            "positions-add",
            options(PositionChannels::Replace)
        )),
        [0.0, 0.1, 0.2, 0.3]
    );
    assert_eq!(
        y(&read_with(
            "positions-replace",
            options(PositionChannels::Add)
        )),
        [21.0; 4]
    );
}

#[test]
fn the_root_stands_where_its_channels_say() {
    let clip_beside = clip("root-offset-beside-positions", &[]);
    assert_eq!(clip_beside.tracks, plain().tracks);
    let clip_zero = clip("root-offset-with-zero-positions", &[]);
    assert_eq!(
        clip_zero.tracks[0].positions,
        [Vec3::new(0.0, 94.0, 0.0); 4]
    );
}

#[test]
fn unusable_samples_are_interpolated_for_their_joint() {
    let plain = plain();
    let between = slerp(&plain.rotations[1], &plain.rotations[7], 0.5);
    for file in [
        "sample-nan",
        "sample-nan-ind",
        "sample-nan-msvc",
        "sample-infinity",
        "sample-overflow",
    ] {
        let clip = clip(
            file,
            &[(25, "value 7"), (0, "1 frames filled by interpolation")],
        );
        assert_eq!(
            (clip.repaired.as_slice(), clip.rotations[4]),
            (&[1..2][..], between),
            "{file}"
        );
        let others = (0..12).filter(|&k| k != 4);
        assert!(
            others
                .into_iter()
                .all(|k| clip.rotations[k] == plain.rotations[k]),
            "{file}"
        );
        assert_eq!(clip.tracks, plain.tracks);
    }
    let position = clip("sample-nan-position", &[(25, "value 2"), (0, "1 frames")]);
    assert_eq!(position.tracks[0].positions[1], Vec3::new(0.5, 90.5, 0.25));
    assert_eq!(position.rotations, plain.rotations);
    let first = clip("sample-nan-first", &[(24, "value 7"), (0, "1 frames")]);
    assert_eq!(first.rotations[1], plain.rotations[4]);
    let always = clip(
        "sample-nan-always",
        &[(24, "value 1 is not a usable number"), (0, "4 frames")],
    );
    assert_eq!(
        (always.repaired.as_slice(), always.rotations[7]),
        (&[0..4][..], Quat::identity())
    );
}

#[test]
fn a_few_broken_lines_are_interpolated_and_many_refused() {
    let ragged = clip(
        "ragged-two-lines-in-250",
        &[
            (124, "the frame is interpolated (and 1 more"),
            (0, "2 frames filled"),
        ],
    );
    assert_eq!(
        (ragged.frames, ragged.repaired.as_slice()),
        (250, &[100..102][..])
    );
    for (f, position) in ragged.tracks[0].positions.iter().enumerate() {
        assert!(
            (position.x - f as f64).abs() < 1e-9,
            "frame {f}: {position}"
        );
        assert!(ragged.rotations[3 * f + 1].angle_to(&turn(&[(Axis::Z, f as f64 * 0.1)])) < 1e-6);
    }
    let spoilt = clip(
        "spoilt-number",
        &[(124, "not a frame of 12 values"), (0, "1 frames filled")],
    );
    assert_eq!(
        (spoilt.frames, spoilt.repaired.as_slice()),
        (250, &[100..101][..])
    );

    let refused = try_read("ragged-too-many").unwrap_err();
    assert_eq!(
        refused.to_string(),
        "line 24: expected 12 values on each line, found 11 values; 50 of 250 lines are bad"
    );
    let options = BvhOptions {
        bad_line_share: 0.25,
        ..Default::default()
    };
    assert_eq!(read_with("ragged-too-many", options).repaired.len(), 50);
}

#[test]
fn without_frames_the_skeleton_is_read() {
    for (file, rate, warnings) in [
        ("zero-frames", 100.0, &[][..]),
        ("no-motion", 30.0, &[(21, "no MOTION")]),
        (
            "no-motion-table",
            30.0,
            &[(21, "no Frame Time"), (21, "no frame count")],
        ),
        ("no-channels", 30.0, &[(23, "no joint has a channel")]),
    ] {
        let clip = clip(file, warnings);
        assert_eq!(
            (clip.frames, clip.rotations.len(), clip.rate_hz),
            (0, 0, rate),
            "{file}"
        );
        assert_eq!(clip.skeleton.len(), 3);
    }
}

#[test]
fn what_cannot_be_read_is_refused_with_a_place() {
    for (file, message) in [
        (
            "refused-empty",
            "file: expected HIERARCHY and the skeleton of a BVH file, found none; the file begins with the end of the file",
        ),
        (
            "refused-no-hierarchy",
            "file: expected HIERARCHY and the skeleton of a BVH file, found no HIERARCHY; 4×12 numbers found",
        ),
        (
            "refused-not-bvh",
            "file: expected HIERARCHY and the skeleton of a BVH file, found none; the file begins with `:version`",
        ),
        (
            "refused-truncated-hierarchy",
            "line 16: expected `}` closing the End Site of Head (opened on line 14), found the end of the file",
        ),
        (
            "refused-truncated-offset",
            "line 12: expected a number after OFFSET, found the end of the file",
        ),
        (
            "refused-motion-inside-joint",
            "line 20: expected OFFSET, CHANNELS, JOINT, End Site or `}`, found `MOTION`",
        ),
        ("refused-no-root", "line 2: expected ROOT, found `MOTION`"),
        (
            "refused-unknown-channel",
            "line 5: expected a channel such as Xrotation, found `Wposition`",
        ),
        (
            "refused-bad-offset",
            "line 8: expected a number after OFFSET, found `ten`",
        ),
        (
            "refused-utf-16",
            "file: expected UTF-8 text, found UTF-16 text",
        ),
    ] {
        assert_eq!(try_read(file).unwrap_err().to_string(), message, "{file}");
    }
}

#[test]
fn limits_hold() {
    let refused = |limits: Limits| {
        let error =
            bvh::read(&bytes("plain"), "clip", &BvhOptions::default(), &limits).unwrap_err();
        error.to_string()
    };
    let limits = Limits::default();
    assert_eq!(
        refused(Limits {
            joints: 2,
            ..limits
        }),
        "line 10: expected at most 2 joints, found more"
    );
    assert_eq!(
        refused(Limits { depth: 2, ..limits }),
        "line 10: expected at most 2 joints from root to leaf, found more"
    );
    assert_eq!(
        refused(Limits {
            frames: 3,
            ..limits
        }),
        "line 27: expected at most 3 frames, found more"
    );
    assert_eq!(
        refused(Limits {
            line_bytes: 60,
            ..limits
        }),
        "line 5: expected at most 60 bytes in a line, found 71"
    );
}

/// A few bytes a frame must not buy thousands of joints' worth of memory.
#[test]
fn a_small_file_does_not_fill_the_memory() {
    let mut text = String::from("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n");
    for k in 0..4000 {
        text.push_str(&format!("JOINT j{k}\n{{\nOFFSET 0 0 0\n}}\n"));
    }
    text.push_str("}\nMOTION\nFrames: 100000\nFrame Time: 0.01\n");
    text.push_str(&"0\n".repeat(100_000));
    assert!(
        read_bytes(text.as_bytes())
            .unwrap_err()
            .expected
            .contains("frames")
    );
}

#[test]
fn hundreds_of_joints_are_ordinary() {
    let mut text = String::from("HIERARCHY\n");
    for k in 0..250 {
        let keyword = if k == 0 { "ROOT" } else { "JOINT" };
        text.push_str(&format!(
            "{keyword} j{k} {{ OFFSET 0 1 0 CHANNELS 3 Zrotation Xrotation Yrotation\n"
        ));
    }
    text.push_str(&"}".repeat(250));
    text.push_str(&format!(
        "\nMOTION\nFrames: 2\nFrame Time: 0.01\n{0}\n{0}\n",
        "1 2 3 ".repeat(250)
    ));
    let loaded = read_bytes(text.as_bytes()).unwrap();
    assert_eq!(
        (loaded.clips[0].skeleton.len(), loaded.clips[0].frames),
        (250, 2)
    );
    assert_eq!(loaded.warnings, []);
}

fn all_files() -> Vec<(String, Vec<u8>)> {
    let entries = std::fs::read_dir(folder())
        .unwrap()
        .map(|e| e.unwrap().path());
    entries
        .map(|p| {
            (
                p.file_name().unwrap().to_string_lossy().into_owned(),
                std::fs::read(&p).unwrap(),
            )
        })
        .collect()
}

/// Checks that clips are whole: finite values, tables of one length, quaternions of continuous sign.
fn check(context: &str, loaded: &Loaded) {
    for clip in &loaded.clips {
        let joints = clip.skeleton.len();
        assert_eq!(clip.rotations.len(), clip.frames * joints, "{context}");
        assert!(clip.rate_hz.is_finite() && clip.rate_hz > 0.0, "{context}");
        assert!(
            clip.rotations
                .iter()
                .all(|q| (q.coords.norm() - 1.0).abs() < 1e-9),
            "{context}"
        );
        let mut pairs = clip
            .rotations
            .iter()
            .zip(clip.rotations.iter().skip(joints));
        assert!(
            pairs.all(|(a, b)| a.coords.dot(&b.coords) >= -1e-12),
            "{context}"
        );
        for track in &clip.tracks {
            assert!(
                track.positions.len() == clip.frames && track.joint < joints,
                "{context}"
            );
            assert!(
                track.positions.iter().flatten().all(|v| v.is_finite()),
                "{context}"
            );
        }
        assert!(
            clip.skeleton
                .joints()
                .iter()
                .all(|j| j.offset.iter().all(|v| v.is_finite())),
            "{context}"
        );
        assert!(
            clip.repaired
                .iter()
                .all(|s| s.start < s.end && s.end <= clip.frames),
            "{context}"
        );
    }
}

#[test]
fn truncated_files_never_panic() {
    for (file, bytes) in all_files() {
        let step = if bytes.len() > 2000 { 13 } else { 1 };
        for end in (0..=bytes.len()).step_by(step) {
            if let Ok(loaded) = read_bytes(&bytes[..end]) {
                check(&format!("{file} cut at {end}"), &loaded);
            }
        }
    }
}

#[test]
fn altered_files_never_panic() {
    // A small fixed generator (Knuth's MMIX constants): the same mutations on every run.
    let mut state = 1u64;
    let mut random = move |below: usize| {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as usize % below
    };
    let pieces: [&[u8]; 12] = [
        b"{",
        b"}",
        b"\n",
        b" ",
        b"-",
        b"nan",
        b"1e308 ",
        b"ROOT a\n{",
        b"\r",
        b"#",
        b"CHANNELS 9",
        b"\xff\x83",
    ];
    for (file, original) in all_files() {
        let rounds = if original.len() > 2000 { 30 } else { 300 };
        for round in 0..rounds {
            let mut bytes = original.clone();
            for _ in 0..=random(3) {
                let at = random(bytes.len() + 1);
                match random(3) {
                    0 if at < bytes.len() => bytes[at] ^= 1 << random(8),
                    1 => drop(bytes.drain(at..(at + random(20)).min(bytes.len()))),
                    _ => drop(bytes.splice(at..at, pieces[random(pieces.len())].iter().copied())),
                }
            }
            if let Ok(loaded) = read_bytes(&bytes) {
                check(&format!("{file}, round {round}"), &loaded);
            }
        }
    }
}
