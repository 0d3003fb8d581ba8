//! The native half of `tests/conformance.test.mjs` and of `.ci/platforms`: writes clips and labels of a few cases into a folder,
//! what native morec learns and finds in them, and how long it takes.
//!
//!     cargo run --release -p morec-wasm --example conformance -- target/wasm/cases

#[path = "cases/mod.rs"]
mod cases;

use std::fs;
use std::path::{Path, PathBuf};

use morec::formats::bvh;
use morec::synth::{DatabaseSpec, database};
use morec::{Labels, Trainer};

use cases::{Case, Outcome, takes};

fn main() -> Outcome<()> {
    let folder = std::env::args_os().nth(1).ok_or("expected a folder")?;
    let folder = fs::create_dir_all(&folder).and_then(|()| fs::canonicalize(&folder))?;
    let mut cases = vec![synthetic(&folder)?];
    let data = std::env::var_os("MOREC_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"),
        PathBuf::from,
    );
    if data.join("sessions").is_dir() {
        cases.push(real(&data)?);
    }
    for case in &mut cases {
        finish(case, &folder)?;
    }
    fs::write(folder.join("cases.json"), serde_json::to_vec(&cases)?)?;
    Ok(())
}

/// Synthetic people: three teach, one performs.
fn synthetic(folder: &Path) -> Outcome<Case> {
    let spec = DatabaseSpec {
        people: 4,
        repetitions: 2,
        ..DatabaseSpec::default()
    };
    let mut labels = "clip\tclass\tstart_secs\tstop_secs\n".to_owned();
    let mut files = Vec::new();
    for person in database(7, &spec) {
        let path = folder.join(format!("{}.bvh", person.clip.name));
        let mut bytes = Vec::new();
        bvh::write(&person.clip, &mut bytes)?;
        fs::write(&path, bytes)?;
        for l in &person.labels {
            let (name, class) = (&person.clip.name, l.class);
            labels += &format!(
                "{name}\t{class}\t{}\t{}\n",
                l.span.start_secs, l.span.stop_secs
            );
        }
        files.push(path);
    }
    let recognise = files.split_off(3);
    // Training refuses labels of clips that it is not given.
    let known = |line: &&str| !line.starts_with(&*stem(&recognise[0]));
    let labels = labels
        .lines()
        .filter(known)
        .map(|line| format!("{line}\n"))
        .collect();
    Ok(Case::new("synthetic", labels, files, recognise))
}

/// One real person teaches every gesture twice; all people's sessions are recognised.
fn real(data: &Path) -> Outcome<Case> {
    let teach = fs::read_to_string(data.join("sessions/teach.tsv"))?;
    let mut lines = teach.lines();
    let mut labels = format!("{}\n", lines.next().unwrap_or_default());
    let person = |line: &str| line.rsplit('\t').next().unwrap_or_default().to_owned();
    let mut learn = Vec::new();
    let mut first = None;
    for line in lines {
        if *first.get_or_insert_with(|| person(line)) == person(line) {
            let clip = line.split('\t').next().unwrap_or_default();
            learn.push(data.join(format!("gestures/clips/{clip}.bvh")));
            labels += &format!("{line}\n");
        }
    }
    let mut recognise: Vec<PathBuf> = fs::read_dir(data.join("sessions/clips"))?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|e| e == "bvh"))
        .collect();
    recognise.sort();
    Ok(Case::new("sessions", labels, learn, recognise))
}

/// Writes the index and what it finds.
fn finish(case: &mut Case, folder: &Path) -> Outcome<()> {
    let labels = Labels::read(case.labels.as_bytes())?;
    let index = Trainer::new().labels(&labels).train(&takes(&case.learn)?)?;
    fs::write(case.index_file(folder), index.to_bytes()?)?;
    case.detections = case.found_by(&index)?;
    case.push_us = case.push_us_of(&index.into())?;
    Ok(())
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}
