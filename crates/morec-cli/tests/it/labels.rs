//! Labels in a database: corrected, tried, misspelt, taken back.

use serde_json::Value;

use crate::db::studio;
use crate::kit::Folder;

fn json(folder: &Folder, args: &[&str]) -> Value {
    let args = [args, &["--json"]].concat();
    serde_json::from_str(&folder.morec(&args).ok()).unwrap()
}

fn labelled() -> (Folder, String) {
    let (folder, takes) = studio(2);
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    folder.morec(&["db", "label", "m.mdb", "labels.tsv"]).ok();
    (folder, takes[0].clip.name.clone())
}

#[test]
fn a_corrected_table_replaces_what_was_there() {
    let (folder, _) = labelled();
    let text = std::fs::read_to_string(folder.path().join("labels.tsv")).unwrap();
    let corrected = text.replace("bow", "nod");
    std::fs::write(folder.path().join("corrected.tsv"), corrected).unwrap();
    let label = ["db", "label", "m.mdb", "corrected.tsv", "--replace"];
    let plan = json(&folder, &[&label[..], &["--dry-run"]].concat());
    let renamed = plan["samples"]["renamed"].as_u64().unwrap();
    assert!(renamed > 0 && plan["samples"]["gone"] == 0, "{plan}");
    assert_eq!(plan["changes"].as_array().unwrap().len() as u64, renamed);
    let class = |at: usize| json(&folder, &["db", "classes", "m.mdb"])[at].clone();
    assert_eq!(class(0)["name"], "bow");
    assert_eq!(json(&folder, &label)["samples"]["renamed"], renamed);
    let classes = json(&folder, &["db", "classes", "m.mdb"]);
    let nod = classes
        .as_array()
        .unwrap()
        .iter()
        .find(|c| c["name"] == "nod")
        .unwrap();
    assert_eq!(nod["accepted"], renamed);
    let bow = classes
        .as_array()
        .unwrap()
        .iter()
        .find(|c| c["name"] == "bow");
    assert!(bow.is_none_or(|bow| bow["accepted"] == 0), "{classes}");
}

#[test]
fn misspelt_names_are_errors_that_name_the_nearest() {
    let (folder, clip) = labelled();
    let typo = format!("{clip}s");
    let one = ["db", "label", "m.mdb", "--class", "bow", "--clip", &typo];
    let wrong: [&[&str]; 9] = [
        &one,
        &["db", "clips", "m.mdb", "--name", &typo],
        &["db", "clips", "m.mdb", "--class", "bows"],
        &["db", "cut", "m.mdb", "--name", &typo],
        &[
            "db",
            "group",
            "m.mdb",
            "--of",
            "labels",
            "--classes",
            "bows",
        ],
        &["db", "propose", "m.mdb", "--classes", "bows"],
        &["db", "export", "m.mdb", "out.tsv", "--class", "bows"],
        &["db", "report", "m.mdb", "-o", "out.html", "--name", &typo],
        &["db", "classes", "m.mdb", "--samples", "bows"],
    ];
    for args in wrong {
        let ran = folder.morec(args);
        assert_eq!(ran.code, Some(1), "{args:?}: {ran:?}");
        assert!(ran.err.contains("did you mean"), "{args:?}: {}", ran.err);
    }
    let text = "clip\tstart_secs\tstop_secs\tclass\n".to_owned() + &typo + "\t0\t1\tbow\n";
    std::fs::write(folder.path().join("typo.tsv"), text).unwrap();
    let ran = folder.morec(&["db", "label", "m.mdb", "typo.tsv"]);
    assert!(
        ran.code == Some(1) && ran.err.contains("did you mean"),
        "{ran:?}"
    );
}

