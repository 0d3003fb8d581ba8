//! Clip files as clips: BVH, AMC with the ASF skeleton it needs, stored clips.

use std::fs;
use std::path::{Path, PathBuf};

use morec::clip::Clip;
use morec::formats::acclaim::{self, AmcOptions, Asf};
use morec::formats::bvh::{self, BvhOptions, PositionChannels};
use morec::formats::container::Member;
use morec::formats::probe::{Format, format_of_name, probe};
use morec::formats::{Limits, Loaded, ParseError, Place, Warning, mclip};
use morec::formats::{c3d, jsonl, read_scene, table, trc};

use crate::archives::Around;
use crate::{ClipReader, ReadFile};

/// Reads every format that morec knows; an AMC motion finds its ASF skeleton beside it or a folder above.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FileReader {
    /// The skeleton of AMC motions, in place of looking for one.
    pub skeleton: Option<PathBuf>,
    /// Frames a second, in place of what the file says (AMC files say nothing).
    pub rate_hz: Option<f64>,
    /// What BVH position channels below the root mean; decided from the data if not given.
    pub positions: Option<PositionChannels>,
    /// What a file may declare.
    pub limits: Limits,
}

/// Clips of a file.
#[derive(Debug, Clone)]
pub struct OpenedFile {
    /// What it is.
    pub format: Format,
    /// The skeleton file that an AMC motion was read with.
    pub skeleton: Option<PathBuf>,
    /// One clip for each character; an ASF file gives one without frames.
    pub clips: Vec<Clip>,
    /// What was repaired or looks wrong.
    pub warnings: Vec<Warning>,
}

/// Why a file cannot be read; of the file itself unless another is named.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// It is not what it should be.
    #[error(transparent)]
    Parse(#[from] ParseError),
    /// A skeleton file cannot be opened.
    #[error("skeleton {path}: {why}")]
    Open {
        /// The skeleton file.
        path: PathBuf,
        /// Why.
        why: std::io::Error,
    },
    /// A skeleton file is not what it should be.
    #[error("skeleton {path}: {why}")]
    Skeleton {
        /// The skeleton file.
        path: PathBuf,
        /// Where and why.
        why: ParseError,
    },
    /// The motion is not what it should be, or not of this skeleton.
    #[error("with skeleton {skeleton}: {why}")]
    Motion {
        /// The skeleton file.
        skeleton: PathBuf,
        /// Where and why.
        why: ParseError,
    },
    /// There is no skeleton near an AMC motion.
    #[error(
        "an AMC motion needs its ASF skeleton, and none lies beside it or a folder above; give --skeleton"
    )]
    NoSkeleton,
}

impl ClipReader for FileReader {
    fn read(&self, path: &Path, bytes: &[u8]) -> Result<ReadFile, String> {
        let opened = self.open(path, bytes).map_err(|error| error.to_string())?;
        Ok(ReadFile {
            format: format!("{:?}", opened.format).to_lowercase(),
            skeleton: opened.skeleton,
            clips: opened.clips,
            warnings: opened.warnings,
        })
    }
}

