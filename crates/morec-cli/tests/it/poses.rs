//! `morec cut`, `morec group` and `morec reduce`, on synthetic people.

use morec::formats::bvh;
use morec::synth::{Person, Script};
use serde_json::Value;

use crate::kit::{Folder, WAVE_BVH};

/// Two people who each wave, bow and wave, and labels of it.
fn folder() -> Folder {
    let mut files = vec![(
        "bad.tsv".to_owned(),
        "clip\tclass\nnobody\twave\n".to_owned(),
    )];
    let mut labels = "clip\tstart_secs\tstop_secs\tclass\n".to_owned();
    for (name, seed) in [("ann", 11), ("ben", 12)] {
        let script = Script::new(seed, Person::draw(seed, 1))
            .rest(0.5)
            .play("wave")
            .play("bow")
            .play("wave");
        let take = script.film(name, 60.0).unwrap();
        for label in &take.labels {
            labels += &format!(
                "{name}\t{}\t{}\t{}\n",
                label.span.start_secs, label.span.stop_secs, label.class
            );
        }
        let mut text = Vec::new();
        bvh::write(&take.clip, &mut text).unwrap();
        files.push((
            format!("clips/{name}.bvh"),
            String::from_utf8(text).unwrap(),
        ));
    }
    files.push(("labels.tsv".to_owned(), labels));
    let files: Vec<(&str, &str)> = files
        .iter()
        .map(|(a, b)| (a.as_str(), b.as_str()))
        .collect();
    Folder::with(&files)
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn cuts_are_printed_and_drawn() {
    let folder = folder();
    let found = json(
        &folder
            .morec(&[
                "cut", "clips", "--json", "--method", "ppca", "--pivots", "roles", "--rise", "2",
            ])
            .ok(),
    );
    let clips = found.as_array().unwrap();
    assert_eq!(clips.len(), 2);
    let cuts = |clip: &Value| clip["cuts"].as_array().unwrap().clone();
    for cut in clips.iter().flat_map(cuts) {
        let (secs, frame) = (
            cut["secs"].as_f64().unwrap(),
            cut["frame"].as_f64().unwrap(),
        );
        assert!((secs * 60.0 - frame).abs() <= 0.5, "{cut}");
    }
    assert!(
        clips
            .iter()
            .all(|clip| !clip["forward"].as_array().unwrap().is_empty())
    );
    let ann = &clips[0];
    let out = folder.morec(&[
        "cut",
        "clips/ann.bvh",
        "--method",
        "ppca",
        "--pivots",
        "roles",
        "--rise",
        "2",
        "--plot",
        "h.svg",
    ]);
    let out = out.ok();
    assert!(
        out.starts_with(&format!("ann: {} cut", cuts(ann).len())),
        "{out}"
    );
    assert_eq!(out.lines().count(), 1 + cuts(ann).len());
    assert!(
        std::fs::read_to_string(folder.path().join("h.svg"))
            .unwrap()
            .starts_with("<svg")
    );
    let few = json(
        &folder
            .morec(&[
                "cut", "clips", "--json", "--method", "ppca", "--pivots", "roles", "--rise", "1e9",
            ])
            .ok(),
    );
    assert!(
        few.as_array()
            .unwrap()
            .iter()
            .all(|clip| cuts(clip).is_empty())
    );
    let drawn = ["cut", "clips", "--plot", "h.svg", "--pivots", "roles"];
    let two = folder.morec(&[&drawn[..], &["--method", "ppca"]].concat());
    assert!(
        two.code == Some(1) && two.err.contains("--plot draws one clip"),
        "{two:?}"
    );
    let kernel = folder.morec(&drawn);
    assert!(kernel.err.contains("--method ppca"), "{kernel:?}");
}

/// Clips and a database are cut by one command, with one default; the spelling of old says so.
#[test]
fn a_database_is_cut_as_its_clips_are() {
    let folder = folder();
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    let of_files = json(
        &folder
            .morec(&["cut", "clips", "--penalty", "1", "--json"])
            .ok(),
    );
    let of_db = json(
        &folder
            .morec(&["cut", "m.mdb", "--penalty", "1", "--json"])
            .ok(),
    );
    let secs = |clip: &Value| -> Vec<f64> {
        let cuts = clip["cuts"]
            .as_array()
            .map(|cuts| cuts.iter().map(|cut| &cut["secs"]).collect());
        let cuts: Vec<&Value> =
            cuts.unwrap_or_else(|| clip["cuts_secs"].as_array().unwrap().iter().collect());
        cuts.iter().map(|secs| secs.as_f64().unwrap()).collect()
    };
    let (files, db) = (of_files.as_array().unwrap(), of_db.as_array().unwrap());
    assert_eq!((files.len(), db.len()), (2, 2));
    for (file, kept) in files.iter().zip(db) {
        assert_eq!(file["clip"], kept["clip"]);
        let (a, b) = (secs(file), secs(kept));
        // The database keeps motion within half a degree: a cut may move by a tick or two.
        assert_eq!(a.len(), b.len(), "{a:?} {b:?}");
        assert!(
            a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 0.15),
            "{a:?} {b:?}"
        );
    }
    assert!(
        files.iter().any(|clip| !secs(clip).is_empty()),
        "{of_files}"
    );
    let old = folder.morec(&["db", "cut", "m.mdb", "--penalty", "1", "--json"]);
    assert!(old.err.contains("is `morec cut` now"), "{old:?}");
    assert_eq!(json(&old.ok()), of_db);
    let mixed = folder.morec(&["cut", "m.mdb", "clips"]);
    assert!(
        mixed
            .err
            .contains("clips and a database cannot be combined"),
        "{mixed:?}"
    );
}

