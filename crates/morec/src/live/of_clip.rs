//! A stored clip played through the live recogniser.

use std::sync::Arc;

use crate::clip::{Clip, Span};
use crate::features::{bones_of_clip, for_each_pose};
use crate::roles::RoleMap;
use crate::templates::{TemplateModel, TemplateModelError};

use super::{Detection, Recognizer};

/// Everything that the recogniser reports of a clip, pose by pose as it would be live; times from the clip's
/// beginning. `rest` are the frames that a conversion left at the start.
pub fn recognize_clip(
    model: &Arc<TemplateModel>,
    clip: &Clip,
    roles: &RoleMap,
    rest: &Span,
) -> Result<Vec<Detection>, TemplateModelError> {
    let mut recognizer = Recognizer::new(model, bones_of_clip(clip, roles, rest))?;
    let mut found = Vec::new();
    for_each_pose(clip, roles, rest, |time_secs, pose| {
        found.extend_from_slice(recognizer.push(time_secs, pose))
    });
    found.extend_from_slice(recognizer.finish());
    Ok(found)
}
