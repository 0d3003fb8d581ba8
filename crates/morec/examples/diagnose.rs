//! Findings of the diagnosis in real clips: `cargo run --release -p morec --example diagnose -- FOLDER…`.
//!
//! One line for each clip with a finding, then how many clips had which. The clips of the project's data folder are
//! recordings of people by calibrated devices: a warning or an error there is a false one.

#![allow(clippy::print_stdout)]

use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};

use morec::diagnosis::{Diagnosis, Severity, diagnose_clip};
use morec::formats::Limits;
use morec::formats::bvh::{self, BvhOptions};
use morec::import::{ImportOptions, normalize};

fn main() -> Result<(), Box<dyn Error>> {
    let folders: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    for folder in &folders {
        let mut counts = BTreeMap::<(Severity, &str), usize>::new();
        let mut clips = 0;
        for path in files(folder)? {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            let parsed = bvh::read(
                &std::fs::read(&path)?,
                &name,
                &BvhOptions::default(),
                &Limits::default(),
            )?;
            for clip in parsed.clips {
                let imported = normalize(clip, &ImportOptions::default())?;
                let rest = &imported.report.rest_frames;
                let diagnosis = diagnose_clip(&imported.clip, &imported.roles, rest);
                clips += 1;
                for finding in diagnosis.findings().iter() {
                    *counts
                        .entry((finding.severity(), finding.label()))
                        .or_default() += 1;
                }
                show(&path, &diagnosis);
            }
        }
        println!("{}: {clips} clips", folder.display());
        for ((severity, label), count) in counts {
            println!("  {severity}: {label}: {count}");
        }
    }
    Ok(())
}

fn show(path: &Path, diagnosis: &Diagnosis) {
    let labels: Vec<&str> = diagnosis.findings().iter().map(|f| f.label()).collect();
    let sides = diagnosis.sides;
    println!(
        "{}\t{}\t{diagnosis}\tsides {:+.3} (knees {:+.3} elbows {:+.3} hands {:+.3}) tilt {:.1} stands {} still {:.2} standing {:.2} hips {:.4} hands {:.3} spikes {:.4} noise {:.4}",
        path.file_stem().unwrap_or_default().to_string_lossy(),
        labels.join(", "),
        sides.sum().unwrap_or(f64::NAN),
        sides.knees.unwrap_or(f64::NAN),
        sides.elbows.unwrap_or(f64::NAN),
        sides.hands.unwrap_or(f64::NAN),
        diagnosis.tilt_rad.unwrap_or(f64::NAN).to_degrees(),
        diagnosis.stands,
        diagnosis.still_secs,
        diagnosis.standing_share.unwrap_or(f64::NAN),
        diagnosis.hips_m.unwrap_or(f64::NAN),
        diagnosis.hands_m.unwrap_or(f64::NAN),
        diagnosis.spike_share,
        diagnosis.noise_m.unwrap_or(f64::NAN),
    );
}

fn files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut found: Vec<PathBuf> = std::fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    found.retain(|path| path.extension().is_some_and(|ext| ext == "bvh"));
    found.sort();
    Ok(found)
}