#[test]
fn samples_are_grouped_and_held_against_their_classes() {
    let folder = folder();
    let text = |more: &[&str]| {
        let common = [
            "group",
            "--clips",
            "clips",
            "--method",
            "kwas",
            "--pivots",
            "roles",
            "--labels",
            "labels.tsv",
        ];
        folder.morec(&[&common, more].concat()).ok()
    };
    let group = |more: &[&str]| json(&text(&[more, &["--json"]].concat()));
    let samples = |found: &Value| {
        found["clusters"]
            .as_array()
            .unwrap()
            .iter()
            .map(|c| c.as_array().unwrap().len())
            .sum()
    };
    let all = group(&["--tau", "0"]);
    assert_eq!(all["clusters"].as_array().unwrap().len(), 1);
    assert_eq!(
        (samples(&all), all["agreement"]["classes"].as_u64()),
        (6usize, Some(2))
    );
    // Of 15 pairs, 6 are of two waves and 1 of two bows.
    assert_eq!(all["agreement"]["pairs"]["true_positive"], 7);
    assert_eq!(all["agreement"]["rand_index"].as_f64(), Some(7.0 / 15.0));
    let none = group(&["--tau", "1"]);
    assert_eq!(none["clusters"].as_array().unwrap().len(), 6);
    assert_eq!(none["agreement"]["adjusted_rand_index"].as_f64(), Some(0.0));
    // Uncentred, the mean pose makes everything alike.
    let uncentred = group(&["--centre", "none"]);
    assert_eq!(
        (uncentred["dims"].as_u64(), uncentred["quality"].as_f64()),
        (Some(48), Some(1.0))
    );
    let count = |found: &Value| found["clusters"].as_array().unwrap().len();
    assert!(count(&uncentred) < count(&group(&[])));
    assert_eq!(
        samples(&group(&["--classes", "bow", "--normalised"])),
        2usize
    );
    let text = text(&["--tau", "0"]);
    assert!(
        text.contains("6 samples in 1 cluster;") && text.contains("bow 2, wave 4"),
        "{text}"
    );
    assert!(text.contains("Rand index 0.467, adjusted 0.000"), "{text}");
    let segments = folder
        .morec(&["group", "clips", "--method", "kwas", "--pivots", "roles"])
        .ok();
    assert!(
        segments.contains("ann 0.00-") && !segments.contains("Rand"),
        "{segments}"
    );
}

/// Clips and a database are grouped by one command, with one default; the spelling of old says so.
#[test]
fn a_database_is_grouped_as_its_clips_are() {
    let folder = folder();
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    folder.morec(&["db", "label", "m.mdb", "labels.tsv"]).ok();
    let files = ["group", "clips", "--labels", "labels.tsv", "--json"];
    let of_files = json(&folder.morec(&files).ok());
    let of_db = json(
        &folder
            .morec(&["group", "m.mdb", "--of", "labels", "--json"])
            .ok(),
    );
    let sizes = |found: &Value| -> Vec<usize> {
        let groups = found["groups"].as_array().unwrap();
        groups
            .iter()
            .map(|group| group.as_array().unwrap().len())
            .collect()
    };
    assert_eq!(sizes(&of_files), sizes(&of_db));
    assert_eq!(sizes(&of_files).iter().sum::<usize>(), 6);
    assert_eq!(of_files["rand_index"], of_db["rand_index"]);
    let old = folder.morec(&["db", "group", "m.mdb", "--of", "labels", "--json"]);
    assert!(old.err.contains("is `morec group` now"), "{old:?}");
    assert_eq!(json(&old.ok()), of_db);
    let segments = folder.morec(&["group", "clips"]).ok();
    assert!(
        segments.contains("ann 0.0") && !segments.contains("Rand"),
        "{segments}"
    );
}

