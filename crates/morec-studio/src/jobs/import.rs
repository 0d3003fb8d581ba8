//! Files into the database.

use std::collections::BTreeSet;
use std::path::PathBuf;

use morec::files::{FileReader, list};
use morec::progress::Progress;
use morec_db::{ClipFilter, ClipInfo, ImportOutcome};
use morec_ops::{CopiedClip, ImportSettings};

use super::label_files::{beside, is_labels};
use super::progress::{JobError, JobProgress};
use crate::format;
use crate::store::DbPlace;
use crate::stretch::Stretch;

/// Result of an import.
#[derive(Debug, Clone, Default)]
pub struct ImportSummary {
    /// Files whose clips are in the database now.
    pub imported: usize,
    /// Names of their clips.
    pub clips: BTreeSet<String>,
    /// Files that were there already.
    pub known: usize,
    /// Files that were refused, with the reason.
    pub refused: Vec<(PathBuf, String)>,
    /// Repairs and doubts, with their files.
    pub warnings: Vec<(PathBuf, String)>,
    /// Clips that are nearly others.
    pub copies: Vec<CopiedStretch>,
    pub cancelled: bool,
    /// Files of labels among what was named, and those beside it that name clips of the database.
    pub labels: Vec<PathBuf>,
    pub beside: Vec<PathBuf>,
}

/// A clip that has come and is nearly another.
#[derive(Debug, Clone)]
pub struct CopiedStretch {
    pub copy: Stretch,
    pub of: Stretch,
    pub mirrored: bool,
    /// In a sentence.
    pub text: String,
}

impl ImportSummary {
    /// True if there is more to say than the number of files.
    pub fn says_anything(&self) -> bool {
        self.cancelled
            || !self.refused.is_empty()
            || !self.warnings.is_empty()
            || !self.copies.is_empty()
            || !self.labels.is_empty()
            || !self.beside.is_empty()
    }

    /// Summary in a sentence.
    pub fn said(&self) -> String {
        let mut parts = vec![files(self.imported, "imported")];
        if self.known > 0 {
            parts.push(format!("{} known already", self.known));
        }
        if !self.refused.is_empty() {
            parts.push(format!("{} refused", self.refused.len()));
        }
        if !self.copies.is_empty() {
            parts.push(format::count(self.copies.len(), "near-duplicate"));
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

/// Imports files, and those in folders, into the database `db`.
pub fn import(
    db: &DbPlace,
    paths: &[PathBuf],
    progress: &JobProgress,
) -> Result<ImportSummary, JobError> {
    let mut report = ImportSummary::default();
    let mut clips = Vec::new();
    let (labels, paths): (Vec<PathBuf>, Vec<PathBuf>) =
        paths.iter().cloned().partition(|path| is_labels(path));
    report.labels = labels;
    for path in &paths {
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
    let imported = db.open().and_then(|mut db| {
        let settings = ImportSettings::default();
        let done = settings.run(&mut db, &clips, &FileReader::default(), progress)?;
        progress.report("looking for labels", 0, 0);
        let infos = db.clips(&ClipFilter::default())?;
        report.copies = copies(&infos, done.near_copies);
        report.beside = beside(&infos, &paths);
        report.beside.retain(|path| !report.labels.contains(path));
        Ok(done.log)
    });
    let stopped = |error| JobError::Failed(format!("Import stopped: {error}"));
    let done = imported.map_err(stopped)?;
    report.cancelled = done.cancelled || progress.cancelled();
    for (path, outcome) in done.files {
        match outcome {
            ImportOutcome::Imported { warnings, clips } => {
                report.imported += 1;
                report.clips.extend(clips);
                let named = warnings.into_iter().map(|w| (path.clone(), w));
                report.warnings.extend(named);
            }
            ImportOutcome::Known | ImportOutcome::Copy { .. } => report.known += 1,
            ImportOutcome::Refused(why) => report.refused.push((path, why.reason)),
        }
    }
    Ok(report)
}

/// Imported clips that are nearly others, so that one of the two can be left out.
fn copies(infos: &[ClipInfo], found: Vec<CopiedClip>) -> Vec<CopiedStretch> {
    let named = |name: &str| infos.iter().find(|info| info.name == name);
    let copied = |found: CopiedClip| {
        let (of, copy) = (named(&found.of)?, named(&found.copy)?);
        Some(CopiedStretch {
            copy: Stretch::new(copy.id, 0.0..copy.duration_secs()),
            of: Stretch::new(of.id, found.span),
            mirrored: found.mirrored,
            text: found.to_string(),
        })
    };
    found.into_iter().filter_map(copied).collect()
}
