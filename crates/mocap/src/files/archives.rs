//! Packed files, files in UTF-16, and the choice among several clips of one file.

use std::borrow::Cow;
use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use crate::clip::{Clip, Joint};
use crate::formats::Format;
use crate::formats::container::{self, Member};
use crate::formats::probe::{format_of_name, probe};
use crate::formats::{Limits, ParseError, Place, Warning, mocopi};
use crate::math::Vec3;

use super::choice::{chosen, split_choice};
use super::neighbours::Around;
use super::{ClipFile, FileError, FileErrorKind, FileReader, is_large, sequence};

/// Archives in archives are opened so deep.
const DEEPEST: usize = 3;

impl FileReader {
    /// Reads `bytes`, which are the file at `path` (`FILE#2` and `FILE#name` choose one of its clips); `-` is a stream without
    /// a place, and so without a skeleton near it. Zip archives and gzip files are unpacked, UTF-16 text is understood.
    ///
    /// # Errors
    /// Those of the format, of an archive in which nothing can be read, and of a choice that is not there.
    pub fn parse(&self, path: &Path, bytes: &[u8]) -> Result<ClipFile, FileError> {
        let (file, choice) = split_choice(path);
        let mut parsed = self.parse_packed(&file, bytes, Around::Folder, 0);
        if let Err(FileErrorKind::Parse(error)) = &mut parsed
            && error.is_of_memory()
            && (container::is_gzip(bytes) || container::is_zip(bytes))
        {
            error
                .found
                .push_str("; unpack it and give the files that it contains");
        }
        let chosen = parsed.and_then(|parsed| choose(parsed, choice.as_deref()));
        chosen.map_err(|kind| kind.at(path))
    }

    /// A large BVH file, which is then not held as a whole; `None` for all else.
    pub(super) fn read_large(&self, path: &Path) -> Option<Result<ClipFile, FileError>> {
        let (file, choice) = split_choice(path);
        if !is_large(&file) {
            return None;
        }
        // What goes wrong here goes wrong again, and is said, when the file is read as a whole.
        let mut opened = File::open(&file).ok()?;
        let mut head = Vec::new();
        (&mut opened).take(1 << 16).read_to_end(&mut head).ok()?;
        opened.rewind().ok()?;
        let packed = container::is_gzip(&head)
            || container::is_zip(&head)
            || matches!(container::utf8(&head), Cow::Owned(_));
        if packed || probe(&head, &file.to_string_lossy()) != Ok(Format::Bvh) {
            return None;
        }
        let read = self.parse_bvh(&file, opened);
        let chosen = read.and_then(|read| choose(read, choice.as_deref()));
        Some(chosen.map_err(|kind| kind.at(path)))
    }

    fn parse_packed(
        &self,
        path: &Path,
        bytes: &[u8],
        around: Around<'_>,
        depth: usize,
    ) -> Result<ClipFile, FileErrorKind> {
        if depth < DEEPEST && container::is_gzip(bytes) {
            let limits = self.limits.of_packed(bytes.len());
            let unpacked = container::gunzip(bytes, limits.memory)?;
            let reader = self.with_limits(limits.without(unpacked.len())?);
            let inner = match path.extension() {
                Some(ending) if ending.eq_ignore_ascii_case("gz") => path.with_extension(""),
                _ => path.to_owned(),
            };
            return reader.parse_packed(&inner, &unpacked, around, depth + 1);
        }
        let is_archive = container::is_zip(bytes) && probe(bytes, "") != Ok(Format::Smpl);
        if depth < DEEPEST && is_archive {
            return self.parse_archive(path, bytes, depth);
        }
        let bare = container::without_padding(bytes);
        let text: Cow<'_, [u8]> = container::utf8(bare);
        let mut opened = match &text {
            Cow::Borrowed(text) => self.parse_bare(path, text, around)?,
            Cow::Owned(text) => {
                let reader = self.with_limits(self.limits.without(text.len())?);
                reader.parse_bare(path, text, around)?
            }
        };
        if bare.len() < bytes.len() {
            let note = format!(
                "{} zero bytes after the text left out",
                bytes.len() - bare.len()
            );
            opened.warnings.push(Warning::new(Place::File, note));
        }
        if let Cow::Owned(_) = text {
            let note = "UTF-16 text";
            opened.warnings.push(Warning::new(Place::File, note));
        }
        Ok(opened)
    }

    pub(super) fn with_limits(&self, limits: Limits) -> Self {
        Self {
            limits,
            ..self.clone()
        }
    }

