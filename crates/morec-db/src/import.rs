//! Files into the database: in parallel, whole files or nothing, each content once.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use morec::clip::Clip;
use morec::features::{BoneSet, FeatureParams};
use morec::files::{ClipFile, FileReader, read_file, split_choice};
use morec::import::{ImportOptions, normalize};
use morec::progress::Progress;
use rayon::prelude::*;
use rusqlite::{Connection, OptionalExtension, params};

use crate::motion::{Packed, pack};
use crate::time::now_secs;
use crate::{ClipId, ClipUpdate, DbError, MotionDb, history, rows};

/// Files in one transaction: a crash loses the work of so many at most, and nothing that was committed.
const BATCH: usize = 32;

/// What became of one file.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(rename_all = "snake_case", tag = "outcome")]
pub enum ImportOutcome {
    /// Its clips are in the database now.
    Imported {
        /// Their names.
        clips: Vec<String>,
        /// What was repaired or looks wrong.
        warnings: Vec<String>,
    },
    /// It was there already, from this path.
    Known,
    /// The same bytes are there from another path.
    Copy {
        /// Which.
        of: PathBuf,
    },
    /// It could not be used.
    Refused(Refused),
}

/// Why a file was refused.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Refused {
    /// The reason in a sentence.
    pub reason: String,
}

/// What became of every file, in their order.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct ImportLog {
    /// Path and outcome.
    pub files: Vec<(PathBuf, ImportOutcome)>,
    /// Whether it was cancelled: files that are not named were not looked at.
    pub cancelled: bool,
}

impl ImportLog {
    /// What it did, for the history.
    fn said(&self) -> String {
        let counts = self.counts();
        match counts.refused {
            0 => format!("import {} files", counts.imported),
            refused => format!("import {} files, {refused} refused", counts.imported),
        }
    }

    /// How many files came to what.
    pub fn counts(&self) -> ImportCounts {
        let mut counts = ImportCounts::default();
        for (_, outcome) in &self.files {
            match outcome {
                ImportOutcome::Imported { warnings, .. } => {
                    counts.imported += 1;
                    counts.with_warnings += usize::from(!warnings.is_empty());
                }
                ImportOutcome::Known => counts.known += 1,
                ImportOutcome::Copy { .. } => counts.copies += 1,
                ImportOutcome::Refused(_) => counts.refused += 1,
            }
        }
        counts
    }
}

/// How many files of an import came to what.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ImportCounts {
    /// Imported.
    pub imported: usize,
    /// Imported, with something that was repaired or looks wrong.
    pub with_warnings: usize,
    /// There already, from the same path.
    pub known: usize,
    /// There already, from another path.
    pub copies: usize,
    /// Not usable.
    pub refused: usize,
}

/// A file after the parallel part.
enum PreparedFile {
    Known(i64),
    Refused(String),
    New(Box<NewFile>),
}

struct NewFile {
    hash: [u8; 32],
    bytes: usize,
    file: ClipFile,
    clips: Vec<NewClip>,
}

struct NewClip {
    name: String,
    packed: Packed,
    bones: BoneSet,
    rows: Vec<u8>,
}

impl MotionDb {
    /// Imports files. Parsing, compressing and feature rows run on all threads of the pool; every 32 files are
    /// committed together. Importing again after a crash, or the same files twice, adds only what is missing.
    ///
    /// # Errors
    /// The database cannot be written. Files that cannot be read are no error but part of the report.
    pub fn import(
        &mut self,
        paths: &[PathBuf],
        reader: &FileReader,
        about: &ClipUpdate,
        progress: &dyn Progress,
    ) -> Result<ImportLog, DbError> {
        let mut report = ImportLog::default();
        let done = AtomicUsize::new(0);
        let params = FeatureParams::default();
        let recipe = rows::recipe(&params);
        // All batches are one step of the history, as the person sees one import.
        let mut step = None;
        for batch in paths.chunks(BATCH) {
            if progress.cancelled() {
                report.cancelled = true;
                break;
            }
            let known = self.known_hashes()?;
            let made: Vec<Option<PreparedFile>> = batch
                .par_iter()
                .map(|path| {
                    if progress.cancelled() {
                        return None;
                    }
                    let made = make(path, reader, &params, &known);
                    progress.report(
                        "importing",
                        done.fetch_add(1, Ordering::Relaxed) + 1,
                        paths.len(),
                    );
                    Some(made)
                })
                .collect();
            let tx = self.write()?;
            let recording = history::record(&tx, "import", step)?;
            for (path, made) in batch.iter().zip(made) {
                match made {
                    Some(made) => report
                        .files
                        .push((path.clone(), store(&tx, path, made, about, &recipe)?)),
                    None => report.cancelled = true,
                }
            }
            step = history::recorded(&tx, &report.said(), &recording)?;
            tx.commit()?;
        }
        Ok(report)
    }

