use serde_json::Value;

use crate::kit::{ARM_ASF, Folder, WAVE_AMC, WAVE_BVH, data};

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn one_clip_is_shown_joint_by_joint() {
    let folder = Folder::with(&[("wave.bvh", WAVE_BVH)]);
    let out = folder.morec(&["inspect", "wave.bvh"]).ok();
    for expected in [
        "wave.bvh\n",
        "format     BVH",
        "3 frames, 0.03 s at 120 Hz",
        "up         ",
        "lower",
        "missing: ",
    ] {
        assert!(out.contains(expected), "{expected}: {out}");
    }
}

#[test]
fn a_motion_finds_its_skeleton() {
    for skeleton in [
        "wave.asf",
        "clips/13_29.asf",
        "13.asf",
        "clips/13.asf",
        "any.asf",
        "clips/any.asf",
    ] {
        let motion = if skeleton == "wave.asf" {
            "wave.amc"
        } else {
            "clips/13_29.amc"
        };
        // A skeleton that does not fit stands in the way.
        let other = ARM_ASF.replace("upper", "wing");
        let folder = Folder::with(&[(skeleton, ARM_ASF), (motion, WAVE_AMC), ("aaa.asf", &other)]);
        let out = json(&folder.morec(&["inspect", motion, "--json"]).ok());
        assert_eq!(out[0]["skeleton"], skeleton_shown(skeleton), "{skeleton}");
        assert_eq!(out[0]["clips"][0]["joints"].as_array().unwrap().len(), 5);
    }
}

fn skeleton_shown(skeleton: &str) -> String {
    if skeleton.contains('/') {
        skeleton.to_owned()
    } else {
        format!("./{skeleton}")
    }
}

#[test]
fn a_motion_without_a_skeleton_asks_for_one() {
    let folder = Folder::with(&[("lone.amc", WAVE_AMC), ("far/away/arm.asf", ARM_ASF)]);
    let ran = folder.morec(&["inspect", "lone.amc"]);
    assert_eq!(ran.code, Some(1));
    assert!(
        ran.err.contains("lone.amc") && ran.err.contains("--skeleton"),
        "{ran:?}"
    );
    folder
        .morec(&["inspect", "lone.amc", "--skeleton", "far/away/arm.asf"])
        .ok();
}

#[test]
fn what_cannot_be_read_is_named_and_the_rest_is_shown() {
    let folder = Folder::with(&[
        ("a.bvh", "HIERARCHY\nROOT Hips\n{\n  OFFSET a b c\n"),
        ("b.bvh", WAVE_BVH),
    ]);
    let ran = folder.morec(&["inspect", ".", "nowhere.bvh"]);
    assert_eq!(ran.code, Some(1));
    assert!(ran.out.contains("b.bvh"), "{ran:?}");
    assert!(ran.err.contains("a.bvh: line 4"), "{ran:?}");
    assert!(ran.err.contains("nowhere.bvh: "), "{ran:?}");
    let ran = folder.morec(&["inspect", ".", "--json"]);
    let out = json(&ran.out);
    assert_eq!((ran.code, out.as_array().unwrap().len()), (Some(1), 2));
    assert!(
        out[0]["error"].as_str().unwrap().contains("line 4"),
        "{out}"
    );
}

#[test]
fn folders_are_searched_in_order() {
    let folder = Folder::with(&[
        ("x/2.bvh", WAVE_BVH),
        ("x/1/b.BVH", WAVE_BVH),
        ("x/notes.txt", "no clip"),
        ("x/1/a.bvh", WAVE_BVH),
        ("empty/notes.txt", "no clip"),
    ]);
    let out = json(&folder.morec(&["inspect", "x", "--json"]).ok());
    let paths: Vec<&str> = out
        .as_array()
        .unwrap()
        .iter()
        .map(|f| f["path"].as_str().unwrap())
        .collect();
    assert_eq!(paths, ["x/1/a.bvh", "x/1/b.BVH", "x/2.bvh"]);
    let ran = folder.morec(&["inspect", "empty"]);
    assert_eq!(ran.code, Some(1));
    assert!(ran.err.contains("empty: no readable clip"), "{ran:?}");
}

