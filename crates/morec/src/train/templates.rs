//! Training of the method templates, step by step as in docs/method.md.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use crate::classes::{ClassId, ClassInfo};
use crate::decode::TYPICAL_SPREAD;
use crate::features::{BoneSet, Profile};
use crate::progress::Progress;
use crate::templates::{
    Activities, Calibration, HeldPoses, Metric, PackedSymmetric, TemplateModel, TemplateSample,
    Verifier, mean_and_spread,
};

use super::activities;
use super::alike::AlikeClasses;
use super::comparison::{StreamMatches, TrainingContext};
use super::error::TrainError;
use super::examples::{self, CandidateFinder, NearStream, VerifierExample};
use super::held;
use super::mining::{NearMiss, NearestByGate};
use super::params::TrainParams;
use super::plan::DecisionPlan;
use super::refused;
use super::representatives::representatives;
use super::scatter::{covariance, ridged, within_class};
use super::second_look::{self, HeldOutAlarms, LearnedLook, OwnSample};
use super::set::{TrainSample, TrainSet};
use super::verifier;

/// A model and how it came about.
#[derive(Debug, Clone)]
pub struct TrainedTemplates {
    /// Ready to recognise.
    pub model: TemplateModel,
    /// The stretches that became negatives.
    pub negatives: Vec<NearMiss>,
    /// Origin of the threshold, in words.
    pub threshold_from: String,
    /// Samples that hardly move, and so are no templates.
    pub quiet: Vec<TrainSample>,
    /// Classes that keep each other from being reported; none where candidates are verified.
    pub alike: Vec<AlikeClasses>,
    /// Samples judged among the others by the second look; none where it does not decide.
    pub own: Vec<OwnSample>,
    /// False alarms of background motion that did not set the bound of the second look.
    pub held_out: Option<HeldOutAlarms>,
}

/// `params` with the spread of the usual template among `samples`, where rows are not a body's. Thresholds are then at most that
/// spread, unless another bound was chosen: a hand is near to many gestures of no class.
fn of_profile(
    params: &TrainParams,
    bones: BoneSet,
    samples: &[TrainSample],
    metric: &Metric,
) -> TrainParams {
    let mut params = params.clone();
    if Profile::of(bones) != Profile::Body {
        let spread = |sample: &TrainSample| {
            let mapped = metric.apply_all(&sample.rows);
            mean_and_spread(&mapped, mapped.dim()).1
        };
        let mut spreads: Vec<f32> = samples.iter().map(spread).collect();
        spreads.sort_by(f32::total_cmp);
        let usual = spreads.get(spreads.len() / 2).copied();
        params.decode.typical_spread = usual.unwrap_or(TYPICAL_SPREAD).max(1e-3);
        if params.max_threshold == TrainParams::default().max_threshold {
            params.max_threshold = f64::from(TYPICAL_SPREAD);
        }
    }
    params
}

/// Trains templates for `set`, whose rows hold `bones`.
///
/// 1. metric from how samples of one class by different people differ;
/// 2. classes of held signs and of activities get models of their own;
/// 3. where whole motions are judged, the second look learns all samples, and the templates are their representatives; elsewhere all samples
///    that move, and faster copies, are templates, up to a limit for each class;
/// 4. thresholds from a rate of false alarms on background, and negatives from background that comes near, where there is no second look;
/// 5. a verifier, where the data allow.
///
/// # Errors
/// No sample, more classes than an index numbers, a model whose parts do not fit together, or `progress` cancels.
pub fn train(
    set: &TrainSet,
    bones: BoneSet,
    params: &TrainParams,
    progress: &dyn Progress,
) -> Result<TrainedTemplates, TrainError> {
    let samples = set.samples();
    if samples.is_empty() {
        return Err(TrainError::NoSamples);
    }
    if set.classes.len() > usize::from(u16::MAX) {
        return Err(TrainError::TooManyClasses(set.classes.len()));
    }
    let (ridged, total) = metric_of(set, &samples, params);
    let metric = Metric::new(&ridged, &total);
    let classes = class_infos(set, &samples);
    let sorted = SortedSamples::new(set, samples, bones, params, &metric);
    let params = &of_profile(params, bones, &sorted.gestures, &metric);
    let step = TrainingContext {
        set,
        metric: &metric,
        params,
        progress,
    };
    let plan = DecisionPlan::new(&step, bones, &classes, (&sorted.gestures, &sorted.going_on));
    let learn = || second_look::learn(set, &plan.judged, bones, params, progress);
    let mut learned = plan.decides_by_look().then(learn).flatten();
    let samples = match &learned {
        // Templates only find candidates, which the second look then compares with all samples.
        Some(learned) => step.representatives(learned, sorted.gestures),
        None => {
            let copies = step.faster_copies(&sorted.gestures, bones, plan.gates.plain)?;
            let mut samples = sorted.gestures;
            samples.extend(copies);
            samples
        }
    };
    let matches = step.templates(&samples, plan.gates, plan.reach(step.largest_threshold()))?;
    let limits = step.limits(&plan, bones, (&samples, &matches), learned.is_some())?;
    let threshold = limits.operating.threshold;
    let verifier = match plan.verifies {
        true => step.verifier(&matches, &limits.near_negatives, threshold),
        false => None,
    };
    if plan.verifies && verifier.is_none() {
        learned = plan.judges_whole.then(learn).flatten();
    }
    let (look, own) = learned.map_or((None, Vec::new()), |l| (Some(l.look), l.own));
    let alike = match verifier.is_none() && look.is_none() {
        true => step.alike(&samples, plan.gates.plain, threshold)?,
        false => Vec::new(),
    };
    let calibration = match (&verifier, &look) {
        (Some(_), _) => Calibration::VERIFIED,
        (None, Some(_)) => Calibration::OF_LOOKS,
        (None, None) => Calibration::MEASURED,
    };
    let model = TemplateModel {
        features: params.features.clone(),
        bones,
        decode: plan.decode(&params.decode, look.is_some()),
        classes,
        samples: samples.into_iter().map(template).collect(),
        negatives: limits.rows,
        ridged,
        total,
        threshold,
        class_thresholds: Vec::new(),
        operating: limits.operating.points,
        calibration: params.calibrate.then_some(calibration),
        stranger: limits.stranger.filter(|_| verifier.is_none()),
        verifier,
        held: sorted.held,
        look,
        activities: sorted.activities,
        step: None,
    };
    let mut model = if params.compact {
        model.compacted()
    } else {
        model
    };
    let held_out = second_look::set_bound(&mut model, set, params, progress)?;
    refused::refuse(&mut model, set, params)?;
    model.check()?;
    Ok(TrainedTemplates {
        model,
        negatives: limits.negatives,
        threshold_from: limits.operating.from,
        quiet: sorted.quiet,
        alike,
        own,
        held_out,
    })
}

