//! Files that the command writes, and those that it must never write over.

use crate::db::studio;
use crate::kit::{ARM_ASF, Folder, WAVE_AMC, WAVE_BVH};

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    std::fs::read(folder.path().join(name)).unwrap()
}

/// Runs a command that names an input as its output: it fails, and the input is as it was.
fn spares(folder: &Folder, input: &str, args: &[&str]) {
    let before = bytes(folder, input);
    let ran = folder.morec(args);
    assert_eq!(ran.code, Some(1), "{args:?}: {ran:?}");
    assert!(ran.err.contains(input), "{args:?}: {}", ran.err);
    assert_eq!(bytes(folder, input), before, "{args:?}");
}

#[test]
fn inputs_are_no_outputs() {
    let (folder, takes) = studio(3);
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    folder.morec(&["db", "label", "m.mdb", "labels.tsv"]).ok();
    let clip = format!("clips/{}.bvh", takes[0].clip.name);
    let of_clip = takes[0].clip.name.as_str();
    spares(&folder, "m.mdb", &["db", "report", "m.mdb", "-o", "m.mdb"]);
    spares(
        &folder,
        "m.mdb",
        &["db", "export", "m.mdb", "m.mdb", "--form", "tsv"],
    );
    let motion = ["db", "export", "m.mdb", "m.mdb", "--motion", of_clip];
    spares(&folder, "m.mdb", &motion);
    let reports = ["db", "reports", "m.mdb", "-o", "m.mdb"];
    spares(&folder, "m.mdb", &reports);
    let search = ["db", "search", "m.mdb", of_clip, "--report", "m.mdb"];
    spares(&folder, "m.mdb", &search);
    spares(&folder, "m.mdb", &["train", "--db", "m.mdb", "-o", "m.mdb"]);
    let train = ["train", "--clips", "clips", "--labels", "labels.tsv", "-o"];
    spares(
        &folder,
        "labels.tsv",
        &[&train[..], &["labels.tsv"]].concat(),
    );
    spares(&folder, &clip, &[&train[..], &[&clip]].concat());
    spares(&folder, &clip, &["convert", &clip, "-o", &clip]);
    let plot = ["cut", &clip, "--method", "ppca", "--plot", &clip];
    spares(&folder, &clip, &plot);
    spares(&folder, &clip, &["smooth", &clip, "-o", &clip]);

    folder.train("i.index", &[]).ok();
    spares(
        &folder,
        &clip,
        &["recognize", "i.index", &clip, "-o", &clip],
    );
    let index = ["recognize", "i.index", "clips", "-o", "i.index"];
    spares(&folder, "i.index", &index);
    // By another name of the same file, too.
    std::fs::hard_link(folder.path().join("m.mdb"), folder.path().join("link")).unwrap();
    spares(&folder, "m.mdb", &["db", "report", "m.mdb", "-o", "link"]);
    folder.is_whole("m.mdb");
}

#[test]
fn a_skeleton_is_an_input() {
    let folder = Folder::with(&[("wave.amc", WAVE_AMC), ("arm.asf", ARM_ASF)]);
    spares(
        &folder,
        "arm.asf",
        &["convert", "wave.amc", "-o", "arm.asf"],
    );
}

#[test]
fn another_kind_of_file_is_not_lost() {
    let folder = Folder::with(&[("a.bvh", WAVE_BVH), ("labels", "clip\tclass\na\twave\n")]);
    let ran = folder.morec(&["convert", "a.bvh", "-o", "labels"]);
    assert!(ran.err.contains("labels.old"), "{ran:?}");
    assert_eq!(bytes(&folder, "labels.old"), b"clip\tclass\na\twave\n");
}

#[test]
fn a_folder_is_no_file() {
    let folder = Folder::with(&[("a.bvh", WAVE_BVH), ("out/readme", "")]);
    let ran = folder.morec(&["convert", "a.bvh", "-o", "out"]);
    assert!(
        ran.code == Some(1) && ran.err.contains("found a folder"),
        "{ran:?}"
    );
}

/// A limit on the size of files stands in for a full disk: a write fails in its middle.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_what_was_there() {
    use std::process::Command;
    let folder = Folder::with(&[("a.bvh", WAVE_BVH)]);
    folder
        .morec(&["convert", "a.bvh", "-o", "big.bvh", "--rate", "5000"])
        .ok();
    std::fs::write(folder.path().join("old.bvh"), WAVE_BVH).unwrap();
    for target in ["new.bvh", "old.bvh"] {
        let script = format!(
            "trap '' XFSZ; ulimit -f 2; exec {} convert big.bvh -o {target}",
            env!("CARGO_BIN_EXE_morec")
        );
        let ran = Command::new("sh")
            .args(["-c", &script])
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert_eq!(ran.status.code(), Some(1), "{ran:?}");
    }
    assert_eq!(bytes(&folder, "old.bvh"), WAVE_BVH.as_bytes());
    let mut left: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    left.sort();
    assert_eq!(left, ["a.bvh", "big.bvh", "old.bvh"]);
}

