//! Training of the method templates, step by step as in docs/method.md.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use crate::classes::{ClassId, ClassInfo};
use crate::decode::{FAR, TYPICAL_SPREAD};
use crate::features::{BoneSet, Profile, Rows};
use crate::math::portable;
use crate::progress::Progress;
use crate::templates::{
    ALARM_RATES, Calibration, Match, MatchGate, Metric, OperatingPoint, PackedSymmetric,
    PerformerKind, StrangerGate, TemplateModel, TemplateSample, Verifier, mean_and_spread,
};

use super::activities;
use super::alike::AlikeClasses;
use super::comparison::{StreamMatches, TrainingContext};
use super::error::TrainError;
use super::examples::{self, CandidateFinder, NearStream, VerifierExample};
use super::held;
use super::mining::{NearMiss, NearestByGate, TrainGates, hard_negatives, smallest};
use super::operating::{AlarmCurve, CAP_EXPONENT};
use super::params::TrainParams;
use super::refused;
use super::representatives::representatives;
use super::scatter::{covariance, ridged, within_class};
use super::second_look::{self, HeldOutAlarms, LearnedLook, OwnSample};
use super::set::{StreamKind, TrainSample, TrainSet, TrainStream};
use super::thresholds;
use super::trim::motion_span;
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
    let held = held::learn(set, &samples, bones, params);
    let activities = activities::learn(set, &samples, bones, params);
    let has_templates = |sample: &TrainSample| {
        let held = held.as_ref();
        let is_held = held.is_some_and(|held| held.poses.classes.contains(&sample.class));
        let activities = activities.as_ref();
        !is_held && !activities.is_some_and(|a| a.holds(sample.class))
    };
    let goes_on =
        |sample: &&TrainSample| activities.as_ref().is_some_and(|a| a.holds(sample.class));
    let going_on: Vec<TrainSample> = samples.iter().filter(goes_on).cloned().collect();
    let samples = samples.into_iter().filter(has_templates).collect();
    let (samples, quiet) = moving(samples, &metric, params);
    let mut samples = templates_of(samples, set.classes.len(), params.max_templates);
    let params = &of_profile(params, bones, &samples, &metric);
    let step = TrainingContext {
        set,
        metric: &metric,
        params,
        progress,
    };
    let plain = MatchGate::plain(params.decode.rest_gate);
    let verified = verified_gate(&classes, &samples, params);
    let verified = verified.filter(|_| params.verify);
    let verifies = verified.is_some() && verifier::has_background(set, params);
    let judges_whole = params.judge_whole
        && Profile::of(bones) == Profile::Body
        && second_look::are_apart(set, &samples, bones, params);
    // The second look compares activities too; their windows report them.
    let judged = match judges_whole {
        true => [samples.as_slice(), &going_on].concat(),
        false => Vec::new(),
    };
    let learn = || second_look::learn(set, &judged, bones, params);
    let mut learned = (judges_whole && !verifies).then(learn).flatten();
    match &learned {
        // Templates only find candidates, which the second look then compares with all samples.
        Some(learned) => samples = step.representatives(learned, samples),
        None => samples.extend(step.faster_copies(&samples, bones, plain)?),
    }
    // The second look needs no gate of its own for strangers.
    let wide = wide_gate(set, &samples, params).filter(|_| !verifies && !judges_whole);
    let gates = TrainGates { plain, wide };
    let gate_of_verifier = verified.filter(|_| verifies).map(MatchGate::plain);
    let most = step.largest_threshold();
    let farthest = if most > 0.0 { most as f32 } else { FAR };
    let matches = step.templates(&samples, gates, (gate_of_verifier, farthest))?;
    let near: Vec<&NearestByGate> = matches.iter().map(|m| &m.all).collect();
    let near_enough = step.operating(&near, None, |near| &near.plain);
    // The second look refuses background that comes near, so no negatives are needed.
    let negatives = match &learned {
        Some(_) => Vec::new(),
        None => {
            let threshold = near_enough.threshold;
            negatives_of(set, bones, (&samples, &matches), threshold, params)
        }
    };
    let rows: Vec<Rows> = negatives.iter().map(|n| negative_rows(set, n)).collect();
    let all = TrainGates {
        plain: MatchGate::plain(0.0),
        wide: wide.map(|gate| MatchGate {
            rest_share: 0.0,
            ..gate
        }),
    };
    let rule = (verifies, most);
    let near_negatives = step.negatives((&negatives, &rows), &matches, all, rule)?;
    let seen: Vec<&NearestByGate> = near_negatives.iter().collect();
    let stranger = wide.map(|gate| {
        let operating = step.operating(&near, Some(&seen), |near| &near.wide);
        step.stranger_gate(gate, operating)
    });
    let operating = step.operating(&near, Some(&seen), |near| &near.plain);
    let threshold = operating.threshold;
    let mut decode = params.decode.clone();
    let mut verifier = None;
    if let Some(gate) = verified {
        decode.rest_gate_verified = gate;
        if verifies {
            verifier = step.verifier(&matches, &near_negatives, threshold);
        }
    }
    if verifies && verifier.is_none() && judges_whole {
        learned = learn();
    }
    let (look, own) = learned.map_or((None, Vec::new()), |l| (Some(l.look), l.own));
    let alike = match verifier.is_none() && look.is_none() {
        true => step.alike(&samples, plain, threshold)?,
        false => Vec::new(),
    };
    if look.is_some() {
        decode.rest_gate = CANDIDATE_REST_GATE;
    }
    let calibration = match (&verifier, &look) {
        (Some(_), _) => Calibration::VERIFIED,
        (None, Some(_)) => Calibration::OF_LOOKS,
        (None, None) => Calibration::MEASURED,
    };
    let model = TemplateModel {
        features: params.features.clone(),
        bones,
        decode,
        classes,
        samples: samples
            .into_iter()
            .map(|s| TemplateSample {
                class: s.class,
                rows: s.rows,
            })
            .collect(),
        negatives: rows,
        ridged,
        total,
        threshold,
        class_thresholds: Vec::new(),
        operating: operating.points,
        calibration: params.calibrate.then_some(calibration),
        stranger: stranger.filter(|_| verifier.is_none()),
        verifier,
        held,
        look,
        activities,
        step: None,
    };
    let mut model = if params.compact {
        model.compacted()
    } else {
        model
    };
    let held_out = second_look::set_bound(&mut model, set, params)?;
    refused::refuse(&mut model, set, params)?;
    model.check()?;
    Ok(TrainedTemplates {
        model,
        negatives,
        threshold_from: operating.from,
        quiet,
        alike,
        own,
        held_out,
    })
}

