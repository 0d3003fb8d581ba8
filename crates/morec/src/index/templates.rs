//! Reads and writes the model of the method templates as manifest and tensors.
//!
//! Words ([`Manifest`]) are what a person may want to read or another program to check: classes, parameters, thresholds, where it
//! comes from. Tables ([`Tensor`]) are rows and matrices. A table that a file lacks was not there when it was written: older files have
//! no verifier, no held poses, no activities, and give a model without. Pieces of different lengths lie one behind the other in
//! one table, beside a table of their lengths.

use std::collections::BTreeMap;

use crate::features::{RowLayout, Rows};
use crate::templates::second_look::{BodyTrack, SecondLook};
use crate::templates::{
    Activities, Exemplars, HeldPoses, PackedSymmetric, ReferenceRows, SHAPE_ROWS, TemplateModel,
    TemplateSample, Verifier,
};

use super::manifest::{ActivityWords, FORMAT, HeldWords, LookWords, Manifest, VerifierWords};
use super::tensors::{Tables, Tensor, class_id};
use super::{INDEX_VERSION, IndexError, MotionIndex};

/// The part of `model` that is written in words.
pub(super) fn manifest(model: &TemplateModel, index: &MotionIndex) -> Manifest {
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
        operating: model.operating.clone(),
        calibration: model.calibration,
        stranger: model.stranger.clone(),
        verifier: model.verifier.as_ref().map(|v| VerifierWords {
            reach: v.reach,
            bar: v.bar,
            operating: v.operating.clone(),
            generic: v.generic.clone(),
        }),
        look: model.look.as_ref().map(|look| LookWords {
            scale: look.scale,
            bound: look.bound,
            operating: look.operating.clone(),
            reach: look.reach,
            own_score: look.own_score,
            performer: look.performer,
        }),
        held: model.held.as_ref().map(|held| HeldWords {
            reach: held.reach,
            least_ticks: held.least_ticks,
        }),
        activities: (model.activities.as_ref()).map(|activities| ActivityWords {
            window_ticks: activities.window_ticks,
            share: activities.share,
        }),
        roles: index.roles.clone(),
        provenance: index.provenance.clone(),
    }
}

