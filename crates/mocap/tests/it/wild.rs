//! Files as laboratories, cameras and scripts write them: what they mean.

use std::path::Path;

use mocap::Take;
use mocap::files::{FileReader, Takes};
use mocap::roles::Role;

fn open(name: &str) -> Result<Takes, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("testdata/wild")
        .join(name);
    let opened = FileReader::default().open_all(&[path]);
    opened.map_err(|error| error.to_string())
}

/// What is wrong with a file that is read; `None` if it is as it should be.
fn fault(name: &str, frames: usize, rate_hz: f64, roles: usize, said: &str) -> Option<String> {
    let takes = match open(name) {
        Ok(takes) => takes,
        Err(error) => return Some(format!("{name}: {error}")),
    };
    let take: &Take = takes.takes.first()?;
    let clip = &take.clip;
    let known = Role::ALL
        .iter()
        .filter(|role| take.roles.joint(**role).is_some());
    let known = known.count();
    let warnings: Vec<String> = take.warnings.iter().map(|w| format!("{w:?}")).collect();
    let warnings = format!("{warnings:?} {:?} {:?}", take.report, clip.repaired);
    let is_right = clip.frames == frames
        && (clip.rate_hz - rate_hz).abs() < 1e-6
        && known >= roles
        && warnings.contains(said);
    (!is_right).then(|| {
        let (frames, rate_hz) = (clip.frames, clip.rate_hz);
        format!(
            "{name}: {frames} frames at {rate_hz} Hz, {known} roles, {} takes: {warnings}",
            takes.takes.len()
        )
    })
}

#[test]
fn times_names_and_units_are_read_as_meant() {
    let files = [
        ("times-one-swapped.csv", 14, 60.0, 16, "out of order"),
        ("times-third-twice.csv", 14, 60.0, 16, "repeated"),
        ("frames-one-twice.csv", 41, 30.0, 16, "repeated"),
        ("landmarks-frames-left-out.json", 14, 30.0, 15, "missing"),
        ("mvnx-frames-left-out.mvnx", 14, 60.0, 18, "5..9"),
        ("rows-blank-between.csv", 14, 30.0, 16, "gap"),
        ("rows-nan-between.csv", 14, 30.0, 16, "gap"),
        ("workstation-rate.csv", 14, 100.0, 15, ""),
        ("time-column-ts.csv", 14, 60.0, 16, ""),
        ("time-column-zeit.csv", 14, 60.0, 16, ""),
        ("names-glued.tsv", 14, 30.0, 16, ""),
        ("names-unit-suffix.csv", 14, 30.0, 16, ""),
        ("names-latin1.csv", 14, 30.0, 16, ""),
        ("names-sjis.csv", 14, 30.0, 16, ""),
        ("names-german-utf8.csv", 14, 30.0, 16, ""),
        ("names-japanese-utf8.csv", 14, 30.0, 16, ""),
        ("missing-as-9999-minus.csv", 14, 30.0, 16, "gaps"),
        ("missing-as-9999.csv", 14, 30.0, 16, "gaps"),
        ("bvh-one-row-short.bvh", 14, 30.0, 16, "interpolated"),
        ("hand22-shrec17.txt", 14, 30.0, 20, ""),
        ("hand21-frame-first.txt", 14, 30.0, 20, "right hand"),
        ("rotations-only.c3d", 4, 85.0, 14, "segments"),
        ("two-bodies-a-line.csv", 8, 30.0, 16, ""),
        ("two-bodies-a-line.txt", 14, 30.0, 16, ""),
        (
            "landmarks-in-the-picture.csv",
            14,
            30.0,
            15,
            "image coordinates",
        ),
        ("landmarks-bare-list-objects.json", 6, 30.0, 15, ""),
        ("landmarks-first-frame-empty.json", 14, 30.0, 15, ""),
        ("json-nan.jsonl", 14, 30.0, 15, ""),
        ("leap-frames.json", 6, 30.0, 20, ""),
        ("names-bts.trc", 14, 30.0, 10, ""),
        ("names-rajagopal.trc", 14, 30.0, 14, ""),
        ("names-vsac.trc", 14, 30.0, 14, ""),
        #[cfg(feature = "fbx")]
        ("fbx-keys-reduced.fbx", 15, 30.0, 16, ""),
        #[cfg(feature = "fbx")]
        ("fbx-keys-uneven.fbx", 15, 30.0, 16, ""),
    ];
    let faults =
        files.map(|(name, frames, rate, roles, said)| fault(name, frames, rate, roles, said));
    let faults: Vec<String> = faults.into_iter().flatten().collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn what_is_no_motion_is_refused_by_what_it_is() {
    for (name, said) in [
        ("small_pErr.sto", "PositionErrors"),
        ("small_u.sto", "Speeds"),
        ("BodyKinematics_pos_global.sto", "centres of mass"),
        ("angles-columns.csv", "angles"),
        ("joint-angles-table.csv", "angles"),
        ("two-dimensions.txt", "two dimensions"),
    ] {
        match open(name) {
            Err(error) => assert!(error.contains(said), "{name}: {error}"),
            Ok(takes) => panic!("{name}: {} takes", takes.takes.len()),
        }
    }
}

#[test]
fn hands_of_gesture_sets_are_right_ones() {
    for name in [
        "hand21-frame-first.txt",
        "hand22-shrec17.txt",
        "leap-frames.json",
    ] {
        let takes = open(name).unwrap();
        let roles = &takes.takes[0].roles;
        assert!(roles.joint(Role::RightIndexTip).is_some(), "{name}");
        assert!(roles.joint(Role::LeftIndexTip).is_none(), "{name}");
    }
}
