//! Recognition in a clip, and in the recorded minutes of a live stream.

use std::sync::Arc;

use morec::features::KeyPose;
use morec::index::MotionIndex;
use morec::labels::ClipDetection;
use morec::live::{Detection, Model, recognize_clip, recognize_poses};
use morec_db::ClipId;

use super::progress::JobError;
use crate::body::ClipMotion;

/// Plays a clip through the recogniser; gives the clip with its detections.
pub fn clip(
    index: &MotionIndex,
    motion: &Arc<ClipMotion>,
) -> Result<(ClipId, Vec<ClipDetection>), JobError> {
    let name = &motion.clip.name;
    let found = recognize_clip(&index.model, &motion.clip, &motion.roles, &motion.rest)
        .map_err(|error| JobError::Failed(format!("{name}: not recognised: {error}")))?;
    let named = found.iter().map(|d| d.named(&index.model));
    let detections = named.map(|d| ClipDetection::new(name, d));
    Ok((motion.id, detections.collect()))
}

/// Recognises with `model` in recorded poses.
pub fn poses(model: &Model, poses: &[(f64, KeyPose)]) -> Result<Vec<Detection>, JobError> {
    recognize_poses(model, poses)
        .map_err(|error| JobError::Failed(format!("The sensitivity cannot be tested: {error}")))
}