fn template(sample: TrainSample) -> TemplateSample {
    TemplateSample {
        class: sample.class,
        rows: sample.rows,
    }
}

/// Samples by what will recognise their classes.
struct SortedSamples {
    held: Option<HeldPoses>,
    activities: Option<Activities>,
    /// Of classes that are activities.
    going_on: Vec<TrainSample>,
    /// Those that become templates, up to a limit for each class.
    gestures: Vec<TrainSample>,
    /// Those of gestures that hardly move.
    quiet: Vec<TrainSample>,
}

impl SortedSamples {
    fn new(
        set: &TrainSet,
        samples: Vec<TrainSample>,
        bones: BoneSet,
        params: &TrainParams,
        metric: &Metric,
    ) -> Self {
        let held = held::learn(set, &samples, bones, params);
        let activities = activities::learn(set, &samples, bones, params);
        let is_held = |sample: &TrainSample| {
            held.as_ref()
                .is_some_and(|held| held.poses.classes.contains(&sample.class))
        };
        let goes_on =
            |sample: &TrainSample| activities.as_ref().is_some_and(|a| a.holds(sample.class));
        let (going_on, others): (Vec<_>, Vec<_>) = samples.into_iter().partition(goes_on);
        let gestures = others.into_iter().filter(|s| !is_held(s)).collect();
        let (gestures, quiet) = moving(gestures, metric, params);
        let gestures = templates_of(gestures, set.classes.len(), params.max_templates);
        Self {
            held,
            activities,
            going_on,
            gestures,
            quiet,
        }
    }
}

impl TrainingContext<'_> {
    /// The samples that stand for their class, those that were mirrored apart from those that were shown.
    fn representatives(
        &self,
        learned: &LearnedLook,
        samples: Vec<TrainSample>,
    ) -> Vec<TrainSample> {
        let most = match self.params.representatives {
            0 => samples.len(),
            most => most,
        };
        let group = |s: &TrainSample| (s.class, self.set.streams[s.stream].is_copy);
        let groups: Vec<_> = samples.iter().map(group).collect();
        let segments = &learned.segments[..samples.len()];
        let by = (&learned.look, &learned.comparison);
        let chosen = representatives(by, segments, &groups, most);
        chosen.into_iter().map(|k| samples[k].clone()).collect()
    }

    /// Candidates of all streams, each seen without its own person, and what a verifier learns from them.
    fn verifier(
        &self,
        matches: &[StreamMatches],
        negatives: &[NearestByGate],
        threshold: f32,
    ) -> Option<Verifier> {
        let (set, params) = (self.set, self.params);
        let candidates = CandidateFinder::new(set, threshold, params);
        let near = |stream: usize| NearStream {
            stream,
            classes: &matches[stream].classes,
            negatives: &negatives[stream].plain,
        };
        let examples: Vec<VerifierExample> = (0..set.streams.len())
            .into_par_iter()
            .flat_map_iter(|stream| candidates.examples(near(stream)))
            .collect();
        let reach = examples::reach(&examples, threshold, params);
        let chosen = examples::select(examples, set, reach, params);
        verifier::learn(&chosen, set, self.metric, threshold, reach, params)
    }
}

