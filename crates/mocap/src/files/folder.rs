//! Finds the clips among the files of a folder and its subfolders.

use std::collections::{HashMap, HashSet};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::formats::probe::{format_of_name, probe};
use crate::formats::{Format, IN_A_PICTURE};

use super::sequence::FrameFiles;
use super::{FileError, FileErrorKind};

/// So much of a file is looked at to tell its format.
const HEAD_BYTES: u64 = 64 * 1024;

/// This many reasons are given when a folder has no clip.
const REASONS: usize = 5;

/// The clip files that paths stand for, and what folders hold besides.
#[derive(Debug, Default)]
pub struct Listing {
    /// In the order of the paths; those of a folder in the order of theirs.
    pub clips: Vec<PathBuf>,
    /// Motion in folders that cannot be read, with the reason, by path.
    pub left_out: Vec<FileError>,
    /// Number of files in folders that are no motion at all.
    pub others: usize,
}

/// Files stay as they are named; folders become the clip files in them and the folders below, by path.
///
/// # Errors
/// A folder that cannot be read, or in which there is no clip.
pub fn list(paths: &[PathBuf]) -> Result<Listing, FileError> {
    list_as(paths, false)
}

/// [`list`]; with `planar`, tables of points in two dimensions are clips too, as [`FileReader::planar`](super::FileReader::planar) reads them.
///
/// # Errors
/// As [`list`].
pub fn list_as(paths: &[PathBuf], planar: bool) -> Result<Listing, FileError> {
    let mut all = Listing::default();
    for path in paths {
        if !path.is_dir() {
            all.clips.push(path.clone());
            continue;
        }
        let (before, left_out) = (all.clips.len(), all.left_out.len());
        collect(path, planar, &mut all)?;
        all.clips[before..].sort();
        if all.clips.len() == before {
            let reasons = all.left_out[left_out..].iter().take(REASONS);
            let reasons: Vec<String> = reasons.map(|error| format!("\n{error}")).collect();
            return Err(FileErrorKind::NoClip(reasons.concat()).at(path));
        }
    }
    all.left_out.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(all)
}

fn collect(folder: &Path, planar: bool, all: &mut Listing) -> Result<(), FileError> {
    let failed = |error| FileErrorKind::Io(error).at(folder);
    let entries: Vec<fs::DirEntry> = fs::read_dir(folder)
        .and_then(Iterator::collect)
        .map_err(failed)?;
    let clips = FrameFiles::among(entries.iter().map(fs::DirEntry::path));
    // The first of them stands for the clip.
    let firsts: HashMap<&PathBuf, &FrameFiles> = clips
        .iter()
        .filter_map(|(_, frames)| Some((frames.paths().next()?, frames)))
        .collect();
    let later: HashSet<&PathBuf> = clips.iter().flat_map(|(_, f)| f.paths().skip(1)).collect();
    for entry in entries {
        let path = entry.path();
        if later.contains(&path) {
            continue;
        }
        // A link to a folder could lead back here; links to files cannot.
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            // A folder that cannot be read is left out alone.
            if let Err(error) = collect(&path, planar, all) {
                all.left_out.push(error);
            }
        } else if path.is_file() {
            match kind_of(&path, firsts.get(&path).copied()) {
                FileKind::Clip => all.clips.push(path),
                FileKind::NotRead(FileErrorKind::NotRead(why)) if planar && why == IN_A_PICTURE => {
                    all.clips.push(path)
                }
                FileKind::NotRead(why) => all.left_out.push(why.at(&path)),
                FileKind::Other => all.others += 1,
                FileKind::Needed => {}
            }
        }
    }
    Ok(())
}

/// Kind of a file in a folder.
enum FileKind {
    Clip,
    /// Motion, but in a format that is not read, or a file that cannot be opened.
    NotRead(FileErrorKind),
    /// Skeletons of motions, hidden files.
    Needed,
    Other,
}

fn kind_of(path: &Path, frames: Option<&FrameFiles>) -> FileKind {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if name.starts_with('.') {
        return FileKind::Needed;
    }
    let ending = path.extension().unwrap_or_default();
    if ["zip", "gz"]
        .iter()
        .any(|known| ending.eq_ignore_ascii_case(known))
    {
        return FileKind::Clip;
    }
    match format_of_name(&name) {
        Some(format) if format.is_skeleton() => FileKind::Needed,
        // Tables and JSON hold labels, too: what is in them decides.
        Some(Format::Table | Format::Jsonl) | None => by_content(path, frames),
        Some(_) => FileKind::Clip,
    }
}

fn by_content(path: &Path, frames: Option<&FrameFiles>) -> FileKind {
    let head = match frames {
        Some(frames) => frames.read(),
        None => head_of(path),
    };
    let head = match head {
        Ok(head) => head,
        Err(error) => return FileKind::NotRead(error.into()),
    };
    match probe(&head, "") {
        Ok(format) if format.is_skeleton() => FileKind::Needed,
        Ok(_) => FileKind::Clip,
        Err(error) if is_motion(&error.found) => {
            FileKind::NotRead(FileErrorKind::NotRead(error.found))
        }
        Err(_) => FileKind::Other,
    }
}

fn head_of(path: &Path) -> io::Result<Vec<u8>> {
    let mut head = Vec::new();
    File::open(path)?.take(HEAD_BYTES).read_to_end(&mut head)?;
    Ok(head)
}

/// True of what is found in a file that holds motion, but none that is read.
fn is_motion(found: &str) -> bool {
    let is_format = found.starts_with("what looks like") && !is_media(found);
    let measures = ["x and y alone", "angles, rotations"];
    is_format || measures.iter().any(|start| found.starts_with(start))
}

/// Pictures and videos lie beside motion without being any.
fn is_media(found: &str) -> bool {
    found.contains("video,") || found.contains("a picture,")
}