/// The part of `model` that is written in tables.
pub(super) fn tensors(model: &TemplateModel) -> BTreeMap<String, Tensor> {
    let dim = model.ridged.dim();
    let step = model.step.as_deref();
    let samples: Vec<&Rows> = model.samples.iter().map(|s| &s.rows).collect();
    let negatives: Vec<&Rows> = model.negatives.iter().collect();
    let table = |tables: &[&Rows]| Tensor::of_rows(tables.iter().flat_map(|r| r.iter()), dim, step);
    let lengths = |tables: &[&Rows]| Tensor::of_u32(tables.iter().map(|r| r.len() as u32));
    let mut tensors = BTreeMap::from([
        (
            "metric.ridged".to_owned(),
            Tensor::of_f32(model.ridged.packed()),
        ),
        (
            "metric.total".to_owned(),
            Tensor::of_f32(model.total.packed()),
        ),
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
    if let Some(look) = &model.look {
        tensors.extend(look_tensors(look));
    }
    if let Some(held) = &model.held {
        tensors.extend(reference_tensors("held", &held.poses));
    }
    if let Some(activities) = &model.activities {
        tensors.extend(reference_tensors("activities", &activities.windows));
        tensors.extend(repetition_tensors(activities, dim));
    }
    tensors
}

/// Rows of classes and of anything else, and their metric.
fn reference_tensors(name: &str, reference: &ReferenceRows) -> [(String, Tensor); 5] {
    let ReferenceRows { ridged, total, .. } = reference;
    let tables = [&reference.rows, &reference.others];
    let rows = tables.iter().flat_map(|rows| rows.iter());
    let rows = Tensor::of_rows(rows, ridged.dim(), None);
    let lengths = tables.iter().map(|rows| rows.len() as u32);
    let classes = reference.classes.iter().map(|class| u32::from(class.0));
    [
        (format!("{name}.classes"), Tensor::of_u32(classes)),
        (format!("{name}.lengths"), Tensor::of_u32(lengths)),
        (format!("{name}.rows"), rows),
        (format!("{name}.ridged"), Tensor::of_f32(ridged.packed())),
        (format!("{name}.total"), Tensor::of_f32(total.packed())),
    ]
}

/// Repetitions of activities, if any are kept.
fn repetition_tensors(activities: &Activities, dim: usize) -> Vec<(String, Tensor)> {
    let Activities {
        repetitions, step, ..
    } = activities;
    if repetitions.is_empty() {
        return Vec::new();
    }
    let classes = repetitions.iter().map(|s| u32::from(s.class.0));
    let rows = repetitions.iter().flat_map(|s| s.rows.iter());
    let lengths = repetitions.iter().map(|s| s.rows.len() as u32);
    let tables = [
        ("classes", Tensor::of_u32(classes)),
        ("lengths", Tensor::of_u32(lengths)),
        ("rows", Tensor::of_rows(rows, dim, Some(step))),
        ("step", Tensor::of_f32(step)),
    ];
    let named = |(name, table)| (format!("repetitions.{name}"), table);
    tables.map(named).into()
}

/// Taught segments, those of other motion behind them, and their metric.
fn look_tensors(look: &SecondLook) -> Vec<(String, Tensor)> {
    let rows = look.segments.iter().chain(look.atlas.iter());
    let step = look.step.as_deref();
    let classes = look.classes.iter().map(|class| u32::from(class.0));
    let lengths = [look.segments.len() as u32, look.atlas.len() as u32];
    let tables = [
        ("classes", Tensor::of_u32(classes)),
        ("lengths", Tensor::of_u32(lengths.into_iter())),
        ("ridged", Tensor::of_f32(look.ridged.packed())),
        ("rows", Tensor::of_rows(rows, look.ridged.dim(), step)),
        ("total", Tensor::of_f32(look.total.packed())),
    ];
    let step = step.map(|step| ("step", Tensor::of_f32(step)));
    let tables = tables.into_iter().chain(step);
    tables
        .map(|(name, table)| (format!("look.{name}"), table))
        .collect()
}

/// All classes' exemplars, one class after the other.
fn exemplars(classes: &[Exemplars], dim: usize, step: Option<&[f32]>) -> [(String, Tensor); 6] {
    let flat = |values: &dyn Fn(&Exemplars) -> Vec<f32>| -> Vec<f32> {
        classes.iter().flat_map(values).collect()
    };
    let shapes = Tensor::of_rows(classes.iter().flat_map(|c| c.shapes.iter()), dim, step);
    [
        (
            "verifier.beside".to_owned(),
            Tensor::of_f32(&flat(&|c| c.beside.concat())),
        ),
        (
            "verifier.classes".to_owned(),
            Tensor::of_u32(classes.iter().map(|c| u32::from(c.class.0))),
        ),
        (
            "verifier.counts".to_owned(),
            Tensor::of_u32(classes.iter().map(|c| c.len() as u32)),
        ),
        ("verifier.shapes".to_owned(), shapes),
        (
            "verifier.sharpness".to_owned(),
            Tensor::of_f32(&flat(&|c| vec![c.sharpness])),
        ),
        (
            "verifier.weights".to_owned(),
            Tensor::of_f32(&flat(&|c| c.weights.clone())),
        ),
    ]
}

/// The model of an opened file.
pub(super) fn read(manifest: &Manifest, tables: &Tables) -> Result<TemplateModel, IndexError> {
    let dim = RowLayout::of(manifest.bones).dim();
    let step = tables.steps("rows.step", dim)?;
    let samples = samples(tables, "templates", dim, step.as_deref())?;
    let model = TemplateModel {
        features: manifest.features.clone(),
        bones: manifest.bones,
        decode: manifest.decode.clone(),
        classes: manifest.classes.clone(),
        samples,
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
        operating: manifest.operating.clone(),
        calibration: manifest.calibration,
        stranger: manifest.stranger.clone(),
        verifier: verifier(manifest, tables, dim, step.as_deref())?,
        held: held(manifest, tables)?,
        look: look(manifest, tables)?,
        activities: activities(manifest, tables)?,
        step,
    };
    // Lengths of tables and numbers of classes are those of a file, which may have been made by anybody.
    model
        .check()
        .map_err(|e| IndexError::Content(e.to_string()))?;
    Ok(model)
}

/// Rows of samples with their classes.
fn samples(
    tables: &Tables,
    name: &str,
    dim: usize,
    step: Option<&[f32]>,
) -> Result<Vec<TemplateSample>, IndexError> {
    let lengths = tables.u32s(&format!("{name}.lengths"))?;
    let classes = tables.u32s(&format!("{name}.classes"))?;
    if classes.len() != lengths.len() {
        let (rows, found) = (lengths.len(), classes.len());
        let message = format!("{rows} {name}, classes for {found}");
        return Err(IndexError::Content(message));
    }
    let rows = tables.pieces(&format!("{name}.rows"), dim, &lengths, step)?;
    let sample = |(rows, class)| {
        Ok(TemplateSample {
            class: class_id(class)?,
            rows,
        })
    };
    rows.into_iter().zip(classes).map(sample).collect()
}

fn verifier(
    manifest: &Manifest,
    tables: &Tables,
    dim: usize,
    step: Option<&[f32]>,
) -> Result<Option<Verifier>, IndexError> {
    let Some(words) = &manifest.verifier else {
        return Ok(None);
    };
    let counts = tables.u32s("verifier.counts")?;
    // Every exemplar has as many rows; a damaged count must not overflow before it is found too large.
    let rows: Option<Vec<u32>> = counts
        .iter()
        .map(|n| n.checked_mul(SHAPE_ROWS as u32))
        .collect();
    let rows =
        rows.ok_or_else(|| IndexError::Content("verifier.counts: too many exemplars".to_owned()))?;
    let shapes = tables.pieces("verifier.shapes", dim, &rows, step)?;
    let beside = tables.pieces("verifier.beside", 4, &counts, None)?;
    let weights = tables.pieces("verifier.weights", 1, &counts, None)?;
    let (numbers, sharpness) = (
        tables.u32s("verifier.classes")?,
        tables.f32s("verifier.sharpness")?,
    );
    if numbers.len() != counts.len() || sharpness.len() != counts.len() {
        return Err(IndexError::Content(
            "the verifier's tables differ in their number of classes".to_owned(),
        ));
    }
    let mut classes = Vec::with_capacity(counts.len());
    for (((shapes, beside), weights), (number, sharpness)) in shapes
        .into_iter()
        .zip(beside)
        .zip(weights)
        .zip(numbers.into_iter().zip(sharpness))
    {
        let beside = beside.values().as_chunks::<4>().0.to_vec();
        let (class, weights) = (class_id(number)?, weights.values().to_vec());
        classes.push(Exemplars {
            class,
            shapes,
            beside,
            weights,
            sharpness,
        });
    }
    let VerifierWords {
        reach,
        bar,
        operating,
        generic,
    } = words.clone();
    Ok(Some(Verifier {
        reach,
        bar,
        operating,
        generic,
        classes,
    }))
}

fn look(manifest: &Manifest, tables: &Tables) -> Result<Option<SecondLook>, IndexError> {
    let Some(words) = &manifest.look else {
        return Ok(None);
    };
    let dim = BodyTrack::columns(manifest.bones).len();
    let step = tables.steps("look.step", dim)?;
    let lengths = tables.u32s("look.lengths")?;
    let rows = tables.pieces("look.rows", dim, &lengths, step.as_deref())?;
    let [segments, atlas] = two_tables("look.lengths", rows)?;
    let classes = tables.u32s("look.classes")?.into_iter();
    Ok(Some(SecondLook {
        classes: classes.map(class_id).collect::<Result<_, _>>()?,
        segments,
        atlas,
        ridged: symmetric(tables, "look.ridged", dim)?,
        total: symmetric(tables, "look.total", dim)?,
        scale: words.scale,
        bound: words.bound,
        operating: words.operating.clone(),
        reach: words.reach,
        own_score: words.own_score,
        performer: words.performer,
        step,
    }))
}

fn two_tables(lengths: &str, rows: Vec<Rows>) -> Result<[Rows; 2], IndexError> {
    <[Rows; 2]>::try_from(rows).map_err(|rows| {
        let found = rows.len();
        IndexError::Content(format!("{lengths}: expected 2 lengths, found {found}"))
    })
}

fn held(manifest: &Manifest, tables: &Tables) -> Result<Option<HeldPoses>, IndexError> {
    let Some(HeldWords { reach, least_ticks }) = manifest.held else {
        return Ok(None);
    };
    // A held pose has no velocity: its rows are directions alone.
    let dim = RowLayout::of(manifest.bones).directions().len();
    Ok(Some(HeldPoses {
        poses: reference(tables, "held", dim)?,
        reach,
        least_ticks,
    }))
}

fn activities(manifest: &Manifest, tables: &Tables) -> Result<Option<Activities>, IndexError> {
    let Some(words) = &manifest.activities else {
        return Ok(None);
    };
    let layout = RowLayout::of(manifest.bones);
    let step = tables.steps("repetitions.step", layout.dim())?;
    let repetitions = match &step {
        Some(step) => samples(tables, "repetitions", layout.dim(), Some(step))?,
        None => Vec::new(),
    };
    let statistics = Activities::statistics(layout);
    Ok(Some(Activities {
        windows: reference(tables, "activities", statistics)?,
        window_ticks: words.window_ticks,
        share: words.share,
        repetitions,
        step: step.unwrap_or_default(),
    }))
}

/// What [`reference_tensors`] writes.
fn reference(tables: &Tables, name: &str, dim: usize) -> Result<ReferenceRows, IndexError> {
    let lengths_name = format!("{name}.lengths");
    let lengths = tables.u32s(&lengths_name)?;
    let rows = tables.pieces(&format!("{name}.rows"), dim, &lengths, None)?;
    let [rows, others] = two_tables(&lengths_name, rows)?;
    let classes = tables.u32s(&format!("{name}.classes"))?.into_iter();
    Ok(ReferenceRows {
        rows,
        classes: classes.map(class_id).collect::<Result<_, _>>()?,
        others,
        ridged: symmetric(tables, &format!("{name}.ridged"), dim)?,
        total: symmetric(tables, &format!("{name}.total"), dim)?,
    })
}

fn symmetric(tables: &Tables, name: &str, dim: usize) -> Result<PackedSymmetric, IndexError> {
    let packed = tables.f32s(name)?;
    let found = packed.len();
    PackedSymmetric::from_packed(dim, packed).ok_or_else(|| {
        IndexError::Content(format!(
            "tensor {name:?}: expected {} values, found {found}",
            dim * (dim + 1) / 2
        ))
    })
}
