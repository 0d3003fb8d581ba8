//! A stored clip played through the live recogniser.

use crate::clip::{Clip, Span};
use crate::features::bones_of_clip;
use crate::kinematics::for_each_world_pose;
use crate::roles::RoleMap;

use super::{Detection, Model, PoseReader, Recognizer, StartError};

/// Everything that the recogniser reports of a clip, pose by pose as it would be live; times from the clip's
/// beginning. `rest` are the frames that a conversion left at the start; the first pose after them stands in for them.
pub fn recognize_clip<M: Clone + Into<Model>>(
    model: &M,
    clip: &Clip,
    roles: &RoleMap,
    rest: &Span,
) -> Result<Vec<Detection>, StartError> {
    let model = model.clone().into();
    let mut recognizer = Recognizer::new(&model, bones_of_clip(clip, roles, rest))?;
    let mut found = Vec::new();
    if clip.frames == 0 {
        return Ok(found);
    }
    let mut reader = PoseReader::new(&model, &clip.skeleton, roles)?;
    for_each_world_pose(clip, rest, |time_secs, world| {
        found.extend_from_slice(recognizer.push(time_secs, reader.read(world)));
    });
    found.extend_from_slice(recognizer.finish());
    Ok(found)
}