#[test]
fn changes_of_every_kind_are_taken_back_by_number() {
    let (folder, clip) = labelled();
    let classes = json(&folder, &["db", "classes", "m.mdb"]);
    folder.morec(&["db", "cut", "m.mdb"]).ok();
    let refused = folder.morec(&["db", "label", "m.mdb", "--undo"]);
    assert!(
        refused.code == Some(1) && refused.err.contains("cut 2 clips"),
        "{refused:?}"
    );
    assert_eq!(json(&folder, &["db", "classes", "m.mdb"]), classes);
    folder
        .morec(&["db", "clips", "m.mdb", "--name", &clip, "--remove"])
        .ok();
    assert!(folder.morec(&["db", "clips", "m.mdb", "--remove"]).code == Some(1));
    let history = json(&folder, &["db", "history", "m.mdb"]);
    let steps: Vec<&str> = history
        .as_array()
        .unwrap()
        .iter()
        .map(|step| step["what"].as_str().unwrap())
        .collect();
    let labels = json(&folder, &["db", "info", "m.mdb"])["accepted"]
        .as_u64()
        .unwrap();
    assert!(labels > 0);
    assert_eq!(steps[0], "remove 1 clip");
    assert_eq!(steps[1], "cut 2 clips by kernel");
    assert_eq!(steps[3], "import 2 files");
    let number = history[1]["id"].to_string();
    let needed = folder.morec(&["db", "undo", "m.mdb", &number]);
    assert!(
        needed.code == Some(1) && needed.err.contains("remove 1 clip"),
        "{needed:?}"
    );
    let would = folder.morec(&["db", "undo", "m.mdb", "--dry-run"]).ok();
    assert!(
        would.contains("would be undone") && would.contains("samples: "),
        "{would}"
    );
    folder.morec(&["db", "undo", "m.mdb"]).ok();
    folder.morec(&["db", "undo", "m.mdb", &number]).ok();
    let info = json(&folder, &["db", "info", "m.mdb"]);
    assert_eq!((&info["segments"], &info["clips"]), (&0.into(), &2.into()));
    assert_eq!(json(&folder, &["db", "classes", "m.mdb"]), classes);
    folder.morec(&["db", "redo", "m.mdb", &number]).ok();
    folder.is_whole("m.mdb");
}

#[test]
fn groups_leave_nothing_behind() {
    let (folder, _) = labelled();
    folder
        .morec(&[
            "db",
            "group",
            "m.mdb",
            "--of",
            "labels",
            "--name-as",
            "group",
        ])
        .ok();
    let forgotten = folder
        .morec(&["db", "classes", "m.mdb", "--forget", "group_*"])
        .ok();
    assert_eq!(forgotten.lines().count(), 1, "{forgotten}");
    let classes = json(&folder, &["db", "classes", "m.mdb"]);
    assert_eq!(classes.as_array().unwrap().len(), 2);
}

#[test]
fn samples_and_indexes_by_name_and_number() {
    let (folder, clip) = labelled();
    let samples = json(&folder, &["db", "samples", "m.mdb", "--clip", &clip]);
    let count = samples.as_array().unwrap().len();
    let number = samples[0]["id"].to_string();
    let moved = json(
        &folder,
        &[
            "db", "samples", "m.mdb", "--move", &number, "--start", "0.5", "--stop", "0.75",
        ],
    );
    assert_eq!(
        (&moved[0]["start_secs"], &moved[0]["stop_secs"]),
        (&0.5.into(), &0.75.into())
    );
    folder
        .morec(&["db", "samples", "m.mdb", "--remove", &number])
        .ok();
    assert_eq!(
        folder
            .morec(&["db", "samples", "m.mdb", "--remove", &number])
            .code,
        Some(1)
    );
    let left = json(&folder, &["db", "samples", "m.mdb", "--clip", &clip]);
    assert_eq!(left.as_array().unwrap().len(), count - 1);
    folder.morec(&["db", "undo", "m.mdb"]).ok();
    folder.morec(&["db", "undo", "m.mdb"]).ok();
    folder
        .morec(&["train", "--db", "m.mdb", "-o", "a.index"])
        .ok();
    let indexes = json(&folder, &["db", "indexes", "m.mdb"]);
    assert_eq!(
        (&indexes[0]["name"], &indexes[0]["stale"]),
        (&"a".into(), &false.into())
    );
    folder
        .morec(&["db", "indexes", "m.mdb", "--write", "a", "-o", "b.index"])
        .ok();
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(read("a.index"), read("b.index"));
    let wrong = folder.morec(&["db", "indexes", "m.mdb", "--remove", "b"]);
    assert!(wrong.err.contains("did you mean `a`"), "{wrong:?}");
    let none = json(&folder, &["db", "indexes", "m.mdb", "--remove", "a"]);
    assert_eq!(none, Value::Array(vec![]));
}