impl FileReader {
    /// Reads `bytes`, which are the file at `path` and neither packed nor UTF-16.
    pub(crate) fn open_bare(
        &self,
        path: &Path,
        bytes: &[u8],
        around: Around<'_>,
    ) -> Result<OpenedFile, FileError> {
        let stem = if path == Path::new("-") {
            "stdin".to_owned()
        } else {
            stem(path)
        };
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
        Ok(OpenedFile {
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
    ) -> Result<(Loaded, PathBuf), FileError> {
        if let Some(skeleton) = &self.skeleton {
            let loaded = self.amc_with(bytes, stem, skeleton, Around::Folder)?;
            return Ok((loaded, skeleton.clone()));
        }
        let candidates = match around {
            Around::Folder => skeletons_near(path, stem),
            Around::Archive(members) => skeletons_among(members, stem),
        };
        let mut best: Option<(Loaded, &Skeleton)> = None;
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
            return Err(first_error.unwrap_or(FileError::NoSkeleton));
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
    ) -> Result<Loaded, FileError> {
        let path = || skeleton.to_owned();
        let asf = around
            .read(skeleton)
            .map_err(|why| FileError::Open { path: path(), why })?;
        let (asf, mut warnings) = acclaim::read_asf(&asf, &self.limits)
            .map_err(|why| FileError::Skeleton { path: path(), why })?;
        for warning in &mut warnings {
            warning.text = format!("{} {}: {}", skeleton.display(), warning.at, warning.text);
            warning.at = Place::File;
        }
        let options = AmcOptions {
            rate_hz: self.rate_hz,
        };
        let mut loaded =
            acclaim::read_amc(bytes, stem, &asf, &options, &self.limits).map_err(|why| {
                FileError::Motion {
                    skeleton: path(),
                    why,
                }
            })?;
        loaded.warnings.splice(0..0, warnings);
        Ok(loaded)
    }
}

fn stem(path: &Path) -> String {
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

/// A skeleton file that may be a motion's.
struct Skeleton {
    kinship: usize,
    path: PathBuf,
}

/// Skeletons beside a motion and then those a folder above, in each the likeliest first: of the same stem, of
/// the longest part of it (`13` for `13_29`), the others.
fn skeletons_near(path: &Path, stem: &str) -> Vec<Skeleton> {
    // So many skeletons in one folder are a library's, and trying them all no way to find the right one.
    const MOST: usize = 64;
    if path == Path::new("-") {
        return Vec::new();
    }
    let beside = match path.parent() {
        Some(folder) if folder != Path::new("") => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    let above = match (beside.file_name(), beside.parent()) {
        (Some(_), Some(above)) if above != Path::new("") => above.to_owned(),
        (Some(_), _) => PathBuf::from("."),
        (None, _) => beside.join(".."),
    };
    let mut found = Vec::new();
    for folder in [beside, above] {
        let paths = fs::read_dir(&folder)
            .into_iter()
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.path()));
        let mut here = likeliest_first(paths, stem);
        here.truncate(MOST);
        found.append(&mut here);
    }
    found
}

/// Skeletons in the archive that a motion is in.
fn skeletons_among(members: &[Member], stem: &str) -> Vec<Skeleton> {
    likeliest_first(members.iter().map(|m| PathBuf::from(&m.path)), stem)
}

fn likeliest_first(paths: impl Iterator<Item = PathBuf>, stem: &str) -> Vec<Skeleton> {
    let mut found: Vec<Skeleton> = paths
        .filter(|path| format_of_name(&path.to_string_lossy()) == Some(Format::Asf))
        .map(|path| Skeleton {
            kinship: kinship(&self::stem(&path), stem),
            path,
        })
        .collect();
    found.sort_by(|a, b| b.kinship.cmp(&a.kinship).then_with(|| a.path.cmp(&b.path)));
    found
}

/// How much of a motion's stem a skeleton's stem says: its length if the motion's begins with it and a mark
/// follows, else 0.
fn kinship(skeleton: &str, motion: &str) -> usize {
    match motion.to_lowercase().strip_prefix(&skeleton.to_lowercase()) {
        Some(rest) if rest.chars().next().is_none_or(|c| !c.is_alphanumeric()) => {
            skeleton.len() + 1
        }
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subjects_own_their_trials() {
        assert!(kinship("13_29", "13_29") > kinship("13", "13_29"));
        assert!(kinship("13", "13_29") > 0);
        assert_eq!(kinship("1", "13_29"), 0);
        assert_eq!(kinship("skeleton", "13_29"), 0);
        assert!(kinship("HDM_dg", "hdm_dg_06-03_120") > 0);
    }

    const ASF: &[u8] = include_bytes!("../../morec/testdata/acclaim/arm.asf");
    const AMC: &[u8] = include_bytes!("../../morec/testdata/acclaim/wave.amc");

    #[test]
    fn a_motion_finds_its_skeleton_and_says_when_there_is_none() {
        let folder = tempfile::TempDir::new().unwrap();
        let motion = folder.path().join("takes/13_29.amc");
        std::fs::create_dir(folder.path().join("takes")).unwrap();
        let reader = FileReader::default();
        assert!(matches!(
            reader.open(&motion, AMC),
            Err(FileError::NoSkeleton)
        ));
        std::fs::write(folder.path().join("13.asf"), ASF).unwrap();
        let read = ClipReader::read(&reader, &motion, AMC).unwrap();
        assert_eq!((read.format.as_str(), read.clips.len()), ("amc", 1));
        assert_eq!(read.skeleton.unwrap(), folder.path().join("13.asf"));
        assert_eq!(read.clips[0].name, "13_29");
        let named = FileReader {
            skeleton: Some("nowhere.asf".into()),
            ..FileReader::default()
        };
        assert!(
            ClipReader::read(&named, &motion, AMC)
                .unwrap_err()
                .contains("nowhere.asf")
        );
    }
}
