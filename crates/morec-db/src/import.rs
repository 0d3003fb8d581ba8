//! Imports files: in parallel, each file wholly or not at all, and each content only once. Reading and normalising are done by
//! `mocap`; this module stores the result.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use morec::files::{FileReader, is_large, read_file, split_choice};
use morec::formats::Limits;
use morec::progress::Progress;
use rayon::prelude::*;
use rusqlite::{Connection, OptionalExtension, Row, params};

use crate::history::counted;
use crate::kept::{FileContent, KeptClip, KeptFile, packed_rows, rows_recipe};
use crate::names::LONGEST as LONGEST_NAME;
use crate::time::now_secs;
use crate::{ClipId, ClipUpdate, DbError, MotionDb, history, rows};

/// Files in one transaction: a crash loses the work of this many at most, and nothing that was committed.
const BATCH: usize = 32;

/// Memory that the files read side by side have together, bytes. What needs more than its share is read again, by itself.
const SHARED_MEMORY: usize = 2 << 30;

/// Outcome of importing one file.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(rename_all = "snake_case", tag = "outcome")]
pub enum ImportOutcome {
    /// Its clips are in the database now.
    Imported {
        /// Names of the new clips.
        clips: Vec<String>,
        /// Repairs and doubts.
        warnings: Vec<String>,
    },
    /// It was there already, from this path.
    Known,
    /// The same bytes are there from another path.
    Copy {
        /// Path from which they were read first.
        of: PathBuf,
    },
    /// It could not be used.
    Refused(Refused),
}

/// Reason for refusing a file.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Refused {
    /// The reason in a sentence.
    pub reason: String,
}

/// Outcomes of all files, in their order.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct ImportLog {
    /// Each path with what became of it.
    pub files: Vec<(PathBuf, ImportOutcome)>,
    /// True if it was cancelled: files that are not named were not looked at.
    pub cancelled: bool,
}

impl ImportLog {
    /// Description for the history.
    fn said(&self) -> String {
        let counts = self.counts();
        let files = counted(counts.imported, "file");
        match counts.refused {
            0 => format!("import {files}"),
            refused => format!("import {files}, {refused} refused"),
        }
    }

    /// Names of the clips that are in the database now.
    pub fn clips(&self) -> impl Iterator<Item = &String> {
        self.files.iter().flat_map(|(_, outcome)| match outcome {
            ImportOutcome::Imported { clips, .. } => clips.as_slice(),
            _ => &[],
        })
    }

    /// Number of files by outcome.
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

/// Number of files of an import, by outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ImportCounts {
    /// Imported, with or without warnings.
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
pub(crate) enum PreparedFile {
    Known(i64),
    Refused(String),
    /// Refused for the memory it needs.
    TooLarge(String),
    New(Vec<KeptClip>),
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
        self.import_sharing(paths, reader, about, progress, SHARED_MEMORY)
    }

    /// [`import`](Self::import) with so much memory for files that are read side by side.
    pub(crate) fn import_sharing(
        &mut self,
        paths: &[PathBuf],
        reader: &FileReader,
        about: &ClipUpdate,
        progress: &dyn Progress,
        memory: usize,
    ) -> Result<ImportLog, DbError> {
        let mut report = ImportLog::default();
        let done = AtomicUsize::new(0);
        let sharing = sharing(reader, memory);
        // All batches are one step of the history, as the person sees one import.
        let mut step = None;
        for batch in paths.chunks(BATCH) {
            if progress.cancelled() {
                report.cancelled = true;
                break;
            }
            let known = self.known_hashes()?;
            let mut made: Vec<Option<PreparedFile>> = batch
                .par_iter()
                .map(|path| {
                    if progress.cancelled() {
                        return None;
                    }
                    let made = make(path, &sharing, about, &known);
                    progress.report(
                        "importing",
                        done.fetch_add(1, Ordering::Relaxed) + 1,
                        paths.len(),
                    );
                    Some(made)
                })
                .collect();
            let program = self.program.clone();
            for (path, made) in batch.iter().zip(&mut made) {
                if matches!(made, Some(PreparedFile::TooLarge(_))) && !progress.cancelled() {
                    *made = Some(make(path, reader, about, &known));
                }
            }
            let tx = self.write()?;
            let recording = history::record(&tx, "import", step, &program)?;
            for (path, made) in batch.iter().zip(made) {
                match made {
                    Some(made) => report.files.push((path.clone(), store(&tx, path, made)?)),
                    None => report.cancelled = true,
                }
            }
            step = history::recorded(&tx, &report.said(), &recording)?;
            tx.commit()?;
        }
        Ok(report)
    }

