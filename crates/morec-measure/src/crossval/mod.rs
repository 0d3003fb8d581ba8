//! Cross-validation: train without a part of the labels, recognise that part, fold by fold.
//!
//! ```
//! use std::collections::BTreeSet;
//!
//! use morec::Labels;
//! use morec_measure::crossval::{CrossvalData, FoldBy, crossval};
//! use morec_measure::eval::Evaluation;
//! use morec::synth::{DatabaseSpec, database};
//! use morec::train::{TrainOptions, TrainingMaterial};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let spec = DatabaseSpec { people: 3, repetitions: 2, classes: vec!["wave", "bow"], ..Default::default() };
//! let (mut clips, mut labels) = (Vec::new(), Labels::default());
//! for made in database(1, &spec) {
//!     made.labels.iter().for_each(|label| labels.add(&made.clip.name, label.class, label.span));
//!     clips.push(morec::Take::new(made.clip)?.into());
//! }
//! let material = TrainingMaterial { labels: &labels, people: None, classes: &[], unknown: &BTreeSet::new() };
//! let data = material.sort_out(clips)?;
//! let of = CrossvalData {
//!     clips: &data.clips,
//!     samples: &data.samples,
//!     classes: &data.classes,
//!     unknown: &data.unknown,
//!     tests: None,
//! };
//! let tested = crossval(&of, &FoldBy::Clip.into(), &TrainOptions::default().into(), &())?.tested;
//! let measured = Evaluation::of(&tested.streams, &tested.truths, &tested.founds)?;
//! assert_eq!(measured.totals.samples, data.samples.len());
//! # Ok(())
//! # }
//! ```

mod folds;
mod whole;

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use crate::eval::event_pairs;
use crate::explain::{Miss, explain};
use crate::perturb::{Perturbation, Perturbed, perturb};
use morec::features::for_each_pose;
use morec::labels::{ClipDetection, GroundTruth, Mark, Sample, StreamInfo};
use morec::live::{Detection, Model, RecognizerCache, StartError};
use morec::progress::Progress;
use morec::train::{
    LabelSet, Recipe, StreamKind, TrainClip, TrainError, TrainingReport, train_model,
};

use folds::thin;
pub use folds::{Fold, FoldBy, TaughtLimit, folds};
pub use whole::{measure_as_taught, taught_span};

/// Data of a cross-validation.
#[derive(Debug, Clone)]
pub struct CrossvalData<'a> {
    /// Clips with samples and background clips.
    pub clips: &'a [TrainClip],
    /// All samples of the classes.
    pub samples: &'a [Sample],
    /// Names of the classes; a `ClassId` is an index into this.
    pub classes: &'a [String],
    /// Clips without any class: every detection in them is a false alarm. A clip may be background
    /// too; it is then tested only in folds that leave it out of training.
    pub unknown: &'a [TrainClip],
    /// Other clips to test on, in place of those that teach: each in the fold of its person.
    pub tests: Option<Tests<'a>>,
}

/// Clips that are only tested.
#[derive(Debug, Clone, Copy)]
pub struct Tests<'a> {
    /// Clips to test, not to train on.
    pub clips: &'a [TrainClip],
    /// Their labels.
    pub samples: &'a [Sample],
}

/// Options of a cross-validation.
#[derive(Debug, Clone)]
pub struct CrossvalOptions {
    /// Unit that is left out in turn.
    pub by: FoldBy,
    /// What teaches in a fold at most.
    pub taught: TaughtLimit,
    /// Copies of the tested clips that are tested too, each worse in one way.
    pub perturbations: Vec<Perturbation>,
    /// Rates of false alarms a minute at which the clips are tested too. A model of one sensitivity is left out.
    pub sensitivities: Vec<f64>,
}

impl From<FoldBy> for CrossvalOptions {
    fn from(by: FoldBy) -> Self {
        Self {
            by,
            taught: TaughtLimit::default(),
            perturbations: Vec::new(),
            sensitivities: Vec::new(),
        }
    }
}

