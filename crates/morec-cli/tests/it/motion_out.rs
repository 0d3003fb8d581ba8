//! Motion out of a database and into it again, and reports that play.

use serde_json::Value;

use crate::db::studio;
use crate::kit::Folder;

/// A database of three synthetic people with their labels, and the name of the first clip.
fn labelled() -> (Folder, String) {
    let (folder, takes) = studio(3);
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    folder.morec(&["db", "label", "m.mdb", "labels.tsv"]).ok();
    (folder, takes[0].clip.name.clone())
}

fn json(folder: &Folder, args: &[&str]) -> Value {
    let args = [args, &["--json"]].concat();
    serde_json::from_str(&folder.morec(&args).ok()).unwrap()
}

#[test]
fn motion_is_exported_in_every_form() {
    let (folder, clip) = labelled();
    let export = |rest: &[&str]| folder.morec(&[&["db", "export", "m.mdb"][..], rest].concat());
    let head = |file: &str| std::fs::read(folder.path().join(file)).unwrap();
    export(&["a.npz", "--motion", &clip]).ok();
    assert!(head("a.npz").starts_with(b"PK"));
    export(&["a.csv", "--motion", &clip, "--table", "features"]).ok();
    assert!(head("a.csv").starts_with(b"time_secs,"));
    export(&["a.glb", "--motion", &clip]).ok();
    assert!(head("a.glb").starts_with(b"glTF"));
    let said = json(
        &folder,
        &[
            "db", "export", "m.mdb", "all", "--motion", "*", "--form", "npz",
        ],
    );
    assert_eq!(said["files"], 3);
    let files = std::fs::read_dir(folder.path().join("all")).unwrap();
    assert_eq!(files.count(), 3);
    for (args, says) in [
        (&["a.fbx", "--motion", &clip][..], ".fbx"),
        (&["all", "--motion", "none*"][..], "none*"),
        (&["a.csv", "--motion", "*"][..], "clips need a folder"),
        (
            &["a.tsv", "--motion", &clip, "--form", "tsv"][..],
            "form of labels",
        ),
        (&["a.npz", "--form", "npz"][..], "--motion"),
        (
            &["b.npz", "--motion", &clip, "--table", "features"][..],
            ".csv",
        ),
    ] {
        let ran = export(args);
        assert!(
            ran.code == Some(1) && ran.err.contains(says),
            "{args:?}: {ran:?}"
        );
    }
    assert!(!folder.path().join("b.npz").exists());
}

#[test]
fn a_file_is_replaced_and_labels_follow() {
    let (folder, clip) = labelled();
    let before = json(&folder, &["db", "samples", "m.mdb", "--clip", &clip]);
    let file = format!("clips/{clip}.bvh");
    let text = std::fs::read_to_string(folder.path().join(&file)).unwrap();
    // A quarter of the frames: what lies behind them has nowhere to stay.
    let (hierarchy, motion) = text.split_once("Frames:").unwrap();
    let lines: Vec<&str> = motion.lines().collect();
    let frames = (lines.len() - 2) / 4;
    let rows = lines[2..2 + frames].join("\n");
    let shorter = format!("{hierarchy}Frames: {frames}\n{}\n{rows}\n", lines[1]);
    std::fs::write(folder.path().join("shorter.bvh"), shorter).unwrap();
    let replace = [
        "db",
        "import",
        "m.mdb",
        "shorter.bvh",
        "--in-place-of",
        &clip,
    ];
    let said = json(&folder, &replace);
    let removed = said["removed"].as_array().unwrap().len();
    let all = before.as_array().unwrap().len();
    assert_eq!(said["kept"].as_u64().unwrap() as usize + removed, all);
    assert!(removed > 0 && said["removed"][0]["clip"] == clip.as_str());
    let clips = json(&folder, &["db", "clips", "m.mdb", "--clip", &clip]);
    assert_eq!(clips[0]["frames"], frames);
    // The same content again is no replacement.
    let again = folder.morec(&replace);
    assert!(
        again.code == Some(1) && again.err.contains("already"),
        "{again:?}"
    );
    folder.morec(&["db", "undo", "m.mdb"]).ok();
    let after = json(&folder, &["db", "samples", "m.mdb", "--clip", &clip]);
    assert_eq!(after, before);
    assert_eq!(folder.morec(&["db", "check", "m.mdb"]).code, Some(0));
}

/// Every object that is printed says its version; a clip's name is `clip` wherever there is one.
#[test]
fn json_says_its_version_and_calls_clips_alike() {
    let (folder, clip) = labelled();
    for args in [
        &["db", "clips", "m.mdb"][..],
        &["db", "samples", "m.mdb"],
        &["db", "search", "m.mdb", &clip],
        &["db", "classes", "m.mdb"],
        &["db", "info", "m.mdb"],
        &["db", "history", "m.mdb"],
        &["inspect", "clips"],
    ] {
        let value = json(&folder, args);
        let object = match &value {
            Value::Array(all) => &all[0],
            object => object,
        };
        assert_eq!(object["format_version"], 1, "{args:?}");
    }
    let limited = json(&folder, &["db", "samples", "m.mdb", "--limit", "2"]);
    assert_eq!(limited.as_array().unwrap().len(), 2);
    assert!(limited[0]["clip"].is_string() && limited[0]["clip_id"].is_number());
    assert!(json(&folder, &["db", "clips", "m.mdb"])[0]["clip"].is_string());
    let hits = json(&folder, &["db", "search", "m.mdb", &clip]);
    assert!(hits["hits"][0]["clip"].is_string() && hits["hits"][0]["clip_id"].is_number());
}

