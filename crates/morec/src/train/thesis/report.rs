//! Report of a training run of the thesis's method.

use std::collections::BTreeMap;

use crate::svrdm::SvrdmModel;
use crate::train::{TrainingReport, class_notes};

use super::details::SvrdmReport;
use super::fit::Fitted;
use super::material::ThesisTrainingData;
use super::thresholds::Estimated;

/// Vectors whose product with their sign vector is below this are close to being turned round.
const CLOSE_TO_FLIPPING: f64 = 0.1;

pub(super) fn of(
    material: &ThesisTrainingData,
    fitted: &Fitted,
    model: &SvrdmModel,
    estimated: Option<Estimated>,
) -> TrainingReport {
    let mut background_secs = BTreeMap::new();
    for background in &material.background {
        let known: usize = background.known.iter().map(ExactSizeIterator::len).sum();
        let secs = background.rows.len().saturating_sub(known) as f64 / model.rate_hz();
        let source = if background.unlabelled {
            "unlabelled"
        } else {
            "clips"
        };
        *background_secs.entry(source.to_owned()).or_insert(0.0) += secs;
    }
    let classes = [&model.classes[..], &material.left_out].concat();
    let mut notes = class_notes(&classes);
    notes.extend(material.left_out.iter().filter(|class| class.samples > 0).map(|class| {
        format!(
            "{}: none of its samples can be used, so it will never be recognised; each needs some motion inside its clip",
            class.name
        )
    }));
    if !material.missing.is_empty() {
        notes.push(format!(
            "joints missing in a clip, which turn with their parents there: {}",
            material.missing.join("; ")
        ));
    }
    let shortest =
        model.params.min_chunks as f64 * model.params.chunk_frames as f64 / model.rate_hz();
    let short = model
        .classes
        .iter()
        .zip(&model.mean_secs)
        .filter(|(_, mean)| **mean < shortest);
    notes.extend(short.map(|(class, mean)| {
        format!(
            "{}: {mean:.2} s on average, the shortest segment considered is {shortest:.2} s",
            class.name
        )
    }));
    let threshold_from = match &estimated {
        Some(e) => format!(
            "{} left-out samples and {:.1} min of background, the most confident of which had {:.2}",
            e.samples, e.background_minutes, e.background_confidence
        ),
        None => "the parameters".to_owned(),
    };
    let svrdm = SvrdmReport {
        dims: model.pca.dims(),
        quality: model.pca.quality(),
        quality_table: model.pca.quality_table(),
        unsure_signs: fitted
            .signs
            .iter()
            .map(|s| s.unsure(CLOSE_TO_FLIPPING))
            .collect(),
        branches: fitted.branches.clone(),
        accept: model.params.accept,
        min_confidence: model.params.min_confidence,
        estimated,
    };
    TrainingReport {
        operating: Vec::new(),
        classes,
        bones: material
            .pivots
            .pivots()
            .iter()
            .map(|p| p.name.clone())
            .collect(),
        background_secs,
        threshold: None,
        threshold_from,
        negatives: BTreeMap::new(),
        judges_whole: false,
        held_out: None,
        verified: false,
        notes,
        svrdm: Some(svrdm),
    }
}