#[test]
fn folders_of_label_tracks_come_back() {
    let (folder, clip) = labelled();
    folder
        .morec(&["db", "clips", "m.mdb", "--rename", &clip, "x/y"])
        .ok();
    let all = json(&folder, &["db", "info", "m.mdb"])["accepted"].clone();
    for form in ["audacity", "eaf"] {
        folder
            .morec(&["db", "export", "m.mdb", form, "--form", form])
            .ok();
        assert!(folder.path().join(form).read_dir().unwrap().count() == 2);
        let again = json(&folder, &["db", "label", "m.mdb", form]);
        assert_eq!(again["samples"]["unchanged"], all, "{form}: {again}");
    }
}

/// The labels of the studio's takes as a table with other columns: `extent` of a label in seconds.
fn table(
    takes: &[morec::synth::SyntheticTake],
    header: &str,
    row: impl Fn(&str, &str, f64, f64) -> String,
) -> String {
    let mut text = format!("{header}\n");
    for take in takes {
        for l in &take.labels {
            text += &row(
                &take.clip.name,
                l.class,
                l.span.start_secs,
                l.span.stop_secs,
            );
            text.push('\n');
        }
    }
    text
}

#[test]
fn the_column_person_of_a_table_says_who_is_in_the_clips() {
    let (folder, takes) = studio(2);
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    let people: std::collections::BTreeMap<_, _> = takes
        .iter()
        .map(|t| (t.clip.name.clone(), t.person.clone()))
        .collect();
    let text = table(
        &takes,
        "clip\tclass\tstart_secs\tstop_secs\tperson",
        |clip, class, start, stop| format!("{clip}\t{class}\t{start}\t{stop}\t{}", people[clip]),
    );
    std::fs::write(folder.path().join("by.tsv"), text).unwrap();
    let done = json(&folder, &["db", "label", "m.mdb", "by.tsv"]);
    assert_eq!(done["samples"]["people"], takes.len());
    for clip in json(&folder, &["db", "clips", "m.mdb"]).as_array().unwrap() {
        let name = clip["clip"].as_str().unwrap();
        assert_eq!(clip["subject"].as_str(), Some(people[name].as_str()));
    }
    // Somebody who is known stays, and it is said.
    let other = format!(
        "clip\tclass\tstart_secs\tstop_secs\tperson\n{}\tbow\t0.5\t1.5\tzoe\n",
        takes[0].clip.name
    );
    std::fs::write(folder.path().join("other.tsv"), other).unwrap();
    let error = folder.morec(&["db", "label", "m.mdb", "other.tsv"]).err;
    assert!(
        error.contains("the label's person zoe is ignored"),
        "{error}"
    );
    // One step takes back labels and people.
    folder.morec(&["db", "undo", "m.mdb"]).ok();
    folder.morec(&["db", "undo", "m.mdb"]).ok();
    let clips = json(&folder, &["db", "clips", "m.mdb"]);
    assert!(
        clips
            .as_array()
            .unwrap()
            .iter()
            .all(|c| c["subject"].is_null()),
        "{clips}"
    );
}