/// Detections and labels of tested streams.
#[derive(Debug, Clone, Default)]
pub struct Tested {
    /// Every stream. A clip tested in several folds is several streams, with the fold in the name.
    pub streams: Vec<StreamInfo>,
    /// The samples of those streams.
    pub truths: Vec<GroundTruth>,
    /// What was recognised in them.
    pub founds: Vec<ClipDetection>,
    /// Samples without an event ([`event_pairs`]), and why; not looked for in copies.
    pub misses: Vec<Miss>,
}

/// Everything that was recognised, and what was there.
#[derive(Debug, Clone, Default)]
pub struct CrossvalOutcome {
    /// The clips as they are.
    pub tested: Tested,
    /// Their copies, for each of [`CrossvalOptions::perturbations`].
    pub perturbed: Vec<(Perturbation, Tested)>,
    /// The clips at each of [`CrossvalOptions::sensitivities`], where every fold's model has more than one.
    pub sensitivities: Vec<(f64, Tested)>,
    /// Report of each fold's training.
    pub folds: Vec<FoldReport>,
    /// Model of each fold.
    pub models: Vec<Model>,
}

/// One fold's training.
#[derive(Debug, Clone, serde::Serialize)]
pub struct FoldReport {
    /// Name of the part that was left out.
    pub name: String,
    /// What training reports: samples, background, threshold, notes.
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
        /// Name of the part that was left out.
        fold: String,
        /// Why.
        source: TrainError,
    },
    /// A clip cannot be recognised.
    #[error("fold {fold}, clip {clip}: {source}")]
    Recognize {
        /// Name of the part that was left out.
        fold: String,
        /// Name of the clip.
        clip: String,
        /// Why.
        source: StartError,
    },
}

