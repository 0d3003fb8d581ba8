//! Import of files into a database, and notes about near-duplicates.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::{Path, PathBuf};

use morec::TimeSpan;
use morec::files::{FileReader, split_choice};
use morec::progress::Progress;
use morec_db::search::{NearCopy, SearchIndex, near_duplicates, near_duplicates_of};
use morec_db::{ClipFilter, ClipId, ClipUpdate, DbError, ImportLog, MotionDb};
use serde::{Deserialize, Serialize};

/// What is noted of the clips of an import.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, clap::Args)]
#[serde(default, deny_unknown_fields)]
pub struct ImportSettings {
    /// Origin of the material
    #[arg(long, value_name = "TEXT")]
    pub source: Option<String>,
    /// Licence of the material
    #[arg(long, value_name = "TEXT")]
    pub licence: Option<String>,
    /// Person in the clips
    #[arg(long, value_name = "NAME")]
    pub subject: Option<String>,
    /// Tag for the clips; can be repeated
    #[arg(long = "tag", value_name = "WORD")]
    pub tags: Vec<String>,
}

/// What became of every file.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ImportedFiles {
    /// Outcomes of the files.
    #[serde(flatten)]
    pub log: ImportLog,
    /// New clips that are nearly others; none is looked for if the import was cancelled.
    pub near_copies: Vec<CopiedClip>,
}

/// A clip that is nearly another, by name.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CopiedClip {
    /// Name of the longer clip.
    pub of: String,
    /// The shorter one; the whole of it lies in the other.
    pub copy: String,
    /// Where in the longer one.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// True if one is the other's mirror image.
    pub mirrored: bool,
    /// Mean squared distance of their directions.
    pub distance: f32,
}

impl ImportSettings {
    /// Imports `files`, each content once, and looks for new clips that are nearly others. The same file is the same path, from
    /// whichever folder it is named.
    ///
    /// # Errors
    /// The database cannot be read or written. Files that cannot be read are no error but part of the report.
    pub fn run(
        &self,
        db: &mut MotionDb,
        files: &[PathBuf],
        reader: &FileReader,
        progress: &dyn Progress,
    ) -> Result<ImportedFiles, DbError> {
        let about = ClipUpdate {
            source: self.source.clone(),
            licence: self.licence.clone(),
            subject: self.subject.clone(),
            add_tags: self.tags.clone(),
            remove_tags: Vec::new(),
        };
        let files: Vec<PathBuf> = files.iter().map(|file| absolute(file)).collect();
        let log = db.import(&files, reader, &about, progress)?;
        let new: BTreeSet<&str> = log.clips().map(String::as_str).collect();
        let near_copies = match new.is_empty() || log.cancelled {
            true => Vec::new(),
            // What was imported is there, whatever is not known of it.
            false => match CopiedClip::among(db, Some(&new), progress) {
                Err(DbError::Cancelled) => Vec::new(),
                found => found?,
            },
        };
        Ok(ImportedFiles { log, near_copies })
    }
}

impl CopiedClip {
    /// Every pair of near copies, or those with at least one of the clips of these names.
    ///
    /// # Errors
    /// The database cannot be read, or the receiver of progress cancelled.
    pub fn among(
        db: &mut MotionDb,
        names: Option<&BTreeSet<&str>>,
        progress: &dyn Progress,
    ) -> Result<Vec<Self>, DbError> {
        let index = SearchIndex::of_db(db, progress)?;
        let clips = db.clips(&ClipFilter::default())?.into_iter();
        let by_id: BTreeMap<ClipId, String> = clips.map(|c| (c.id, c.name)).collect();
        let found = match names {
            None => near_duplicates(&index),
            Some(names) => {
                let of_names = by_id.iter().filter(|(_, n)| names.contains(n.as_str()));
                near_duplicates_of(&index, &of_names.map(|(id, _)| *id).collect())
            }
        };
        let copied = |pair: NearCopy| {
            Some(Self {
                of: by_id.get(&pair.of)?.clone(),
                copy: by_id.get(&pair.copy)?.clone(),
                span: pair.span,
                mirrored: pair.mirrored,
                distance: pair.distance,
            })
        };
        Ok(found.into_iter().filter_map(copied).collect())
    }
}

impl fmt::Display for CopiedClip {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.mirrored {
            true => "nearly the mirror image of",
            false => "nearly the same as",
        };
        let (start, stop) = (self.span.start_secs, self.span.stop_secs);
        let (copy, of, distance) = (&self.copy, &self.of, self.distance);
        write!(
            out,
            "{copy} is {kind} {of}, {start:.2} to {stop:.2} s (distance {distance:.4})"
        )
    }
}

fn absolute(path: &Path) -> PathBuf {
    let (file, choice) = split_choice(path);
    // On Windows without the prefix of verbatim paths, which people and many programs do not expect.
    match (dunce::canonicalize(file), choice) {
        (Ok(file), Some(choice)) => format!("{}#{choice}", file.display()).into(),
        (Ok(file), None) => file,
        (Err(_), _) => path.to_owned(),
    }
}
