//! Writing an index.

use std::collections::{BTreeMap, HashMap};

use crate::features::Rows;
use crate::templates::Exemplars;

use super::manifest::{FORMAT, Manifest, VerifierWords};
use super::tensors::{Tensor, checksum};
use super::{INDEX_VERSION, IndexError, MotionIndex};

impl MotionIndex {
    /// The file's bytes: equal for equal indexes.
    pub fn to_bytes(&self) -> Result<Vec<u8>, IndexError> {
        let tensors = self.tensors();
        let mut manifest = self.manifest();
        manifest.checksum = checksum(&json(&manifest)?, &tensors);
        let metadata = HashMap::from([("morec".to_owned(), json(&manifest)?)]);
        safetensors::serialize(&tensors, Some(metadata)).map_err(|e| IndexError::Content(e.to_string()))
    }

    fn manifest(&self) -> Manifest {
        let model = &self.model;
        Manifest {
            format: FORMAT.to_owned(),
            version: INDEX_VERSION,
            method: "templates".to_owned(),
            checksum: 0,
            classes: model.classes.clone(),
            bones: model.bones,
            features: model.features.clone(),
            decode: model.decode.clone(),
            threshold: model.threshold,
            class_thresholds: model.class_thresholds.clone(),
            verifier: model.verifier.as_ref().map(|v| VerifierWords {
                reach: v.reach,
                bar: v.bar,
                generic: v.generic.clone(),
            }),
            roles: self.roles.clone(),
            provenance: self.provenance.clone(),
        }
    }

    fn tensors(&self) -> BTreeMap<String, Tensor> {
        let model = &self.model;
        let dim = model.ridged.dim();
        let step = model.step.as_deref();
        let samples: Vec<&Rows> = model.samples.iter().map(|s| &s.rows).collect();
        let negatives: Vec<&Rows> = model.negatives.iter().collect();
        let table = |tables: &[&Rows]| Tensor::of_rows(tables.iter().flat_map(|r| r.iter()), dim, step);
        let lengths = |tables: &[&Rows]| Tensor::of_u32(tables.iter().map(|r| r.len() as u32));
        let mut tensors = BTreeMap::from([
            ("metric.ridged".to_owned(), Tensor::of_f32(model.ridged.packed())),
            ("metric.total".to_owned(), Tensor::of_f32(model.total.packed())),
            ("negatives.lengths".to_owned(), lengths(&negatives)),
            ("negatives.rows".to_owned(), table(&negatives)),
            (
                "templates.classes".to_owned(),
                Tensor::of_u32(model.samples.iter().map(|s| u32::from(s.class.0))),
            ),
            ("templates.lengths".to_owned(), lengths(&samples)),
            ("templates.rows".to_owned(), table(&samples)),
        ]);
        if let Some(step) = step {
            tensors.insert("rows.step".to_owned(), Tensor::of_f32(step));
        }
        if let Some(verifier) = &model.verifier {
            tensors.extend(exemplars(&verifier.classes, dim, step));
        }
        tensors
    }
}

/// All classes' exemplars, one class after the other.
fn exemplars(classes: &[Exemplars], dim: usize, step: Option<&[f32]>) -> [(String, Tensor); 6] {
    let flat =
        |values: &dyn Fn(&Exemplars) -> Vec<f32>| -> Vec<f32> { classes.iter().flat_map(values).collect() };
    let shapes = Tensor::of_rows(classes.iter().flat_map(|c| c.shapes.iter()), dim, step);
    [
        ("verifier.beside".to_owned(), Tensor::of_f32(&flat(&|c| c.beside.concat()))),
        ("verifier.classes".to_owned(), Tensor::of_u32(classes.iter().map(|c| u32::from(c.class.0)))),
        ("verifier.counts".to_owned(), Tensor::of_u32(classes.iter().map(|c| c.len() as u32))),
        ("verifier.shapes".to_owned(), shapes),
        ("verifier.sharpness".to_owned(), Tensor::of_f32(&flat(&|c| vec![c.sharpness]))),
        ("verifier.weights".to_owned(), Tensor::of_f32(&flat(&|c| c.weights.clone()))),
    ]
}

/// JSON with the fields in the order they are declared: the checksum depends on it.
pub fn json(manifest: &Manifest) -> Result<String, IndexError> {
    serde_json::to_string(manifest).map_err(|e| IndexError::Content(e.to_string()))
}