#[test]
fn roles_can_be_given() {
    let roles = "left_arm\tupper\nleft_forearm\tlower\nhips\t-\n";
    let folder = Folder::with(&[
        ("wave.bvh", WAVE_BVH),
        ("mine.tsv", roles),
        ("bad.tsv", "head\tnose\n"),
    ]);
    let out = json(
        &folder
            .morec(&["inspect", "wave.bvh", "--roles", "mine.tsv", "--json"])
            .ok(),
    );
    let clip = &out[0]["clips"][0];
    let role = |name: &str| {
        let joints = clip["joints"].as_array().unwrap();
        joints.iter().find(|j| j["name"] == name).unwrap()["roles"].clone()
    };
    assert_eq!(role("upper"), serde_json::json!(["left_arm"]));
    assert_eq!(role("root"), serde_json::json!([]));
    assert!(
        clip["missing_roles"]
            .as_array()
            .unwrap()
            .contains(&"hips".into())
    );
    let ran = folder.morec(&["inspect", "wave.bvh", "--roles", "bad.tsv"]);
    assert_eq!(ran.code, Some(1));
    assert!(
        ran.err
            .contains("--roles: line 1: expected a joint of the skeleton, found `nose`"),
        "{ran:?}"
    );
}

#[test]
fn what_is_inferred_can_be_overridden() {
    let folder = Folder::with(&[("wave.bvh", WAVE_BVH)]);
    let args = [
        "inspect",
        "wave.bvh",
        "--up",
        "-z",
        "--unit",
        "0.01",
        "--file-rate",
        "60",
        "--json",
    ];
    let out = json(&folder.morec(&args).ok());
    let clip = &out[0]["clips"][0];
    assert_eq!((&clip["up"], &clip["unit"]), (&"-z".into(), &"cm".into()));
    assert_eq!(clip["rate_hz"], 60.0);
    for wrong in [["--up", "w"], ["--unit", "-1"], ["--file-rate", "0"]] {
        let ran = folder.morec(&[&["inspect", "wave.bvh"][..], &wrong].concat());
        assert_eq!(ran.code, Some(2), "{wrong:?}");
    }
}

#[test]
fn standard_input_is_a_clip() {
    let folder = Folder::with(&[("wave.bvh", WAVE_BVH)]);
    let out = folder.morec_fed(&["inspect", "-"], Some("wave.bvh")).ok();
    assert!(out.contains("3 frames"), "{out}");
}

#[test]
fn real_referee_clips_have_all_roles_and_a_rest_pose() {
    let Some(data) = data() else { return };
    let clips = data.join("referee/clips");
    let folder = Folder::with(&[]);
    let out = json(
        &folder
            .morec(&["inspect", &clips.to_string_lossy(), "--json"])
            .ok(),
    );
    assert_eq!(out.as_array().unwrap().len(), 29);
    for file in out.as_array().unwrap() {
        let clip = &file["clips"][0];
        assert_eq!(
            clip["missing_roles"],
            serde_json::json!([]),
            "{}",
            file["path"]
        );
        assert_eq!(
            clip["rest_frames"],
            serde_json::json!({"start": 0, "end": 1}),
            "{}",
            file["path"]
        );
    }
}

/// A name as long as a page does not fit a column, and must not be tried to.
#[test]
fn a_name_of_any_length_is_printed() {
    let name = "x".repeat(65_536);
    let folder = Folder::with(&[(
        "long.bvh",
        &WAVE_BVH.replacen("ROOT ", &format!("ROOT {name}"), 1),
    )]);
    let out = folder.morec(&["inspect", "long.bvh"]).ok();
    assert!(out.contains(&name));
}

/// Files without an end are refused, whoever names them.
#[cfg(unix)]
#[test]
fn a_device_without_an_end_is_refused() {
    let folder = Folder::with(&[]);
    let ran = folder.morec(&["inspect", "/dev/zero"]);
    assert!(
        ran.code == Some(1) && ran.err.contains("at most 512 MB"),
        "{ran:?}"
    );
}

