//! `morec evaluate` as a person types it.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

const LABELS: &str =
    "clip\tstart\tstop\tclass\na\t30\t60\twave\na\t90\t120\tbow\nelsewhere\t0\t9\twave\n";
const FOUND: &str = "clip\tstart\tstop\tclass\tscore\treported_at\na\t31\t60\twave\t0.9\t66\nrest\t0\t30\tbow\t0.2\t36\n";

/// One joint that never moves, for `frames` frames at 30 Hz.
fn bvh(frames: usize) -> String {
    let head = "HIERARCHY\nROOT hips\n{\n  OFFSET 0 0 0\n  CHANNELS 3 Zrotation Xrotation Yrotation\n  End Site\n  {\n    \
                OFFSET 0 10 0\n  }\n}\nMOTION\n";
    format!(
        "{head}Frames: {frames}\nFrame Time: 0.0333333\n{}",
        "0 0 0\n".repeat(frames)
    )
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    fs::create_dir(folder.path().join("clips")).unwrap();
    write("clips/a.bvh", &bvh(150));
    write("rest.bvh", &bvh(300));
    write("labels.tsv", LABELS);
    write("found.tsv", FOUND);
    folder
}

fn evaluate(folder: &Path, more: &[&str]) -> Output {
    let fixed = [
        "evaluate",
        "--truth",
        "labels.tsv",
        "--found",
        "found.tsv",
        "--clips",
        "clips",
    ];
    Command::new(env!("CARGO_BIN_EXE_morec"))
        .current_dir(folder)
        .args(fixed)
        .args(more)
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

#[test]
fn json_holds_every_measure() {
    let folder = folder();
    let output = evaluate(folder.path(), &["--unknown", "rest.bvh", "--json"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    // wave found, bow missed, three pauses of a second left alone.
    let thesis = &json["thesis"];
    let counts = [
        "true_positives",
        "false_positives",
        "false_negatives",
        "true_negatives",
    ]
    .map(|key| &thesis[key]);
    assert_eq!(counts, [1, 0, 1, 3]);
    assert_eq!(thesis["accuracy"], 0.8);
    let f1: Vec<f64> = json["overlap"]
        .as_array()
        .unwrap()
        .iter()
        .map(|o| o["f1"].as_f64().unwrap())
        .collect();
    assert_eq!(f1, [2.0 / 3.0; 4]);
    assert_eq!(json["false_alarms"]["per_minute"], 0.0);
    assert_eq!(json["unknown"]["unknown_accepted"], 1.0);
    assert!((json["unknown"]["per_minute"].as_f64().unwrap() - 6.0).abs() < 0.01);
    assert!((json["delay"]["median_secs"].as_f64().unwrap() - 0.2).abs() < 1e-3);
    assert!((json["boundaries"]["start_median_secs"].as_f64().unwrap() - 1.0 / 30.0).abs() < 1e-3);
    assert_eq!(json["classification"]["p_r"], 0.5);
    assert_eq!(json["confusion"]["counts"][0], serde_json::json!([0, 0, 1]));
}

#[test]
fn tables_report_and_what_was_left_out() {
    let folder = folder();
    let output = evaluate(folder.path(), &["--report", "out/deep/report.html"]);
    let (printed, said) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{said}");
    // In words first; the measure of 2009 last.
    assert!(printed.contains("1 of 2 samples found, "), "{printed}");
    let place = |what: &str| printed.find(what).unwrap();
    assert!(place("samples found") < place("F1 of events"));
    assert!(place("F1 of events") < place("F1 at half overlap"));
    assert!(place("edit score") < place("thesis accuracy"));
    for line in [
        "thesis accuracy",
        "TP 1  FP 0  FN 1  TN 3",
        "P_R  (rejected)",
        "confusion",
        "2 wave",
    ] {
        assert!(printed.contains(line), "{line} not in\n{printed}");
    }
    assert!(
        said.contains("1 labels are of unknown clips: elsewhere"),
        "{said}"
    );
    assert!(
        said.contains("line 3: 1 detections are of the unknown clip rest"),
        "{said}"
    );
    let report = fs::read_to_string(folder.path().join("out/deep/report.html")).unwrap();
    assert!(report.contains("bow 3.00–4.00 s: missed"));
}

#[test]
fn a_bad_table_names_file_line_and_column() {
    let folder = folder();
    fs::write(
        folder.path().join("labels.tsv"),
        "clip\tstart\tstop\tclass\na\t60\t30\twave\n",
    )
    .unwrap();
    let output = evaluate(folder.path(), &[]);
    assert_eq!(output.status.code(), Some(1));
    let expected = "morec: labels.tsv: line 2, column 6: expected a stop after the start, 60 (stop is exclusive), found `30`\n";
    assert_eq!(text(&output.stderr), expected);
    assert!(output.stdout.is_empty());
}

#[test]
fn a_wrong_command_line_is_exit_code_2() {
    let folder = folder();
    assert_eq!(evaluate(folder.path(), &["--loud"]).status.code(), Some(2));
}

/// A label of a whole clip teaches without its still ends, and so it is measured.
#[test]
fn labels_of_whole_clips_are_measured_as_they_teach() {
    use morec::synth::{Person, Script};

    let folder = tempfile::tempdir().unwrap();
    let person = Person::draw(3, 0);
    let script = Script::new(3, person).rest(2.0).play("wave");
    let take = script.rest_until(8.0).film("wave_1", 30.0).unwrap();
    let mut bytes = Vec::new();
    morec::formats::bvh::write(&take.clip, &mut bytes).unwrap();
    fs::create_dir(folder.path().join("clips")).unwrap();
    fs::write(folder.path().join("clips/wave_1.bvh"), bytes).unwrap();
    fs::write(
        folder.path().join("labels.tsv"),
        "clip\tclass\nwave_1\twave\n",
    )
    .unwrap();
    let span = take.labels[0].span;
    let (start, stop) = (span.start_secs, span.stop_secs);
    let found = format!("clip\tclass\tstart_secs\tstop_secs\nwave_1\twave\t{start}\t{stop}\n");
    fs::write(folder.path().join("found.tsv"), found).unwrap();
    let output = evaluate(folder.path(), &["--json"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("without still ends"));
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    let overlaps = json["overlap"].as_array().unwrap();
    let half = overlaps.iter().find(|o| o["min_iou"] == 0.5).unwrap();
    assert_eq!(half["f1"], 1.0, "{json:#}");
}
