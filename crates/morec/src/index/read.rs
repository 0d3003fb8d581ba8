//! Reading an index.

use std::sync::Arc;

use safetensors::SafeTensors;

use crate::classes::ClassId;
use crate::features::row_dim;
use crate::templates::{Exemplars, SHAPE_ROWS, Sample, Symmetric, TemplateModel, Verifier};

use super::manifest::{FORMAT, Manifest, Preamble, VerifierWords};
use super::tensors::{Tables, checksum};
use super::{INDEX_VERSION, IndexError, MotionIndex};

impl MotionIndex {
    /// Opens a file's bytes and checks every part of them.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, IndexError> {
        let foreign = |e: safetensors::SafeTensorError| IndexError::Foreign(e.to_string());
        let (_, header) = SafeTensors::read_metadata(bytes).map_err(foreign)?;
        let words = header.metadata().as_ref().and_then(|m| m.get("morec"));
        let words =
            words.ok_or_else(|| IndexError::Foreign("a safetensors file without a morec manifest".into()))?;
        let preamble: Preamble = parse(words)?;
        if preamble.format != FORMAT {
            return Err(IndexError::Foreign(format!("its manifest says {:?}", preamble.format)));
        }
        if preamble.version > INDEX_VERSION {
            return Err(IndexError::Newer { found: preamble.version });
        }
        if preamble.method != "templates" {
            return Err(IndexError::Method(preamble.method));
        }
        let manifest: Manifest = parse(words)?;
        let tables = Tables::of(&SafeTensors::deserialize(bytes).map_err(foreign)?);
        check(words, &manifest, &tables)?;
        let model = model(&manifest, &tables)?;
        Ok(Self { model: Arc::new(model), roles: manifest.roles, provenance: manifest.provenance })
    }
}

fn parse<'j, T: serde::Deserialize<'j>>(words: &'j str) -> Result<T, IndexError> {
    serde_json::from_str(words).map_err(|e| IndexError::Content(format!("manifest: {e}")))
}

/// The checksum is over the manifest's own text, so that fields this release does not know count too.
fn check(words: &str, manifest: &Manifest, tables: &Tables) -> Result<(), IndexError> {
    let expected = manifest.checksum;
    let text = words.replacen(&format!("\"checksum\":{expected}"), "\"checksum\":0", 1);
    let found = checksum(&text, tables.all());
    if found == expected { Ok(()) } else { Err(IndexError::Checksum { expected, found }) }
}

fn model(manifest: &Manifest, tables: &Tables) -> Result<TemplateModel, IndexError> {
    let dim = row_dim(manifest.bones);
    let step = if tables.has("rows.step") { Some(tables.f32s("rows.step")?) } else { None };
    if let Some(found) = step.as_ref().map(Vec::len).filter(|found| *found != dim) {
        return Err(IndexError::Content(format!(
            "tensor \"rows.step\": expected {dim} values, found {found}"
        )));
    }
    let lengths = tables.u32s("templates.lengths")?;
    let classes = tables.u32s("templates.classes")?;
    if classes.len() != lengths.len() {
        let message = format!("{} templates, classes for {}", lengths.len(), classes.len());
        return Err(IndexError::Content(message));
    }
    let rows = tables.pieces("templates.rows", dim, &lengths, step.as_deref())?;
    let samples: Result<_, IndexError> =
        rows.into_iter().zip(classes).map(|(rows, c)| Ok(Sample { class: class_id(c)?, rows })).collect();
    let model = TemplateModel {
        features: manifest.features.clone(),
        bones: manifest.bones,
        decode: manifest.decode.clone(),
        classes: manifest.classes.clone(),
        samples: samples?,
        negatives: tables.pieces(
            "negatives.rows",
            dim,
            &tables.u32s("negatives.lengths")?,
            step.as_deref(),
        )?,
        ridged: symmetric(tables, "metric.ridged", dim)?,
        total: symmetric(tables, "metric.total", dim)?,
        threshold: manifest.threshold,
        class_thresholds: manifest.class_thresholds.clone(),
        verifier: verifier(manifest, tables, dim, step.as_deref())?,
        step,
    };
    model.check().map_err(|e| IndexError::Content(e.to_string()))?;
    Ok(model)
}

fn verifier(
    manifest: &Manifest,
    tables: &Tables,
    dim: usize,
    step: Option<&[f32]>,
) -> Result<Option<Verifier>, IndexError> {
    let Some(words) = &manifest.verifier else { return Ok(None) };
    let counts = tables.u32s("verifier.counts")?;
    let rows: Option<Vec<u32>> = counts.iter().map(|n| n.checked_mul(SHAPE_ROWS as u32)).collect();
    let rows = rows.ok_or_else(|| IndexError::Content("verifier.counts: too many exemplars".to_owned()))?;
    let shapes = tables.pieces("verifier.shapes", dim, &rows, step)?;
    let beside = tables.pieces("verifier.beside", 4, &counts, None)?;
    let weights = tables.pieces("verifier.weights", 1, &counts, None)?;
    let (numbers, sharpness) = (tables.u32s("verifier.classes")?, tables.f32s("verifier.sharpness")?);
    if numbers.len() != counts.len() || sharpness.len() != counts.len() {
        return Err(IndexError::Content(
            "the verifier's tables differ in their number of classes".to_owned(),
        ));
    }
    let mut classes = Vec::with_capacity(counts.len());
    for (((shapes, beside), weights), (number, sharpness)) in
        shapes.into_iter().zip(beside).zip(weights).zip(numbers.into_iter().zip(sharpness))
    {
        let beside = beside.values().as_chunks::<4>().0.to_vec();
        let (class, weights) = (class_id(number)?, weights.values().to_vec());
        classes.push(Exemplars { class, shapes, beside, weights, sharpness });
    }
    let VerifierWords { reach, bar, generic } = words.clone();
    Ok(Some(Verifier { reach, bar, generic, classes }))
}

fn class_id(number: u32) -> Result<ClassId, IndexError> {
    u16::try_from(number).map(ClassId).map_err(|_| IndexError::Content(format!("class number {number}")))
}

fn symmetric(tables: &Tables, name: &str, dim: usize) -> Result<Symmetric, IndexError> {
    let packed = tables.f32s(name)?;
    let found = packed.len();
    Symmetric::from_packed(dim, packed).ok_or_else(|| {
        IndexError::Content(format!(
            "tensor {name:?}: expected {} values, found {found}",
            dim * (dim + 1) / 2
        ))
    })
}