/// Parts the samples into those that teach and those that hardly move: of spread below
/// [`TrainParams::quiet_share`] of the median of their class, or of all samples where a class has fewer than three.
/// A sample that hardly moves is near everything, whatever it is called.
fn moving(
    samples: Vec<TrainSample>,
    metric: &Metric,
    params: &TrainParams,
) -> (Vec<TrainSample>, Vec<TrainSample>) {
    let spread = |s: &TrainSample| mean_and_spread(&metric.apply_all(&s.rows), metric.dim()).1;
    let spreads: Vec<f32> = samples.iter().map(spread).collect();
    if samples.is_empty() {
        return (samples, Vec::new());
    }
    let mut by_class = BTreeMap::<ClassId, Vec<f32>>::new();
    for (sample, spread) in samples.iter().zip(&spreads) {
        by_class.entry(sample.class).or_default().push(*spread);
    }
    let median = |some: &mut Vec<f32>| {
        some.sort_by(f32::total_cmp);
        some[some.len() / 2]
    };
    let all = median(&mut spreads.clone());
    let usual = by_class.iter_mut().map(|(class, spreads)| {
        let of_class = median(spreads);
        let usual = match spreads.len() < 3 {
            true => all.min(of_class),
            false => of_class,
        };
        (*class, usual)
    });
    let usual: BTreeMap<ClassId, f32> = usual.collect();
    let is_quiet = |i: usize| {
        let usual = usual[&samples[i].class];
        f64::from(spreads[i]) < params.quiet_share * f64::from(usual)
    };
    let quiet: Vec<bool> = (0..samples.len()).map(is_quiet).collect();
    let (mut teach, mut aside) = (Vec::new(), Vec::new());
    for (sample, quiet) in samples.into_iter().zip(quiet) {
        if quiet { &mut aside } else { &mut teach }.push(sample);
    }
    (teach, aside)
}

/// At most `most` samples of each class, from its groups in turn, in the order of the set.
fn templates_of(samples: Vec<TrainSample>, classes: usize, most: usize) -> Vec<TrainSample> {
    let mut kept = BTreeSet::new();
    for class in 0..classes {
        let mut by_group: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (i, sample) in samples
            .iter()
            .enumerate()
            .filter(|(_, s)| s.class.index() == class)
        {
            by_group.entry(&sample.group).or_default().push(i);
        }
        let longest = by_group.values().map(Vec::len).max().unwrap_or(0);
        let turns =
            (0..longest).flat_map(|turn| by_group.values().filter_map(move |g| g.get(turn)));
        kept.extend(turns.take(most).copied());
    }
    samples
        .into_iter()
        .enumerate()
        .filter(|(i, _)| kept.contains(i))
        .map(|(_, s)| s)
        .collect()
}

/// Arguments of [`Metric::new`] from the samples of a set: `S_w + ρ tr(S_t)/d · I` and `S_t`. With no two samples of any class
/// the metric is the identity. `None` if there is no sample.
pub fn scatters(
    set: &TrainSet,
    params: &TrainParams,
) -> Option<(PackedSymmetric, PackedSymmetric)> {
    let samples = set.samples();
    (!samples.is_empty()).then(|| metric_of(set, &samples, params))
}

fn metric_of(
    set: &TrainSet,
    samples: &[TrainSample],
    params: &TrainParams,
) -> (PackedSymmetric, PackedSymmetric) {
    let dim = samples[0].rows.dim();
    let labelled = set
        .streams
        .iter()
        .filter(|s| !s.is_copy && s.known.iter().any(|k| k.class.is_some()));
    let total = covariance(labelled.map(|s| &s.rows), dim);
    // How a sample differs from a mirrored one is not how people differ.
    let shown: Vec<TrainSample> = samples
        .iter()
        .filter(|s| !set.streams[s.stream].is_copy)
        .cloned()
        .collect();
    let within = within_class(&shown, set.classes.len(), dim, params.max_pairs);
    (
        ridged(&within, &total, params.rho),
        PackedSymmetric::pack(&total),
    )
}

fn class_infos(set: &TrainSet, samples: &[TrainSample]) -> Vec<ClassInfo> {
    let shown = |s: &&TrainSample| !set.streams[s.stream].is_copy;
    let of = |class: usize| {
        let shown = samples.iter().filter(shown);
        shown.filter(move |s| s.class.index() == class)
    };
    let named = set.classes.iter().enumerate();
    named
        .map(|(class, name)| ClassInfo {
            name: name.clone(),
            samples: of(class).count(),
            people: of(class)
                .filter_map(|s| set.streams[s.stream].person.as_deref())
                .collect::<BTreeSet<_>>()
                .len(),
        })
        .collect()
}
