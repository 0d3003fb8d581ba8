//! Writes files. Every output of the command passes through here, so that inputs and databases are never overwritten and
//! files are written wholly or not at all.
//!
//! A file that this run reads is never written, whatever name or link it is reached by. Everything else is written beside
//! its target, synced and renamed: after a failure (a full disk, a broken clip) the target is what it was before. A file
//! of another kind than the one that takes its name is kept under a name of its own, and named on standard error.

mod kind;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::{Context, Result, bail};
use tempfile::{Builder, NamedTempFile};

/// Paths that this run reads.
static READ: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// So much of a file says what kind of file it is.
const HEAD_BYTES: u64 = 4096;

fn read_so_far() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    READ.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Marks a file as input of this run: from now on no output may take its place.
pub fn mark_read(path: &Path) {
    read_so_far().insert(path.to_owned());
}

/// Marks a database and the files that SQLite keeps beside it.
pub fn mark_database(path: &Path) {
    for ending in ["", "-wal", "-shm", "-journal"] {
        let mut name = path.as_os_str().to_owned();
        name.push(ending);
        mark_read(Path::new(&name));
    }
}

/// Checks that `path` can be an output, as far as that is known before there is anything to write, so that a long job fails at
/// its beginning.
///
/// # Errors
/// It is a folder, a file that this run reads, or a database; it, its folder or its disk may not be written.
pub fn check(path: &Path) -> Result<()> {
    if path.is_dir() {
        bail!("expected a file to write, found a folder; name a file in it");
    }
    // A folder that is not there may be made before the file.
    let folder = folder_of(path);
    if !path.exists() && folder.is_dir() {
        tempfile::tempfile_in(folder).map_err(named)?;
    }
    if !path.is_file() {
        return Ok(());
    }
    // Databases are compared by name too: the file that SQLite writes to may not be there yet.
    let same = |read: &PathBuf| same_file::is_same_file(read, path).unwrap_or(false);
    if let Some(read) = read_so_far()
        .iter()
        .find(|read| read.is_file() && same(read))
    {
        bail!(
            "this is the input {}, which writing would destroy; give the output another name",
            read.display()
        );
    }
    // Renaming would replace a write-protected file all the same.
    OpenOptions::new().write(true).open(path).map_err(named)?;
    if kind::of(&head(path)?) == Some(kind::DATABASE) {
        bail!(
            "this is a database, which is never overwritten; give another name, or delete it first"
        );
    }
    Ok(())
}

/// Endings that promise a format.
const ENDINGS: [&str; 33] = [
    "amc", "asf", "bvh", "c3d", "csv", "eaf", "fbx", "glb", "gltf", "htm", "html", "index", "jpg",
    "json", "jsonl", "mclip", "mdb", "mvnx", "npy", "npz", "pdf", "pkl", "png", "skeleton", "smd",
    "svg", "trc", "tsv", "txt", "vrm", "vrma", "xml", "zip",
];

/// Refuses a name that promises another format than what is written.
///
/// # Errors
/// The ending is a format's, and not one of `own`.
pub fn check_ending(path: &Path, written: &str, own: &[&str]) -> Result<()> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let ending = ending.to_lowercase();
    if ENDINGS.contains(&ending.as_str()) && !own.contains(&ending.as_str()) {
        bail!(
            "{}: the output is {written}, which does not fit the extension .{ending}; use .{}",
            path.display(),
            own[0]
        );
    }
    Ok(())
}

/// As [`check`] and [`check_ending`], for a page of HTML.
pub fn check_page(path: &Path) -> Result<()> {
    check(path).with_context(|| path.display().to_string())?;
    check_ending(path, "a page of HTML", &["html", "htm"])
}

/// As [`check`] and [`check_ending`], for an index.
pub fn check_index(path: &Path) -> Result<()> {
    check(path).with_context(|| path.display().to_string())?;
    check_ending(path, "an index", &["index"])
}

/// As [`check`] and [`check_ending`], for a picture.
pub fn check_picture(path: &Path) -> Result<()> {
    check(path).with_context(|| path.display().to_string())?;
    check_ending(path, "an SVG picture", &["svg"])
}

/// Writes a whole file, or leaves what was there.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<()> {
    let mut output = Output::create(path)?;
    write(&mut output)?;
    output.finish()
}

/// Opens a file that others may read while it grows: it is written in place, and what it held is gone at once.
pub fn growing(path: &Path) -> Result<File> {
    check(path)?;
    keep_other_kind(path, b"{")?;
    Ok(File::create(path).map_err(named)?)
}

