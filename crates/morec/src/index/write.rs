//! Writing an index.

use std::collections::{BTreeMap, HashMap};

use serde::Serialize;

use super::tensors::{Tensor, checksum};
use super::{IndexError, Model, MotionIndex, svrdm, templates};

impl MotionIndex {
    /// The file's bytes: equal for equal indexes.
    ///
    /// # Errors
    /// The manifest or the tables cannot be written.
    pub fn to_bytes(&self) -> Result<Vec<u8>, IndexError> {
        match &self.model {
            Model::Templates(model) => {
                let mut manifest = templates::manifest(model, self);
                let tensors = templates::tensors(model);
                manifest.checksum = checksum(&json(&manifest)?, &tensors);
                file(&json(&manifest)?, &tensors)
            }
            Model::Svrdm(model) => {
                let mut manifest = svrdm::manifest(model, self);
                let tensors = svrdm::tensors(model);
                manifest.checksum = checksum(&json(&manifest)?, &tensors);
                file(&json(&manifest)?, &tensors)
            }
        }
    }
}

fn file(manifest: &str, tensors: &BTreeMap<String, Tensor>) -> Result<Vec<u8>, IndexError> {
    let metadata = HashMap::from([("morec".to_owned(), manifest.to_owned())]);
    safetensors::serialize(tensors, Some(metadata)).map_err(|e| IndexError::Content(e.to_string()))
}

/// JSON with the fields in the order they are declared: the checksum depends on it.
fn json(manifest: &impl Serialize) -> Result<String, IndexError> {
    serde_json::to_string(manifest).map_err(|e| IndexError::Content(e.to_string()))
}
