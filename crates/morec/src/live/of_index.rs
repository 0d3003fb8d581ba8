//! Recognition with an index.

use crate::features::BoneSet;
use crate::index::MotionIndex;

use super::{Recognizer, StartError};

impl MotionIndex {
    /// Detections of `take`, recognised pose by pose as in a live stream; times from its beginning.
    ///
    /// # Errors
    /// The take shows no bone that the index uses, or the index needs joint rotations that it lacks.
    #[cfg(feature = "formats")]
    pub fn recognize(
        &self,
        take: &crate::Take,
    ) -> Result<Vec<super::Detection<&str>>, crate::Error> {
        let mut roles = take.roles.clone();
        self.complete_roles(&mut roles, &take.clip.skeleton);
        let found = super::recognize_clip(&self.model, &take.clip, &roles, take.rest())?;
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
