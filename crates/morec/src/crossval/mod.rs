//! Cross-validation: train without a part of the labels, recognise that part, fold by fold.

mod folds;

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use crate::eval::{Found, StreamInfo, Truth};
use crate::labels::Sample;
use crate::live::{Model, StartError, recognize_clip};
use crate::progress::Progress;
use crate::train::{Labelling, Recipe, Source, TrainClip, TrainError, TrainingReport, train_model};

pub use folds::{By, Fold, folds};

/// What to cross-validate on.
#[derive(Debug, Clone)]
pub struct Material<'a> {
    /// Clips with samples and background clips.
    pub clips: &'a [TrainClip],
    /// All samples of the classes.
    pub samples: &'a [Sample],
    /// The classes.
    pub classes: &'a [String],
    /// Clips that hold none of the classes: what is recognised in them is a false alarm. A clip may be background
    /// too; it is then tested only in folds that leave it out of training.
    pub unknown: &'a [TrainClip],
}

/// Everything that was recognised, and what was there.
#[derive(Debug, Clone, Default)]
pub struct Outcome {
    /// Every stream tested. A clip tested in several folds is several streams, with the fold in the name.
    pub streams: Vec<StreamInfo>,
    /// The samples of those streams.
    pub truths: Vec<Truth>,
    /// What was recognised.
    pub founds: Vec<Found>,
    /// How each fold's training went.
    pub folds: Vec<FoldReport>,
    /// What each fold trained.
    pub models: Vec<Model>,
}

/// One fold's training.
#[derive(Debug, Clone, serde::Serialize)]
pub struct FoldReport {
    /// What was left out.
    pub name: String,
    /// What training reported.
    pub training: TrainingReport,
}

/// Why a fold failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CrossvalError {
    /// Nothing to do.
    #[error("no fold can be made: there are no samples")]
    NoFolds,
    /// Training failed.
    #[error("fold {fold}: {source}")]
    Train {
        /// Which fold.
        fold: String,
        /// Why.
        source: TrainError,
    },
    /// A clip cannot be recognised.
    #[error("fold {fold}, clip {clip}: {source}")]
    Recognize {
        /// Which fold.
        fold: String,
        /// Which clip.
        clip: String,
        /// Why.
        source: StartError,
    },
}

/// Trains and tests every fold. Folds run one after the other, the clips of a fold in parallel; the outcome does
/// not depend on the number of threads.
pub fn crossval(
    material: &Material<'_>,
    by: By,
    recipe: &Recipe,
    progress: &dyn Progress,
) -> Result<Outcome, CrossvalError> {
    let folds = folds(by, material.samples, &people(material));
    if folds.is_empty() {
        return Err(CrossvalError::NoFolds);
    }
    let mut outcome = Outcome::default();
    for (done, fold) in folds.iter().enumerate() {
        progress.report("folds", done, folds.len());
        if progress.cancelled() {
            let source = TrainError::Cancelled;
            return Err(CrossvalError::Train {
                fold: fold.name.clone(),
                source,
            });
        }
        run_fold(material, fold, folds.len() > 1, recipe, &mut outcome)?;
    }
    progress.report("folds", folds.len(), folds.len());
    Ok(outcome)
}

fn people(material: &Material<'_>) -> BTreeMap<String, String> {
    let clips = material.clips.iter().chain(material.unknown);
    let named = clips.map(|c| {
        (
            c.name.clone(),
            c.person.clone().unwrap_or_else(|| c.name.clone()),
        )
    });
    named.collect()
}

fn run_fold(
    material: &Material<'_>,
    fold: &Fold,
    several: bool,
    recipe: &Recipe,
    outcome: &mut Outcome,
) -> Result<(), CrossvalError> {
    let pick = |places: &[usize]| -> Vec<Sample> {
        places
            .iter()
            .map(|&i| material.samples[i].clone())
            .collect()
    };
    let (taught, held_back) = (pick(&fold.taught), pick(&fold.held_back));
    let teachers: BTreeSet<&str> = taught.iter().map(|s| s.clip.as_str()).collect();
    let trains = |c: &&TrainClip| {
        !fold.left_out.contains(&c.name)
            && (c.source != Source::Labelled || teachers.contains(c.name.as_str()))
    };
    let training: Vec<TrainClip> = material.clips.iter().filter(trains).cloned().collect();
    let labelling = Labelling {
        samples: &taught,
        held_back: &held_back,
        classes: material.classes,
        unlabelled_is_background: recipe.unlabelled_is_background(),
    };
    let trained = train_model(&training, &labelling, recipe, &());
    let (model, report) = trained.map_err(|source| CrossvalError::Train {
        fold: fold.name.clone(),
        source,
    })?;

    let trained_on: BTreeSet<&str> = training.iter().map(|c| c.name.as_str()).collect();
    let known = material
        .clips
        .iter()
        .filter(|c| fold.tested.contains(&c.name))
        .map(|c| (c, false));
    // An unknown clip of a person is a test of that person's fold; of nobody known, of every fold.
    let of_fold = |c: &TrainClip| !several || c.person.is_none() || fold.left_out.contains(&c.name);
    let unknown = material
        .unknown
        .iter()
        .filter(|c| !trained_on.contains(c.name.as_str()) && of_fold(c));
    let tested: Vec<_> = known.chain(unknown.map(|c| (c, true))).collect();
    let tests: Result<Vec<_>, _> = tested
        .par_iter()
        .map(|(c, u)| test(&model, c, *u, fold, several))
        .collect();
    for (stream, founds) in tests? {
        outcome.founds.extend(founds);
        outcome.streams.push(stream);
    }
    let truths = material
        .samples
        .iter()
        .filter(|s| fold.tested.contains(&s.clip));
    outcome
        .truths
        .extend(truths.map(|s| Truth::from(s.clone())));
    outcome.folds.push(FoldReport {
        name: fold.name.clone(),
        training: report,
    });
    outcome.models.push(model);
    Ok(())
}

fn test(
    model: &Model,
    clip: &TrainClip,
    unknown: bool,
    fold: &Fold,
    several: bool,
) -> Result<(StreamInfo, Vec<Found>), CrossvalError> {
    let failed = |source| CrossvalError::Recognize {
        fold: fold.name.clone(),
        clip: clip.name.clone(),
        source,
    };
    let found = recognize_clip(model, &clip.clip, &clip.roles, &clip.rest).map_err(failed)?;
    let again = unknown && several && clip.person.is_none();
    let name = if again {
        format!("{} (without {})", clip.name, fold.name)
    } else {
        clip.name.clone()
    };
    let founds = found.iter().map(|d| Found {
        clip: name.clone(),
        class: model.class_name(d.class).to_owned(),
        start_secs: d.start_secs,
        stop_secs: d.stop_secs,
        score: Some(d.score),
        reported_secs: Some(d.reported_secs),
    });
    let founds = founds.collect();
    Ok((
        StreamInfo {
            clip: name,
            duration_secs: clip.clip.duration_secs(),
            unknown,
        },
        founds,
    ))
}
