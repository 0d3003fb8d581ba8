use crate::kit::{ARM_ASF, Folder, WAVE_AMC, WAVE_BVH};

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
    assert!(refused.err.contains("positions alone"), "{refused:?}");
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
