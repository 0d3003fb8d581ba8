//! Recognition in a clip, and in the recorded minutes of a live stream.

use std::sync::Arc;

use morec::eval::ClipDetection;
use morec::features::KeyPose;
use morec::index::MotionIndex;
use morec::live::{Detection, Model, recognize_clip, recognize_poses};
use morec_db::ClipId;

use super::load::ClipMotion;
use super::progress::JobError;

/// Plays a clip through the recogniser; gives the clip with its detections.
pub fn clip(
    index: &MotionIndex,
    motion: &Arc<ClipMotion>,
) -> Result<(ClipId, Vec<ClipDetection>), JobError> {
    let name = &motion.clip.name;
    let found = recognize_clip(&index.model, &motion.clip, &motion.roles, &motion.rest)
        .map_err(|error| JobError::Failed(format!("{name}: not recognised: {error}")))?;
    let detections = found.iter().map(|d| ClipDetection {
        clip: name.clone(),
        class: index.model.class_name(d.class).to_owned(),
        start_secs: d.start_secs,
        stop_secs: d.stop_secs,
        score: Some(d.score),
        reported_secs: Some(d.reported_secs),
        repetitions: d.repetitions.map(|r| r.count),
    });
    Ok((motion.id, detections.collect()))
}

/// Recognises with `model` in recorded poses.
pub fn poses(model: &Model, poses: &[(f64, KeyPose)]) -> Result<Vec<Detection>, JobError> {
    recognize_poses(model, poses)
        .map_err(|error| JobError::Failed(format!("The sensitivity cannot be tried: {error}")))
}
