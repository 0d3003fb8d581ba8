//! What reads clip files: from bytes and their path to clips, and on to takes.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::clip::Clip;
use crate::formats::acclaim::{self, AmcOptions, Asf};
use crate::formats::bvh::{self, BvhOptions, PositionChannels};
use crate::formats::probe::{Format, probe};
use crate::formats::{Limits, Loaded, ParseError, Place, Warning, mclip};
use crate::formats::{c3d, jsonl, read_scene, table, trc};
use crate::import::{ImportOptions, Take, normalize};

use super::archives::Around;
use super::skeletons::{SkeletonFile, skeletons_among, skeletons_near};
use super::{FileError, FileErrorKind, Takes, list, read_file, read_stream, split_choice};

/// Reads every format that morec knows, as its fields say; the default decides everything from the files.
#[derive(Debug, Clone, Default)]
pub struct FileReader {
    /// The skeleton of AMC motions, in place of looking for one.
    pub skeleton: Option<PathBuf>,
    /// Frames a second, in place of what the file says (AMC files say nothing).
    pub rate_hz: Option<f64>,
    /// What BVH position channels below the root mean; decided from the data if not given.
    pub positions: Option<PositionChannels>,
    /// What a file may declare.
    pub limits: Limits,
    /// How clips become takes.
    pub import: ImportOptions,
}

/// Clips of a file as it holds them: in its units and axes.
#[derive(Debug, Clone, PartialEq)]
pub struct ClipFile {
    /// What it is.
    pub format: Format,
    /// The skeleton file that an AMC motion was read with.
    pub skeleton: Option<PathBuf>,
    /// One clip for each character; an ASF file gives one without frames.
    pub clips: Vec<Clip>,
    /// What was repaired or looks wrong.
    pub warnings: Vec<Warning>,
}

impl ClipFile {
    /// The clips made ready, each with the warnings of the file.
    ///
    /// # Errors
    /// A mapping in `options` that names a joint which a clip does not have.
    pub fn into_takes(self, options: &ImportOptions) -> Result<Vec<Take>, ParseError> {
        let warnings = self.warnings;
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
        let stem = stem(path);
        let format = probe(bytes, &path.to_string_lossy())?;
        let (loaded, skeleton) = match format {
            Format::Bvh => (bvh::read(bytes, &stem, &self.bvh(), &self.limits)?, None),
            Format::Asf => {
                let (asf, warnings) = acclaim::read_asf(bytes, &self.limits)?;
                (
                    Loaded {
                        clips: vec![without_frames(&asf, stem)],
                        warnings,
                    },
                    None,
                )
            }
            Format::Amc => {
                let (loaded, skeleton) = self.amc(path, bytes, &stem, around)?;
                (loaded, Some(skeleton))
            }
            Format::Mclip => (self.mclip(bytes, &stem)?, None),
            Format::C3d => (c3d::read(bytes, &stem, self.rate_hz, &self.limits)?, None),
            Format::Trc => (trc::read(bytes, &stem, self.rate_hz, &self.limits)?, None),
            Format::Table => (table::read(bytes, &stem, self.rate_hz, &self.limits)?, None),
            Format::Jsonl => (jsonl::read(bytes, &stem, self.rate_hz, &self.limits)?, None),
            scene => {
                let beside = |name: &str| around.file(path, name);
                let (rate_hz, limits) = (self.rate_hz, &self.limits);
                let loaded = read_scene(scene, bytes, &stem, rate_hz, &beside, limits);
                let none = || ParseError::new(Place::File, "a format that is read", "another");
                (loaded.ok_or_else(none)??, None)
            }
        };
        Ok(ClipFile {
            format,
            skeleton,
            clips: loaded.clips,
            warnings: loaded.warnings,
        })
    }

    fn bvh(&self) -> BvhOptions {
        BvhOptions {
            positions: self.positions,
            rate_hz: self.rate_hz,
            ..BvhOptions::default()
        }
    }

    fn mclip(&self, bytes: &[u8], stem: &str) -> Result<Loaded, ParseError> {
        let mut loaded = mclip::read(bytes, stem, &self.limits)?;
        for clip in &mut loaded.clips {
            clip.rate_hz = self.rate_hz.unwrap_or(clip.rate_hz);
        }
        Ok(loaded)
    }

