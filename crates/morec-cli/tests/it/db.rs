//! The database from the command line, from an empty file to a trained index.

use std::process::{Command, Stdio};
use std::time::Duration;

use morec::formats::bvh;
use morec::synth::{DatabaseSpec, SyntheticTake, database};
use serde_json::Value;

use crate::kit::Folder;

fn takes(people: usize) -> Vec<SyntheticTake> {
    let spec = DatabaseSpec {
        people,
        repetitions: 2,
        classes: vec!["wave", "bow"],
        ..Default::default()
    };
    database(3, &spec)
}

/// A folder with `clips/` and `labels.tsv` of synthetic people.
pub fn studio(people: usize) -> (Folder, Vec<SyntheticTake>) {
    let folder = Folder::with(&[("clips/readme.txt", "not a clip")]);
    let takes = takes(people);
    let mut labels = String::from("clip\tstart\tstop\tclass\n");
    for take in &takes {
        let name = &take.clip.name;
        let mut bytes = Vec::new();
        bvh::write(&take.clip, &mut bytes).unwrap();
        std::fs::write(folder.path().join(format!("clips/{name}.bvh")), bytes).unwrap();
        for label in &take.labels {
            let span = label.span.frames(take.clip.rate_hz);
            labels.push_str(&format!(
                "{name}\t{}\t{}\t{}\n",
                span.start, span.end, label.class
            ));
        }
    }
    std::fs::write(folder.path().join("labels.tsv"), labels).unwrap();
    (folder, takes)
}

fn json(folder: &Folder, args: &[&str]) -> Value {
    let mut args = args.to_vec();
    args.push("--json");
    serde_json::from_str(&folder.morec(&args).ok()).unwrap()
}

#[test]
fn from_clips_to_labels_and_back() {
    let (folder, takes) = studio(3);
    let db = |args: &[&str]| {
        let args: Vec<&str> = ["db", args[0], "m.mdb"]
            .into_iter()
            .chain(args[1..].iter().copied())
            .collect();
        json(&folder, &args)
    };
    db(&["init"]);
    assert_eq!(folder.morec(&["db", "init", "m.mdb"]).code, Some(1));
    let imported = db(&["import", "clips", "--licence", "CC0", "--tag", "made"]);
    assert_eq!(imported["near_copies"], serde_json::json!([]));
    let clips = db(&["clips", "--tag", "made"]);
    assert_eq!(clips.as_array().unwrap().len(), 3);
    assert_eq!(clips[0]["licence"], "CC0");

    let all: usize = takes.iter().map(|t| t.labels.len()).sum();
    assert_eq!(db(&["label", "labels.tsv"])["samples"]["added"], all);
    assert_eq!(db(&["label", "labels.tsv"])["samples"]["unchanged"], all);
    for form in ["tsv", "csv", "json", "babel", "label-studio"] {
        db(&["export", "out", "--form", form]);
        let again = db(&["label", "out", "--form", form, "--state", "accepted"]);
        assert_eq!(again["samples"]["unchanged"], all, "{form}");
    }
    db(&["export", "eaf", "--form", "eaf"]);
    for take in &takes {
        let file = format!("eaf/{}.eaf", take.clip.name);
        assert_eq!(
            db(&["label", &file])["samples"]["unchanged"],
            take.labels.len()
        );
    }

    let bow = |start: &str, stop: &str| {
        let what = ["--clip", &takes[0].clip.name, "--class", "bow"];
        let span = ["--start", start, "--stop", stop];
        folder.morec(&[&["db", "label", "m.mdb"], &what[..], &span].concat())
    };
    let over = bow("1", "900");
    assert!(
        over.code == Some(0) && over.err.contains("cut there"),
        "{}",
        over.err
    );
    let beyond = bow("900", "901");
    assert!(
        beyond.out.contains("0 samples added") && beyond.err.contains("left out"),
        "{}",
        beyond.err
    );
    db(&["label", "--undo"]);
    db(&["classes", "--rename", "bow", "nod"]);
    assert_eq!(db(&["classes"])[0]["name"], "nod");
    db(&["label", "--undo"]);
    assert_eq!(db(&["classes"])[0]["name"], "bow");

    let strips = |page: &str| {
        let page = std::fs::read_to_string(folder.path().join(page)).unwrap();
        assert!(!page.contains("http"), "nothing is loaded from elsewhere");
        page.matches("<svg").count()
    };
    let name = &takes[0].clip.name;
    let label = &takes[0].labels[0];
    let (start, stop) = (
        label.span.start_secs.to_string(),
        label.span.stop_secs.to_string(),
    );
    let search = |example: &str, limit: &str, more: &[&str]| {
        let span = ["--start", &start, "--stop", &stop, "--limit", limit];
        db(&[&["search", example], &span[..], more].concat())
    };
    let hits = search(name, "3", &["--report", "hits.html"]);
    assert_eq!(hits["hits"].as_array().unwrap().len(), 3);
    assert_eq!(strips("hits.html"), 4, "the example and its hits");
    let outside = search(&format!("clips/{name}.bvh"), "1", &[]);
    assert_eq!(
        outside["hits"][0]["clip"],
        Value::from(name.as_str()),
        "a file finds itself"
    );

    let learned = search(name, "3", &["--learned"]);
    assert_eq!(
        (
            &learned["learned"]["classes"],
            &learned["learned"]["samples"]
        ),
        (&2.into(), &all.into())
    );
    assert_eq!(learned["hits"].as_array().unwrap().len(), 3);
    let few = folder.morec(&[
        "db",
        "search",
        "m.mdb",
        name,
        "--learned",
        "--classes",
        "bow",
    ]);
    assert!(
        few.code == Some(1) && few.err.contains("at least 2 classes"),
        "{}",
        few.err
    );

    assert_eq!(db(&["cut"]).as_array().unwrap().len(), 3);
    assert!(!db(&["cycles"]).as_array().unwrap().is_empty());
    let groups = db(&["group", "--of", "labels", "--report", "groups.html"]);
    assert!(groups["adjusted_rand_index"].as_f64().unwrap() > 0.3);
    let members: usize = groups["groups"]
        .as_array()
        .unwrap()
        .iter()
        .map(|g| g.as_array().unwrap().len())
        .sum();
    assert_eq!(strips("groups.html"), members);
    assert!(db(&["check"])["faults"].as_array().unwrap().is_empty());
    db(&["vacuum", "--caches"]);

    folder
        .morec(&[
            "convert",
            &format!("clips/{name}.bvh"),
            "--rate",
            "50",
            "-o",
            "clips/again.bvh",
        ])
        .ok();
    let copies = db(&["import", "clips/again.bvh"])["near_copies"].clone();
    assert_eq!(
        (copies.as_array().unwrap().len(), &copies[0]["copy"]),
        (1, &Value::from("again")),
        "{copies}"
    );

    assert!(
        db(&["report", "-o", "page.html"])["strips"]
            .as_u64()
            .unwrap()
            > 3
    );
    assert!(strips("page.html") > 3);
    let left: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .filter_map(|f| f.ok()?.file_name().into_string().ok())
        .collect();
    assert!(
        !left.iter().any(|f| f.contains("wal") || f.contains("shm")),
        "one file stays: {left:?}"
    );
}

