//! Thresholds of recognition from training samples and background motion (future work in the thesis, ch. 6).
//!
//! The thesis trains with `T = 1` and recognises with a `T` of 0.92 that was chosen by hand. Here `T` is as low as it may
//! be without samples that were left out of training being taken for another class, and a second threshold, on the confidence of what the tree let pass, is
//! high enough to reject motion of no class. `t`, which the thesis wishes estimated too, is estimated on request.

use std::sync::Arc;

use rayon::prelude::*;
use serde::Serialize;

use crate::progress::Progress;
use crate::svrdm::{Classified, FrameDetection, SampleClassifier, SvrdmEngine, SvrdmModel};
use crate::train::{TrainError, overlap_share};

use super::fit::fit;
use super::material::{Background, ThesisTrainingData};
use super::{SvrdmTrainParams, ThesisSample};

/// `T` is not below this: outputs between the sides of a branch are about `t = 0.4`.
const LEAST_ACCEPT: f64 = 0.5;
/// `T` is not above what the thesis recognises with.
const MOST_ACCEPT: f64 = 0.92;
/// This share of left-out samples may be taken for another class.
const MAY_MISTAKE: f64 = 0.01;
/// This share of the left-out samples that the tree gets right may fall below the least confidence, if background
/// asks for as much: what lies near a motion in its own clip must not silence the class.
const MAY_SILENCE: f64 = 0.25;
/// This share of them may be lost to `t`.
const MAY_LOSE: f64 = 0.02;
/// Margin below a threshold that unwanted detections must keep.
const MARGIN: f64 = 0.01;
/// The least confidence where there is no background to ask for more.
const LEAST_CONFIDENCE: f64 = 0.3;
/// Detections that share more than this with a sample say nothing about background.
const MAX_OVERLAP: f64 = 0.3;

/// Estimated thresholds and the data behind them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Estimated {
    /// `T`.
    pub accept: f64,
    /// `t`, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub other: Option<f64>,
    /// The least confidence that is reported.
    pub min_confidence: f64,
    /// Left-out samples that were judged.
    pub samples: usize,
    /// Of these, the share that the tree takes to their class with at least `accept`.
    pub right: f64,
    /// The share that it takes to another.
    pub wrong: f64,
    /// Of the right ones, the share that is confident enough.
    pub confident: f64,
    /// Minutes of background that were looked at.
    pub background_minutes: f64,
    /// Detections in the background before the threshold on confidence.
    pub background_detections: usize,
    /// The most confident of these.
    pub background_confidence: f64,
}

impl Estimated {
    /// The model with these thresholds.
    pub fn applied_to(&self, model: &SvrdmModel) -> SvrdmModel {
        let mut model = model.clone();
        let params = &mut model.params;
        (params.accept, params.min_confidence) = (self.accept, self.min_confidence);
        params.other = self.other.or(params.other);
        model
    }
}

/// Result of one left-out sample.
struct LeftOutResult {
    right: bool,
    found: Classified,
}

impl LeftOutResult {
    fn passes(&self, accept: f64, other: Option<f64>) -> bool {
        self.found.output >= accept && other.is_none_or(|other| self.found.other <= other)
    }
}

/// Estimates both thresholds. Trains `folds` times, then plays all background through the model.
pub(super) fn estimate(
    material: &ThesisTrainingData,
    model: &SvrdmModel,
    params: &SvrdmTrainParams,
    (folds, wants_other): (usize, bool),
    progress: &dyn Progress,
) -> Result<Estimated, TrainError> {
    let folds = folds.max(2);
    let places = dealt(&material.samples, folds);
    let mut judged = vec![];
    for fold in 0..folds {
        progress.report("thresholds", fold, folds + 1);
        if progress.cancelled() {
            return Err(TrainError::Cancelled);
        }
        judged.extend(judge_fold(material, params, &places, fold)?);
    }
    let other = match wants_other {
        true => least_other(&judged, params.tree.machine.other),
        false => params.stages.other,
    };
    let mut mistaken: Vec<f64> = judged
        .iter()
        .filter(|j| !j.right && j.passes(LEAST_ACCEPT, other))
        .map(|j| j.found.output)
        .collect();
    mistaken.sort_by(|a, b| b.total_cmp(a));
    let spared = (MAY_MISTAKE * judged.len() as f64) as usize;
    let accept = mistaken
        .get(spared)
        .map_or(LEAST_ACCEPT, |output| output + MARGIN);
    let accept = accept.clamp(LEAST_ACCEPT, MOST_ACCEPT);

    let mut listening = model.clone();
    (listening.params.accept, listening.params.min_confidence) = (accept, 0.2);
    listening.params.other = other;
    let listening = Arc::new(listening);
    let scores: Result<Vec<Vec<f64>>, TrainError> = material
        .background
        .par_iter()
        .map(|b| heard(&listening, b))
        .collect();
    let scores = scores?.concat();
    let background_confidence = scores.iter().copied().fold(0.0, f64::max);

    let passing = || judged.iter().filter(|j| j.right && j.passes(accept, other));
    let mut confidences: Vec<f64> = passing().map(|j| j.found.confidence).collect();
    let most = low_quantile(&mut confidences, MAY_SILENCE)
        .unwrap_or(1.0)
        .max(LEAST_CONFIDENCE);
    let min_confidence = (background_confidence + MARGIN).clamp(LEAST_CONFIDENCE, most);
    let share = |count: usize, of: usize| count as f64 / of.max(1) as f64;
    let right = passing().count();
    let frames: usize = material
        .background
        .iter()
        .map(|b| b.rows.len() - known_frames(b))
        .sum();
    Ok(Estimated {
        accept,
        other: other.filter(|_| wants_other),
        min_confidence: min_confidence.min(0.99),
        samples: judged.len(),
        right: share(right, judged.len()),
        wrong: share(
            judged
                .iter()
                .filter(|j| !j.right && j.passes(accept, other))
                .count(),
            judged.len(),
        ),
        confident: share(
            passing()
                .filter(|j| j.found.confidence >= min_confidence)
                .count(),
            right,
        ),
        background_minutes: frames as f64 / params.pose.rate_hz / 60.0,
        background_detections: scores.len(),
        background_confidence,
    })
}