#[test]
fn times_in_the_wrong_column_are_an_error_with_the_likely_reason() {
    let (folder, takes) = studio(2);
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    let whole = table(
        &takes,
        "clip\tclass\tstart\tstop",
        |clip, class, start, stop| format!("{clip}\t{class}\t{}\t{}", start.floor(), stop.ceil()),
    );
    let framed = table(
        &takes,
        "clip\tclass\tstart_secs\tstop_secs",
        |clip, class, start, stop| {
            format!(
                "{clip}\t{class}\t{}\t{}",
                (start * 60.0).round(),
                (stop * 60.0).round()
            )
        },
    );
    std::fs::write(folder.path().join("whole.tsv"), whole).unwrap();
    std::fs::write(folder.path().join("framed.tsv"), framed).unwrap();
    for (file, why) in [
        ("whole.tsv", "last "),
        ("framed.tsv", "end after their clips do"),
    ] {
        for args in [
            vec!["db", "label", "m.mdb", file],
            vec![
                "train", "--clips", "clips", "--labels", file, "-o", "x.index",
            ],
            vec![
                "crossval", "--clips", "clips", "--labels", file, "--by", "half",
            ],
            vec!["group", "--clips", "clips", "--labels", file],
        ] {
            let ran = folder.morec(&args);
            let error = ran.fails();
            assert!(
                error.contains(why) && error.contains("`start_secs`"),
                "{args:?}: {error}"
            );
        }
    }
    assert!(!folder.path().join("x.index").exists());
    assert_eq!(
        json(&folder, &["db", "samples", "m.mdb"])
            .as_array()
            .unwrap()
            .len(),
        0
    );
}

#[test]
fn a_misspelt_class_or_clip_in_a_table_is_asked_about() {
    let (folder, takes) = studio(3);
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    folder.morec(&["db", "label", "m.mdb", "labels.tsv"]).ok();
    let clip = &takes[0].clip.name;
    let class = takes[0].labels[0].class;
    let slip = format!("{}{}", class, &class[class.len() - 1..]);
    let text = format!(
        "clip\tclass\tstart_secs\tstop_secs\n{clip}\t{slip}\t0.2\t1.2\n{clip}s\t{class}\t0.2\t1.2\n"
    );
    std::fs::write(folder.path().join("slip.tsv"), &text).unwrap();
    let error = folder
        .morec(&["db", "label", "m.mdb", "slip.tsv", "--dry-run"])
        .err;
    assert!(
        error.contains(&format!("did you mean `{class}`?")),
        "{error}"
    );
    let mut rows = table(
        &takes,
        "clip\tclass\tstart_secs\tstop_secs",
        |clip, class, start, stop| format!("{clip}\t{class}\t{start}\t{stop}"),
    );
    rows += &text[text.find('\n').unwrap() + 1..];
    std::fs::write(folder.path().join("all.tsv"), rows).unwrap();
    let error = folder
        .morec(&[
            "train",
            "--clips",
            "clips",
            "--labels",
            "all.tsv",
            "--everyday",
            "never",
            "-o",
            "x.index",
        ])
        .err;
    assert!(
        error.contains(&format!("for `{clip}s` did you mean `{clip}`?")),
        "{error}"
    );
    assert!(
        error.contains(&format!(
            "the class {slip} has 1 label; did you mean `{class}`?"
        )),
        "{error}"
    );
}

#[test]
fn crossval_says_by_what_it_divides_and_refuses_one_person() {
    let (folder, takes) = studio(2);
    let rows = |person: &str| {
        table(
            &takes,
            "clip\tclass\tstart_secs\tstop_secs\tperson",
            |clip, class, start, stop| format!("{clip}\t{class}\t{start}\t{stop}\t{person}"),
        )
    };
    std::fs::write(folder.path().join("one.tsv"), rows("ada")).unwrap();
    std::fs::write(folder.path().join("nobody.tsv"), rows("")).unwrap();
    let run = |labels: &str, by: &str| {
        let args = [
            "crossval",
            "--clips",
            "clips",
            "--labels",
            labels,
            "--by",
            by,
            "--everyday",
            "never",
        ];
        folder.morec(&args)
    };
    let error = run("one.tsv", "person").fails();
    assert!(
        error.contains("all labels are by one person, ada"),
        "{error}"
    );
    let said = run("nobody.tsv", "person").ok();
    assert!(
        said.starts_with(&format!(
            "Left out: each clip in turn, {} clips, because no persons are named",
            takes.len()
        )),
        "{said}"
    );
    let said = run("one.tsv", "half").ok();
    assert!(said.starts_with("Left out: half of the labels"), "{said}");
}