#[test]
fn a_database_trains_an_index_and_keeps_it() {
    let (folder, _) = studio(3);
    json(&folder, &["db", "import", "m.mdb", "clips"]);
    json(&folder, &["db", "label", "m.mdb", "labels.tsv"]);
    folder
        .morec(&["train", "--db", "m.mdb", "-o", "moves.idx"])
        .ok();
    assert_eq!(json(&folder, &["db", "info", "m.mdb"])["indexes"], 1);
    let found = folder.morec(&["recognize", "moves.idx", "clips"]).ok();
    assert!(found.contains("wave"), "{found}");
}

#[test]
fn kept_reports_are_listed_and_written() {
    let (folder, _) = studio(1);
    json(&folder, &["db", "import", "m.mdb", "clips"]);
    let path = folder.path().join("m.mdb");
    let mut db = morec_db::MotionDb::open(&path).unwrap();
    let kinds = [
        morec_db::ReportKind::Training,
        morec_db::ReportKind::Crossval,
        morec_db::ReportKind::Curve,
    ];
    for (number, kind) in kinds.into_iter().enumerate() {
        let contents = serde_json::json!({ "number": number });
        db.keep_report(kind, "2 of 3 found", &contents).unwrap();
    }
    drop(db);
    let listed = json(&folder, &["db", "reports", "m.mdb"]);
    assert_eq!(listed.as_array().unwrap().len(), 3);
    assert_eq!(listed[0]["kind"], "curve");
    assert_eq!(
        (&listed[1]["id"], &listed[1]["kind"]),
        (&2.into(), &"crossval".into())
    );
    let printed = folder.morec(&["db", "reports", "m.mdb"]).ok();
    assert!(
        printed.contains("learning curve")
            && printed.contains("cross-validation")
            && printed.contains("2 of 3 found")
    );
    let read = |name: &str| -> Value {
        let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
        serde_json::from_str(&text).unwrap()
    };
    let write = ["db", "reports", "m.mdb", "-o", "all.json"];
    folder.morec(&write).ok();
    assert_eq!(read("all.json")[2]["report"]["number"], 0);
    let one = ["db", "reports", "m.mdb", "--only", "2", "-o", "one.json"];
    folder.morec(&one).ok();
    assert_eq!(read("one.json")["report"]["number"], 1);
    assert_eq!(read("one.json")["about"]["title"], "2 of 3 found");
    let unknown = folder.morec(&["db", "reports", "m.mdb", "--only", "7"]);
    assert!(
        unknown.code == Some(1) && unknown.err.contains("report"),
        "{unknown:?}"
    );
}