/// `t`: as low as it may be without silencing more than a share of the left-out samples that are right, and not below the `trained` one.
/// None where no sample is.
fn least_other(judged: &[LeftOutResult], trained: f64) -> Option<f64> {
    let right = judged
        .iter()
        .filter(|j| j.right && j.found.output >= LEAST_ACCEPT);
    // Ascending from the largest.
    let mut others: Vec<f64> = right.map(|j| -j.found.other).collect();
    let largest = -low_quantile(&mut others, MAY_LOSE)?;
    Some((largest + MARGIN).max(trained))
}

/// For each sample the fold that leaves it out; `None` for the only one of its class.
fn dealt(samples: &[ThesisSample], folds: usize) -> Vec<Option<usize>> {
    let mut met = std::collections::BTreeMap::new();
    let count = |s: &ThesisSample| {
        samples
            .iter()
            .filter(|other| other.class == s.class)
            .count()
    };
    samples
        .iter()
        .map(|s| {
            let at = met.entry(s.class).or_insert(0usize);
            *at += 1;
            (count(s) > 1).then_some((*at - 1) % folds)
        })
        .collect()
}

/// Trains without one fold and puts its samples through.
fn judge_fold(
    material: &ThesisTrainingData,
    params: &SvrdmTrainParams,
    places: &[Option<usize>],
    fold: usize,
) -> Result<Vec<LeftOutResult>, TrainError> {
    let (mut out, mut taught) = (vec![], vec![]);
    for (sample, place) in material.samples.iter().zip(places) {
        if *place == Some(fold) {
            out.push(sample)
        } else {
            taught.push(sample.clone())
        }
    }
    if out.is_empty() {
        return Ok(vec![]);
    }
    let model = Arc::new(fit(&taught, &material.classes, &material.pca, params)?.model);
    let mut classifier = SampleClassifier::new(&model).map_err(TrainError::Svrdm)?;
    let judge = |sample: &ThesisSample| {
        let found = classifier.classify(&sample.rows)?;
        Some(LeftOutResult {
            right: found.class == sample.class,
            found,
        })
    };
    Ok(out.into_iter().filter_map(judge).collect())
}

/// Confidences of what is detected in background.
fn heard(model: &Arc<SvrdmModel>, background: &Background) -> Result<Vec<f64>, TrainError> {
    let mut engine = SvrdmEngine::new(model).map_err(TrainError::Svrdm)?;
    let mut scores = vec![];
    let mut hear = |d: FrameDetection| {
        let span = d.start.max(0) as usize..d.stop.max(0) as usize;
        if background
            .known
            .iter()
            .all(|known| overlap_share(&span, known) <= MAX_OVERLAP)
        {
            scores.push(d.score);
        }
    };
    background
        .rows
        .iter()
        .for_each(|row| engine.push(row, &mut hear));
    engine.finish(&mut hear);
    Ok(scores)
}

fn known_frames(background: &Background) -> usize {
    background
        .known
        .iter()
        .map(ExactSizeIterator::len)
        .sum::<usize>()
        .min(background.rows.len())
}

/// The value below which at most the share `below` of `values` lies.
fn low_quantile(values: &mut [f64], below: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values
        .get((below * values.len() as f64).floor() as usize)
        .copied()
}
