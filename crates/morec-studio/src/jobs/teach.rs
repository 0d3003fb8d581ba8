//! A stretch of a live stream becomes a clip of the database, with a label if it has one.

use std::path::{Path, PathBuf};

use morec::files::FileReader;
use morec::formats::bvh;
use morec::live::Recording;
use morec_db::labels::{LabelOptions, NewSample, SampleState};
use morec_db::{ClipUpdate, ImportOutcome, MotionDb};

use super::progress::JobError;
use crate::store::BY;

/// A stretch that was kept.
#[derive(Debug, Clone)]
pub struct Taught {
    pub name: String,
    pub secs: f64,
    /// The class it was marked as.
    pub class: Option<String>,
}

/// A stretch to keep.
pub struct Lesson {
    /// The motion, with what came before and after it.
    pub recording: Recording,
    /// Its class, start and stop in the recording, seconds.
    pub label: Option<(String, f64, f64)>,
    /// Beginning of the new clip's name.
    pub name: String,
}

/// Keeps a lesson in the database at `db`; its file lies in `folder` for as long as that takes.
pub fn teach(db: &Path, folder: &Path, lesson: &Lesson) -> Result<Taught, JobError> {
    taught(db, folder, lesson).map_err(|why| JobError::Failed(format!("Not kept: {why}")))
}

fn taught(path: &Path, folder: &Path, lesson: &Lesson) -> Result<Taught, String> {
    let mut db = MotionDb::open(path).map_err(|e| e.to_string())?;
    let name = free_name(&db, &lesson.name);
    let clip = lesson.recording.to_clip(&name).map_err(|e| e.to_string())?;
    let secs = clip.duration_secs();
    let file: PathBuf = folder.join(format!("{name}.bvh"));
    let mut bytes = Vec::new();
    bvh::write(&clip, &mut bytes).map_err(|e| e.to_string())?;
    std::fs::write(&file, bytes)
        .map_err(|e| format!("{}: {e}", crate::format::file_name(&file)))?;
    let report = db.import(
        std::slice::from_ref(&file),
        &FileReader::default(),
        &ClipUpdate::default(),
        &(),
    );
    // It is in the database, or it never was a clip.
    let _ = std::fs::remove_file(&file);
    let report = report.map_err(|e| e.to_string())?;
    let name = match report.files.into_iter().next().map(|(_, outcome)| outcome) {
        Some(ImportOutcome::Imported { clips, .. }) => clips.into_iter().next().unwrap_or(name),
        Some(ImportOutcome::Refused(why)) => return Err(why.reason),
        _ => return Err("the same motion is in the database already".to_owned()),
    };
    let id = db.find_clip(&name).map_err(|e| e.to_string())?.id;
    if let Some((class, start, stop)) = &lesson.label {
        let sample = NewSample {
            clip: id,
            class: class.clone(),
            start_secs: start.max(0.0),
            stop_secs: stop.min(secs),
            whole_clip: false,
            state: SampleState::Accepted,
            score: None,
        };
        let options = LabelOptions {
            by: BY.to_owned(),
            ..LabelOptions::default()
        };
        db.label(&[sample], &options).map_err(|e| e.to_string())?;
    }
    Ok(Taught {
        name,
        secs,
        class: lesson.label.as_ref().map(|l| l.0.clone()),
    })
}

/// A clip's name that is not there yet.
fn free_name(db: &MotionDb, stem: &str) -> String {
    (1..)
        .map(|n| format!("{stem}_{n:03}"))
        .find(|name| db.find_clip(name).is_err())
        .unwrap_or_default()
}
