//! Recognition with an index.

use crate::Error;
use crate::features::BoneSet;
use crate::import::Take;
use crate::index::MotionIndex;

use super::{Detection, Recognizer, StartError, recognize_clip};

impl MotionIndex {
    /// What recognition reports of `take`, pose by pose as it would be live; times from its beginning.
    ///
    /// # Errors
    /// The take shows no bone that the index uses, or the index needs joint rotations that it lacks.
    pub fn recognize(&self, take: &Take) -> Result<Vec<Detection<&str>>, Error> {
        let mut roles = take.roles.clone();
        self.complete_roles(&mut roles, &take.clip.skeleton);
        let found = recognize_clip(&self.model, &take.clip, &roles, take.rest())?;
        Ok(found.into_iter().map(|d| d.named(&self.model)).collect())
    }

    /// A recogniser for a stream that offers `bones`.
    ///
    /// # Errors
    /// The index uses none of these bones.
    pub fn recognizer(&self, bones: impl Into<BoneSet>) -> Result<Recognizer, StartError> {
        Recognizer::new(&self.model, bones.into())
    }
}
