//! Files of labels: which they are, and what they would change.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use morec::formats::probe::probe;
use morec_db::exchange::{
    self, ClipLengths, LabelFormat, ReadLabels, clip_lengths, clip_of_file, resolve,
};
use morec_db::labels::{LabelOptions, Labelled, NewSample};
use morec_db::{ClipFilter, ClipId, ClipInfo, DbError, MotionDb};

use morec_ops::OperationError;

use super::progress::JobError;
use crate::format::file_name;
use crate::store::BY;

/// A larger file is no file of labels, bytes.
const LARGEST: u64 = 64 << 20;
/// The format of motion is recognised by this much of a file, bytes.
const HEAD: u64 = 64 << 10;
/// Number of files beside clips that are looked at.
const LOOKED_AT: usize = 2000;

/// Labels of files, read and not yet in the database.
#[derive(Debug, Clone)]
pub struct LabelFiles {
    pub paths: Vec<PathBuf>,
    pub samples: Vec<NewSample>,
    /// Who is in clips of which that was not known.
    pub people: BTreeMap<ClipId, String>,
    /// Who says each sample.
    pub annotators: Vec<Option<String>>,
    /// Doubts and omissions, in sentences.
    pub notes: Vec<String>,
    /// What they would change: added to what is there, or in place of the labels of the clips that they name.
    pub added: Labelled,
    pub replaced: Labelled,
}

/// The labels of a file, in whatever form; `None` if its name says no form.
fn read_one(path: &Path, lengths: &ClipLengths) -> Option<Result<ReadLabels, String>> {
    let name = path.to_string_lossy();
    // What the ending says is known before the file is read.
    LabelFormat::of_file(&name, b"")?;
    let read = || {
        let bytes = match fs::metadata(path) {
            Ok(about) if about.len() > LARGEST => {
                return Err("too large for a label file".to_owned());
            }
            _ => fs::read(path).map_err(|e| e.to_string())?,
        };
        let form = LabelFormat::of_file(&name, &bytes).unwrap_or(LabelFormat::Tsv);
        let clip = clip_of_file(path, lengths).filter(|_| form.is_of_one_clip());
        // ELAN names the clip in the file if morec wrote it.
        exchange::read(form, &bytes, None, lengths)
            .or_else(|error| match &clip {
                Some(clip) => exchange::read(form, &bytes, Some(clip), lengths),
                None => Err(error),
            })
            .map_err(|error| match form.is_of_one_clip() {
                true => format!("{error}; the clip is known by the name of the label file"),
                false => error.to_string(),
            })
    };
    Some(read())
}

/// True if a file holds labels, and no motion.
pub fn is_labels(path: &Path) -> bool {
    let any = |read: &ReadLabels| !read.annotations.is_empty() || !read.absent.is_empty();
    if !path.is_file() || LabelFormat::of_file(&path.to_string_lossy(), b"").is_none() {
        return false;
    }
    let mut head = Vec::new();
    let opened = File::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head));
    if opened.is_err() || probe(&head, "").is_ok() {
        return false;
    }
    // A file of one clip is taken for that of a clip of its name, whichever there are.
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let named = exchange::clip_of_file_name(&stem);
    let length = morec::labels::ClipLength {
        frames: 1,
        rate_hz: 1.0,
    };
    let lengths = ClipLengths::from([(named, length)]);
    read_one(path, &lengths).is_some_and(|read| read.is_ok_and(|read| any(&read)))
}

