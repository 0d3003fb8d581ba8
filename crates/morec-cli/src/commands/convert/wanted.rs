//! The requested form of the output: format, rate, fitting.

use anyhow::{Context, Result};
use morec::clip::Clip;
use morec::fitting::fit_skeleton;
use morec::import::{ImportOptions, Stated, normalize};
use morec_measure::tables::Content;

/// Options of writing clips.
#[derive(Clone)]
pub(super) struct Wanted {
    pub(super) content: Content,
    pub(super) import: ImportOptions,
    pub(super) rate_hz: Option<f64>,
    pub(super) fit: bool,
}

impl Wanted {
    /// The same for the clips of a file that states its unit and axis, or whose format does.
    pub(super) fn of_file(&self, stated: Option<Stated>) -> Self {
        let mut wanted = self.clone();
        wanted.import.stated = stated;
        wanted
    }

    /// The clip at the rate, and with the rotations, that are asked for.
    pub(super) fn prepared(&self, clip: Clip) -> Result<Clip> {
        let clip = match self.rate_hz {
            Some(rate_hz) => clip.resampled(rate_hz)?,
            None => clip,
        };
        match self.fit && !clip.has_rotations() {
            true => fitted(clip, &self.import),
            false => Ok(clip),
        }
    }
}

/// A skeleton laid into a clip of points.
fn fitted(clip: Clip, import: &ImportOptions) -> Result<Clip> {
    let take = normalize(clip, import)?;
    let fit = fit_skeleton(&take).with_context(|| take.clip.name.clone())?;
    let (role, worst) = fit.worst;
    eprintln!(
        "morec: {}: a skeleton of {} joints fits the points to {:.1} cm (root mean square; {role} to {:.1} cm); the twist of \
         straight limbs is unknown",
        take.clip.name,
        fit.clip.skeleton.len(),
        100.0 * fit.rms_metres,
        100.0 * worst
    );
    Ok(fit.clip)
}