/// An output in the making. Dropped before [`Output::finish`], it leaves nothing behind.
pub struct Output {
    /// Final path; links are followed.
    target: PathBuf,
    sink: Target,
}

enum Target {
    /// A file beside the target.
    Beside(BufWriter<NamedTempFile>),
    /// A device or a pipe: there is nothing to rename.
    Through(BufWriter<File>),
}

impl Output {
    /// Begins to write what will be the file `path`.
    ///
    /// # Errors
    /// As [`check`]; its folder does not exist or cannot be written.
    pub fn create(path: &Path) -> Result<Self> {
        check(path)?;
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if target.exists() && !target.is_file() {
            let file = OpenOptions::new().write(true).open(&target)?;
            let sink = Target::Through(BufWriter::new(file));
            return Ok(Self { target, sink });
        }
        let name = target.file_name().context("expected the name of a file")?;
        let mut builder = Builder::new();
        let prefix = format!(".{}.", name.to_string_lossy());
        builder.prefix(&prefix).suffix(".partial");
        // Others may read what was written, as far as the user's mask lets them.
        #[cfg(unix)]
        let builder = {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(fs::Permissions::from_mode(0o666))
        };
        let beside = builder.tempfile_in(folder_of(&target)).map_err(named)?;
        if let Ok(there) = fs::metadata(&target) {
            // Best effort: on some file systems files have no permissions.
            let _ = beside.as_file().set_permissions(there.permissions());
        }
        let sink = Target::Beside(BufWriter::new(beside));
        Ok(Self { target, sink })
    }

    /// Puts the file in its place, once all of it is on the disk.
    ///
    /// # Errors
    /// The disk is full; the target has become an input meanwhile.
    pub fn finish(self) -> Result<()> {
        let beside = match self.sink {
            Target::Through(mut out) => return Ok(out.flush()?),
            Target::Beside(out) => out.into_inner().map_err(io::IntoInnerError::into_error)?,
        };
        beside.as_file().sync_all()?;
        check(&self.target)?;
        keep_other_kind(&self.target, &head(beside.path())?)?;
        beside.persist(&self.target)?;
        #[cfg(unix)]
        if let Ok(folder) = File::open(folder_of(&self.target)) {
            // The name, too, is on the disk; a file system that cannot sync a folder is no reason to fail.
            let _ = folder.sync_all();
        }
        Ok(())
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.sink {
            Target::Beside(out) => out.write(bytes),
            Target::Through(out) => out.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Target::Beside(out) => out.flush(),
            Target::Through(out) => out.flush(),
        }
    }
}

/// The error of a file that cannot be written, without the name that it has until it is whole.
fn named(error: io::Error) -> io::Error {
    let kind = error.kind();
    let said = match kind {
        io::ErrorKind::ReadOnlyFilesystem => "its disk is read-only",
        io::ErrorKind::PermissionDenied => "the file or its folder is read-only",
        io::ErrorKind::NotFound => "its folder does not exist",
        _ => return error,
    };
    io::Error::new(kind, said)
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

fn head(path: &Path) -> io::Result<Vec<u8>> {
    let mut head = Vec::new();
    File::open(path)?.take(HEAD_BYTES).read_to_end(&mut head)?;
    Ok(head)
}

/// Gives a file of another kind than what is about to be written a name of its own.
fn keep_other_kind(path: &Path, written: &[u8]) -> Result<()> {
    if !path.is_file() {
        return Ok(());
    }
    let (was, is) = (kind::of(&head(path)?), kind::of(written));
    let (Some(was), Some(is)) = (was, is) else {
        return Ok(());
    };
    if was == is {
        return Ok(());
    }
    let kept = free_name(path);
    fs::rename(path, &kept)?;
    eprintln!(
        "morec: {}: was {was}, is now {is}; the old file is kept as {}",
        path.display(),
        kept.display()
    );
    Ok(())
}

/// `FILE.old`, or with a number behind it.
fn free_name(path: &Path) -> PathBuf {
    let numbered = (2..).map(|number| format!(".old{number}"));
    let mut candidates = std::iter::once(".old".to_owned())
        .chain(numbered)
        .map(|ending| {
            let mut name = path.as_os_str().to_owned();
            name.push(ending);
            PathBuf::from(name)
        });
    candidates
        .find(|name| fs::symlink_metadata(name).is_err())
        .unwrap_or_else(|| path.with_extension("old"))
}
