use crate::kit::{ARM_ASF, Folder, KNEE_FBX, WAVE_AMC, WAVE_BVH};

#[test]
fn a_motion_becomes_bvh_and_stays_the_same() {
    let folder = Folder::with(&[("arm.asf", ARM_ASF), ("wave.amc", WAVE_AMC)]);
    let ran = folder.morec(&["convert", "wave.amc", "-o", "out.bvh"]);
    assert!(ran.err.contains("120 Hz is assumed"), "{ran:?}");
    assert_eq!(ran.ok(), "");
    let again = folder.morec(&["convert", "out.bvh", "-o", "-"]).ok();
    let once = std::fs::read_to_string(folder.path().join("out.bvh")).unwrap();
    assert_eq!(
        once.split_whitespace().count(),
        again.split_whitespace().count()
    );
    for (a, b) in once.split_whitespace().zip(again.split_whitespace()) {
        match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(a), Ok(b)) => assert!((a - b).abs() < 1e-5, "{a} {b}"),
            _ => assert_eq!(a, b),
        }
    }
    assert!(again.contains("Frames: 3"), "{again}");
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
    assert_eq!(left.len(), 3, "no partial file stays");
}

#[test]
fn a_rate_is_resampled_to() {
    let folder = Folder::with(&[("wave.bvh", WAVE_BVH)]);
    let out = folder
        .morec(&["convert", "wave.bvh", "-o", "-", "--rate", "60"])
        .ok();
    assert!(out.contains("Frames: 2"), "{out}");
}

#[test]
fn several_characters_are_chosen_from() {
    let (hierarchy, _) = WAVE_BVH.split_once("MOTION").unwrap();
    let second = hierarchy
        .replace("HIERARCHY\n", "")
        .replace("ROOT root", "ROOT other");
    let two = format!(
        "{hierarchy}{second}MOTION\nFrames: 1\nFrame Time: 0.01\n{}\n",
        "0 ".repeat(2 * 15)
    );
    let folder = Folder::with(&[("two.bvh", &two)]);
    let ran = folder.morec(&["convert", "two.bvh", "-o", "one.bvh"]);
    assert_eq!(ran.code, Some(1));
    assert!(
        ran.err.contains("2 characters") && ran.err.contains("--character"),
        "{ran:?}"
    );
    let out = folder
        .morec(&["convert", "two.bvh", "-o", "-", "--character", "2"])
        .ok();
    assert!(
        out.contains("ROOT other") && !out.contains("ROOT root"),
        "{out}"
    );
    assert_eq!(
        folder
            .morec(&["convert", "two.bvh", "-o", "-", "--character", "3"])
            .code,
        Some(1)
    );
}

#[test]
fn failures_name_the_place_and_leave_no_file() {
    let folder = Folder::with(&[("bad.bvh", "HIERARCHY\nROOT\n"), ("wave.bvh", WAVE_BVH)]);
    let ran = folder.morec(&["convert", "bad.bvh", "-o", "out.bvh"]);
    assert_eq!(ran.code, Some(1));
    assert!(ran.err.starts_with("morec: bad.bvh: line"), "{ran:?}");
    assert!(!folder.path().join("out.bvh").exists());
    let ran = folder.morec(&["convert", "wave.bvh", "-o", "no/such/folder/out.bvh"]);
    assert_eq!(ran.code, Some(1));
    assert!(ran.err.contains("no/such/folder/out.bvh"), "{ran:?}");
    assert_eq!(folder.morec(&["convert", "wave.bvh"]).code, Some(2));
}

#[test]
fn positions_go_through_every_format_of_points() {
    let folder = Folder::with(&[("wave.bvh", WAVE_BVH)]);
    let mut from = "wave.bvh".to_owned();
    for ending in ["trc", "c3d", "jsonl", "bvh"] {
        let to = format!("points.{ending}");
        folder.morec(&["convert", &from, "-o", &to]).ok();
        let shown = folder.morec(&["inspect", &to]).ok();
        for said in ["3 frames, 0.03 s at 120 Hz", "rotations are not known"] {
            assert!(shown.contains(said), "{to}: {shown}");
        }
        from = to;
    }
    let refused = folder.morec(&["cut", "points.c3d", "--method", "ppca"]);
    assert!(refused.err.contains("positions only"), "{refused:?}");
}

#[test]
fn tables_in_folders_are_clips_if_they_hold_positions() {
    let positions =
        "time,hips_x,hips_y,hips_z,head_x,head_y,head_z\n0,0,1,0,0,1.6,0\n0.1,0,1,0,0,1.6,0\n";
    let labels = "clip\tclass\tstart\tstop\nwave\twave\t0\t3\n";
    let folder = Folder::with(&[("clips/take.csv", positions), ("clips/labels.tsv", labels)]);
    let shown = folder.morec(&["inspect", "clips"]).ok();
    assert!(
        shown.contains("take.csv") && !shown.contains("labels"),
        "{shown}"
    );
}