/// Trains and tests every fold. Folds run one after the other, the clips of a fold in parallel; the outcome does
/// not depend on the number of threads.
///
/// # Errors
/// No sample, a fold that cannot be trained, or a clip that cannot be recognised.
pub fn crossval(
    material: &CrossvalData<'_>,
    options: &CrossvalOptions,
    recipe: &Recipe,
    progress: &dyn Progress,
) -> Result<CrossvalOutcome, CrossvalError> {
    let people = people(material);
    let mut folds = folds(options.by, material.samples, &people);
    if folds.is_empty() {
        return Err(CrossvalError::NoFolds);
    }
    let group = |s: &Sample| people.get(&s.clip).unwrap_or(&s.clip).clone();
    for fold in &mut folds {
        fold.taught = thin(&fold.taught, material.samples, options.taught, group);
        if let Some(tests) = &material.tests {
            let of_fold = |c: &&TrainClip| c.person.as_ref() == Some(&fold.name);
            let of_fold = tests.clips.iter().filter(of_fold);
            fold.tested = of_fold.map(|c| c.name.clone()).collect();
        }
    }
    let mut outcome = CrossvalOutcome::default();
    let perturbations = options.perturbations.iter();
    outcome.perturbed = perturbations.map(|p| (*p, Tested::default())).collect();
    let rates = options.sensitivities.iter();
    outcome.sensitivities = rates.map(|r| (*r, Tested::default())).collect();
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

fn people(material: &CrossvalData<'_>) -> BTreeMap<String, String> {
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
    material: &CrossvalData<'_>,
    fold: &Fold,
    several: bool,
    recipe: &Recipe,
    outcome: &mut CrossvalOutcome,
) -> Result<(), CrossvalError> {
    let training = training_clips(material, fold);
    let (model, report) = train_fold(material, fold, &training, recipe)?;
    let tested = tested_clips(material, fold, &training, several);
    let samples = material.tests.map_or(material.samples, |t| t.samples);
    let truths: Vec<&Sample> = samples
        .iter()
        .filter(|s| fold.tested.contains(&s.clip))
        .collect();
    let test = FoldTest {
        recognizers: &RecognizerCache::new(&model),
        fold,
        truths: &truths,
        explains: true,
    };
    test.run(&tested, None, &mut outcome.tested)?;
    let plain = FoldTest {
        explains: false,
        ..test
    };
    for (perturbation, result) in &mut outcome.perturbed {
        plain.run(&tested, Some(*perturbation), result)?;
    }
    run_sensitivities(&plain, &tested, &mut outcome.sensitivities)?;
    outcome.folds.push(FoldReport {
        name: fold.name.clone(),
        training: report,
    });
    outcome.models.push(model);
    Ok(())
}

/// Tests a fold's clips at each rate of false alarms; leaves none where the model has one sensitivity only.
fn run_sensitivities(
    test: &FoldTest<'_>,
    clips: &[TestClip<'_>],
    results: &mut Vec<(f64, Tested)>,
) -> Result<(), CrossvalError> {
    for i in 0..results.len() {
        let (rate, result) = &mut results[i];
        let Ok(model) = test.recognizers.model().with_sensitivity(*rate) else {
            results.clear();
            break;
        };
        let test = FoldTest {
            recognizers: &RecognizerCache::new(&model),
            ..*test
        };
        test.run(clips, None, result)?;
    }
    Ok(())
}

/// Clips with samples of the fold, and background that the fold does not test.
fn training_clips(material: &CrossvalData<'_>, fold: &Fold) -> Vec<TrainClip> {
    let taught = fold.taught.iter().map(|&i| &material.samples[i]);
    let teachers: BTreeSet<&str> = taught.map(|s| s.clip.as_str()).collect();
    let trains = |c: &&TrainClip| {
        !fold.left_out.contains(&c.name)
            && (c.source != StreamKind::Labelled || teachers.contains(c.name.as_str()))
    };
    material.clips.iter().filter(trains).cloned().collect()
}

fn train_fold(
    material: &CrossvalData<'_>,
    fold: &Fold,
    training: &[TrainClip],
    recipe: &Recipe,
) -> Result<(Model, TrainingReport), CrossvalError> {
    let pick = |places: &[usize]| -> Vec<Sample> {
        let chosen = places.iter().map(|&i| material.samples[i].clone());
        chosen.collect()
    };
    let (taught, held_back) = (pick(&fold.taught), pick(&fold.held_back));
    let labelling = LabelSet {
        samples: &taught,
        held_back: &held_back,
        classes: material.classes,
        unlabelled_is_background: recipe.unlabelled_is_background(),
    };
    let trained = train_model(training, &labelling, recipe, &());
    trained.map_err(|source| CrossvalError::Train {
        fold: fold.name.clone(),
        source,
    })
}

struct TestClip<'a> {
    clip: &'a TrainClip,
    /// True if it holds none of the classes.
    unknown: bool,
    /// Name of its stream.
    name: String,
}

fn tested_clips<'a>(
    material: &CrossvalData<'a>,
    fold: &Fold,
    training: &[TrainClip],
    several: bool,
) -> Vec<TestClip<'a>> {
    let clips = material.tests.map_or(material.clips, |t| t.clips);
    let known = clips.iter().filter(|c| fold.tested.contains(&c.name));
    let known = known.map(|clip| TestClip {
        clip,
        unknown: false,
        name: clip.name.clone(),
    });
    let trained_on: BTreeSet<&str> = training.iter().map(|c| c.name.as_str()).collect();
    // Test clips with a known person run in that person's fold, others in every fold.
    let of_fold = |c: &&TrainClip| {
        let of_person = c.person.is_none() || fold.left_out.contains(&c.name);
        !trained_on.contains(c.name.as_str()) && (!several || of_person)
    };
    let unknown = material.unknown.iter().filter(of_fold);
    let unknown = unknown.map(|clip| TestClip {
        clip,
        unknown: true,
        name: if several && clip.person.is_none() {
            format!("{} (without {})", clip.name, fold.name)
        } else {
            clip.name.clone()
        },
    });
    known.chain(unknown).collect()
}

