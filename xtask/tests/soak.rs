//! `cargo xtask soak` on a clip of some seconds.

use std::process::{Command, Output};

use morec::formats::bvh;
use morec::synth::{Person, Script};
use tempfile::TempDir;

const TEMPLATES: &[u8] = include_bytes!("../../crates/morec/testdata/index/v1.index");
const SVRDM: &[u8] = include_bytes!("../../crates/morec/testdata/index/svrdm_v1.index");

/// A folder with an index of each method and a person who moves.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    let take = Script::new(5, Person::draw(5, 0))
        .rest(1.0)
        .play("wave")
        .rest(0.5)
        .film("person", 60.0)
        .unwrap();
    let mut bytes = Vec::new();
    bvh::write(&take.clip, &mut bytes).unwrap();
    for (name, bytes) in [
        ("templates.index", TEMPLATES),
        ("svrdm.index", SVRDM),
        ("person.bvh", &bytes),
    ] {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

fn soak(folder: &TempDir, index: &str, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xtask"))
        .args(["soak", index, "person.bvh"])
        .args(more)
        .current_dir(folder.path())
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout.clone()).unwrap()
}

#[test]
fn every_lap_finds_the_same() {
    let folder = folder();
    let out = said(&soak(&folder, "templates.index", &["--hours", "0.02"]));
    assert!(out.contains("every lap found the same"), "{out}");
    assert!(out.contains("processing of one frame"), "{out}");
    let stages = ["--hours", "0.01", "--layout", "stages"];
    let out = said(&soak(&folder, "svrdm.index", &stages));
    assert!(out.contains("every lap found the same"), "{out}");
}

#[test]
fn layouts_are_compared_and_templates_have_one() {
    let folder = folder();
    let both = ["--layout", "both", "--for", "1"];
    let out = said(&soak(&folder, "svrdm.index", &both));
    assert!(out.contains("stages to inline"), "{out}");
    let refused = soak(&folder, "templates.index", &["--layout", "stages"]);
    let err = String::from_utf8_lossy(&refused.stderr);
    assert!(!refused.status.success(), "{err}");
    assert!(err.contains("expected an index of method svrdm"), "{err}");
}
