//! Recognition in a clip, and in the recorded minutes of a live stream.

use std::sync::Arc;

use morec::eval::ClipDetection;
use morec::features::KeyPose;
use morec::index::MotionIndex;
use morec::live::{Model, recognize_clip, recognize_poses};

use super::load::ClipMotion;
use super::{JobOutcome, JobProgress};

/// Plays a clip through the recogniser.
pub fn clip(index: &MotionIndex, motion: &Arc<ClipMotion>, _progress: &JobProgress) -> JobOutcome {
    match recognize_clip(&index.model, &motion.clip, &motion.roles, &motion.rest) {
        Ok(found) => JobOutcome::Recognised {
            clip: motion.id,
            found: found
                .iter()
                .map(|d| ClipDetection {
                    clip: motion.clip.name.clone(),
                    class: index.model.class_name(d.class).to_owned(),
                    start_secs: d.start_secs,
                    stop_secs: d.stop_secs,
                    score: Some(d.score),
                    reported_secs: Some(d.reported_secs),
                })
                .collect(),
        },
        Err(error) => JobOutcome::Failed(format!("{}: not recognised: {error}", motion.clip.name)),
    }
}

/// Recognises with `model` in recorded poses.
pub fn poses(model: &Model, poses: &[(f64, KeyPose)], _progress: &JobProgress) -> JobOutcome {
    match recognize_poses(model, poses) {
        Ok(found) => JobOutcome::Resensed(found),
        Err(error) => JobOutcome::Failed(format!("The sensitivity cannot be tried: {error}")),
    }
}
