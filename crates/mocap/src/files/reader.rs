//! The reader of clip files: from a path and its bytes to clips, and to takes. The command, the studio and Python read through
//! it.

use std::fs::File;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::clip::Clip;
use crate::formats::bvh::{self, BvhOptions, PositionChannels};
use crate::formats::container::zip_paths;
#[cfg(feature = "fbx")]
use crate::formats::fbx;
use crate::formats::numpy;
use crate::formats::probe::probe;
use crate::formats::{Format, FormatInput, Limits, ParseError, Place, Warning};
#[cfg(feature = "fbx")]
use crate::import::SignedAxis;
use crate::import::{ImportOptions, Stated, Take, normalize};
use crate::roles::mapping::Mapping;

use super::neighbours::Around;
use super::sequence::FrameFiles;
use super::skeletons::SkeletonKind;
use super::{FileError, FileErrorKind, Takes, list, read_file, read_stream, split_choice};

/// Reads every format that morec knows, as its fields say; the default decides everything from the files.
#[derive(Debug, Clone, Default)]
pub struct FileReader {
    /// The skeleton of AMC motions, or the model of OpenSim's, in place of looking for one.
    pub skeleton: Option<PathBuf>,
    /// Frames a second, in place of what the file says (AMC files say nothing).
    pub rate_hz: Option<f64>,
    /// Meaning of BVH position channels below the root; decided from the data if not given.
    pub positions: Option<PositionChannels>,
    /// Limits of what a file may declare.
    pub limits: Limits,
    /// Unit, up axis and roles, where they are not to be inferred.
    pub import: ImportOptions,
    /// Accept points that have two coordinates, as points of one plane. With custom roles they are always accepted.
    pub planar: bool,
}

/// Clips of a file as it holds them: in its units and axes.
#[derive(Debug, Clone, PartialEq)]
pub struct ClipFile {
    /// Format of the file.
    pub format: Format,
    /// The skeleton or model that an AMC or OpenSim motion was read with.
    pub skeleton: Option<PathBuf>,
    /// One clip for each character; an ASF file gives one without frames.
    pub clips: Vec<Clip>,
    /// Repairs and oddities.
    pub warnings: Vec<Warning>,
    /// Unit of length and up axis as the file, or its format, states them.
    pub stated: Option<Stated>,
}

impl ClipFile {
    /// The clips made ready, each with the warnings of the file.
    ///
    /// # Errors
    /// A mapping in `options` that names a joint which a clip does not have.
    pub fn into_takes(self, options: &ImportOptions) -> Result<Vec<Take>, ParseError> {
        let warnings = self.warnings;
        let options = &ImportOptions {
            stated: self.stated,
            ..options.clone()
        };
        let ready = |clip| {
            let take = normalize(clip, options)?;
            Ok(Take {
                warnings: warnings.clone(),
                ..take
            })
        };
        self.clips.into_iter().map(ready).collect()
    }
}

impl FileReader {
    /// The takes in the file at `path`: one for each character of each clip in it. `FILE#2` and `FILE#name` choose one of
    /// its clips; `-` is standard input.
    ///
    /// # Errors
    /// The file cannot be read, is in no format that is read, or is damaged; [`FileErrorKind`] says which.
    pub fn open(&self, path: &Path) -> Result<Vec<Take>, FileError> {
        self.takes(path, self.read(path)?)
    }

    /// The takes in files and folders (and the folders below), read in parallel.
    ///
    /// # Errors
    /// A folder that cannot be read; no clip that can be. Files that cannot be used are listed in
    /// [`Takes::refused`] otherwise.
    pub fn open_all(&self, paths: &[PathBuf]) -> Result<Takes, FileError> {
        let listing = list(paths)?;
        let opened: Vec<_> = listing
            .clips
            .par_iter()
            .map(|path| self.open(path))
            .collect();
        let mut all = Takes {
            refused: listing.left_out,
            others: listing.others,
            ..Takes::default()
        };
        for (path, result) in listing.clips.iter().zip(opened) {
            match result {
                Ok(takes) if takes.iter().all(|take| take.clip.frames == 0) => {
                    let none = ParseError::new(Place::File, "frames of motion", "none");
                    all.refused.push(FileErrorKind::Parse(none).at(path));
                }
                Ok(takes) => all.takes.extend(takes),
                Err(error) => all.refused.push(error),
            }
        }
        match (all.takes.is_empty(), all.refused.is_empty()) {
            (true, false) => Err(all.refused.swap_remove(0)),
            _ => Ok(all),
        }
    }

    /// The clips in the file at `path`, in the file's units and axes; as [`open`](Self::open) otherwise.
    ///
    /// # Errors
    /// Those of [`open`](Self::open), but for the mapping of roles.
    pub fn read(&self, path: &Path) -> Result<ClipFile, FileError> {
        if let Some(read) = self.read_large(path) {
            return read;
        }
        let bytes = match path == Path::new("-") {
            true => read_stream(std::io::stdin().lock()),
            false => read_file(&split_choice(path).0),
        };
        let bytes = bytes.map_err(|error| FileErrorKind::Io(error).at(path))?;
        self.parse(path, &bytes)
    }