#[test]
fn crossval_says_what_more_samples_are_worth() {
    let (folder, _) = studio(2);
    let args = "crossval --clips clips --labels labels.tsv --by half --everyday never --curve --plot curve.svg --json";
    let said = folder.morec(&args.split(' ').collect::<Vec<_>>()).ok();
    let curve: serde_json::Value = serde_json::from_str(&said).unwrap();
    let points = curve["points"].as_array().unwrap();
    let (first, last) = (&points[0], points.last().unwrap());
    assert_eq!(
        (&first["samples"], first["draws"].as_array().unwrap().len()),
        (&1.into(), 3)
    );
    assert_eq!(
        (&last["samples"], last["draws"].as_array().unwrap().len()),
        (&serde_json::Value::Null, 1)
    );
    let f1 = |point: &serde_json::Value| point["draws"][0]["f1"].as_f64().unwrap();
    assert!(f1(last) >= f1(first), "{curve}");
    let drawn = std::fs::read_to_string(folder.path().join("curve.svg")).unwrap();
    assert!(drawn.contains("F1 of each draw"));
}

#[test]
fn labels_that_count_otherwise_are_read_wherever_labels_are() {
    let (folder, takes) = studio(1);
    let clip = &takes[0].clip.name;
    let write = |name: &str, text: String| {
        std::fs::write(folder.path().join(name), text).unwrap();
    };
    let secs = |start: f64| {
        format!(
            "clip\tclass\tstart_secs\tstop_secs\n{clip}\tbow\t{start}\t{}\n",
            start + 1.0
        )
    };
    write("found.tsv", secs(1.0));
    write("plain.tsv", secs(1.0));
    write("late.tsv", secs(3.5));
    write(
        "video.tsv",
        format!("clip\tclass\tstart\tstop\n{clip}\tbow\t25\t50\n"),
    );
    let tier = |name: &str, start: f64| {
        format!(
            "\"IntervalTier\"\n\"{name}\"\n0\n9\n1\n{start}\n{}\n\"bow\"\n",
            start + 1.0
        )
    };
    let grid = "File type = \"ooTextFile\"\n\"TextGrid\"\n0\n9\n<exists>\n2\n";
    write(
        &format!("{clip}.TextGrid"),
        format!("{grid}{}{}", tier("hand", 1.0), tier("foot", 5.0)),
    );
    let evaluate = |labels: &str, more: &[&str]| {
        let args = [
            "evaluate",
            "--found",
            "found.tsv",
            "--clips",
            "clips",
            "--labels",
            labels,
        ];
        folder.morec(&[&args[..], more].concat())
    };
    let evaluated = |labels: &str, more: &[&str]| evaluate(labels, more).ok();
    let plain = evaluated("plain.tsv", &[]);
    assert!(plain.contains("1 of 1"), "{plain}");
    assert_eq!(evaluated("late.tsv", &["--offset", "-2.5"]), plain);
    assert_eq!(evaluated("video.tsv", &["--label-rate", "25"]), plain);
    let grid = format!("{clip}.TextGrid");
    assert_eq!(evaluated(&grid, &["--tier", "hand"]), plain);
    assert_ne!(evaluated(&grid, &[]), plain);
    let refused = evaluate("video.tsv", &["--offset", "1"]).fails();
    assert!(refused.contains("--label-rate"), "{refused}");
}
