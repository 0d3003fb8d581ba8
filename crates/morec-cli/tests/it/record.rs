//! `morec record` and `morec teach`, before clips and lines in place of a tracker.

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};

use morec::formats::bvh;
use morec::synth::{Person, Script};
use serde_json::Value;

use crate::kit::Folder;

const INDEX: &[u8] = include_bytes!("../../../morec/testdata/index/v1.index");

/// A folder with an index and somebody who performs each of `motions`, one every four seconds, at 60 Hz.
fn folder(motions: &[&str]) -> Folder {
    let folder = Folder::with(&[]);
    std::fs::write(folder.path().join("v1.index"), INDEX).unwrap();
    let mut script = Script::new(8, Person::draw(8, 2));
    for (at, motion) in motions.iter().enumerate() {
        script = script
            .rest(0.5)
            .play(motion)
            .rest_until(4.0 * (at + 1) as f64);
    }
    let take = script.rest(1.0).film("person", 60.0).unwrap();
    let mut bytes = Vec::new();
    bvh::write(&take.clip, &mut bytes).unwrap();
    std::fs::write(folder.path().join("person.bvh"), bytes).unwrap();
    folder
}

fn inspect(folder: &Folder, file: &str) -> Value {
    let out = folder.morec(&["inspect", file, "--json"]).ok();
    let all: Value = serde_json::from_str(&out).unwrap();
    all[0]["clips"][0].clone()
}

#[test]
fn takes_are_numbered_kept_and_not_written_over() {
    let folder = folder(&["wave", "bow"]);
    let record = [
        "record",
        "--listen",
        "clip://person.bvh?speed=0",
        "-o",
        "take.bvh",
    ];
    let more = ["--takes", "2", "--secs", "3", "--count-down", "0.5"];
    let ran = folder.morec(&[&record[..], &more[..]].concat());
    assert_eq!(ran.code, Some(0), "{ran:?}");
    // A bell at the beginning and at the end of each.
    assert_eq!(ran.err.matches('\x07').count(), 4, "{}", ran.err);
    let was = inspect(&folder, "person.bvh");
    for file in ["take_1.bvh", "take_2.bvh"] {
        let take = inspect(&folder, file);
        assert_eq!(
            (take["frames"].as_u64(), take["rate_hz"].as_f64()),
            (Some(181), Some(60.0))
        );
        assert_eq!(take["missing_roles"], was["missing_roles"]);
        assert_eq!(
            take["diagnosis"]["findings"].as_array().map(Vec::len),
            Some(0),
            "{take}"
        );
        let leg = |clip: &Value| clip["leg_length"].as_f64().unwrap();
        assert!((leg(&take) - leg(&was)).abs() < 1e-3);
    }
    let ran = folder.morec(&[&record[..], &more[..]].concat());
    assert_eq!(ran.code, Some(1), "{ran:?}");
    assert!(
        ran.err.contains("take_1.bvh") && ran.err.contains("--overwrite"),
        "{}",
        ran.err
    );
    let ran = folder.morec(&[&record[..], &["--secs", "2", "--no-bell", "--overwrite"]].concat());
    assert!(ran.code == Some(0) && !ran.err.contains('\x07'), "{ran:?}");
}