#[test]
fn clips_with_the_tag_background_are_what_a_database_has_of_it() {
    let (folder, takes) = studio(4);
    let names: Vec<&str> = takes.iter().map(|take| take.clip.name.as_str()).collect();
    json(&folder, &["db", "import", "m.mdb", "clips"]);
    let text = std::fs::read_to_string(folder.path().join("labels.tsv")).unwrap();
    let others = text.lines().filter(|line| !line.starts_with(names[3]));
    let others: Vec<&str> = others.collect();
    std::fs::write(folder.path().join("three.tsv"), others.join("\n")).unwrap();
    json(&folder, &["db", "label", "m.mdb", "three.tsv"]);
    let trained = |more: &[&str]| {
        // What the tag does is the same without everyday motion, and faster.
        let train = [
            "train",
            "--db",
            "m.mdb",
            "-o",
            "i.index",
            "--json",
            "--everyday",
            "never",
        ];
        let ran = folder.morec(&[&train[..], more].concat());
        assert_eq!(ran.code, Some(0), "{ran:?}");
        let report: Value = serde_json::from_str(&ran.out).unwrap();
        (report, ran.err)
    };
    let secs = |report: &Value| report["background_secs"]["clips"].as_f64();
    assert_eq!(secs(&trained(&[]).0), None);
    let tag = ["db", "clips", "m.mdb", "--add-tag", "background", "--clip"];
    json(&folder, &[&tag[..], &[names[3]]].concat());
    // The tag is what --background says.
    let (report, err) = trained(&[]);
    assert!(secs(&report).unwrap() > 1.0, "{report}");
    assert!(!err.contains("background"), "{err}");
    assert_eq!(trained(&["--background", names[3]]).0, report);
    assert_eq!(secs(&trained(&["--exclude", names[3]]).0), None);
    // A clip that holds samples of the classes is none, and it is said.
    json(&folder, &[&tag[..], &[names[0]]].concat());
    let (report, err) = trained(&[]);
    let samples: u64 = report["classes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|class| class["samples"].as_u64().unwrap())
        .sum();
    assert_eq!(samples as usize, others.len() - 1);
    let said = format!("used as labelled clips: {}", names[0]);
    assert!(err.contains(&said), "{err}");
    // Named on the command line it is background, and its labels are said not to count.
    let (_, err) = trained(&["--background", names[0]]);
    let said = "labels are ignored because their clips are given as background";
    assert!(err.contains(said), "{err}");
}

#[test]
fn proposals_are_judged_in_bulk() {
    let (folder, takes) = studio(3);
    json(&folder, &["db", "import", "m.mdb", "clips"]);
    let text = std::fs::read_to_string(folder.path().join("labels.tsv")).unwrap();
    let own: Vec<&str> = text
        .lines()
        .filter(|l| l.starts_with("clip") || l.starts_with(takes[0].clip.name.as_str()))
        .collect();
    std::fs::write(folder.path().join("few.tsv"), own.join("\n")).unwrap();
    json(&folder, &["db", "label", "m.mdb", "few.tsv"]);
    let proposed = json(&folder, &["db", "propose", "m.mdb"])
        .as_array()
        .unwrap()
        .len();
    assert!(proposed > 2, "{proposed}");
    json(
        &folder,
        &["db", "export", "m.mdb", "ask.csv", "--state", "proposed"],
    );
    let ask = std::fs::read_to_string(folder.path().join("ask.csv")).unwrap();
    std::fs::write(
        folder.path().join("answer.csv"),
        ask.replacen("proposed", "accepted", 1),
    )
    .unwrap();
    let answered = json(&folder, &["db", "label", "m.mdb", "answer.csv"]);
    assert_eq!(answered["samples"]["changed"], 1, "{answered}");
    std::fs::write(
        folder.path().join("answer.csv"),
        ask.replacen("proposed", "reject", 1),
    )
    .unwrap();
    assert_eq!(
        folder.morec(&["db", "label", "m.mdb", "answer.csv"]).code,
        Some(1),
        "no such state"
    );
    let judged = json(
        &folder,
        &[
            "db", "propose", "m.mdb", "--accept", "0.5", "--reject", "0.5",
        ],
    );
    assert_eq!(judged["left"], 0);
    assert_eq!(
        judged["accepted"].as_u64().unwrap() + judged["rejected"].as_u64().unwrap(),
        proposed as u64 - 1
    );
    json(
        &folder,
        &["db", "group", "m.mdb", "--of", "clips", "--name-as", "like"],
    );
    json(&folder, &["db", "propose", "m.mdb"]);
    let likes = json(&folder, &["db", "classes", "m.mdb"])
        .as_array()
        .unwrap()
        .clone();
    let likes = likes
        .iter()
        .filter(|c| c["name"].as_str().unwrap().starts_with("like"));
    assert_eq!(
        likes.map(|c| c["proposed"].as_u64().unwrap()).sum::<u64>(),
        3,
        "others' proposals stay"
    );
}

/// Ctrl-C ends an import with what is done kept, said, and to be gone on with.
#[cfg(unix)]
#[test]
fn an_interrupted_import_says_what_it_did() {
    let (folder, takes) = studio(1);
    copies(&folder, &takes, 60);
    let begin = || {
        Command::new(env!("CARGO_BIN_EXE_morec"))
            .args(["db", "import", "m.mdb", "clips"])
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap()
    };
    // Once it has made the file, it listens.
    let import = begin();
    while !folder.path().join("m.mdb").exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(300));
    let sent = Command::new("kill")
        .args(["-INT", &import.id().to_string()])
        .status();
    let done = import.wait_with_output().unwrap();
    let said = String::from_utf8(done.stdout).unwrap();
    if !sent.is_ok_and(|status| status.success()) || done.status.code() == Some(0) {
        crate::kit::skipped("no `kill` here, or the import was done before it came");
        return;
    }
    assert_eq!(done.status.code(), Some(130), "{said}");
    assert!(
        said.contains("stopped: ") && said.contains("the same command continues"),
        "{said}"
    );
    let clips = json(&folder, &["db", "info", "m.mdb"])["clips"]
        .as_u64()
        .unwrap();
    assert!(
        said.starts_with(&format!("{clips} files imported")) && clips < 61,
        "{clips} clips: {said}"
    );
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    assert_eq!(json(&folder, &["db", "info", "m.mdb"])["clips"], 61);
}

