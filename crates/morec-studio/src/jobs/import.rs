//! Files into the database.

use std::path::{Path, PathBuf};

use morec::files::{FileReader, list};
use morec::progress::Progress;
use morec_db::{ClipUpdate, ImportOutcome, MotionDb};

use super::{JobOutcome, JobProgress};

/// What became of an import.
#[derive(Debug, Clone, Default)]
pub struct ImportSummary {
    /// Files whose clips are in the database now.
    pub imported: usize,
    /// Files that were there already.
    pub known: usize,
    /// Files that were refused, with the reason.
    pub refused: Vec<(PathBuf, String)>,
    /// What was repaired or looks wrong, with its file.
    pub warnings: Vec<(PathBuf, String)>,
    pub cancelled: bool,
}

impl ImportSummary {
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
pub fn import(db: &Path, paths: &[PathBuf], progress: &JobProgress) -> JobOutcome {
    let mut report = ImportSummary::default();
    let mut clips = Vec::new();
    for path in paths {
        match list(std::slice::from_ref(path)) {
            Ok(listing) => {
                clips.extend(listing.clips);
                let left_out = listing.left_out.into_iter();
                let refused = left_out.map(|e| (e.path.clone(), e.kind.to_string()));
                report.refused.extend(refused);
            }
            Err(error) => report.refused.push((path.clone(), error.kind.to_string())),
        }
    }
    let (reader, about) = (FileReader::default(), ClipUpdate::default());
    let imported =
        MotionDb::open(db).and_then(|mut db| db.import(&clips, &reader, &about, progress));
    let done = match imported {
        Ok(done) => done,
        Err(error) => return JobOutcome::Failed(format!("Import stopped: {error}")),
    };
    report.cancelled = done.cancelled || progress.cancelled();
    for (path, outcome) in done.files {
        match outcome {
            ImportOutcome::Imported { warnings, .. } => {
                report.imported += 1;
                let named = warnings.into_iter().map(|w| (path.clone(), w));
                report.warnings.extend(named);
            }
            ImportOutcome::Known | ImportOutcome::Copy { .. } => report.known += 1,
            ImportOutcome::Refused(why) => report.refused.push((path, why.reason)),
        }
    }
    JobOutcome::Imported(report)
}
