//! Prepares clips for playing: resampled to a rate, without the rest pose at the beginning.

use std::path::{Path, PathBuf};

use morec::clip::Clip;
use morec::files::{FileReader, list};
use morec::import::Take;
use morec::index::MotionIndex;
use morec::resample::RateError;
use morec::roles::RoleMap;

use crate::LiveError;

/// A clip that can be played.
#[derive(Debug, Clone)]
pub struct PlayableClip {
    /// The motion, in metres and Y up, at the rate at which it is played.
    pub clip: Clip,
    /// Joint of each role.
    pub roles: RoleMap,
    /// The first frame that is motion and not a rest pose.
    pub first: usize,
    /// Frames a second of the file it came from.
    pub file_hz: f64,
}

/// Every character of every clip that `paths` name (folders: the clips in them), at `rate_hz` if one is given. `index`
/// knows the roles of joints of its own clips.
///
/// # Errors
/// A file that cannot be read, a rate that cannot be, no clip with a frame of motion.
pub fn load(
    paths: &[PathBuf],
    reader: &FileReader,
    index: Option<&MotionIndex>,
    rate_hz: Option<f64>,
) -> Result<Vec<PlayableClip>, LiveError> {
    let mut all = Vec::new();
    for path in list(paths)?.clips {
        all.extend(load_file(&path, reader, index, rate_hz)?);
    }
    all.retain(|playable| playable.clip.frames > playable.first);
    if all.is_empty() {
        let text = "none of the named files contains motion";
        return Err(LiveError::Clip(text.to_owned()));
    }
    Ok(all)
}

fn load_file(
    path: &Path,
    reader: &FileReader,
    index: Option<&MotionIndex>,
    rate_hz: Option<f64>,
) -> Result<Vec<PlayableClip>, LiveError> {
    let ready = |mut take: Take| {
        if index.is_some_and(|index| index.model.needs_rotations()) && !take.clip.has_rotations() {
            return Err(LiveError::Clip(format!(
                "{}: a clip of points has no rotations, which this index (method svrdm) needs; train an index without --method \
                 svrdm",
                path.display()
            )));
        }
        if let Some(index) = index.filter(|_| reader.import.mapping.is_none()) {
            index.complete_roles(&mut take.roles, &take.clip.skeleton);
        }
        let playable = PlayableClip::of(take, rate_hz);
        playable.map_err(|error| LiveError::Clip(format!("{}: {error}", path.display())))
    };
    reader.open(path)?.into_iter().map(ready).collect()
}

impl PlayableClip {
    /// A take, at `rate_hz` if one is given.
    ///
    /// # Errors
    /// A rate that is not above 0.
    pub fn of(take: Take, rate_hz: Option<f64>) -> Result<Self, RateError> {
        let file_hz = take.clip.rate_hz;
        let rest_secs = take.rest().end as f64 / file_hz;
        let clip = match rate_hz {
            Some(rate_hz) => take.clip.resampled(rate_hz)?,
            None => take.clip,
        };
        // Between the rest pose and the first frame of motion nothing is motion, at any rate.
        let first = (rest_secs * clip.rate_hz - 1e-6).ceil().max(0.0) as usize;
        Ok(Self {
            clip,
            roles: take.roles,
            first,
            file_hz,
        })
    }
}
