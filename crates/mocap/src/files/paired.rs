//! Motions with a separate skeleton file: AMC with ASF, OpenSim's `.mot` with `.osim`.

use std::path::{Path, PathBuf};

use crate::formats::acclaim::{self, AmcOptions};
use crate::formats::{Limits, Loaded, Place, Warning, opensim};
use crate::kinematics::WorldPose;

use super::neighbours::Around;
use super::skeletons::{
    SkeletonFile, SkeletonKind, prefer_stated, skeletons_among, skeletons_near,
};
use super::{FileErrorKind, FileReader};

impl FileReader {
    /// A motion with the skeleton given, or with the one near it that is most likely its own; and that skeleton's path.
    pub(super) fn paired(
        &self,
        kind: SkeletonKind,
        path: &Path,
        bytes: &[u8],
        stem: &str,
        around: Around<'_>,
    ) -> Result<(Loaded, Option<PathBuf>), FileErrorKind> {
        if let Some(skeleton) = &self.skeleton {
            let loaded = self.motion_with(kind, bytes, stem, skeleton, Around::Folder)?;
            return Ok((loaded, Some(skeleton.clone())));
        }
        let mut candidates = near(path, stem, kind, around);
        if kind == SkeletonKind::Asf {
            prefer_stated(&mut candidates, bytes);
        }
        // Two readings of it are held while they are compared.
        let memory = self.limits.memory / candidates.len().clamp(1, 2);
        let reader = self.with_limits(Limits {
            memory,
            ..self.limits
        });
        let found = likeliest(&candidates, |path| {
            reader.motion_with(kind, bytes, stem, path, around)
        });
        let (loaded, skeleton) = found.unwrap_or_else(|| Err(kind.missing()))?;
        Ok((loaded, Some(skeleton)))
    }

    fn motion_with(
        &self,
        kind: SkeletonKind,
        bytes: &[u8],
        stem: &str,
        skeleton: &Path,
        around: Around<'_>,
    ) -> Result<Loaded, FileErrorKind> {
        let path = || skeleton.to_owned();
        let of_skeleton = |why| FileErrorKind::Skeleton { path: path(), why };
        let text = around
            .read(skeleton)
            .map_err(|why| FileErrorKind::OpenSkeleton { path: path(), why })?;
        let (limits, rate_hz) = (&self.limits, self.rate_hz);
        let (motion, warnings) = match kind {
            SkeletonKind::Asf => {
                let (asf, warnings) = acclaim::read_asf(&text, limits).map_err(of_skeleton)?;
                let options = AmcOptions { rate_hz };
                let motion = acclaim::read_amc(bytes, stem, &asf, &options, limits);
                (motion, warnings)
            }
            SkeletonKind::OsimModel => {
                let (model, warnings) = opensim::read_model(&text, limits).map_err(of_skeleton)?;
                let motion = opensim::read_motion(bytes, stem, &model, rate_hz, limits);
                (motion, warnings)
            }
        };
        let mut loaded = motion.map_err(|why| FileErrorKind::Motion {
            skeleton: path(),
            why,
        })?;
        loaded.warnings.splice(0..0, named(skeleton, warnings));
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
fn near(path: &Path, stem: &str, kind: SkeletonKind, around: Around<'_>) -> Vec<SkeletonFile> {
    match around {
        Around::Folder => skeletons_near(path, stem, kind),
        Around::Archive(members) => skeletons_among(members, stem, kind),
    }
}

/// The motion read with the candidate that fits best, and its path; `None` if there are no candidates.
fn likeliest(
    candidates: &[SkeletonFile],
    read: impl Fn(&Path) -> Result<Loaded, FileErrorKind>,
) -> Option<Result<(Loaded, PathBuf), FileErrorKind>> {
    let (mut best, mut alike): (Option<Fitting>, usize) = (None, 0);
    let mut first_error = None;
    for skeleton in candidates {
        // A skeleton whose name says less is asked only where none that says more fits.
        let says_less = |fits: &Fitting| skeleton.kinship < fits.skeleton.kinship;
        if alike == MOST_COMPARED || best.as_ref().is_some_and(says_less) {
            break;
        }
        match read(&skeleton.path) {
            Ok(loaded) => {
                let fits = Fitting { skeleton, loaded };
                alike += 1;
                best = match best.take() {
                    Some(best) if Fitting::compare(&fits, &best).is_ge() => Some(best),
                    _ => Some(fits),
                };
            }
            Err(error) => _ = first_error.get_or_insert(error),
        }
    }
    let Some(mut best) = best else {
        return first_error.map(Err);
    };
    let path = &best.skeleton.path;
    if best.skeleton.kinship == 0 && alike > 1 {
        let note = format!(
            "{alike} skeletons fit and no file name decides between them; {} is used, because it brings the feet nearest to the \
             floor (--skeleton FILE chooses another)",
            path.display()
        );
        best.loaded.warnings.push(Warning::new(Place::File, note));
    }
    Some(Ok((best.loaded, path.clone())))
}

/// This many skeletons are compared by their bodies.
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
}