/// A fold's recognisers and the samples of its tested clips.
#[derive(Clone, Copy)]
struct FoldTest<'a> {
    /// Of the fold's model.
    recognizers: &'a RecognizerCache,
    fold: &'a Fold,
    truths: &'a [&'a Sample],
    /// True if to look for the reasons of misses.
    explains: bool,
}

impl FoldTest<'_> {
    /// Recognises `clips`, or copies of them, in parallel and adds the results to `out`.
    fn run(
        &self,
        clips: &[TestClip<'_>],
        perturbation: Option<Perturbation>,
        out: &mut Tested,
    ) -> Result<(), CrossvalError> {
        let tests: Result<Vec<Tested>, _> = clips
            .par_iter()
            .map(|clip| self.test(clip, perturbation))
            .collect();
        for tested in tests? {
            out.streams.extend(tested.streams);
            out.truths.extend(tested.truths);
            out.founds.extend(tested.founds);
            out.misses.extend(tested.misses);
        }
        Ok(())
    }

    fn test(
        &self,
        test: &TestClip<'_>,
        perturbation: Option<Perturbation>,
    ) -> Result<Tested, CrossvalError> {
        let clip = test.clip;
        let copy = perturbation.map(|perturbation| perturbed(clip, perturbation));
        let found = match &copy {
            Some(copy) => self.recognizers.recognize_poses(&copy.poses),
            None => (self.recognizers).recognize_clip(&clip.clip, &clip.roles, &clip.rest),
        };
        let found = found.map_err(|source| CrossvalError::Recognize {
            fold: self.fold.name.clone(),
            clip: clip.name.clone(),
            source,
        })?;
        let in_copy = |secs: f64| copy.as_ref().map_or(secs, |c| c.secs_in_copy(secs));
        let truths = self.truths.iter().filter(|s| s.clip == clip.name);
        let truths: Vec<GroundTruth> = truths
            .map(|s| GroundTruth {
                clip: test.name.clone(),
                class: s.class.clone(),
                span: whole::taught_part(s, clip).map(in_copy),
            })
            .collect();
        let model = self.recognizers.model();
        let named = |d: &Detection| ClipDetection::new(&test.name, d.named(model));
        let founds: Vec<ClipDetection> = found.iter().map(named).collect();
        let misses = if self.explains {
            let played = (&clip.clip, &clip.roles, &clip.rest);
            explain(
                self.recognizers.model(),
                played,
                &missed(&truths, &founds),
                &found,
            )
        } else {
            Vec::new()
        };
        Ok(Tested {
            truths,
            founds,
            misses,
            streams: vec![StreamInfo {
                clip: test.name.clone(),
                duration_secs: in_copy(clip.clip.duration_secs()),
                unknown: test.unknown,
            }],
        })
    }
}

/// The samples without an event.
fn missed<'t>(truths: &'t [GroundTruth], founds: &[ClipDetection]) -> Vec<Mark<&'t str>> {
    let all: Vec<&GroundTruth> = truths.iter().collect();
    let pairs = event_pairs(&all, &founds.iter().collect::<Vec<_>>());
    let missed = all
        .into_iter()
        .zip(pairs)
        .filter(|(_, pair)| pair.is_none());
    missed.map(|(truth, _)| truth.into()).collect()
}

/// A copy of `clip`, reproducible: the seed comes of its name.
pub fn perturbed(clip: &TrainClip, perturbation: Perturbation) -> Perturbed {
    let mut poses = Vec::with_capacity(clip.clip.frames);
    let roles = &clip.roles.with_fingers(&clip.clip.skeleton);
    for_each_pose(&clip.clip, roles, &clip.rest, |secs, pose| {
        poses.push((secs, *pose));
    });
    let seed = clip
        .name
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
    perturb(poses, &[perturbation], seed)
}