    /// Forgets which files were refused. Gives how many there were.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn forget_refused(&mut self) -> Result<usize, DbError> {
        self.edit("forget refused files", |conn| {
            Ok(conn.execute("DELETE FROM refused", [])?)
        })
    }

    fn known_hashes(&self) -> Result<std::collections::HashMap<[u8; 32], i64>, DbError> {
        let mut statement = self.conn.prepare("SELECT hash, id FROM files")?;
        let pairs = statement.query_map([], |row| Ok((row.get(0)?, row.get(1)?)))?;
        Ok(pairs.collect::<Result<_, _>>()?)
    }
}

fn make(
    path: &Path,
    reader: &FileReader,
    params: &FeatureParams,
    known: &std::collections::HashMap<[u8; 32], i64>,
) -> PreparedFile {
    let (file, choice) = split_choice(path);
    let bytes = match read_file(&file) {
        Ok(bytes) => bytes,
        Err(error) => return PreparedFile::Refused(error.to_string()),
    };
    // One clip of a file is another content than the whole.
    let mut hasher = blake3::Hasher::new();
    hasher.update(&bytes);
    hasher.update(choice.unwrap_or_default().as_bytes());
    let hash = *hasher.finalize().as_bytes();
    if let Some(file) = known.get(&hash) {
        return PreparedFile::Known(*file);
    }
    let mut read = match reader.parse(path, &bytes) {
        Ok(read) => read,
        Err(error) => return PreparedFile::Refused(error.kind.to_string()),
    };
    let mut clips = Vec::new();
    for clip in std::mem::take(&mut read.clips) {
        match new_clip(clip, &reader.import, params) {
            Ok(clip) => clips.push(clip),
            Err(reason) => return PreparedFile::Refused(reason),
        }
    }
    if clips.is_empty() {
        return PreparedFile::Refused("there is no clip in it".to_owned());
    }
    PreparedFile::New(Box::new(NewFile {
        hash,
        bytes: bytes.len(),
        file: read,
        clips,
    }))
}

fn new_clip(
    clip: Clip,
    options: &ImportOptions,
    params: &FeatureParams,
) -> Result<NewClip, String> {
    if clip.frames == 0 {
        return Err(format!("{}: expected frames, found none", clip.name));
    }
    let name = clip.name.clone();
    let imported = normalize(clip, options).map_err(|error| error.to_string())?;
    let packed = pack(imported, &()).map_err(|reason| format!("{name}: {reason}"))?;
    let (bones, rows) = rows::rows_of(&packed.stored, params);
    Ok(NewClip {
        name,
        bones,
        rows: rows.to_packed(params),
        packed,
    })
}

fn store(
    conn: &Connection,
    path: &Path,
    made: PreparedFile,
    about: &ClipUpdate,
    recipe: &str,
) -> Result<ImportOutcome, DbError> {
    let shown = path.to_string_lossy();
    match made {
        PreparedFile::Refused(reason) => {
            // Refused for the same reason again, it is no change.
            let sql = "INSERT INTO refused (path, reason, tried_secs) VALUES (?1, ?2, ?3) \
                ON CONFLICT (path) DO UPDATE SET reason = excluded.reason, tried_secs = excluded.tried_secs \
                WHERE reason <> excluded.reason";
            conn.execute(sql, params![shown, reason, now_secs()])?;
            Ok(ImportOutcome::Refused(Refused { reason }))
        }
        PreparedFile::Known(file) => known(conn, &shown, file),
        PreparedFile::New(new) => {
            conn.execute("DELETE FROM refused WHERE path = ?1", params![shown])?;
            // Two files of one batch may hold the same bytes.
            let twin = conn
                .query_row(
                    "SELECT id FROM files WHERE hash = ?1",
                    params![new.hash],
                    |row| row.get(0),
                )
                .optional()?;
            match twin {
                Some(file) => known(conn, &shown, file),
                None => insert(conn, path, *new, about, recipe),
            }
        }
    }
}

