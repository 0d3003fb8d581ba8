//! The training itself, step by step as in the method's description.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::classes::ClassInfo;
use crate::decode::FAR;
use crate::features::{BoneSet, Rows};
use crate::progress::Progress;
use crate::templates::{Bank, Metric, Sample, Symmetric, TemplateModel, TemplateModelError};

use super::mining::{Distances, NearMiss, near_misses};
use super::params::TrainParams;
use super::scatter::{covariance, ridged, within_class};
use super::set::{Source, TrainSample, TrainSet, TrainStream};

/// Why nothing could be trained.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrainError {
    /// There is no sample to learn from.
    #[error("no sample to learn from: none of the labels lies inside its clip")]
    NoSamples,
    /// More classes than an index numbers.
    #[error("{0} classes; an index holds at most 65535")]
    TooManyClasses(usize),
    /// Parts came out unusable.
    #[error(transparent)]
    Model(#[from] TemplateModelError),
    /// The listener asked to stop.
    #[error("cancelled")]
    Cancelled,
}

/// A model and how it came about.
#[derive(Debug, Clone)]
pub struct Trained {
    /// The model.
    pub model: TemplateModel,
    /// The stretches that became negatives.
    pub negatives: Vec<NearMiss>,
    /// What set the threshold, in words.
    pub threshold_from: String,
    /// What the user should know.
    pub notes: Vec<String>,
}

/// Trains templates for `set`, whose rows hold `bones`.
///
/// 1. metric from how samples of one class by different people differ;
/// 2. every sample is a template;
/// 3. threshold from the nearest that background motion comes to any of them;
/// 4. hard negatives from unlabelled stretches that come near.
pub fn train(
    set: &TrainSet,
    bones: BoneSet,
    params: &TrainParams,
    progress: &dyn Progress,
) -> Result<Trained, TrainError> {
    let samples = set.samples();
    if samples.is_empty() {
        return Err(TrainError::NoSamples);
    }
    if set.classes.len() > usize::from(u16::MAX) {
        return Err(TrainError::TooManyClasses(set.classes.len()));
    }
    let (ridged, total) = metric_of(set, &samples, params);
    let metric = Metric::new(&ridged, &total);
    let mapped: Vec<Rows> = samples.iter().map(|s| metric.apply_all(&s.rows)).collect();
    let bank = Bank::new(&mapped, metric.dim());
    let distances = all_distances(set, &bank, &metric, progress)?;
    let (threshold, threshold_from) = threshold_of(set, &distances, params);
    let negatives =
        if params.mine_negatives { mine(set, &samples, &distances, threshold, params) } else { vec![] };
    let model = TemplateModel {
        features: params.features.clone(),
        bones,
        decode: params.decode.clone(),
        classes: class_infos(set, &samples),
        samples: samples.into_iter().map(|s| Sample { class: s.class, rows: s.rows }).collect(),
        negatives: negatives.iter().map(|n| negative_rows(set, n)).collect(),
        ridged,
        total,
        threshold,
        step: None,
    };
    model.check()?;
    Ok(Trained { model, negatives, threshold_from, notes: Vec::new() })
}

fn metric_of(set: &TrainSet, samples: &[TrainSample], params: &TrainParams) -> (Symmetric, Symmetric) {
    let dim = samples[0].rows.dim();
    let labelled = set.streams.iter().filter(|s| s.known.iter().any(|k| k.class.is_some()));
    let total = covariance(labelled.map(|s| &s.rows), dim);
    let within = within_class(samples, set.classes.len(), dim, params.max_pairs);
    (ridged(&within, &total, params.rho), Symmetric::pack(&total))
}

/// Every stream against every template, in parallel, in the order of the set.
fn all_distances(
    set: &TrainSet,
    bank: &Bank,
    metric: &Metric,
    progress: &dyn Progress,
) -> Result<Vec<Distances>, TrainError> {
    let (done, total) = (AtomicUsize::new(0), set.streams.len());
    let compare = |bank: &mut Bank, stream: &TrainStream| {
        if progress.cancelled() {
            return Err(TrainError::Cancelled);
        }
        let distances = Distances::of(bank, &metric.apply_all(&stream.rows));
        progress.report("comparing clips", done.fetch_add(1, Ordering::Relaxed) + 1, total);
        Ok(distances)
    };
    set.streams.par_iter().map_init(|| bank.clone(), compare).collect()
}

/// A share of the smallest distance that background motion has to any template, and what set it.
fn threshold_of(set: &TrainSet, distances: &[Distances], params: &TrainParams) -> (f32, String) {
    let background = set.streams.iter().zip(distances).filter(|(s, _)| s.source != Source::Labelled);
    let nearest = background.min_by(|a, b| a.1.smallest().total_cmp(&b.1.smallest()));
    match nearest {
        Some((stream, d)) if d.smallest() < FAR / 2.0 => {
            (params.background_share as f32 * d.smallest(), format!("background clip {}", stream.name))
        }
        _ => (params.fallback_threshold as f32, "no background: a general value".to_owned()),
    }
}

fn mine(
    set: &TrainSet,
    samples: &[TrainSample],
    distances: &[Distances],
    threshold: f32,
    params: &TrainParams,
) -> Vec<NearMiss> {
    let streams = set.streams.iter().enumerate().filter(|(_, s)| s.rest_is_background);
    let mut found: Vec<NearMiss> =
        streams.flat_map(|(i, s)| near_misses(&distances[i], samples, (i, s), threshold, params)).collect();
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    found.truncate(params.max_negatives);
    found
}

/// The rows of a near miss, and at least the eight before its end: a shorter template would match anything.
fn negative_rows(set: &TrainSet, miss: &NearMiss) -> Rows {
    let start = miss.ticks.start.min(miss.ticks.end.saturating_sub(8));
    set.streams[miss.stream].rows.slice(start..miss.ticks.end)
}

fn class_infos(set: &TrainSet, samples: &[TrainSample]) -> Vec<ClassInfo> {
    let of = |class: usize| samples.iter().filter(move |s| s.class.index() == class);
    let named = set.classes.iter().enumerate();
    named
        .map(|(class, name)| ClassInfo {
            name: name.clone(),
            samples: of(class).count(),
            people: of(class).map(|s| s.group.as_str()).collect::<BTreeSet<_>>().len(),
        })
        .collect()
}