#[test]
fn clips_are_cut_by_either_method_and_one_at_a_time() {
    let (folder, _) = studio(1);
    json(&folder, &["db", "import", "m.mdb", "clips"]);
    let cuts = |method: &str| json(&folder, &["db", "cut", "m.mdb", "--method", method]);
    let segments = || {
        json(&folder, &["db", "info", "m.mdb"])["segments"]
            .as_u64()
            .unwrap()
    };
    cuts("kernel");
    let kernel = segments();
    let ppca = cuts("ppca");
    assert!(ppca[0]["cuts_secs"].is_array() && segments() > 0);
    cuts("kernel");
    assert_eq!(
        segments(),
        kernel,
        "earlier cuts are replaced, by whatever method they are"
    );
}

#[test]
fn a_clip_is_cut_by_hand_and_stays_so() {
    let (folder, takes) = studio(2);
    json(&folder, &["db", "import", "m.mdb", "clips"]);
    let name = takes[0].clip.name.as_str();
    folder
        .morec(&["cut", "m.mdb", "--name", name, "--at", "4,1.5"])
        .ok();
    let again = folder.morec(&["cut", "m.mdb"]);
    assert!(
        again.err.contains("its cuts were set by hand"),
        "{}",
        again.err
    );
    assert!(!again.out.contains(name), "{}", again.out);
    let outside = folder.morec(&["cut", "m.mdb", "--name", name, "--at", "1e6"]);
    assert_eq!(outside.code, Some(1));
    assert!(
        outside.err.contains("expected cuts between"),
        "{}",
        outside.err
    );
    let several = folder.morec(&["cut", "m.mdb", "--name", "*", "--at", "1"]);
    assert_eq!(several.code, Some(1));
}