#[test]
fn the_body_is_drawn_in_the_terminal_and_as_a_picture() {
    let spec = morec::synth::DatabaseSpec {
        people: 1,
        repetitions: 1,
        classes: vec!["wave"],
        ..Default::default()
    };
    let person = morec::synth::database(2, &spec).remove(0).clip;
    let folder = Folder::with(&[("arm.bvh", WAVE_BVH)]);
    let file = std::fs::File::create(folder.path().join("person.bvh")).unwrap();
    morec::formats::bvh::write(&person, &mut std::io::BufWriter::new(file)).unwrap();
    let out = folder.morec(&["inspect", "person.bvh", "--draw"]).ok();
    assert!(
        out.contains("from the front") && out.contains("the body's left is on the right"),
        "{out}"
    );
    folder
        .morec(&["inspect", "person.bvh", "--draw", "-o", "person.svg"])
        .ok();
    let svg = std::fs::read_to_string(folder.path().join("person.svg")).unwrap();
    assert!(
        svg.starts_with("<svg") && svg.contains("<title>left_hand: "),
        "{svg}"
    );
    // An arm alone has no hips, neck or head to draw it from.
    let ran = folder.morec(&["inspect", "arm.bvh", "--draw", "-o", "arm.svg"]);
    assert!(
        ran.err.contains("no body was found") && ran.code == Some(1),
        "{ran:?}"
    );
    assert_eq!(
        folder.morec(&["inspect", "arm.bvh", "-o", "x.svg"]).code,
        Some(2)
    );
}

#[test]
fn what_is_no_human_body_is_told() {
    let folder = Folder::with(&[("wave.bvh", WAVE_BVH)]);
    let out = folder.morec(&["inspect", "wave.bvh"]).ok();
    assert!(
        out.contains("probably not a human body"),
        "an arm alone: {out}"
    );
}

#[test]
fn recognise_is_recognize_and_names_files_in_which_nothing_is_found() {
    let (folder, takes) = crate::db::studio(2);
    folder.train("x.index", &["--everyday", "never"]).ok();
    // A clip of nothing but standing: the first frame of a take again and again.
    let mut clip = takes[0].clip.clone();
    let joints = clip.skeleton.len();
    for frame in 1..clip.frames {
        let (first, rest) = clip.rotations.split_at_mut(joints);
        rest[(frame - 1) * joints..frame * joints].copy_from_slice(first);
    }
    for track in &mut clip.tracks {
        let first = track.positions[0];
        track.positions.fill(first);
    }
    let mut bytes = Vec::new();
    morec::formats::bvh::write(&clip, &mut bytes).unwrap();
    std::fs::write(folder.path().join("still.bvh"), bytes).unwrap();
    let ran = folder.morec(&["recognise", "x.index", "still.bvh", "clips"]);
    assert!(
        ran.err.contains("no motion was recognised in 1 of"),
        "{ran:?}"
    );
    assert!(ran.err.contains(": still.bvh"), "{ran:?}");
    ran.ok();
}

#[test]
fn a_file_of_roles_begins_with_what_is_found() {
    let names = [
        "LASI", "RASI", "LPSI", "RPSI", "LKNE", "RKNE", "LANK", "RANK", "Zed",
    ];
    let header: Vec<String> = names
        .iter()
        .flat_map(|n| ["x", "y", "z"].map(|a| format!("{n}_{a}")))
        .collect();
    let row = |frame: usize| {
        let value = |at: usize| format!("{}", 0.1 * at as f64 + 0.01 * frame as f64);
        (0..header.len()).map(value).collect::<Vec<_>>().join(",")
    };
    let rows: Vec<String> = (0..8).map(row).collect();
    let table = format!("{}\n{}\n", header.join(","), rows.join("\n"));
    let folder = Folder::with(&[("lab.csv", table.as_str())]);
    let text = folder
        .morec(&["inspect", "lab.csv", "--roles-template"])
        .ok();
    assert!(
        text.contains("left_shin\tLKNE\n") && text.contains("without a role: Zed"),
        "{text}"
    );
    std::fs::write(folder.path().join("mine.tsv"), &text).unwrap();
    folder
        .morec(&["inspect", "lab.csv", "--roles", "mine.tsv"])
        .ok();
}