    /// Adds clips that a database or an archive kept, as they are; those of one file lie together. What is there already by
    /// the content of its file is left out. Gives what became of each file.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn add_kept(&mut self, clips: &[KeptClip]) -> Result<ImportLog, DbError> {
        let files: Vec<&[KeptClip]> = clips.chunk_by(|a, b| a.file.hash == b.file.hash).collect();
        let what = format!("add {}", counted(files.len(), "kept file"));
        let added = self.edit(&what, |conn| {
            let add = |clips: &&[KeptClip]| {
                let path = PathBuf::from(&clips[0].file.path);
                let outcome = add_file(conn, &path, clips)?;
                Ok((path, outcome))
            };
            files.iter().map(add).collect::<Result<Vec<_>, DbError>>()
        })?;
        Ok(ImportLog {
            files: added,
            cancelled: false,
        })
    }

    /// The content of every clip, which is the same in all databases and archives, and its name here: hash of the file, which
    /// of the file's clips it is, name.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn contents(&self) -> Result<Vec<([u8; 32], usize, String)>, DbError> {
        let sql = "SELECT f.hash, c.character, c.name FROM clips c JOIN files f ON f.id = c.file ORDER BY c.id";
        let mut statement = self.conn.prepare(sql)?;
        let rows = statement.query_map([], |row| {
            Ok((
                row.get("hash")?,
                row.get::<_, i64>("character")?.max(0) as usize,
                row.get("name")?,
            ))
        })?;
        Ok(rows.collect::<Result<_, _>>()?)
    }

    /// Every clip as it is kept, by number; feature rows that are not ready are made.
    ///
    /// # Errors
    /// The database cannot be read, or a clip's motion is damaged.
    pub fn kept_clips(&self) -> Result<Vec<KeptClip>, DbError> {
        let sql = "SELECT c.name, c.character, c.subject, c.source, c.licence, c.frames, c.rate_hz, c.rest_frames, \
             c.repaired_frames, k.joints, k.hash AS skeleton_hash, c.roles, c.facts, c.max_angle_rad, \
             c.max_position_metres, c.motion, f.hash, f.path, f.format, f.bytes, f.skeleton_path, f.warnings, \
             (SELECT group_concat(tag, char(10)) FROM tags t WHERE t.clip = c.id) AS tags, \
             r.bones, r.bytes AS row_bytes \
             FROM clips c JOIN files f ON f.id = c.file JOIN skeletons k ON k.id = c.skeleton \
             LEFT JOIN feature_rows r ON r.clip = c.id AND r.recipe = ?1 ORDER BY c.id";
        let recipe = rows_recipe();
        let mut statement = self.conn.prepare(sql)?;
        let count = |row: &Row<'_>, column: &str| -> rusqlite::Result<usize> {
            Ok(row.get::<_, i64>(column)?.max(0) as usize)
        };
        let kept = statement.query_map(params![recipe], |row| {
            let warnings: String = row.get("warnings")?;
            let tags: Option<String> = row.get("tags")?;
            let rows: (Option<i64>, Option<Vec<u8>>) = (row.get("bones")?, row.get("row_bytes")?);
            let clip = KeptClip {
                name: row.get("name")?,
                file: KeptFile {
                    hash: row.get("hash")?,
                    path: row.get("path")?,
                    format: row.get("format")?,
                    bytes: row.get::<_, i64>("bytes")?.max(0) as u64,
                    skeleton: row.get("skeleton_path")?,
                    warnings: serde_json::from_str(&warnings).unwrap_or_default(),
                },
                character: count(row, "character")?,
                subject: row.get("subject")?,
                source: row.get("source")?,
                licence: row.get("licence")?,
                tags: tags.map_or_else(Vec::new, |t| t.lines().map(str::to_owned).collect()),
                frames: count(row, "frames")?,
                rate_hz: row.get("rate_hz")?,
                rest_frames: count(row, "rest_frames")?,
                repaired_frames: count(row, "repaired_frames")?,
                joints: count(row, "joints")?,
                skeleton_hash: row.get("skeleton_hash")?,
                roles: row.get("roles")?,
                facts: row.get("facts")?,
                max_angle_rad: row.get("max_angle_rad")?,
                max_position_metres: row.get("max_position_metres")?,
                motion: row.get("motion")?,
                recipe: recipe.clone(),
                bones: rows.0.unwrap_or(0),
                rows: rows.1.clone().unwrap_or_default(),
            };
            Ok((clip, rows.1.is_some()))
        })?;
        let kept: Vec<(KeptClip, bool)> = kept.collect::<Result<_, _>>()?;
        let complete = |(clip, ready): (KeptClip, bool)| match ready {
            true => Ok(clip),
            false => {
                let (bones, rows) = packed_rows(&clip.stored()?);
                Ok(KeptClip {
                    bones,
                    rows,
                    ..clip
                })
            }
        };
        kept.into_par_iter().map(complete).collect()
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

    pub(crate) fn known_hashes(&self) -> Result<std::collections::HashMap<[u8; 32], i64>, DbError> {
        let mut statement = self.conn.prepare("SELECT hash, id FROM files")?;
        let pairs = statement.query_map([], |row| Ok((row.get("hash")?, row.get("id")?)))?;
        Ok(pairs.collect::<Result<_, _>>()?)
    }
}