/// The wider gate of matches, if so few people teach that a stranger is likely to be unlike them. Who is not named is one person.
fn wide_gate(set: &TrainSet, samples: &[TrainSample], params: &TrainParams) -> Option<MatchGate> {
    let people: BTreeSet<Option<&str>> = samples
        .iter()
        .map(|s| set.streams[s.stream].person.as_deref())
        .collect();
    let few = people.len() < params.verify_people && params.alarms_per_minute > 0.0;
    (few && params.stranger.rest_gate > 0.0).then_some(MatchGate {
        discount: params.stranger.discount,
        rest_share: params.stranger.rest_gate,
    })
}

/// Share of a body's distance at rest below which a match is a candidate of the second look: a body at rest never matches.
const CANDIDATE_REST_GATE: f32 = 0.85;

/// The threshold and its origin.
struct Operating {
    threshold: f32,
    from: String,
    /// For other rates of false alarms.
    points: Vec<OperatingPoint>,
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

    /// Bound of the threshold at a rate of false alarms. It moves with the rate, or it would be all there is where no
    /// background comes near.
    fn most_at(&self, rate: f64) -> f64 {
        let params = self.params;
        params.max_threshold * portable::powf(rate / params.alarms_per_minute, CAP_EXPONENT)
    }

    /// Bound of all thresholds; 0 where none comes from a rate of false alarms.
    fn largest_threshold(&self) -> f64 {
        let usual = self.params.alarms_per_minute;
        if usual <= 0.0 {
            return 0.0;
        }
        let rates = ALARM_RATES.into_iter().chain([usual]);
        rates.map(|rate| self.most_at(rate)).fold(0.0, f64::max)
    }