#[test]
fn an_ending_that_promises_another_format_is_refused() {
    let folder = Folder::with(&[("wave.bvh", WAVE_BVH)]);
    for name in ["x.fbx", "x.amc", "x.gltf", "x.txt"] {
        let ran = folder.morec(&["convert", "wave.bvh", "-o", name]);
        assert_eq!(ran.code, Some(1), "{ran:?}");
        assert!(ran.err.contains("not as ."), "{ran:?}");
        assert!(!folder.path().join(name).exists());
    }
    let ran = folder.morec(&["convert", "wave.bvh", "-o", "x.bvh", "--table", "features"]);
    assert!(ran.err.contains(".csv"), "{ran:?}");
}

/// What `convert` writes as lines of JSON is what `live` reads: by the parts of the body, whatever the file calls them and whichever
/// way is up in it.
#[test]
fn lines_of_json_are_read_live() {
    let clip = |name: &str| format!("{}/demo/{name}.mclip", env!("CARGO_MANIFEST_DIR"));
    let folder = Folder::with(&[(
        "labels.tsv",
        "clip\tclass\tstart_secs\tstop_secs\nsignals_1\tx\t1.0\t2.5\nsignals_1\tx\t4.0\t5.5\n",
    )]);
    let train = |more: &[&str]| folder.morec(&[&["train", "--everyday", "never"], more].concat());
    let signals = clip("signals_1");
    let words = [
        "--clips",
        &signals,
        "--labels",
        "labels.tsv",
        "-o",
        "i.index",
    ];
    train(&words).ok();
    let to = ["convert", &signals, "-o", "poses.jsonl"];
    folder.morec(&to).ok();
    let ran = folder.morec_fed(
        &["live", "i.index", "--listen", "json:-", "--quiet"],
        Some("poses.jsonl"),
    );
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let lines = std::fs::read_to_string(folder.path().join("poses.jsonl")).unwrap();
    let frames = format!("{} frames", lines.lines().count());
    assert!(ran.err.contains(&frames), "{}", ran.err);
    assert!(!ran.err.contains("malformed"), "{}", ran.err);
}

#[test]
fn folders_are_written_whole_in_any_form() {
    let folder = Folder::with(&[
        ("takes/wave.bvh", WAVE_BVH),
        ("takes/deep/wave.bvh", WAVE_BVH),
        ("takes/notes.txt", "nothing"),
    ]);
    for form in ["bvh", "c3d", "trc", "jsonl", "glb", "npz", "csv"] {
        let ran = folder.morec(&["convert", "takes", "-o", form, "--form", form]);
        assert_eq!(ran.code, Some(0), "{ran:?}");
        for name in ["wave", "deep/wave"] {
            let path = folder.path().join(form).join(name).with_extension(form);
            assert!(path.is_file(), "{}", path.display());
        }
        if !matches!(form, "npz") {
            let one = format!("{form}/wave.{form}");
            let ran = folder.morec(&["inspect", &one]);
            assert_eq!(ran.code, Some(0), "{ran:?}");
        }
    }
    // An arm is no humanoid, and the others would be written.
    let ran = folder.morec(&["convert", "takes", "-o", "vrma", "--form", "vrma"]);
    assert_eq!(ran.code, Some(1));
    assert!(ran.err.contains("a VRM animation needs"), "{ran:?}");
}

#[test]
fn clips_of_one_name_do_not_replace_each_other() {
    let folder = Folder::with(&[("a/wave.bvh", WAVE_BVH), ("b/wave.bvh", WAVE_BVH)]);
    let ran = folder.morec(&["convert", "a", "b", "-o", "out"]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert_eq!(
        std::fs::read_dir(folder.path().join("out"))
            .unwrap()
            .count(),
        2
    );
}

#[test]
fn the_unit_that_a_file_states_is_the_one_that_is_written() {
    // Three joints are no body: their lengths say nothing of the unit, the file says centimetres.
    let folder = Folder::with(&[("knee.fbx", KNEE_FBX)]);
    for (args, table) in [
        (vec!["convert", "knee.fbx", "-o", "knee.trc"], "knee.trc"),
        (
            vec!["convert", "knee.fbx", "-o", "all", "--form", "trc"],
            "all/knee.trc",
        ),
    ] {
        folder.morec(&args).ok();
        let text = std::fs::read_to_string(folder.path().join(table)).unwrap();
        let facts = text.lines().nth(2).unwrap();
        assert_eq!(facts.split('\t').nth(4), Some("cm"), "{text}");
    }
    folder
        .morec(&["convert", "knee.fbx", "-o", "knee.csv"])
        .ok();
    let text = std::fs::read_to_string(folder.path().join("knee.csv")).unwrap();
    assert!(text.contains(",0.6"), "{text}");
}