#[test]
fn dimensions_are_counted() {
    let folder = folder();
    let args = ["reduce", "clips", "--pivots", "roles", "--plot", "q.svg"];
    let found = json(&folder.morec(&[&args[..], &["--json"]].concat()).ok());
    let (dims, quality) = (
        found["dims"].as_u64().unwrap(),
        found["quality"].as_f64().unwrap(),
    );
    assert!(
        quality >= 0.99 && found["clips"] == 2 && found["table"].as_array().unwrap().len() == 48
    );
    assert!(
        found["table"][dims as usize - 2]["quality"]
            .as_f64()
            .unwrap()
            < 0.99
    );
    assert!(
        std::fs::read_to_string(folder.path().join("q.svg"))
            .unwrap()
            .contains("dimensions")
    );
    let text = folder
        .morec(&["reduce", "clips", "--pivots", "roles", "--dims", "3"])
        .ok();
    assert!(
        text.starts_with("2 clips, ") && text.contains("\n3 dimensions keep "),
        "{text}"
    );
}

#[test]
fn what_cannot_be_done_is_said() {
    let folder = folder();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("wave.bvh", WAVE_BVH);
    write("pivots.json", r#"[{"name":"a","parent":"b"}]"#);
    write("pelvis.json", r#"[{"name":"Pelvis","joints":["pelvis"]}]"#);
    let cases: [(&[&str], &str); 6] = [
        (
            &[
                "cut",
                "wave.bvh",
                "--method",
                "ppca",
                "--pivots",
                "pivots.json",
            ],
            "the first pivot is the root and has no parent",
        ),
        (
            &[
                "cut",
                "wave.bvh",
                "--method",
                "ppca",
                "--pivots",
                "none.json",
            ],
            "--pivots: none.json",
        ),
        (
            &["cut", "clips", "--rise", "0"],
            "rise must be above 0, found 0",
        ),
        (
            &["reduce", "clips", "--quality", "2"],
            "quality must be above 0 and at most 1, found 2",
        ),
        (
            &["group", "--clips", "clips", "--labels", "bad.tsv"],
            "no sample to group",
        ),
        (
            &["reduce", "wave.bvh", "--pivots", "pelvis.json"],
            "no joint for the root pivot Pelvis",
        ),
    ];
    let tau = folder.morec(&["group", "clips", "--tau", "2"]);
    assert!(tau.code == Some(2) && tau.err.contains("--tau"), "{tau:?}");
    for (args, said) in cases {
        let ran = folder.morec(args);
        assert!(
            ran.code == Some(1) && ran.err.contains(said),
            "{args:?}: {ran:?}"
        );
    }
}

#[test]
fn reduced_clips_are_written_as_their_dimensions_have_them() {
    let folder = folder();
    folder
        .morec(&[
            "reduce", "clips", "--pivots", "roles", "--dims", "40", "-o", "all",
        ])
        .ok();
    folder
        .morec(&[
            "reduce", "clips", "--pivots", "roles", "--dims", "1", "-o", "one",
        ])
        .ok();
    let angles = |of: &str| {
        let read = |path: String| {
            let bytes = std::fs::read(folder.path().join(path)).unwrap();
            let read = bvh::read(&bytes, "ann", &Default::default(), &Default::default());
            read.unwrap().clips.remove(0)
        };
        let (before, after) = (read("clips/ann.bvh".into()), read(format!("{of}/ann.bvh")));
        assert_eq!(before.frames, after.frames);
        let pairs = before.rotations.iter().zip(&after.rotations);
        pairs.map(|(a, b)| a.angle_to(b)).fold(0.0, f64::max)
    };
    assert!(angles("all") < 0.1, "{}", angles("all"));
    assert!(angles("one") > 0.3, "{}", angles("one"));
    let over = ["reduce", "clips", "--pivots", "roles", "-o", "clips"];
    let said = folder.morec(&over).fails();
    assert!(said.contains("would be overwritten"), "{said}");
}