/// Reads files of labels, and finds what they would change in the database at `db`.
pub fn read(db: &Path, paths: &[PathBuf]) -> Result<LabelFiles, JobError> {
    let failed = |error: DbError| JobError::of("Labels were not read", error);
    let mut db = MotionDb::open(db).map_err(failed)?;
    let clips = db.clips(&ClipFilter::default()).map_err(failed)?;
    let lengths = clip_lengths(&clips);
    let mut notes = Vec::new();
    let (mut annotations, mut absent) = (Vec::new(), BTreeMap::new());
    for path in paths {
        let name = file_name(path);
        match read_one(path, &lengths) {
            Some(Ok(read)) => {
                notes.extend(read.warnings.iter().map(|w| format!("{name}: {w}")));
                annotations.extend(read.annotations);
                add(&mut absent, read.absent);
            }
            Some(Err(why)) => notes.push(format!("{name}: {why}")),
            None => notes.push(format!(
                "{name}: expected a label file with the extension .tsv, .csv, .json, .eaf or .txt"
            )),
        }
    }
    let resolved = resolve(annotations, &clips);
    if let Some(why) = resolved.doubtful_unit() {
        let why = OperationError::Settings(why);
        return Err(JobError::of("Labels were not read", why));
    }
    add(&mut absent, resolved.absent);
    notes.extend(resolved.notes);
    notes.extend(db.misspelled(&resolved.samples).map_err(failed)?);
    if let Some(said) = said_absent(&db, &absent) {
        notes.insert(0, said);
    }
    let mut preview = |replace| {
        let options = LabelOptions {
            by: BY.to_owned(),
            replace,
            dry_run: true,
            people: resolved.people.clone(),
            annotators: resolved.annotators.clone(),
        };
        db.label(&resolved.samples, &options).map_err(failed)
    };
    Ok(LabelFiles {
        paths: paths.to_vec(),
        added: preview(false)?,
        replaced: preview(true)?,
        samples: resolved.samples,
        people: resolved.people,
        annotators: resolved.annotators,
        notes,
    })
}

fn add(all: &mut BTreeMap<String, usize>, more: BTreeMap<String, usize>) {
    for (clip, count) in more {
        *all.entry(clip).or_default() += count;
    }
}

fn said_absent(db: &MotionDb, absent: &BTreeMap<String, usize>) -> Option<String> {
    const NAMED: usize = 3;
    if absent.is_empty() {
        return None;
    }
    let mut names: Vec<String> = absent.keys().take(NAMED).cloned().collect();
    if absent.len() > NAMED {
        names.push(format!("{} more", absent.len() - NAMED));
    }
    // That there are other names is no help; that one is near is.
    let hint = absent.keys().map(|clip| db.hint_of_clip(clip));
    let hint = hint.take(NAMED).find(|hint| hint.contains('?'));
    Some(format!(
        "{} of unknown clips left out: {}{}",
        crate::format::count(absent.values().sum(), "label"),
        names.join(", "),
        hint.unwrap_or_default()
    ))
}

/// Files of labels in and beside the folders, and beside the files, that were imported, as far as they name clips of the database.
pub fn beside(clips: &[ClipInfo], paths: &[PathBuf]) -> Vec<PathBuf> {
    let mut folders = BTreeSet::new();
    for path in paths {
        if path.is_dir() {
            folders.insert(path.as_path());
        }
        folders.extend(path.parent());
    }
    let lengths = clip_lengths(clips);
    let inside = |folder: &Path| {
        let here = folder.as_os_str().is_empty();
        let entries = fs::read_dir(if here { Path::new(".") } else { folder });
        let files = entries.into_iter().flatten().flatten().map(|e| e.path());
        let form = |path: &PathBuf| LabelFormat::of_file(&path.to_string_lossy(), b"").is_some();
        files.filter(form).take(LOOKED_AT).collect::<Vec<_>>()
    };
    let files: BTreeSet<PathBuf> = folders.into_iter().flat_map(inside).collect();
    let names_a_clip = |path: &PathBuf| {
        let read = read_one(path, &lengths).and_then(Result::ok);
        read.is_some_and(|read| !resolve(read.annotations, clips).samples.is_empty())
    };
    let named = |path: &PathBuf| paths.contains(path);
    files
        .into_iter()
        .filter(|path| !named(path) && is_labels(path) && names_a_clip(path))
        .collect()
}