#[test]
fn lines_of_json_are_what_live_reads_and_become_bvh_and_clips_of_a_database() {
    let folder = folder(&["wave"]);
    let record = ["record", "--count-down", "0", "--no-bell", "--listen"];
    let to = |listen: &str, output: &str, input: Option<&str>| {
        folder.morec_fed(&[&record[..], &[listen, "-o", output]].concat(), input)
    };
    let ran = to("clip://person.bvh?speed=0", "take.jsonl", None);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let frames = inspect(&folder, "person.bvh")["frames"].as_u64().unwrap();
    let ran = folder.morec_fed(
        &["live", "v1.index", "--listen", "json:-"],
        Some("take.jsonl"),
    );
    assert!(
        ran.err.contains(&format!(" {frames} frames,")),
        "{}",
        ran.err
    );
    assert!(!ran.err.contains("malformed"), "{}", ran.err);
    let ran = to("json:-", "take.bvh", Some("take.jsonl"));
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let take = inspect(&folder, "take.bvh");
    assert_eq!(take["frames"].as_u64(), Some(frames));
    assert_eq!(take["missing_roles"].as_array().map(Vec::len), Some(0));
    for (n, secs) in [(1, "3"), (2, "2"), (3, "2")] {
        let listen = [
            "clip://person.bvh?speed=0",
            "--secs",
            secs,
            "-o",
            "moves.mdb",
        ];
        let ran = folder.morec(&[&record[..], &listen[..]].concat());
        assert_eq!(ran.code, Some(0), "{ran:?}");
        let file = folder.path().join(format!("moves.takes/take_00{n}.bvh"));
        assert!(file.is_file());
        // The third is the second over again.
        assert_eq!(
            ran.err.contains("the same take already"),
            n == 3,
            "{}",
            ran.err
        );
    }
    let clips = folder.morec(&["db", "clips", "moves.mdb"]).ok();
    assert!(
        clips.contains("take_001") && clips.contains("take_002"),
        "{clips}"
    );
    let tagged = [
        "clip://person.bvh?speed=0",
        "--secs",
        "4",
        "--tag",
        "background",
        "-o",
    ];
    let ran = folder.morec(&[&record[..], &tagged[..], &["moves.mdb"]].concat());
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let clips = folder.morec(&["db", "clips", "moves.mdb", "--tag", "background"]);
    let clips = clips.ok();
    assert!(
        clips.contains("take_004") && !clips.contains("take_001"),
        "{clips}"
    );
    let ran = folder.morec(&[&record[..], &tagged[..], &["other.bvh"]].concat());
    assert_eq!(ran.code, Some(1), "{ran:?}");
    assert!(ran.err.contains("tags need a database"), "{ran:?}");
    assert!(!folder.path().join("other.bvh").exists());
}

#[test]
fn what_cannot_be_recorded_says_why() {
    let folder = folder(&["wave"]);
    for (args, said) in [
        (
            ["clip://person.bvh?speed=0", "take.fbx"],
            "ends in .bvh, .jsonl or .mdb",
        ),
        (["json:-", "take.bvh"], "nothing was recorded"),
        (["clip://absent.bvh", "take.bvh"], "absent.bvh"),
    ] {
        let ran = folder.morec(&[
            "record",
            "--count-down",
            "0",
            "--listen",
            args[0],
            "-o",
            args[1],
        ]);
        assert_eq!(ran.code, Some(1), "{ran:?}");
        assert!(ran.err.contains(said), "{}", ran.err);
        assert!(!folder.path().join(args[1]).exists());
    }
}

/// Runs a command that does not end by itself, waits until it has said `go!`, interrupts it as Ctrl-C would, and
/// returns what else it said.
#[cfg(unix)]
fn interrupted(folder: &Folder, args: &[&str]) -> String {
    let mut child = Command::new(env!("CARGO_BIN_EXE_morec"))
        .args(args)
        .current_dir(folder.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut err = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("go!") {
        line.clear();
        assert!(
            err.read_line(&mut line).unwrap() > 0,
            "it ended before it began"
        );
    }
    // Some of the stream must come; how much does not matter.
    std::thread::sleep(std::time::Duration::from_secs(2));
    let done = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(done.success());
    let mut said = String::new();
    err.read_to_string(&mut said).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0), "{said}");
    said
}

#[test]
#[cfg(unix)]
fn ctrl_c_loses_nothing_that_was_recorded() {
    let folder = folder(&["wave"]);
    let listen = ["--listen", "clip://person.bvh?loop", "--count-down", "0"];
    let said = interrupted(
        &folder,
        &[&["record", "-o", "take.bvh"], &listen[..]].concat(),
    );
    assert!(said.contains("take.bvh: "), "{said}");
    assert!(inspect(&folder, "take.bvh")["frames"].as_u64() > Some(15));
    // The first repetition ends after half a second, the second is cut off by Ctrl-C.
    let teach = [
        "teach",
        "new.index",
        "--name",
        "wave",
        "--secs",
        "0.5",
        "--repetitions",
        "99",
    ];
    let said = interrupted(&folder, &[&teach[..], &listen[..]].concat());
    assert!(said.contains("new.takes"), "{said}");
    let labels = std::fs::read_to_string(folder.path().join("new.takes/labels.tsv")).unwrap();
    assert!(
        labels.starts_with("clip\tclass\nwave_001\twave\n"),
        "{labels}"
    );
    for row in labels.lines().skip(1) {
        let clip = row.split('\t').next().unwrap();
        assert!(
            folder
                .path()
                .join(format!("new.takes/{clip}.bvh"))
                .is_file()
        );
    }
}