    /// A motion with the skeleton given, or with the first one near it that it fits.
    fn amc(
        &self,
        path: &Path,
        bytes: &[u8],
        stem: &str,
        around: Around<'_>,
    ) -> Result<(Loaded, PathBuf), FileErrorKind> {
        if let Some(skeleton) = &self.skeleton {
            let loaded = self.amc_with(bytes, stem, skeleton, Around::Folder)?;
            return Ok((loaded, skeleton.clone()));
        }
        let candidates = match around {
            Around::Folder => skeletons_near(path, stem),
            Around::Archive(members) => skeletons_among(members, stem),
        };
        let mut best: Option<(Loaded, &SkeletonFile)> = None;
        let mut first_error = None;
        for skeleton in &candidates {
            match self.amc_with(bytes, stem, &skeleton.path, around) {
                // Fewer warnings: a skeleton that lacks bones of the motion is not the right one.
                Ok(loaded)
                    if best
                        .as_ref()
                        .is_none_or(|(b, _)| loaded.warnings.len() < b.warnings.len()) =>
                {
                    let clean = loaded.warnings.len() <= usize::from(self.rate_hz.is_none());
                    best = Some((loaded, skeleton));
                    if clean {
                        break;
                    }
                }
                Ok(_) => {}
                Err(error) => _ = first_error.get_or_insert(error),
            }
        }
        let Some((mut loaded, skeleton)) = best else {
            return Err(first_error.unwrap_or(FileErrorKind::NoSkeleton));
        };
        if skeleton.kinship == 0 && candidates.len() > 1 {
            let shown = skeleton.path.display();
            let note = format!("skeleton {shown} is the first that fits; its name does not say");
            loaded.warnings.push(Warning::new(Place::File, note));
        }
        Ok((loaded, skeleton.path.clone()))
    }

    fn amc_with(
        &self,
        bytes: &[u8],
        stem: &str,
        skeleton: &Path,
        around: Around<'_>,
    ) -> Result<Loaded, FileErrorKind> {
        let path = || skeleton.to_owned();
        let asf = around
            .read(skeleton)
            .map_err(|why| FileErrorKind::OpenSkeleton { path: path(), why })?;
        let (asf, mut warnings) = acclaim::read_asf(&asf, &self.limits)
            .map_err(|why| FileErrorKind::Skeleton { path: path(), why })?;
        for warning in &mut warnings {
            warning.text = format!("{} {}: {}", skeleton.display(), warning.at, warning.text);
            warning.at = Place::File;
        }
        let options = AmcOptions {
            rate_hz: self.rate_hz,
        };
        let mut loaded =
            acclaim::read_amc(bytes, stem, &asf, &options, &self.limits).map_err(|why| {
                FileErrorKind::Motion {
                    skeleton: path(),
                    why,
                }
            })?;
        loaded.warnings.splice(0..0, warnings);
        Ok(loaded)
    }
}

/// What a clip is called after its file.
fn stem(path: &Path) -> String {
    if path == Path::new("-") {
        return "stdin".to_owned();
    }
    path.file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

fn without_frames(asf: &Asf, name: String) -> Clip {
    Clip {
        name,
        skeleton: asf.skeleton(),
        rate_hz: acclaim::DEFAULT_RATE_HZ,
        rotations: Vec::new(),
        tracks: Vec::new(),
        frames: 0,
        repaired: Vec::new(),
        points: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASF: &[u8] = include_bytes!("../../testdata/acclaim/arm.asf");
    const AMC: &[u8] = include_bytes!("../../testdata/acclaim/wave.amc");

    #[test]
    fn a_motion_finds_its_skeleton_and_says_when_there_is_none() {
        let folder = tempfile::TempDir::new().unwrap();
        let motion = folder.path().join("takes/13_29.amc");
        std::fs::create_dir(folder.path().join("takes")).unwrap();
        let reader = FileReader::default();
        let error = reader.parse(&motion, AMC).unwrap_err();
        assert!(matches!(*error.kind, FileErrorKind::NoSkeleton));
        std::fs::write(folder.path().join("13.asf"), ASF).unwrap();
        let read = reader.parse(&motion, AMC).unwrap();
        assert_eq!((read.format.name(), read.clips.len()), ("amc", 1));
        assert_eq!(read.skeleton.unwrap(), folder.path().join("13.asf"));
        assert_eq!(read.clips[0].name, "13_29");
        let named = FileReader {
            skeleton: Some("nowhere.asf".into()),
            ..FileReader::default()
        };
        let error = named.parse(&motion, AMC).unwrap_err().to_string();
        assert!(error.contains("nowhere.asf"), "{error}");
    }

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
