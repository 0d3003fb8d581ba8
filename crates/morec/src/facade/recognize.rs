//! Recognition of a whole take in one call.

use crate::import::Take;
use crate::index::MotionIndex;
use crate::live::{Detection, recognize_clip};

use super::Error;

impl MotionIndex {
    /// Detections of `take`, recognised pose by pose as in a live stream; times from its beginning.
    ///
    /// # Errors
    /// The take shows no bone that the index uses, or the index needs joint rotations that it lacks.
    pub fn recognize(&self, take: &Take) -> Result<Vec<Detection<&str>>, Error> {
        let mut roles = take.roles.clone();
        self.complete_roles(&mut roles, &take.clip.skeleton);
        let found = recognize_clip(&self.model, &take.clip, &roles, take.rest())?;
        Ok(found.into_iter().map(|d| d.named(&self.model)).collect())
    }
}
