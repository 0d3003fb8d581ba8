//! Recognisers of one model for many streams or clips.

use std::sync::{Mutex, PoisonError};

use crate::features::BoneSet;

use super::{Model, Recognizer, StartError};

/// Recognisers of a model, laid out once for each set of bones that comes up and copied from then on: laying out maps every
/// template and decomposes the metric, a copy shares the result.
#[derive(Debug)]
pub struct RecognizerCache {
    model: Model,
    made: Mutex<Vec<(BoneSet, Recognizer)>>,
}

impl RecognizerCache {
    /// With nothing laid out yet.
    pub fn new<M: Clone + Into<Model>>(model: &M) -> Self {
        Self {
            model: model.clone().into(),
            made: Mutex::new(Vec::new()),
        }
    }

    /// The model of all recognisers.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// A new recogniser for a stream that offers `bones`. Holds a lock while it lays one out.
    ///
    /// # Errors
    /// As [`Recognizer::new`].
    pub fn recognizer(&self, bones: BoneSet) -> Result<Recognizer, StartError> {
        // What the model has not makes no difference, unless nothing else is offered.
        let used = bones.and(self.model.bones());
        let bones = if used.is_empty() { bones } else { used };
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = made.iter().find(|(of, _)| *of == bones) {
            return Ok(known.clone());
        }
        let new = Recognizer::new(&self.model, bones)?;
        made.push((bones, new.clone()));
        Ok(new)
    }
}