/// Strips play, every section is reached from the top, and what is not drawn is listed.
#[test]
fn reports_play_and_list_everything() {
    let (folder, clip) = labelled();
    let page = |args: &[&str], name: &str| {
        folder.morec(args).ok();
        std::fs::read_to_string(folder.path().join(name)).unwrap()
    };
    let report = page(
        &["db", "report", "m.mdb", "-o", "r.html", "--limit", "1"],
        "r.html",
    );
    let search = page(
        &["db", "search", "m.mdb", &clip, "--report", "s.html"],
        "s.html",
    );
    std::fs::write(
        folder.path().join("found.tsv"),
        "clip\tstart\tstop\tclass\n",
    )
    .unwrap();
    let evaluate = "evaluate --labels labels.tsv --found found.tsv --clips clips --report e.html";
    let measured = page(&evaluate.split(' ').collect::<Vec<_>>(), "e.html");
    for (page, name) in [
        (&report, "report"),
        (&search, "search"),
        (&measured, "measured"),
    ] {
        assert!(page.contains("const clips = [{"), "{name}");
        let sections = page.matches("<h2 id=").count();
        assert!(sections > 1, "{name}");
        assert_eq!(page.matches("<a href=\"#").count(), sections, "{name}");
        for outside in ["http:", "https:", "src=", "@import", "url("] {
            assert!(!page.contains(outside), "{name}: {outside}");
        }
    }
    assert_eq!(
        report.matches("data-motion=\"").count(),
        report.matches("<figure").count()
    );
    assert!(report.contains("more accepted samples</summary>") && report.contains("2 more clips"));
}

#[test]
fn a_wrong_parameter_names_the_nearest() {
    let (folder, _) = labelled();
    for (given, says) in [
        ("rhoo=1", "did you mean `rho`"),
        ("decode.lag_tick=1", "did you mean `decode.lag_ticks`"),
        ("lag_ticks=1", "did you mean `decode.lag_ticks`"),
    ] {
        let ran = folder.morec(&["train", "--db", "m.mdb", "-o", "i.index", "--param", given]);
        assert!(ran.code == Some(1) && ran.err.contains(says), "{ran:?}");
        assert!(ran.err.lines().count() <= 2, "{ran:?}");
    }
}

#[test]
fn kinds_of_classes_are_of_classes_that_there_are() {
    let (folder, _) = labelled();
    let train = |options: &[&str]| {
        let command = ["train", "--db", "m.mdb", "-o", "i.index"];
        folder.morec(&[&command, options].concat())
    };
    for (options, says) in [
        (&["--activities", "jump"][..], "no class is called \"jump\""),
        (&["--one-sided", "jump"], "no class is called \"jump\""),
        (
            &["--method", "templates", "--gestures", "wave"],
            "activities and gestures apply to the method auto only",
        ),
    ] {
        let ran = train(options);
        assert!(ran.code == Some(1) && ran.err.contains(says), "{ran:?}");
    }
}

#[test]
fn how_well_a_motion_was_performed_is_said_beside_it() {
    let (folder, _) = labelled();
    let train = ["train", "--db", "m.mdb", "-o", "i.index"];
    folder
        .morec(&[&train[..], &["--everyday", "never"]].concat())
        .ok();
    let table = folder
        .morec(&["recognize", "i.index", "clips", "--deviation"])
        .ok();
    let mut lines = table.lines();
    let columns: Vec<&str> = lines.next().unwrap().split('\t').collect();
    let at = |name: &str| columns.iter().position(|c| *c == name).unwrap();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split('\t').collect()).collect();
    assert!(!rows.is_empty() && rows.iter().all(|row| row.len() == columns.len()));
    let off = |row: &Vec<&str>| row[at("off_degrees")].parse::<f64>().unwrap();
    // These clips teach: each motion is near a sample, some are one.
    assert!(rows.iter().all(|row| off(row) < 30.0), "{table}");
    assert!(rows.iter().any(|row| off(row) < 1.0), "{table}");
    let lines = [
        "recognize",
        "i.index",
        "clips",
        "--deviation",
        "--form",
        "jsonl",
    ];
    let lines = folder.morec(&lines).ok();
    let first: Value = serde_json::from_str(lines.lines().next().unwrap()).unwrap();
    let worst = first["deviation"]["bones"][0]["bone"].as_str();
    assert_eq!(worst, Some(rows[0][at("worst_bone")]));
}

/// Training and measuring read every form of labels that `db label` reads.
#[test]
fn every_form_of_labels_teaches() {
    let (folder, _) = labelled();
    let train = |labels: &str| {
        folder.morec(&[
            "train",
            "--clips",
            "clips",
            "--labels",
            labels,
            "-o",
            "i.index",
            "--everyday",
            "never",
            "--json",
        ])
    };
    let samples = |labels: &str| {
        let report: Value = serde_json::from_str(&train(labels).ok()).unwrap();
        report["classes"].to_string().len()
    };
    let table = samples("labels.tsv");
    assert!(table > 10);
    for (output, form) in [("l.csv", "csv"), ("l.json", "json"), ("eaf", "eaf")] {
        folder
            .morec(&["db", "export", "m.mdb", output, "--form", form])
            .ok();
        assert!(samples(output) > 10, "{form}");
    }
    let wrong = folder.morec(&[
        "db",
        "export",
        "m.mdb",
        "l.rejected.csv",
        "--state",
        "rejected",
    ]);
    wrong.ok();
    assert_eq!(train("l.rejected.csv").code, Some(1));
}