    /// The threshold under the gate that `of` chooses; `negatives` add what near misses of other people and clips keep out.
    fn operating(
        &self,
        near: &[&NearestByGate],
        negatives: Option<&[&NearestByGate]>,
        of: impl Fn(&NearestByGate) -> &[Match],
    ) -> Operating {
        let params = self.params;
        let near: Vec<&[Match]> = near.iter().map(|near| of(near)).collect();
        if params.alarms_per_minute <= 0.0 {
            let (threshold, from) = thresholds::global_threshold(self.set, &near, params);
            let points = Vec::new();
            return Operating {
                threshold,
                from,
                points,
            };
        }
        let negatives = negatives.map(|near| near.iter().map(|near| of(near)).collect::<Vec<_>>());
        let curve = AlarmCurve::of(self.set, &near, negatives.as_deref(), params);
        let at = |rate: f64| {
            let most = self.most_at(rate);
            let set_by = curve.distance_at(rate);
            set_by
                .filter(|(distance, _)| f64::from(*distance) < most)
                .map_or((most as f32, None), |(distance, stream)| {
                    (distance, Some(stream))
                })
        };
        let (threshold, stream) = at(params.alarms_per_minute);
        let point = |alarms_per_minute: f64| OperatingPoint {
            alarms_per_minute,
            threshold: at(alarms_per_minute).0,
        };
        Operating {
            threshold,
            from: stream.map_or_else(
                || "its upper bound, because no background comes near".to_owned(),
                |stream| format!("background clip {}", self.set.streams[stream].name),
            ),
            points: ALARM_RATES.map(point).to_vec(),
        }
    }

    /// The wider gate, with the thresholds that background motion sets when it is matched as under that gate.
    fn stranger_gate(&self, gate: MatchGate, operating: Operating) -> StrangerGate {
        let params = &self.params.stranger;
        StrangerGate {
            performer: PerformerKind::Auto,
            discount: gate.discount,
            rest_gate: gate.rest_share,
            rival_share: params.rival_share,
            threshold: operating.threshold,
            operating: operating.points,
            open_at: params.open_at,
            close_at: params.close_at,
            calibration: self.params.calibrate.then_some(Calibration::OF_STRANGERS),
        }
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

/// The gate against a body at rest under a verifier, if enough people showed enough samples that a verifier is better
/// than the plain rule. With few samples the gate has to do what the verifier could not learn.
fn verified_gate(
    classes: &[ClassInfo],
    samples: &[TrainSample],
    params: &TrainParams,
) -> Option<f32> {
    let mut counts: Vec<usize> = classes.iter().map(|c| c.samples).collect();
    counts.sort_unstable();
    let people: BTreeSet<&str> = samples.iter().map(|s| s.group.as_str()).collect();
    let median = counts.get(counts.len() / 2).copied().unwrap_or(0);
    let enough = median >= params.verify_samples && people.len() >= params.verify_people;
    enough.then_some(if median >= params.many_samples {
        params.decode.rest_gate_verified
    } else {
        params.rest_gate_few
    })
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

/// Short background clips as a whole, and the nearest misses in everything else that is background.
fn negatives_of(
    set: &TrainSet,
    bones: BoneSet,
    (samples, matches): (&[TrainSample], &[StreamMatches]),
    threshold: f32,
    params: &TrainParams,
) -> Vec<NearMiss> {
    if !params.mine_negatives {
        return Vec::new();
    }
    let longest = samples.iter().map(|s| s.rows.len()).max().unwrap_or(0) as f64;
    let short = |s: &TrainStream| {
        s.source == StreamKind::Background
            && s.rows.len() as f64 <= params.whole_background * longest
    };
    let (whole, long): (Vec<_>, Vec<_>) = set
        .streams
        .iter()
        .enumerate()
        .filter(|(_, s)| s.rest_is_background)
        .partition(|(_, s)| short(s));
    let mut found: Vec<NearMiss> = long
        .into_iter()
        .flat_map(|(i, s)| {
            let near = [&matches[i].all.plain, &matches[i].others].map(Vec::as_slice);
            hard_negatives(near, (i, s), threshold, params)
        })
        .collect();
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    found.truncate(params.max_negatives);
    found.extend(whole.into_iter().map(|(stream, s)| NearMiss {
        distance: smallest(&matches[stream].all.plain),
        stream,
        ticks: motion_span(&s.rows, bones),
    }));
    found
}

/// The rows of a near miss, and at least the eight before its end: a shorter template would match anything.
fn negative_rows(set: &TrainSet, miss: &NearMiss) -> Rows {
    let start = miss.ticks.start.min(miss.ticks.end.saturating_sub(8));
    set.streams[miss.stream].rows.slice(start..miss.ticks.end)
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
