//! Reader of clip files: from bytes and their path to clips, and on to takes.

use std::fs::File;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::clip::Clip;
use crate::formats::acclaim::{self, AmcOptions, Asf};
use crate::formats::bvh::{self, BvhOptions, PositionChannels};
use crate::formats::container::zip_paths;
#[cfg(feature = "fbx")]
use crate::formats::fbx;
use crate::formats::probe::{Format, probe};
use crate::formats::{Limits, Loaded, ParseError, Place, Warning, mclip};
use crate::formats::{c3d, jsonl, numpy, opensim, read_scene, table, trc};
#[cfg(feature = "fbx")]
use crate::import::SignedAxis;
use crate::import::{ImportOptions, Stated, Take, normalize};
use crate::kinematics::WorldPose;

use super::neighbours::Around;
use super::sequence::FrameFiles;
use super::skeletons::{SkeletonFile, prefer_stated, skeletons_among, skeletons_near};
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
    /// Options of the import.
    pub import: ImportOptions,
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
    /// What the file, or its format, states about lengths and axes.
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
            Format::OpenSimMotion => {
                let (loaded, model) = self.opensim(path, bytes, &stem, around)?;
                (loaded, Some(model))
            }
            Format::OpenSimModel => return Err(FileErrorKind::OnlyModel),
            Format::Mclip => (self.mclip(bytes, &stem)?, None),
            Format::C3d => (c3d::read(bytes, &stem, self.rate_hz, &self.limits)?, None),
            Format::Trc => (trc::read(bytes, &stem, self.rate_hz, &self.limits)?, None),
            Format::Table => (table::read(bytes, &stem, self.rate_hz, &self.limits)?, None),
            Format::Jsonl => (jsonl::read(bytes, &stem, self.rate_hz, &self.limits)?, None),
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
            stated,
        })
    }

    /// A BVH file of which a piece at a time is held.
    pub(super) fn parse_bvh(&self, path: &Path, file: File) -> Result<ClipFile, FileErrorKind> {
        let loaded = bvh::read_from(file, &stem(path), &self.bvh(), &self.limits)?;
        Ok(ClipFile {
            stated: Stated::of(Format::Bvh),
            format: Format::Bvh,
            skeleton: None,
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

    /// A motion with the skeleton given, or with the one near it that is most likely its own.
    fn amc(
        &self,
        path: &Path,
        bytes: &[u8],
        stem: &str,
        around: Around<'_>,
    ) -> Result<(Loaded, PathBuf), FileErrorKind> {
        let with = |skeleton: &Path, around| self.amc_with(bytes, stem, skeleton, around);
        if let Some(skeleton) = &self.skeleton {
            return Ok((with(skeleton, Around::Folder)?, skeleton.clone()));
        }
        let mut candidates = near(path, stem, Format::Asf, around);
        prefer_stated(&mut candidates, bytes);
        likeliest(&candidates, |path| with(path, around)).unwrap_or(Err(FileErrorKind::NoSkeleton))
    }

    /// Joint angles with the model given, or with the one near them that is most likely theirs.
    fn opensim(
        &self,
        path: &Path,
        bytes: &[u8],
        stem: &str,
        around: Around<'_>,
    ) -> Result<(Loaded, PathBuf), FileErrorKind> {
        let with = |model: &Path, around| self.opensim_with(bytes, stem, model, around);
        if let Some(model) = &self.skeleton {
            return Ok((with(model, Around::Folder)?, model.clone()));
        }
        let candidates = near(path, stem, Format::OpenSimModel, around);
        likeliest(&candidates, |path| with(path, around)).unwrap_or(Err(FileErrorKind::NoModel))
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
        let (asf, warnings) = acclaim::read_asf(&asf, &self.limits)
            .map_err(|why| FileErrorKind::Skeleton { path: path(), why })?;
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
        loaded.warnings.splice(0..0, named(skeleton, warnings));
        Ok(loaded)
    }

    fn opensim_with(
        &self,
        bytes: &[u8],
        stem: &str,
        model: &Path,
        around: Around<'_>,
    ) -> Result<Loaded, FileErrorKind> {
        let path = || model.to_owned();
        let xml = around
            .read(model)
            .map_err(|why| FileErrorKind::OpenSkeleton { path: path(), why })?;
        let (read, warnings) = opensim::read_model(&xml, &self.limits)
            .map_err(|why| FileErrorKind::Skeleton { path: path(), why })?;
        let motion = opensim::read_motion(bytes, stem, &read, self.rate_hz, &self.limits);
        let mut loaded = motion.map_err(|why| FileErrorKind::Motion {
            skeleton: path(),
            why,
        })?;
        loaded.warnings.splice(0..0, named(model, warnings));
        Ok(loaded)
    }
}

/// Warnings about a skeleton's file, which they name.
fn named(skeleton: &Path, warnings: Vec<Warning>) -> impl Iterator<Item = Warning> {
    warnings.into_iter().map(move |warning| {
        let text = format!("{} {}: {}", skeleton.display(), warning.at, warning.text);
        Warning::new(Place::File, text)
    })
}

/// Skeletons or models near a motion, the likeliest first.
fn near(path: &Path, stem: &str, format: Format, around: Around<'_>) -> Vec<SkeletonFile> {
    match around {
        Around::Folder => skeletons_near(path, stem, format),
        Around::Archive(members) => skeletons_among(members, stem, format),
    }
}

/// The motion read with the candidate that fits best, and its path; `None` if there are no candidates.
fn likeliest(
    candidates: &[SkeletonFile],
    read: impl Fn(&Path) -> Result<Loaded, FileErrorKind>,
) -> Option<Result<(Loaded, PathBuf), FileErrorKind>> {
    let mut fitting: Vec<Fitting> = Vec::new();
    let mut first_error = None;
    for skeleton in candidates {
        // A skeleton whose name says less is asked only where none that says more fits.
        let says_less = |fits: &Fitting| skeleton.kinship < fits.skeleton.kinship;
        if fitting.len() == MOST_COMPARED || fitting.first().is_some_and(says_less) {
            break;
        }
        match read(&skeleton.path) {
            Ok(loaded) => fitting.push(Fitting { skeleton, loaded }),
            Err(error) => _ = first_error.get_or_insert(error),
        }
    }
    let alike = fitting.len();
    let Some(mut best) = fitting.into_iter().min_by(Fitting::compare) else {
        return first_error.map(Err);
    };
    let path = &best.skeleton.path;
    if best.skeleton.kinship == 0 && alike > 1 {
        let note = format!(
            "{alike} skeletons fit and no name says which is right; {} is taken, with which the feet are nearest to the \
             floor (--skeleton names another)",
            path.display()
        );
        best.loaded.warnings.push(Warning::new(Place::File, note));
    }
    Some(Ok((best.loaded, path.clone())))
}

/// So many skeletons are compared by their bodies.
const MOST_COMPARED: usize = 8;

/// A motion read with a skeleton that it fits.
struct Fitting<'a> {
    skeleton: &'a SkeletonFile,
    loaded: Loaded,
}

impl Fitting<'_> {
    /// Fewer warnings first (a skeleton that lacks bones of the motion is not the right one), then feet nearer to the
    /// floor: legs of another length make them float or sink.
    fn compare(a: &Self, b: &Self) -> std::cmp::Ordering {
        let warnings = a.loaded.warnings.len().cmp(&b.loaded.warnings.len());
        warnings.then_with(|| a.off_floor().total_cmp(&b.off_floor()))
    }

    /// Distance of the lowest joint from 0, in the usual frame.
    fn off_floor(&self) -> f64 {
        const FRAMES: usize = 40;
        let Some(clip) = self.loaded.clips.first().filter(|clip| clip.frames > 0) else {
            return f64::INFINITY;
        };
        let mut pose = WorldPose::default();
        let mut lowest: Vec<f64> = (0..clip.frames)
            .step_by(clip.frames.div_ceil(FRAMES))
            .map(|frame| {
                pose.set(clip, frame);
                let joints = 0..clip.skeleton.len();
                let heights = joints.map(|joint| pose.tip(clip, joint).y);
                heights.fold(f64::MAX, f64::min)
            })
            .collect();
        lowest.sort_by(f64::total_cmp);
        lowest[lowest.len() / 2].abs()
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
    fn of_several_skeletons_the_one_whose_feet_stand_is_taken() {
        let skeleton = |leg: f64| {
            format!(
                ":version 1.10\n:name x\n:units\n mass 1\n length 1\n angle deg\n:root\n order TX TY TZ RX RY RZ\n \
                 axis XYZ\n position 0 0 0\n orientation 0 0 0\n:bonedata\n begin\n id 1\n name leg\n direction 0 -1 0\n \
                 length {leg}\n axis 0 0 0 XYZ\n dof rx\n limits (-180 180)\n end\n:hierarchy\n begin\n root leg\n end\n"
            )
        };
        let folder = tempfile::TempDir::new().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("anna.asf"), skeleton(9.0)).unwrap();
        std::fs::write(at("bert.asf"), skeleton(7.0)).unwrap();
        let motion = ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 7.1 0 0 0 0\nleg 0\n2\nroot 0 7 0 0 0 0\nleg 1\n";
        let reader = FileReader::default();
        let of = |name: &str, motion: &str| reader.parse(&at(name), motion.as_bytes()).unwrap();
        let read = of("take.amc", motion);
        assert_eq!(read.skeleton, Some(at("bert.asf")));
        let told = read
            .warnings
            .iter()
            .any(|w| w.text.contains("2 skeletons fit"));
        assert!(told, "{:?}", read.warnings);
        // A name counts for more, in the file's or in the motion itself.
        assert_eq!(of("anna_walks.amc", motion).skeleton, Some(at("anna.asf")));
        let stated = format!("#!OML:ASF C:\\takes\\ANNA.ASF\n{motion}");
        assert_eq!(of("take.amc", &stated).skeleton, Some(at("anna.asf")));
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