#[test]
fn a_gesture_that_was_taught_is_recognised_at_once_and_beside_those_taught_later() {
    let folder = folder(&["wave", "wave", "wave", "wave", "bow", "wave"]);
    let teach = [
        "teach",
        "new.index",
        "--secs",
        "4",
        "--count-down",
        "0",
        "--no-bell",
        "--emit",
        "json:-",
    ];
    let listen = ["--listen", "clip://person.bvh?speed=0", "--name"];
    let ran = folder.morec(&[&teach[..], &listen[..], &["wave"]].concat());
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(ran.err.contains("new.index knows wave (3)"), "{}", ran.err);
    let ends: Vec<Value> = ran
        .out
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap())
        .filter(|event| event["phase"] == "end")
        .collect();
    assert!(
        ends.iter().any(|event| event["class"] == "wave"),
        "{}\n{}",
        ran.out,
        ran.err
    );

    // Another gesture, taught another day by another clip.
    let other = self::folder(&["bow", "bow", "bow", "bow", "wave"]);
    std::fs::copy(
        other.path().join("person.bvh"),
        folder.path().join("person.bvh"),
    )
    .unwrap();
    let ran = folder.morec(&[&teach[..], &listen[..], &["bow"]].concat());
    assert!(
        ran.err.contains("new.index knows bow (3), wave (3)"),
        "{}",
        ran.err
    );
    let names: Vec<String> = ran
        .out
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap())
        .filter(|event| event["phase"] == "end")
        .map(|event| event["class"].as_str().unwrap().to_owned())
        .collect();
    assert!(
        names.contains(&"bow".to_owned()) && names.contains(&"wave".to_owned()),
        "{names:?}"
    );

    // The takes are clips like any other.
    let takes = [
        "--clips",
        "new.takes",
        "--labels",
        "new.takes/labels.tsv",
        "-o",
        "again.index",
    ];
    folder.morec(&[&["train"], &takes[..]].concat()).ok();
    // And an index that was made otherwise is not taught over.
    let ran = folder.morec(&[&["teach", "v1.index", "--name", "x"], &listen[..2]].concat());
    assert_eq!(ran.code, Some(1), "{ran:?}");
    assert!(
        ran.err
            .contains("v1.index: this index was trained on clips"),
        "{}",
        ran.err
    );
}

#[test]
fn live_says_what_is_wrong_with_a_stream_and_with_its_lines() {
    let folder = folder(&["wave"]);
    let record = [
        "record",
        "--count-down",
        "0",
        "--listen",
        "clip://person.bvh?speed=0",
        "-o",
        "take.jsonl",
    ];
    folder.morec(&record).ok();
    let lines = std::fs::read_to_string(folder.path().join("take.jsonl")).unwrap();
    let milliseconds: String = lines
        .lines()
        .map(|line| {
            let mut line: Value = serde_json::from_str(line).unwrap();
            line["t"] = Value::from(line["t"].as_f64().unwrap() * 1e3);
            format!("{line}\n")
        })
        .collect();
    let live = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).unwrap();
        let ran = folder.morec_fed(&["live", "v1.index", "--listen", "json:-"], Some(name));
        assert_eq!(ran.code, Some(0), "{ran:?}");
        ran.err
    };
    let said = live("ms.jsonl", &milliseconds);
    assert!(
        said.contains(
            "error: frames are 16.7 s apart by their times, which look like milliseconds"
        ),
        "{said}"
    );
    let swapped = lines
        .replace("left_", "L_")
        .replace("right_", "left_")
        .replace("L_", "right_");
    let said = live("swapped.jsonl", &swapped);
    assert!(
        said.contains("error: knees and arms bend backwards"),
        "{said}"
    );
    let said = live(
        "wrong.jsonl",
        &format!("\n{{\"t\": 1, \"positions\": {{\"paw\": [0,0,0]}}}}\nhello\n{lines}"),
    );
    assert!(
        said.contains(
            "json:-: line 2: positions.paw: no body part is called paw; the names are hips"
        ),
        "{said}"
    );
    assert!(
        said.contains("json:-: line 3: column 1: invalid JSON"),
        "{said}"
    );
    assert!(said.contains(" 2 malformed packets"), "{said}");
    let said = live("empty.jsonl", "");
    assert!(said.contains("nothing has arrived"), "{said}");
    let help = folder.morec(&["live", "--help-all"]).ok();
    let help = Vec::from_iter(help.split_whitespace()).join(" ");
    for part in [
        "hips, torso, neck, head",
        "thigh, shin, foot, shoulder, arm",
        "forearm, hand",
    ] {
        assert!(help.contains(part), "{part}: {help}");
    }
}