#[test]
fn a_part_of_the_body_is_given_to_another_joint() {
    let (folder, takes) = studio(1);
    json(&folder, &["db", "import", "m.mdb", "clips"]);
    let name = takes[0].clip.name.as_str();
    let give =
        |role: &str| folder.morec(&["db", "clips", "m.mdb", "--name", name, "--set-role", role]);
    give("left_foot=RightFoot").ok();
    let steps = json(&folder, &["db", "history", "m.mdb"]);
    assert_eq!(steps[0]["what"], "roles of 1 clips");
    give("left_foot=").ok();
    let nobody = give("left_foot=Tail");
    assert_eq!(nobody.code, Some(1));
    assert!(nobody.err.contains("no joint called"), "{}", nobody.err);
    assert_eq!(give("tail=RightFoot").code, Some(2));
}

#[test]
fn tables_through_a_pipe_are_separated_by_tabs() {
    let (folder, takes) = studio(2);
    json(&folder, &["db", "import", "m.mdb", "clips"]);
    let listed = folder.morec(&["db", "clips", "m.mdb"]).ok();
    let rows: Vec<Vec<&str>> = listed
        .lines()
        .map(|line| line.split('\t').collect())
        .collect();
    assert_eq!(rows[0][..2], ["clip", "secs"]);
    assert!(
        rows.iter().all(|row| row.len() == rows[0].len()),
        "{listed}"
    );
    assert_eq!(
        rows[1..].iter().map(|row| row[0]).collect::<Vec<_>>(),
        names(&takes)
    );
}

fn names(takes: &[SyntheticTake]) -> Vec<&str> {
    let mut names: Vec<&str> = takes.iter().map(|take| take.clip.name.as_str()).collect();
    names.sort_unstable();
    names
}

/// Files of different content: a comment's worth of difference in one offset is enough.
#[cfg(unix)]
fn copies(folder: &Folder, takes: &[SyntheticTake], count: usize) {
    let mut bytes = Vec::new();
    bvh::write(&takes[0].clip, &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    for number in 1..=count {
        let path = folder.path().join(format!("clips/c{number:03}.bvh"));
        std::fs::write(
            path,
            text.replacen("0.000000", &format!("0.{number:06}"), 1),
        )
        .unwrap();
    }
}

/// Killed at any moment, what is there is whole, and importing again completes it.
#[cfg(unix)]
#[test]
fn kill_nine_leaves_whole_clips() {
    let (folder, takes) = studio(1);
    copies(&folder, &takes, 50);
    let mut seen = 0;
    for millis in [30, 150, 400, 800] {
        let mut import = Command::new(env!("CARGO_BIN_EXE_morec"))
            .args(["db", "import", "m.mdb", "clips"])
            .current_dir(folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(millis));
        import.kill().unwrap(); // SIGKILL
        import.wait().unwrap();
        if !folder.path().join("m.mdb").exists() {
            continue;
        }
        let info = folder.morec(&["db", "info", "m.mdb", "--json"]);
        if info.code != Some(0) {
            // Killed while the empty database was being made: the next import finishes it.
            assert_eq!(seen, 0, "{info:?}");
            continue;
        }
        let info: Value = serde_json::from_str(&info.out).unwrap();
        let check = json(&folder, &["db", "check", "m.mdb"]);
        assert!(check["faults"].as_array().unwrap().is_empty(), "{check}");
        assert_eq!(check["clips"], info["clips"]);
        let clips = info["clips"].as_u64().unwrap();
        assert!(clips >= seen, "what was committed stays");
        seen = clips;
    }
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    assert_eq!(json(&folder, &["db", "info", "m.mdb"])["clips"], 51);
}

/// One clip that cannot be written does not cost the others.
#[test]
fn an_export_names_what_it_cannot_write_and_goes_on() {
    let (folder, takes) = studio(2);
    folder.morec(&["db", "init", "m.mdb"]).ok();
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    let [first, second] = [0, 1].map(|at| takes[at].clip.name.clone());
    // A folder of the file's name.
    let file = |name: &str| folder.path().join(format!("out/{name}.bvh"));
    std::fs::create_dir_all(file(&first).join("taken")).unwrap();
    let ran = folder.morec(&["db", "export", "m.mdb", "out", "--motion", "*"]);
    assert_eq!(ran.code, Some(1), "{ran:?}");
    let named = format!("morec: clip {first} left out: ");
    assert!(ran.err.contains(&named), "{ran:?}");
    assert!(file(&second).is_file(), "{ran:?}");
}