    fn takes(&self, path: &Path, file: ClipFile) -> Result<Vec<Take>, FileError> {
        let takes = file.into_takes(&self.import);
        takes.map_err(|error| FileErrorKind::Parse(error).at(path))
    }

    /// Reads `bytes`, which are the file at `path` and neither packed nor UTF-16.
    pub(super) fn parse_bare(
        &self,
        path: &Path,
        bytes: &[u8],
        around: Around<'_>,
    ) -> Result<ClipFile, FileErrorKind> {
        let mut stem = stem(path);
        let format = match probe(bytes, &path.to_string_lossy())? {
            // Archives of poses and of positions look alike at their beginning.
            Format::Smpl if numpy::has_positions(&zip_paths(bytes).unwrap_or_default()) => {
                Format::Numpy
            }
            format => format,
        };
        if let (Format::Landmarks, Around::Folder) = (format, around)
            && let Some(name) = FrameFiles::around(path).and_then(|frames| frames.name())
        {
            stem = name;
        }
        #[cfg_attr(not(feature = "fbx"), allow(unused_mut))]
        let mut stated = Stated::of(format);
        let (loaded, skeleton) = match format {
            Format::Amc => self.paired(SkeletonKind::Asf, path, bytes, &stem, around)?,
            Format::OpenSimMotion => {
                self.paired(SkeletonKind::OsimModel, path, bytes, &stem, around)?
            }
            Format::OpenSimModel => return Err(FileErrorKind::OnlyModel),
            #[cfg(feature = "fbx")]
            Format::Fbx => {
                let (loaded, by_file) = fbx::read_stated(bytes, &stem, self.rate_hz, &self.limits)?;
                stated = by_file.map(|settings| Stated {
                    up: SignedAxis {
                        axis: settings.up,
                        negative: settings.is_down,
                    },
                    metres_per_unit: settings.metres_per_unit,
                });
                (loaded, None)
            }
            format => {
                let source = FormatInput {
                    bytes,
                    name: &stem,
                    rate_hz: self.rate_hz,
                    positions: self.positions,
                    planar: self.planar
                        || self.import.mapping.as_ref().is_some_and(Mapping::is_custom),
                    beside: &|name| around.file(path, name),
                    limits: &self.limits,
                };
                (format.read(&source)?, None)
            }
        };
        Ok(ClipFile {
            format,
            skeleton,
            clips: loaded.clips,
            warnings: loaded.warnings,
            stated,
        })
    }

    /// A BVH file of which a piece at a time is held.
    pub(super) fn parse_bvh(&self, path: &Path, file: File) -> Result<ClipFile, FileErrorKind> {
        let options = BvhOptions {
            positions: self.positions,
            rate_hz: self.rate_hz,
            ..BvhOptions::default()
        };
        let loaded = bvh::read_from(file, &stem(path), &options, &self.limits)?;
        Ok(ClipFile {
            stated: Stated::of(Format::Bvh),
            format: Format::Bvh,
            skeleton: None,
            clips: loaded.clips,
            warnings: loaded.warnings,
        })
    }
}

/// Name of a clip after its file.
fn stem(path: &Path) -> String {
    if path == Path::new("-") {
        return "stdin".to_owned();
    }
    path.file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASF: &[u8] = include_bytes!("../../testdata/acclaim/arm.asf");
    const AMC: &[u8] = include_bytes!("../../testdata/acclaim/wave.amc");

    #[test]
    fn a_folder_gives_its_takes_and_names_what_it_cannot_read() {
        let folder = tempfile::TempDir::new().unwrap();
        let motion = folder.path().join("13_29.amc");
        std::fs::write(folder.path().join("13.asf"), ASF).unwrap();
        std::fs::write(&motion, AMC).unwrap();
        std::fs::write(folder.path().join("broken.bvh"), "nothing").unwrap();
        std::fs::write(folder.path().join("notes.md"), "nothing").unwrap();
        let takes = super::super::open_all(folder.path()).unwrap();
        let names: Vec<&str> = takes.iter().map(Take::name).collect();
        assert_eq!((names, takes.others), (vec!["13_29"], 1));
        assert_eq!(takes.refused.len(), 1);
        assert!(takes.refused[0].to_string().contains("broken.bvh: "));
        let [one] = &super::super::open(&motion).unwrap()[..] else {
            panic!("one take");
        };
        assert_eq!(one, &takes[0]);
        std::fs::remove_file(&motion).unwrap();
        let error = super::super::open_all(folder.path()).unwrap_err();
        assert!(error.to_string().contains("broken.bvh"), "{error}");
    }
}