/// Points of a clip whose X points the other way, as a file: a recording in left-handed coordinates.
fn mirrored(clip: &morec::clip::Clip) -> Vec<u8> {
    let mut points = clip.to_points(None);
    for track in &mut points.tracks {
        track.positions.iter_mut().for_each(|at| at.x = -at.x);
    }
    let mut bytes = Vec::new();
    morec::formats::jsonl::write(&points, &mut bytes).unwrap();
    bytes
}

#[test]
fn what_inspect_calls_an_error_is_said_wherever_the_clip_is_read() {
    let (folder, takes) = crate::db::studio(2);
    for take in &takes {
        let file = folder.path().join(format!("clips/{}.bvh", take.clip.name));
        std::fs::remove_file(&file).unwrap();
        std::fs::write(file.with_extension("jsonl"), mirrored(&take.clip)).unwrap();
    }
    let clip = format!("clips/{}.jsonl", takes[0].clip.name);
    let inspected = folder.morec(&["inspect", &clip]).ok();
    let error = "left and right are exchanged or one axis points the wrong way";
    assert!(
        inspected.contains("  error ") && inspected.contains(error),
        "{inspected}"
    );
    let teaching = [
        "--clips",
        "clips",
        "--labels",
        "labels.tsv",
        "--everyday",
        "never",
    ];
    for args in [
        &[&["train", "-o", "x.index"], &teaching[..]].concat()[..],
        &["recognize", "x.index", &clip],
        &[&["crossval", "--by", "half"], &teaching[..]].concat(),
        &["cut", &clip],
        &["play", &clip, "-o", "clip.html"],
        &["db", "import", "m.mdb", "clips"],
        &["db", "label", "m.mdb", "labels.tsv"],
        &[
            "train",
            "--db",
            "m.mdb",
            "--everyday",
            "never",
            "-o",
            "y.index",
        ],
    ] {
        let ran = folder.morec(args);
        assert_eq!(ran.code, Some(0), "{ran:?}");
        let quiet = args.contains(&"label");
        let said = ran.out + &ran.err;
        assert!(quiet || said.contains(error), "{args:?}: {said}");
    }
}

#[test]
fn a_folder_ends_in_a_summary_of_what_is_there_and_what_is_odd() {
    let (folder, takes) = crate::db::studio(2);
    let odd = folder.path().join("clips/odd.jsonl");
    std::fs::write(odd, mirrored(&takes[0].clip)).unwrap();
    std::fs::write(folder.path().join("clips/wave.bvh"), WAVE_BVH).unwrap();
    std::fs::write(folder.path().join("clips/broken.bvh"), "HIERARCHY").unwrap();
    let ran = folder.morec(&["inspect", "clips"]);
    assert_eq!(ran.code, Some(1), "{ran:?}");
    let summary: Vec<&str> = ran.out.split("\n\n").last().unwrap().lines().collect();
    // All but a text.
    let files = std::fs::read_dir(folder.path().join("clips"))
        .unwrap()
        .count()
        - 1;
    let clips = files - 1;
    let head = format!("{files} files, {clips} clips, ");
    assert!(summary[0].starts_with(&head), "{summary:#?}");
    let joints = takes[0].clip.skeleton.len();
    let most = format!("  skeleton of {joints} joints in {} clips", takes.len());
    assert_eq!(summary[1], most);
    assert!(
        summary[2..4]
            .iter()
            .any(|line| line.ends_with("in 1 clip: wave")),
        "{summary:#?}"
    );
    let odd = summary
        .iter()
        .find(|line| line.starts_with("  check odd: "));
    assert!(
        odd.unwrap().contains("left and right are exchanged"),
        "{summary:#?}"
    );
    assert_eq!(summary.last(), Some(&"  1 file could not be read"));
    // One clip needs none.
    let one = folder.morec(&["inspect", "clips/wave.bvh"]).ok();
    assert!(!one.contains("files, "), "{one}");
}
