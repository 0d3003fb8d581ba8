//! A stretch of a live stream becomes a clip of the database, with a label or as background.

use std::path::{Path, PathBuf};

use morec::TimeSpan;
use morec::files::FileReader;
use morec::formats::bvh;
use morec::import::ImportOptions;
use morec::live::Recording;
use morec_db::labels::{LabelOptions, NewSample};
use morec_db::{BACKGROUND, ClipId, ClipUpdate, ImportOutcome, MotionDb};

use super::progress::JobError;
use crate::store::{BY, DbPlace, background};

/// A stretch that was kept.
#[derive(Debug, Clone)]
pub struct Taught {
    pub name: String,
    pub secs: f64,
    pub clip: ClipId,
    /// What it was marked as; `None` for a take.
    pub meaning: Option<Meaning>,
}

/// What a stretch of motion is said to be.
#[derive(Debug, Clone, PartialEq)]
pub enum Meaning {
    /// A sample of a class.
    Class(String),
    /// None of the classes.
    Background,
}

impl Meaning {
    /// The class, or the word for none.
    pub fn name(&self) -> &str {
        match self {
            Meaning::Class(class) => class,
            Meaning::Background => BACKGROUND,
        }
    }

    /// True if the same motion cannot be both: as background it would teach what its class is not.
    pub fn contradicts(&self, other: &Meaning) -> bool {
        (*self == Meaning::Background) != (*other == Meaning::Background)
    }
}

/// A stretch to keep.
pub struct Lesson {
    /// The motion, with what came before and after it.
    pub recording: Recording,
    /// `None` for a take, of which nothing is said.
    pub meaning: Option<Meaning>,
    /// Start and stop of the marked stretch in the recording, seconds.
    pub extent: TimeSpan,
    /// Beginning of the new clip's name.
    pub name: String,
    /// Who labels it.
    pub annotator: Option<String>,
}

/// Keeps a lesson in the database at `db`; its file lies in `folder` for as long as that takes.
pub fn teach(db: &DbPlace, folder: &Path, lesson: &Lesson) -> Result<Taught, JobError> {
    taught(db, folder, lesson).map_err(|why| JobError::Failed(format!("Not kept: {why}")))
}

fn taught(place: &DbPlace, folder: &Path, lesson: &Lesson) -> Result<Taught, String> {
    let mut db = place.open().map_err(|e| e.to_string())?;
    let name = free_name(&db, &lesson.name);
    let clip = lesson.recording.to_clip(&name).map_err(|e| e.to_string())?;
    let secs = clip.duration_secs();
    let file: PathBuf = folder.join(format!("{name}.bvh"));
    let mut bytes = Vec::new();
    bvh::write(&clip, &mut bytes).map_err(|e| e.to_string())?;
    std::fs::write(&file, bytes)
        .map_err(|e| format!("{}: {e}", crate::format::file_name(&file)))?;
    let about = match lesson.meaning {
        Some(Meaning::Background) => background(true),
        _ => ClipUpdate::default(),
    };
    let reader = FileReader {
        import: ImportOptions {
            mapping: lesson.recording.mapping(&clip),
            ..ImportOptions::default()
        },
        ..FileReader::default()
    };
    let report = db.import(std::slice::from_ref(&file), &reader, &about, &());
    // It is in the database, or it never was a clip.
    let _ = std::fs::remove_file(&file);
    let report = report.map_err(|e| e.to_string())?;
    let name = match report.files.into_iter().next().map(|(_, outcome)| outcome) {
        Some(ImportOutcome::Imported { clips, .. }) => clips.into_iter().next().unwrap_or(name),
        Some(ImportOutcome::Refused(why)) => return Err(why.reason),
        _ => return Err("the same motion is in the database already".to_owned()),
    };
    let id = db.find_clip(&name).map_err(|e| e.to_string())?.id;
    if let Some(Meaning::Class(class)) = &lesson.meaning {
        let sample = NewSample::accepted(
            id,
            class,
            TimeSpan::new(
                lesson.extent.start_secs.max(0.0),
                lesson.extent.stop_secs.min(secs),
            ),
        );
        let options = LabelOptions {
            by: BY.to_owned(),
            annotators: vec![lesson.annotator.clone()],
            ..LabelOptions::default()
        };
        db.label(&[sample], &options).map_err(|e| e.to_string())?;
    }
    Ok(Taught {
        name,
        secs,
        clip: id,
        meaning: lesson.meaning.clone(),
    })
}

/// A clip's name that is not there yet.
fn free_name(db: &MotionDb, stem: &str) -> String {
    (1..)
        .map(|n| format!("{stem}_{n:03}"))
        .find(|name| db.find_clip(name).is_err())
        .unwrap_or_default()
}