/// The reader of one of several files that are read side by side.
fn sharing(reader: &FileReader, memory: usize) -> FileReader {
    let share = memory / rayon::current_num_threads().max(1);
    let limits = Limits {
        memory: reader.limits.memory.min(share),
        ..reader.limits
    };
    FileReader {
        limits,
        ..reader.clone()
    }
}

pub(crate) fn make(
    path: &Path,
    reader: &FileReader,
    about: &ClipUpdate,
    known: &std::collections::HashMap<[u8; 32], i64>,
) -> PreparedFile {
    let (file, _) = split_choice(path);
    let large = is_large(&file);
    let opened = match large {
        true => FileContent::of_large(path).map(|content| (content, Vec::new())),
        false => read_file(&file).map(|bytes| (FileContent::of(path, &bytes), bytes)),
    };
    let (content, bytes) = match opened {
        Ok(opened) => opened,
        Err(error) => return PreparedFile::Refused(error.to_string()),
    };
    if let Some(file) = known.get(&content.hash) {
        return PreparedFile::Known(*file);
    }
    let kept = match large {
        true => KeptClip::of_large(path, content, reader),
        false => KeptClip::of_file(path, &bytes, reader),
    };
    match kept {
        Err(refused) if refused.of_memory => PreparedFile::TooLarge(refused.reason),
        Err(refused) => PreparedFile::Refused(refused.reason),
        Ok(clips) => {
            let told = |clip| KeptClip {
                source: about.source.clone(),
                licence: about.licence.clone(),
                subject: about.subject.clone(),
                tags: about.add_tags.clone(),
                ..clip
            };
            PreparedFile::New(clips.into_iter().map(told).collect())
        }
    }
}

fn store(conn: &Connection, path: &Path, made: PreparedFile) -> Result<ImportOutcome, DbError> {
    let shown = path.to_string_lossy();
    match made {
        PreparedFile::Refused(reason) | PreparedFile::TooLarge(reason) => {
            // Refused for the same reason again, it is no change.
            let sql = "INSERT INTO refused (path, reason, tried_secs) VALUES (?1, ?2, ?3) \
                ON CONFLICT (path) DO UPDATE SET reason = excluded.reason, tried_secs = excluded.tried_secs \
                WHERE reason <> excluded.reason";
            conn.execute(sql, params![shown, reason, now_secs()])?;
            Ok(ImportOutcome::Refused(Refused { reason }))
        }
        PreparedFile::Known(file) => known(conn, &shown, file),
        PreparedFile::New(clips) => add_file(conn, path, &clips),
    }
}

/// Adds the clips of one file, unless the file's content is there.
fn add_file(conn: &Connection, path: &Path, clips: &[KeptClip]) -> Result<ImportOutcome, DbError> {
    let Some(first) = clips.first() else {
        let reason = "the file contains no clip".to_owned();
        return Ok(ImportOutcome::Refused(Refused { reason }));
    };
    let shown = path.to_string_lossy();
    conn.prepare_cached("DELETE FROM refused WHERE path = ?1")?
        .execute(params![shown])?;
    // Two files of one batch may hold the same bytes.
    let twin = conn
        .prepare_cached("SELECT id FROM files WHERE hash = ?1")?
        .query_row(params![first.file.hash], |row| row.get(0))
        .optional()?;
    match twin {
        Some(file) => known(conn, &shown, file),
        None => insert(conn, path, &first.file, clips),
    }
}

fn known(conn: &Connection, shown: &str, file: i64) -> Result<ImportOutcome, DbError> {
    let first: String = conn
        .prepare_cached("SELECT path FROM files WHERE id = ?1")?
        .query_row(params![file], |row| row.get(0))?;
    if first == shown {
        return Ok(ImportOutcome::Known);
    }
    conn.prepare_cached("INSERT OR IGNORE INTO file_copies (file, path) VALUES (?1, ?2)")?
        .execute(params![file, shown])?;
    Ok(ImportOutcome::Copy { of: first.into() })
}