/// A reader that goes away must not cost the report.
#[cfg(unix)]
#[test]
fn a_closed_pipe_does_not_lose_the_report() {
    use std::process::{Command, Stdio};
    let (folder, _) = studio(3);
    let found = "clip\tstart\tstop\tclass\n".to_owned();
    std::fs::write(folder.path().join("found.tsv"), found).unwrap();
    for command in [
        "evaluate --truth labels.tsv --found found.tsv --clips clips --report report/report.html",
        "crossval --clips clips --labels labels.tsv --by half --report report/report.html",
    ] {
        let mut running = Command::new(env!("CARGO_BIN_EXE_morec"))
            .args(command.split(' '))
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // Nobody reads.
        drop(running.stdout.take());
        running.wait().unwrap();
        let report = folder.path().join("report/report.html");
        assert!(report.is_file(), "{command}");
        std::fs::remove_file(report).unwrap();
    }
}

/// Nobody hears what is said, on either stream: what is written is written all the same.
#[cfg(unix)]
#[test]
fn closed_pipes_do_not_end_training() {
    use std::process::{Command, Stdio};
    let (folder, _) = studio(2);
    let mut running = Command::new(env!("CARGO_BIN_EXE_morec"))
        .args(["train", "--clips", "clips", "--labels", "labels.tsv"])
        .args(["--everyday", "never", "-o", "i.index"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop((running.stdout.take(), running.stderr.take()));
    assert_eq!(running.wait().unwrap().code(), Some(0));
    assert!(folder.path().join("i.index").is_file());
}

/// A disk that is full is no reader that has had enough.
#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_is_an_error() {
    use std::process::{Command, Stdio};
    let folder = Folder::with(&[("a.bvh", WAVE_BVH)]);
    let full = std::fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let ran = Command::new(env!("CARGO_BIN_EXE_morec"))
        .args(["inspect", "a.bvh"])
        .current_dir(folder.path())
        .stdout(Stdio::from(full))
        .output()
        .unwrap();
    let said = String::from_utf8(ran.stderr).unwrap();
    assert!(
        ran.status.code() == Some(1) && said.contains("space"),
        "{said}"
    );
}

/// An ending says what a file holds.
#[test]
fn endings_of_other_formats_are_refused() {
    let (folder, takes) = studio(2);
    folder.morec(&["db", "import", "m.mdb", "clips"]).ok();
    folder.morec(&["db", "label", "m.mdb", "labels.tsv"]).ok();
    let clip = format!("clips/{}.bvh", takes[0].clip.name);
    std::fs::write(
        folder.path().join("v1.index"),
        include_bytes!("../../../morec/testdata/index/v1.index"),
    )
    .unwrap();
    for (command, right) in [
        ("train --db m.mdb -o o.fbx", ".index"),
        ("recognize v1.index CLIP -o o.bvh", ".tsv"),
        ("recognize v1.index CLIP --form jsonl -o o.tsv", ".jsonl"),
        ("play CLIP -o o.bvh", ".html"),
        ("db report m.mdb -o o.tsv", ".html"),
        ("db reports m.mdb -o o.tsv", ".json"),
        ("crossval --db m.mdb --by half --report o.JSON", ".html"),
        ("inspect CLIP --draw -o o.png", ".svg"),
        ("convert CLIP -o o.fbx", ".bvh"),
    ] {
        let command = command.replace("CLIP", &clip);
        let ran = folder.morec(&command.split(' ').collect::<Vec<_>>());
        assert!(
            ran.code == Some(1) && ran.err.contains(right),
            "{command}: {ran:?}"
        );
        let left = std::fs::read_dir(folder.path()).unwrap();
        let mut names = left.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        assert!(!names.any(|name| name.starts_with("o.")), "{command}");
    }
}

#[test]
fn a_folder_where_a_file_is_asked_for_is_called_one() {
    let (folder, _) = studio(1);
    for command in [
        "recognize clips clips",
        "live clips --listen json:-",
        "db info clips",
        "train --clips clips --labels labels.tsv --people clips -o i.index",
    ] {
        let ran = folder.morec(&command.split(' ').collect::<Vec<_>>());
        assert!(
            ran.code == Some(1) && ran.err.contains("a folder"),
            "{command}: {ran:?}"
        );
    }
}

#[test]
fn a_class_that_is_not_there_is_named_with_the_nearest() {
    let (folder, _) = studio(1);
    for of in ["--clips clips --labels labels.tsv", "--db m.mdb"] {
        folder.morec(&["db", "import", "m.mdb", "clips"]);
        folder.morec(&["db", "label", "m.mdb", "labels.tsv"]);
        let command = format!("train {of} --classes wvae -o i.index");
        let ran = folder.morec(&command.split(' ').collect::<Vec<_>>());
        assert!(
            ran.code == Some(1) && ran.err.contains("did you mean `wave`?"),
            "{ran:?}"
        );
    }
}

/// Names in files may hold what moves the cursor or changes what a terminal shows.
#[test]
fn control_characters_do_not_reach_the_terminal() {
    let text = WAVE_BVH.replace("lower", "lo\u{9b}31mw\u{7f}er");
    assert_ne!(text, WAVE_BVH);
    let folder = Folder::with(&[("wave\u{1b}[31m.bvh", &text), ("x.bvh", &text)]);
    let missing = "no\u{1b}]0;title\u{7}.bvh";
    for args in [
        &["inspect", "wave\u{1b}[31m.bvh"][..],
        &["inspect", "--full", "x.bvh"],
        &["inspect", missing],
    ] {
        let ran = folder.morec(args);
        for shown in [&ran.out, &ran.err] {
            let raw = shown
                .chars()
                .find(|c| c.is_control() && !matches!(c, '\n' | '\t'));
            assert_eq!(raw, None, "{args:?}: {shown:?}");
        }
        assert!(format!("{}{}", ran.out, ran.err).contains('?'), "{ran:?}");
    }
}
