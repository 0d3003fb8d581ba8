//! Sets of the same motion, from clips without labels to proposed samples.

use serde_json::Value;

use crate::db::studio;
use crate::kit::Folder;

fn json(folder: &Folder, args: &[&str]) -> Value {
    let args = [args, &["--json"]].concat();
    serde_json::from_str(&folder.morec(&args).ok()).unwrap()
}

fn array(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

#[test]
fn repetitions_of_clips_and_of_a_database_are_found_and_proposed() {
    let (folder, takes) = studio(3);
    let found = json(&folder, &["discover", "clips", "--report", "sets.html"]);
    let sets = array(&found["sets"]);
    assert!(!sets.is_empty(), "{found}");
    let whole = sets.iter().find(|set| set["clips"] == takes.len());
    assert!(whole.is_some(), "a set of all people: {found}");
    assert!(sets.iter().all(|set| array(&set["instances"]).len() >= 2));
    assert_eq!(
        found,
        json(&folder, &["discover", "clips"]),
        "the same twice"
    );
    let page = std::fs::read_to_string(folder.path().join("sets.html")).unwrap();
    assert!(page.contains("Set 1: ") && page.contains("data-motion"));

    json(
        &folder,
        &["db", "import", "m.mdb", "clips", "--subject", "ada"],
    );
    let stored = json(
        &folder,
        &[
            "discover",
            "m.mdb",
            "--name-as",
            "set",
            "--report",
            "db.html",
        ],
    );
    assert_eq!(stored["sets"][0]["people"], 1);
    let proposed: usize = array(&stored["sets"])
        .iter()
        .map(|s| array(&s["instances"]).len())
        .sum();
    let samples = json(&folder, &["db", "samples", "m.mdb", "--state", "proposed"]);
    assert_eq!(array(&samples).len(), proposed);
    folder.morec(&["db", "undo", "m.mdb"]).ok();
    let samples = json(&folder, &["db", "samples", "m.mdb", "--state", "proposed"]);
    assert_eq!(array(&samples).len(), 0, "one step");

    let table = folder.morec(&["discover", "m.mdb"]);
    assert!(
        table
            .out
            .starts_with("set\trepetitions\tsecs\tclips\tpeople\tfirst\n"),
        "{}",
        table.out
    );
    assert!(table.err.contains("% of all motion; "), "{}", table.err);
    let one = json(
        &folder,
        &[
            "discover",
            "m.mdb",
            "--clip",
            &takes[0].clip.name,
            "--plain",
        ],
    );
    assert!(array(&one["sets"]).iter().all(|set| set["clips"] == 1));
}

#[test]
fn cuts_at_repetitions_are_the_bounds_of_the_sets() {
    let (folder, takes) = studio(3);
    let name = takes[1].clip.name.as_str();
    let bounds = |found: &Value| {
        let instances = array(&found["sets"])
            .iter()
            .flat_map(|set| array(&set["instances"]));
        let of_clip = instances.filter(|of| of["clip"] == name);
        let ends = of_clip.flat_map(|of| [&of["start_secs"], &of["stop_secs"]]);
        let mut ends: Vec<f64> = ends
            .filter_map(Value::as_f64)
            .filter(|secs| *secs > 0.0)
            .collect();
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        ends
    };
    let cuts = |found: &Value| -> Vec<f64> {
        let clip = array(found).iter().find(|of| of["clip"] == name).unwrap();
        let secs = |cut: &Value| cut.get("secs").unwrap_or(cut).as_f64();
        let list = clip.get("cuts").or(clip.get("cuts_secs")).unwrap();
        array(list).iter().filter_map(secs).collect()
    };
    let expected = bounds(&json(&folder, &["discover", "clips"]));
    assert!(!expected.is_empty());
    let found = cuts(&json(&folder, &["cut", "clips", "--method", "repeats"]));
    assert_eq!(found, expected);
    json(&folder, &["db", "import", "m.mdb", "clips"]);
    let expected = bounds(&json(&folder, &["discover", "m.mdb"]));
    assert_eq!(
        cuts(&json(&folder, &["cut", "m.mdb", "--method", "repeats"])),
        expected
    );
    let plot = folder.morec(&["cut", "clips", "--method", "repeats", "--plot", "cuts.svg"]);
    assert!(plot.err.contains("--method ppca"), "{}", plot.err);
}

#[test]
fn what_makes_no_sense_is_said() {
    let (folder, _) = studio(1);
    let refused = folder.morec(&["discover", "clips", "--name-as", "set"]);
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("morec db import"), "{}", refused.err);
    let name = folder.morec(&["discover", "clips", "clips"]);
    assert!(
        name.code == Some(0) || name.err.contains("two clips are called"),
        "{}",
        name.err
    );
    let page = folder.morec(&["discover", "clips", "--report", "sets.bvh"]);
    assert_eq!(page.code, Some(1));
}