fn insert(
    conn: &Connection,
    path: &Path,
    file: &KeptFile,
    clips: &[KeptClip],
) -> Result<ImportOutcome, DbError> {
    let number = insert_file(conn, path, file)?;
    let (mut names, mut warnings) = (Vec::new(), file.warnings.clone());
    for clip in clips {
        let name = free_name(conn, path, &clip.name)?;
        if clip.name.len() > LONGEST_NAME {
            warnings.push(format!(
                "the name has {} bytes, a clip's at most {LONGEST_NAME}: the clip is called {name}",
                clip.name.len()
            ));
        }
        let id = insert_clip(conn, number, &name, clip)?;
        rows::keep(conn, id, &clip.recipe, clip.bones, &clip.rows)?;
        names.push(name);
    }
    Ok(ImportOutcome::Imported {
        clips: names,
        warnings,
    })
}

/// Adds what is known of a file; gives its number.
pub(crate) fn insert_file(conn: &Connection, path: &Path, file: &KeptFile) -> Result<i64, DbError> {
    conn.prepare_cached(
        "INSERT INTO files (hash, path, skeleton_path, format, bytes, imported_secs, warnings) \
         VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)",
    )?
    .execute(params![
        file.hash,
        path.to_string_lossy(),
        file.skeleton,
        file.format,
        file.bytes as i64,
        now_secs(),
        serde_json::to_string(&file.warnings).unwrap_or_default(),
    ])?;
    Ok(conn.last_insert_rowid())
}

/// The number of a clip's skeleton, which is added if need be.
pub(crate) fn skeleton_of(conn: &Connection, clip: &KeptClip) -> Result<i64, DbError> {
    let sql = "INSERT OR IGNORE INTO skeletons (hash, joints) VALUES (?1, ?2)";
    conn.prepare_cached(sql)?
        .execute(params![clip.skeleton_hash, clip.joints as i64])?;
    let sql = "SELECT id FROM skeletons WHERE hash = ?1";
    let mut statement = conn.prepare_cached(sql)?;
    Ok(statement.query_row(params![clip.skeleton_hash], |row| row.get(0))?)
}

/// A name that tables and terminals can hold: control characters are blanks, and it neither begins nor ends with one.
fn sanitized_name(name: &str) -> String {
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
    let name = &sanitized_name(name);
    let taken = |name: &str| {
        conn.prepare_cached("SELECT 1 FROM clips WHERE name = ?1")?
            .exists(params![name])
    };
    let folder = path
        .parent()
        .and_then(Path::file_name)
        .map(|f| format!("{}/{name}", sanitized_name(&f.to_string_lossy())))
        .filter(|name| name.len() <= LONGEST_NAME);
    let numbered = (2..).map(|number| {
        let behind = format!("~{number}");
        let begin = shortened(name, LONGEST_NAME - behind.len());
        format!("{begin}{behind}")
    });
    let own = shortened(name, LONGEST_NAME).to_owned();
    for candidate in [own].into_iter().chain(folder).chain(numbered) {
        if !taken(&candidate)? {
            return Ok(candidate);
        }
    }
    unreachable!("numbers do not end")
}

/// The beginning of a name, at most this many bytes.
fn shortened(name: &str, bytes: usize) -> &str {
    let mut end = bytes.min(name.len());
    while !name.is_char_boundary(end) {
        end -= 1;
    }
    name[..end].trim_end()
}

fn insert_clip(
    conn: &Connection,
    file: i64,
    name: &str,
    clip: &KeptClip,
) -> Result<ClipId, DbError> {
    let skeleton = skeleton_of(conn, clip)?;
    conn.prepare_cached(
        "INSERT INTO clips (name, file, character, skeleton, frames, rate_hz, rest_frames, repaired_frames, roles, \
         facts, max_angle_rad, max_position_metres, motion, source, licence, subject) VALUES (?1, ?2, ?3, ?4, ?5, \
         ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16)",
    )?
    .execute(params![
        name,
        file,
        clip.character as i64,
        skeleton,
        clip.frames as i64,
        clip.rate_hz,
        clip.rest_frames as i64,
        clip.repaired_frames as i64,
        clip.roles,
        clip.facts,
        clip.max_angle_rad,
        clip.max_position_metres,
        clip.motion,
        clip.source,
        clip.licence,
        clip.subject,
    ])?;
    let id = ClipId(conn.last_insert_rowid());
    for tag in clip.tags.iter().collect::<BTreeSet<_>>() {
        conn.execute(
            "INSERT INTO tags (clip, tag) VALUES (?1, ?2)",
            params![id.0, tag],
        )?;
    }
    Ok(id)
}