fn known(conn: &Connection, shown: &str, file: i64) -> Result<ImportOutcome, DbError> {
    let first: String = conn.query_row(
        "SELECT path FROM files WHERE id = ?1",
        params![file],
        |row| row.get(0),
    )?;
    if first == shown {
        return Ok(ImportOutcome::Known);
    }
    conn.execute(
        "INSERT OR IGNORE INTO file_copies (file, path) VALUES (?1, ?2)",
        params![file, shown],
    )?;
    Ok(ImportOutcome::Copy { of: first.into() })
}

fn insert(
    conn: &Connection,
    path: &Path,
    new: NewFile,
    about: &ClipUpdate,
    recipe: &str,
) -> Result<ImportOutcome, DbError> {
    let warnings: Vec<String> = new.file.warnings.iter().map(ToString::to_string).collect();
    conn.prepare_cached(
        "INSERT INTO files (hash, path, skeleton_path, format, bytes, imported_secs, warnings) \
         VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)",
    )?
    .execute(params![
        new.hash,
        path.to_string_lossy(),
        new.file
            .skeleton
            .as_ref()
            .map(|p| p.to_string_lossy().into_owned()),
        new.file.format.name(),
        new.bytes as i64,
        now_secs(),
        serde_json::to_string(&warnings).unwrap_or_default(),
    ])?;
    let file = conn.last_insert_rowid();
    let mut names = Vec::new();
    for (character, clip) in new.clips.into_iter().enumerate() {
        let name = free_name(conn, path, &clip.name)?;
        let id = insert_clip(conn, file, character, &name, &clip, about)?;
        rows::keep(conn, id, recipe, clip.bones, &clip.rows)?;
        names.push(name);
    }
    Ok(ImportOutcome::Imported {
        clips: names,
        warnings,
    })
}

/// A name that tables and terminals can hold: control characters are blanks, and it neither begins nor ends with one.
fn speakable(name: &str) -> String {
    let plain: String = name
        .chars()
        .map(|sign| if sign.is_control() { ' ' } else { sign })
        .collect();
    match plain.trim() {
        "" => "clip".to_owned(),
        trimmed => trimmed.to_owned(),
    }
}

/// The clip's own name, else with its folder before it, else with a number behind it.
fn free_name(conn: &Connection, path: &Path, name: &str) -> Result<String, DbError> {
    let name = &speakable(name);
    let taken = |name: &str| {
        conn.prepare_cached("SELECT 1 FROM clips WHERE name = ?1")?
            .exists(params![name])
    };
    let folder = path
        .parent()
        .and_then(Path::file_name)
        .map(|f| format!("{}/{name}", speakable(&f.to_string_lossy())));
    let numbered = (2..).map(|number| format!("{name}~{number}"));
    for candidate in [name.to_owned()].into_iter().chain(folder).chain(numbered) {
        if !taken(&candidate)? {
            return Ok(candidate);
        }
    }
    unreachable!("numbers do not end")
}

fn insert_clip(
    conn: &Connection,
    file: i64,
    character: usize,
    name: &str,
    clip: &NewClip,
    about: &ClipUpdate,
) -> Result<ClipId, DbError> {
    let packed = &clip.packed;
    let sql = "INSERT OR IGNORE INTO skeletons (hash, joints) VALUES (?1, ?2)";
    conn.prepare_cached(sql)?
        .execute(params![packed.skeleton_hash, packed.joints as i64])?;
    let motion = &packed.stored.clip;
    conn.prepare_cached(
        "INSERT INTO clips (name, file, character, skeleton, frames, rate_hz, rest_frames, repaired_frames, roles, \
         facts, max_angle_rad, max_position_metres, motion, source, licence, subject) VALUES (?1, ?2, ?3, \
         (SELECT id FROM skeletons WHERE hash = ?4), ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16)",
    )?
    .execute(params![
        name,
        file,
        character as i64,
        packed.skeleton_hash,
        motion.frames as i64,
        motion.rate_hz,
        packed.stored.rest.len() as i64,
        motion.repaired.iter().map(|span| span.len() as i64).sum::<i64>(),
        packed.roles,
        packed.facts,
        packed.max_angle_rad,
        packed.max_position_metres,
        packed.motion,
        about.source,
        about.licence,
        about.subject,
    ])?;
    let id = ClipId(conn.last_insert_rowid());
    for tag in about.add_tags.iter().collect::<BTreeSet<_>>() {
        conn.execute(
            "INSERT INTO tags (clip, tag) VALUES (?1, ?2)",
            params![id.0, tag],
        )?;
    }
    Ok(id)
}