    /// The clips of all files in a zip archive that can be read; the others are named in warnings.
    fn parse_archive(
        &self,
        path: &Path,
        bytes: &[u8],
        depth: usize,
    ) -> Result<ClipFile, FileErrorKind> {
        let mut limits = self.limits.of_packed(bytes.len());
        let members = container::unzip(bytes, &may_be_needed, limits.memory)?;
        limits = limits.without(members.iter().map(|member| member.bytes.len()).sum())?;
        let members = sequence::join(members);
        let mut all: Option<ClipFile> = None;
        let mut first_error = None;
        let mut refused = Vec::new();
        for member in members.iter().filter(|member| is_motion(member)) {
            let inner = Path::new(&member.path);
            let reader = self.with_limits(limits);
            match reader.parse_packed(inner, &member.bytes, Around::Archive(&members), depth + 1) {
                Ok(opened) => {
                    limits = limits.without(opened.clips.iter().map(memory_of).sum())?;
                    gather(&mut all, opened, &member.path);
                }
                // What comes behind it would be left out as well.
                Err(error) if error.is_of_memory() => return Err(error),
                Err(error) => {
                    refused.push(format!("{}: {error}", member.path));
                    first_error.get_or_insert(error);
                }
            }
        }
        let mut opened = match (all, first_error) {
            (Some(opened), _) => opened,
            (None, Some(error)) if refused.len() == 1 => return Err(error),
            (None, _) => {
                // Workbooks and scenes are archives, too.
                let known = probe(bytes, "").err();
                let known = known.filter(|error| !error.found.contains("a zip archive"));
                return Err(known.unwrap_or_else(|| nothing_in(bytes, &refused)).into());
            }
        };
        for text in refused {
            let text = format!("left out: {text}");
            opened.warnings.push(Warning::new(Place::File, text));
        }
        if opened.clips.len() > 1 {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            for clip in &mut opened.clips {
                clip.name = format!("{stem}#{}", clip.name);
            }
        }
        Ok(opened)
    }
}

/// Bytes of memory that a clip takes.
fn memory_of(clip: &Clip) -> usize {
    let joint = |joint: &Joint| size_of::<Joint>() + joint.name.len();
    let positions = clip.tracks.iter().map(|track| track.positions.len());
    size_of_val(clip.rotations.as_slice())
        + positions.sum::<usize>() * size_of::<Vec3>()
        + clip.skeleton.joints().iter().map(joint).sum::<usize>()
        + size_of::<Clip>()
}

/// Files of an archive worth unpacking: motions, skeletons, what scenes keep in files of their own.
fn may_be_needed(path: &str) -> bool {
    let name = path.rsplit('/').next().unwrap_or(path);
    let hidden = name.starts_with('.') || path.starts_with("__MACOSX/");
    let ending = name.rsplit('.').next().unwrap_or_default();
    let packed = [
        "bin", "gz", "zip", "txt", "json", "emt", "asc", "dat", "prn", "xyz",
    ]
    .iter();
    !hidden
        && (format_of_name(name).is_some()
            || packed
                .into_iter()
                .any(|known| ending.eq_ignore_ascii_case(known)))
}

/// True if a file of an archive is a clip, by its name or its content.
fn is_motion(member: &Member) -> bool {
    match format_of_name(&member.path) {
        Some(format) if format.is_skeleton() => false,
        // Tables and JSON hold labels and lists, too: what is in them decides.
        Some(Format::Table | Format::Jsonl) => probe(&member.bytes, "").is_ok(),
        Some(_) => true,
        None => {
            let bytes = &member.bytes;
            let packed = container::is_gzip(bytes) || container::is_zip(bytes);
            packed
                || mocopi::looks_so(bytes)
                || probe(bytes, "").is_ok_and(|format| !format.is_skeleton())
        }
    }
}

fn gather(all: &mut Option<ClipFile>, mut opened: ClipFile, path: &str) {
    for warning in &mut opened.warnings {
        warning.text = format!("{path} {}: {}", warning.at, warning.text);
        warning.at = Place::File;
    }
    match all {
        Some(all) => {
            all.clips.append(&mut opened.clips);
            all.warnings.append(&mut opened.warnings);
            // What one file states says nothing of another.
            all.stated = all.stated.filter(|stated| opened.stated == Some(*stated));
        }
        None => *all = Some(opened),
    }
}

fn nothing_in(bytes: &[u8], refused: &[String]) -> ParseError {
    let found = if refused.is_empty() {
        let mut paths = container::zip_paths(bytes).unwrap_or_default();
        let more = paths.len().saturating_sub(5);
        paths.truncate(5);
        match (paths.is_empty(), more) {
            (true, _) => "an empty one".to_owned(),
            (false, 0) => paths.join(", "),
            (false, more) => format!("{} and {more} more", paths.join(", ")),
        }
    } else {
        let shown: Vec<&str> = refused.iter().take(5).map(String::as_str).collect();
        format!("{} unreadable: {}", refused.len(), shown.join("; "))
    };
    ParseError::new(Place::File, "a zip archive with motions", found)
}

/// The file with the clip that was asked for, if one was.
fn choose(mut file: ClipFile, choice: Option<&str>) -> Result<ClipFile, FileErrorKind> {
    if let Some(choice) = choice {
        file.clips = chosen(file.clips, choice)?;
    }
    Ok(file)
}

#[cfg(test)]
mod tests;
