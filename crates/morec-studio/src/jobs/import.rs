//! Files into the database.

use std::path::{Path, PathBuf};

use morec::formats::probe::{Format, format_of_name, probe};
use morec::progress::Progress;
use morec_db::{FileReader, ImportSettings, MotionDb, Outcome as FileOutcome};

use super::{JobProgress, Outcome};

/// What became of an import.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// Files whose clips are in the database now.
    pub imported: usize,
    /// Files that were there already.
    pub known: usize,
    /// Files that were refused, with the reason.
    pub refused: Vec<(PathBuf, String)>,
    /// What was repaired or looks wrong, with its file.
    pub warnings: Vec<(PathBuf, String)>,
    pub cancelled: bool,
    /// Name of the first clip that came.
    pub first: Option<String>,
}

impl Report {
    /// What it did, in a sentence.
    pub fn said(&self) -> String {
        let mut parts = vec![files(self.imported, "imported")];
        if self.known > 0 {
            parts.push(format!("{} known already", self.known));
        }
        if !self.refused.is_empty() {
            parts.push(format!("{} refused", self.refused.len()));
        }
        if self.cancelled {
            parts.push("stopped before the end".to_owned());
        }
        parts.join(", ")
    }
}

fn files(n: usize, what: &str) -> String {
    match n {
        1 => format!("1 file {what}"),
        n => format!("{n} files {what}"),
    }
}

/// Imports files, and those in folders, into the database at `db`.
pub fn import(db: &Path, paths: &[PathBuf], progress: &JobProgress) -> Outcome {
    let mut report = Report::default();
    let mut clips = Vec::new();
    for path in paths {
        collect(path, true, &mut clips, &mut report);
    }
    let imported = MotionDb::open(db).and_then(|mut db| {
        db.import(
            &clips,
            &FileReader::default(),
            &ImportSettings::default(),
            progress,
        )
    });
    let done = match imported {
        Ok(done) => done,
        Err(error) => return Outcome::Failed(format!("Import stopped: {error}")),
    };
    report.cancelled = done.cancelled || progress.cancelled();
    for (path, outcome) in done.files {
        match outcome {
            FileOutcome::Imported { clips, warnings } => {
                report.imported += 1;
                report.first = report.first.take().or(clips.first().cloned());
                let named = warnings.into_iter().map(|w| (path.clone(), w));
                report.warnings.extend(named);
            }
            FileOutcome::Known | FileOutcome::Copy { .. } => report.known += 1,
            FileOutcome::Refused(why) => report.refused.push((path, why.reason)),
        }
    }
    Outcome::Imported(report)
}

/// The clips that a path stands for. What is named itself is tried; what lies in a folder must look like motion.
fn collect(path: &Path, named: bool, clips: &mut Vec<PathBuf>, report: &mut Report) {
    if !path.is_dir() {
        if named || looks_like_motion(path) {
            clips.push(path.to_owned());
        }
        return;
    }
    let entries = match std::fs::read_dir(path) {
        Ok(entries) => entries,
        Err(error) => {
            report.refused.push((path.to_owned(), error.to_string()));
            return;
        }
    };
    let mut inside: Vec<PathBuf> = entries
        .flatten()
        // A link to a folder could lead back here.
        .filter(|e| !e.path().is_dir() || e.file_type().is_ok_and(|t| t.is_dir()))
        .map(|e| e.path())
        .collect();
    inside.sort();
    inside
        .iter()
        .for_each(|path| collect(path, false, clips, report));
}

fn looks_like_motion(path: &Path) -> bool {
    const HEAD: u64 = 64 * 1024;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if name.starts_with('.') {
        return false;
    }
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    if ["zip", "gz"].iter().any(|known| ending == *known) {
        return true;
    }
    match format_of_name(&name) {
        Some(Format::Asf) => false,
        Some(Format::Table | Format::Jsonl) | None => {
            use std::io::Read;
            let mut head = Vec::new();
            let read = std::fs::File::open(path).and_then(|f| f.take(HEAD).read_to_end(&mut head));
            read.is_ok() && probe(&head, "").is_ok_and(|format| format != Format::Asf)
        }
        Some(_) => true,
    }
}
