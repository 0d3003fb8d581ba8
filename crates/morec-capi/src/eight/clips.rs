//! A clip from a file, made ready for playing.

use std::path::{Path, PathBuf};

use morec::clip::Clip;
use morec::formats::acclaim::{AmcOptions, read_amc, read_asf};
use morec::formats::bvh::{self, BvhOptions};
use morec::formats::probe::{Format, format_of_name, probe};
use morec::formats::{Limits, Loaded, ParseError, read_scene};
use morec::formats::{c3d, jsonl, mclip, table, trc};
use morec::import::{ImportOptions, Imported, prepare};
use morec::index::MotionIndex;
use morec::live::Model;
use morec::pivots::NoPivots;

use crate::status::{Error, MorecStatus};

fn file_error(path: &Path, error: impl std::fmt::Display) -> Error {
    Error::new(MorecStatus::File, format!("{}: {error}", path.display()))
}

/// The first clip in the file, in metres and Y up, with its roles.
pub(super) fn load(path: &Path, index: &MotionIndex) -> Result<Imported, Error> {
    let bytes = std::fs::read(path).map_err(|error| file_error(path, error))?;
    let clip = read(path, &bytes)?.filter(|clip| clip.frames > 0);
    let clip = clip.ok_or_else(|| file_error(path, "no frame of motion in it"))?;
    if matches!(index.model, Model::Svrdm(_)) && !clip.has_rotations() {
        return Err(file_error(path, NoPivots::Rotations));
    }
    let mut imported =
        prepare(clip, &ImportOptions::default()).map_err(|error| file_error(path, error))?;
    index.complete_roles(&mut imported.roles, &imported.clip.skeleton);
    Ok(imported)
}

fn read(path: &Path, bytes: &[u8]) -> Result<Option<Clip>, Error> {
    let located = |error| file_error(path, error);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let limits = Limits::default();
    match probe(bytes, &path.to_string_lossy()).map_err(located)? {
        Format::Bvh => {
            let loaded =
                bvh::read(bytes, &stem, &BvhOptions::default(), &limits).map_err(located)?;
            Ok(loaded.clips.into_iter().next())
        }
        Format::Amc => {
            let skeleton = skeleton_of(path, &stem)?;
            let text = std::fs::read(&skeleton).map_err(|error| file_error(&skeleton, error))?;
            let (asf, _) =
                read_asf(&text, &limits).map_err(|error| file_error(&skeleton, error))?;
            let loaded =
                read_amc(bytes, &stem, &asf, &AmcOptions::default(), &limits).map_err(located)?;
            Ok(loaded.clips.into_iter().next())
        }
        Format::Mclip => {
            let loaded = mclip::read(bytes, &stem, &limits).map_err(located)?;
            Ok(loaded.clips.into_iter().next())
        }
        Format::C3d => first(c3d::read(bytes, &stem, None, &limits)).map_err(located),
        Format::Trc => first(trc::read(bytes, &stem, None, &limits)).map_err(located),
        Format::Table => first(table::read(bytes, &stem, None, &limits)).map_err(located),
        Format::Jsonl => first(jsonl::read(bytes, &stem, None, &limits)).map_err(located),
        Format::Asf => Err(file_error(
            path,
            "a skeleton without motion; name the AMC file",
        )),
        other => {
            let beside = |name: &str| std::fs::read(path.with_file_name(name)).ok();
            match read_scene(other, bytes, &stem, None, &beside, &limits) {
                Some(loaded) => Ok(loaded.map_err(located)?.clips.into_iter().next()),
                None => Err(file_error(path, "a format that is not read here")),
            }
        }
    }
}

fn first(loaded: Result<Loaded, ParseError>) -> Result<Option<Clip>, ParseError> {
    Ok(loaded?.clips.into_iter().next())
}

/// The skeleton of a motion: of the same stem, or of the subject's (`13.asf` of `13_29.amc`), or the only one there.
fn skeleton_of(motion: &Path, stem: &str) -> Result<PathBuf, Error> {
    let folder = motion
        .parent()
        .filter(|folder| *folder != Path::new(""))
        .unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).map_err(|error| file_error(folder, error))?;
    let mut skeletons: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| format_of_name(&path.to_string_lossy()) == Some(Format::Asf))
        .collect();
    skeletons.sort();
    let subject = stem.split(['_', '-']).next().unwrap_or(stem);
    let called = |name: &str| {
        skeletons
            .iter()
            .find(|path| path.file_stem().is_some_and(|stem| stem == name))
    };
    let only = if skeletons.len() == 1 {
        skeletons.first()
    } else {
        None
    };
    let found = called(stem).or_else(|| called(subject)).or(only).cloned();
    found.ok_or_else(|| {
        let expected = format!("{stem}.asf or {subject}.asf");
        file_error(
            motion,
            format!("an AMC motion needs its skeleton, and {expected} is not beside it"),
        )
    })
}
