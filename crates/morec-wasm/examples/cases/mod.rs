//! What `examples/conformance.rs` writes and other platforms are held to.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use morec::files::FileReader;
use morec::live::{PerformerStream, StreamOptions};
use morec::roles::Role;
use morec::{ImportOptions, KeyPose, MotionIndex, Take};
use morec_wasm::DetectionRow;
use serde::{Deserialize, Serialize};

pub type Outcome<T> = Result<T, Box<dyn Error>>;

/// What both sides do: learn from some files, recognise others.
#[derive(Serialize, Deserialize)]
pub struct Case {
    pub name: String,
    /// Table of labels.
    pub labels: String,
    pub learn: Vec<PathBuf>,
    pub recognise: Vec<PathBuf>,
    /// For each file in `recognise`.
    pub detections: Vec<serde_json::Value>,
    /// Microseconds a push of their frames.
    pub push_us: f64,
}

impl Case {
    /// Nothing is found yet.
    pub fn new(name: &str, labels: String, learn: Vec<PathBuf>, recognise: Vec<PathBuf>) -> Self {
        Self {
            name: name.to_owned(),
            labels,
            learn,
            recognise,
            detections: Vec::new(),
            push_us: 0.0,
        }
    }

    /// Where its index is.
    pub fn index_file(&self, folder: &Path) -> PathBuf {
        folder.join(format!("{}.index", self.name))
    }

    /// What `index` finds, for each take to recognise.
    pub fn found_by(&self, index: &MotionIndex) -> Outcome<Vec<serde_json::Value>> {
        let mut all = Vec::new();
        for take in takes(&self.recognise)? {
            let found = index.recognize(&take)?;
            let rows: Vec<DetectionRow<'_>> = found.iter().map(DetectionRow::from).collect();
            all.push(serde_json::to_value(rows)?);
        }
        Ok(all)
    }

    /// Microseconds a push, over all frames.
    pub fn push_us_of(&self, index: &Arc<MotionIndex>) -> Outcome<f64> {
        let (mut secs, mut frames) = (0.0, 0);
        for take in takes(&self.recognise)? {
            secs += push_secs(index, &take)?;
            frames += take.clip.frames;
        }
        Ok(1e6 * secs / frames as f64)
    }
}

/// Seconds that pushing every pose of `take` takes, as the package pushes it.
fn push_secs(index: &Arc<MotionIndex>, take: &Take) -> Outcome<f64> {
    let points = Role::ALL.map(Role::name);
    let mut stream = PerformerStream::of_points(index, &points, &StreamOptions::default())?;
    let poses = take.poses();
    let begun = Instant::now();
    for (time_secs, pose) in &poses {
        fill(stream.values(), pose);
        stream.push_values(*time_secs, *time_secs);
    }
    Ok(begun.elapsed().as_secs_f64())
}

fn fill(values: &mut [f64], pose: &KeyPose) {
    for (at, role) in values.chunks_exact_mut(3).zip(Role::ALL) {
        let known = pose.get(role).map(|p| [p.x, p.y, p.z]);
        at.copy_from_slice(&known.unwrap_or([f64::NAN; 3]));
    }
}

/// What is in `files`.
pub fn takes(files: &[PathBuf]) -> Outcome<Vec<Take>> {
    let mut takes = Vec::new();
    for path in files {
        let parsed = FileReader::default().parse(path, &fs::read(path)?)?;
        takes.extend(parsed.into_takes(&ImportOptions::default())?);
    }
    Ok(takes)
}
