//! Clips made ready for playing: imported, at a rate, roles known.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use morec::clip::Clip;
use morec::import::{ImportOptions, Take};
use morec::index::MotionIndex;
use morec::live::Model;
use morec::roles::RoleMap;

use crate::files::{ReadArgs, expand, takes};

/// A clip that can be played.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The motion, in metres and Y-up, without the rest pose that a conversion left.
    pub clip: Clip,
    /// Who plays what.
    pub roles: RoleMap,
    /// The first frame that is motion.
    pub first: usize,
    /// Frames a second of the file it came from.
    pub file_hz: f64,
}

/// Every character of every clip that `paths` name, at `rate_hz` if one is given.
pub fn load(
    paths: &[PathBuf],
    read: &ReadArgs,
    options: &ImportOptions,
    index: Option<&MotionIndex>,
    rate_hz: Option<f64>,
) -> Result<Vec<Loaded>> {
    let mut all = Vec::new();
    for path in expand(paths)? {
        all.extend(load_file(&path, read, options, index, rate_hz)?);
    }
    all.retain(|loaded| loaded.clip.frames > loaded.first);
    if all.is_empty() {
        bail!("no clip with a frame of motion among what was named");
    }
    Ok(all)
}

fn load_file(
    path: &Path,
    read: &ReadArgs,
    options: &ImportOptions,
    index: Option<&MotionIndex>,
    rate_hz: Option<f64>,
) -> Result<Vec<Loaded>> {
    let ready = |mut take: Take| {
        let by_rotations = index.is_some_and(|index| matches!(index.model, Model::Svrdm(_)));
        if by_rotations && !take.clip.has_rotations() {
            bail!(
                "{}: a clip of points has no rotations, and this index looks at nothing else (it is of the method of 2009); \
                 train one without --method svrdm",
                path.display()
            );
        }
        if let Some(index) = index.filter(|_| options.mapping.is_none()) {
            index.complete_roles(&mut take.roles, &take.clip.skeleton);
        }
        Loaded::of(take, rate_hz).with_context(|| path.display().to_string())
    };
    takes(path, read, options)?.into_iter().map(ready).collect()
}

impl Loaded {
    /// An imported clip, at `rate_hz` if one is given.
    pub fn of(imported: Take, rate_hz: Option<f64>) -> Result<Self> {
        let file_hz = imported.clip.rate_hz;
        let rest_secs = imported.report.rest_frames.end as f64 / file_hz;
        let clip = match rate_hz {
            Some(rate_hz) => imported.clip.resampled(rate_hz)?,
            None => imported.clip,
        };
        // Between the rest pose and the first frame of motion nothing is motion, at any rate.
        let first = (rest_secs * clip.rate_hz - 1e-6).ceil().max(0.0) as usize;
        Ok(Self {
            clip,
            roles: imported.roles,
            first,
            file_hz,
        })
    }
}
