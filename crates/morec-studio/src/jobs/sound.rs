//! The sound of a clip's video, and the clap in both.

use std::path::Path;

use morec::progress::Progress;
use morec_db::ClipId;
use morec_ops::{ClapMatch, SoundEnvelope};

use super::progress::{JobError, JobProgress};
use crate::body::ClipMotion;

/// The sound of a video, and the clap in it and in the clip; else the reasons in sentences.
#[derive(Debug)]
pub struct ClipSound {
    /// The clip, and the file of its video.
    pub of: (ClipId, String),
    pub envelope: Result<SoundEnvelope, String>,
    pub clap: Result<ClapMatch, String>,
}

/// Reads the sound of `file` by the program `decoder`. Without a sound, the reason is the result.
pub fn read(
    decoder: &Path,
    motion: &ClipMotion,
    file: &str,
    progress: &JobProgress,
) -> Result<ClipSound, JobError> {
    let envelope = SoundEnvelope::of_file(decoder, file.as_ref(), progress);
    if progress.cancelled() {
        return Err(JobError::Cancelled);
    }
    let sound = envelope.as_ref().map_err(Clone::clone);
    let clap = sound.and_then(|sound| ClapMatch::of(sound, &motion.clip, &motion.roles));
    Ok(ClipSound {
        of: (motion.id, file.to_owned()),
        envelope,
        clap,
    })
}
