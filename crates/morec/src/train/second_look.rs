//! Trains the second look: segments, their metric, and the bound of its score.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::classes::ClassId;
use crate::features::{BoneSet, Rows};
use crate::math::portable;
use crate::progress::Progress;
use crate::rng::Rng;
use crate::templates::second_look::{
    BodyTrack, Comparison, SEGMENT_ROWS, SecondLook, grown_of, sample_span, segment_of,
};
use crate::templates::{
    ALARM_RATES, OperatingPoint, PackedSymmetric, PerformerKind, TemplateEngine, TemplateModel,
    TemplateModelError,
};

use super::error::TrainError;
use super::everyday::is_built_in;
use super::operating::CAP_EXPONENT;
use super::params::TrainParams;
use super::scatter::{covariance, ridged, within_class};
use super::set::{StreamKind, TrainSample, TrainSet, evenly, overlap};

/// Matches farther than this are no candidates, in normalised distances.
const REACH: f32 = 5.0;
/// From this many classes on the classes are each other's scale, and no atlas is needed.
const CLASSES_OF_SCALE: usize = 6;
/// The bound is this, and half of the score that background motion exceeds at the rate of false alarms that is asked for.
const BOUND: f32 = 0.35;
const BACKGROUND_SHARE: f32 = 0.5;
/// Bounds lie between these.
const LEAST_BOUND: f32 = 0.45;
const MOST_BOUND: f32 = 0.90;
/// The bound of fewer classes: what is reported wrongly there is mostly motion like the classes, which background does not show.
const BOUND_OF_FEW: f32 = 0.60;
/// Taught motions are parts of a flow if the median share of a short growth that lies within its label is below this.
const FLOW_SHARE: f32 = 0.75;
/// Stretches of the atlas, their durations in seconds, and the pace that they have at least.
const ATLAS: usize = 200;
const ATLAS_SECS: [f64; 7] = [0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0];
const ATLAS_PACE: f32 = 0.15;
/// Samples that are judged among the others at most.
const MOST_JUDGED: usize = 200;

/// True if the taught motions begin and end where their pace falls. Where they are parts of a flow, as signals or steps that follow each
/// other without rest, growing a match to the motion around it reaches into its neighbours: matches decide there.
pub fn are_apart(
    set: &TrainSet,
    samples: &[TrainSample],
    bones: BoneSet,
    params: &TrainParams,
) -> bool {
    let tracks = Tracks::new(set, bones, params);
    let mut shares = tracks.each(samples, |track, sample| {
        let grown = &grown_of(track, &sample.ticks)[0];
        overlap(grown, &sample.ticks) as f32 / grown.len().max(1) as f32
    });
    shares.sort_by(f32::total_cmp);
    shares
        .get(shares.len() / 2)
        .is_some_and(|share| *share >= FLOW_SHARE)
}

/// A taught sample judged among the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnSample {
    /// Number of the class.
    pub class: ClassId,
    /// The class that it would be named.
    pub named: ClassId,
    /// The score that it would have.
    pub score: f32,
}

/// What [`learn`] gives.
pub struct LearnedLook {
    /// Its bound is that of few classes until [`set_bound`].
    pub look: SecondLook,
    /// Samples judged among the others.
    pub own: Vec<OwnSample>,
    /// The segments of the samples within their labels: places in the second look.
    pub segments: Vec<usize>,
    /// Compares with it.
    pub comparison: Comparison,
}

/// Learns from the segments of `samples`, of a body. `None` where there is nothing to scale the score by.
pub fn learn(
    set: &TrainSet,
    samples: &[TrainSample],
    bones: BoneSet,
    params: &TrainParams,
    progress: &dyn Progress,
) -> Option<LearnedLook> {
    if samples.is_empty() {
        return None;
    }
    let tracks = Tracks::new(set, bones, params);
    let segments = tracks.of_samples(samples);
    let dim = tracks.columns.len();
    let first: Vec<TrainSample> = segments
        .iter()
        .map(|(sample, rows)| TrainSample {
            rows: rows[0].clone(),
            ..(*sample).clone()
        })
        .collect();
    let within = within_class(&first, set.classes.len(), dim, params.max_pairs);
    let total = covariance(first.iter().map(|s| &s.rows), dim);
    drop(first);
    let of_segments = segments.iter().enumerate();
    let places = of_segments.flat_map(|(place, (_, rows))| rows.iter().map(move |_| place));
    let places: Vec<usize> = places.collect();
    // Of many samples a second copy of the rows would be much.
    let mut values = Vec::with_capacity(places.len() * SEGMENT_ROWS * dim);
    for rows in segments.into_iter().flat_map(|(_, rows)| rows) {
        values.extend(rows.into_values());
    }
    let mut distinct: Vec<ClassId> = samples.iter().map(|s| s.class).collect();
    distinct.sort_unstable();
    distinct.dedup();
    let mut look = SecondLook {
        classes: places.iter().map(|place| samples[*place].class).collect(),
        segments: Rows::from_values(dim, values),
        atlas: match distinct.len() < CLASSES_OF_SCALE {
            true => tracks.atlas(),
            false => Rows::new(dim),
        },
        ridged: ridged(&within, &total, params.rho),
        total: PackedSymmetric::pack(&total),
        scale: 0.0,
        bound: BOUND_OF_FEW,
        operating: Vec::new(),
        reach: REACH,
        own_score: 0.0,
        performer: PerformerKind::Auto,
        step: None,
    };
    if params.compact {
        look = look.compacted();
    }
    let mut comparison = Comparison::new(&look);
    look.scale = look.scale_by(&mut comparison);
    let comparison = comparison.with_scale(look.scale);
    if look.scale <= 0.0 && look.atlas.is_empty() {
        return None;
    }
    let segments: Vec<usize> = (0..places.len())
        .filter(|k| *k == 0 || places[*k] != places[*k - 1])
        .collect();
    let own = among_others((&look, &comparison), &places, &segments, progress);
    let mut scores: Vec<f32> = own.iter().map(|s| s.score).collect();
    scores.sort_by(f32::total_cmp);
    look.own_score = scores.get(scores.len() / 2).copied().unwrap_or(0.0);
    Some(LearnedLook {
        look,
        own,
        segments,
        comparison,
    })
}

/// The first segment of each sample judged among those of the others; `places` are the segments' samples, `firsts` the first of each.
/// O(samples² · rows · band · d).
fn among_others(
    (look, comparison): (&SecondLook, &Comparison),
    places: &[usize],
    firsts: &[usize],
    progress: &dyn Progress,
) -> Vec<OwnSample> {
    let chosen: Vec<usize> = evenly(firsts, MOST_JUDGED).copied().collect();
    let done = AtomicUsize::new(0);
    let judge = |comparison: &mut Comparison, segment: &usize| {
        let others = |k: usize| places[k] != places[*segment];
        let judged = comparison.judge_among(look.segment(*segment), others)?;
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        progress.report("comparing samples", done, chosen.len());
        Some(OwnSample {
            class: look.classes[*segment],
            named: judged.class,
            score: judged.score,
        })
    };
    let judged = chosen.par_iter().map_init(|| comparison.clone(), judge);
    judged.flatten_iter().collect()
}

/// Rows of the second look over the streams of a set.
struct Tracks<'a> {
    set: &'a TrainSet,
    bones: BoneSet,
    params: &'a TrainParams,
    columns: Vec<usize>,
}

impl<'a> Tracks<'a> {
    fn new(set: &'a TrainSet, bones: BoneSet, params: &'a TrainParams) -> Self {
        Self {
            set,
            bones,
            params,
            columns: BodyTrack::columns(bones),
        }
    }

    fn of_rows(&self, rows: &Rows) -> BodyTrack {
        let mut track = BodyTrack::new(self.bones, &self.params.features, rows.len());
        rows.iter().for_each(|row| track.push(row));
        track
    }

    /// What `of_sample` makes of each sample and the track of its stream, in the order of the samples.
    fn each<T: Send>(
        &self,
        samples: &[TrainSample],
        of_sample: impl Fn(&BodyTrack, &TrainSample) -> T + Sync,
    ) -> Vec<T> {
        let mut by_stream = BTreeMap::<usize, Vec<(usize, &TrainSample)>>::new();
        for (place, sample) in samples.iter().enumerate() {
            let of_stream = by_stream.entry(sample.stream).or_default();
            of_stream.push((place, sample));
        }
        let of_stream = |(stream, samples): (&usize, &Vec<(usize, &TrainSample)>)| {
            let track = self.of_rows(&self.set.streams[*stream].rows);
            let made = samples.iter();
            let made = made.map(|(place, sample)| (*place, of_sample(&track, sample)));
            made.collect::<Vec<_>>()
        };
        let mut made: Vec<(usize, T)> = by_stream.par_iter().flat_map_iter(of_stream).collect();
        made.sort_by_key(|(place, _)| *place);
        made.into_iter().map(|(_, made)| made).collect()
    }

    /// The segments of each sample: the motion within its label, and its growths, as a stream's are judged.
    fn of_samples<'s>(&self, samples: &'s [TrainSample]) -> Vec<(&'s TrainSample, Vec<Rows>)> {
        let segments = self.each(samples, |track, sample| {
            let pace: Vec<f32> = sample.ticks.clone().map(|t| track.pace(t as i64)).collect();
            let (span, start) = (sample_span(&pace), sample.ticks.start);
            let [short, long] = grown_of(track, &sample.ticks);
            let mut spans = vec![start + span.start..start + span.end, short, long];
            spans.dedup();
            let rows = spans.into_iter();
            rows.map(|ticks| segment_of(track, ticks, &self.columns))
                .collect()
        });
        samples.iter().zip(segments).collect()
    }

    /// Segments of everyday motion, drawn evenly from all that move; of what people really did.
    fn atlas(&self) -> Rows {
        let hz = self.params.features.tick_hz();
        let everyday = self.set.everyday.par_iter();
        let real = everyday.filter(|stream| is_built_in(&stream.name));
        let tracks: Vec<BodyTrack> = real.map(|stream| self.of_rows(&stream.rows)).collect();
        let mut stretches = Vec::new();
        for (place, track) in tracks.iter().enumerate() {
            for secs in ATLAS_SECS {
                let ticks = (secs * hz).round() as i64;
                let starts = (0..).map(|k| k * ticks / 4);
                for start in starts.take_while(|start| start + ticks <= track.ticks()) {
                    let pace = (start..start + ticks).map(|t| track.pace(t)).sum::<f32>();
                    if pace > ATLAS_PACE * ticks as f32 {
                        stretches.push((place, start as usize..(start + ticks) as usize));
                    }
                }
            }
        }
        Rng::new(1).shuffle(&mut stretches);
        stretches.truncate(ATLAS);
        let rows = stretches
            .into_iter()
            .map(|(place, ticks)| segment_of(&tracks[place], ticks, &self.columns));
        Rows::from_values(
            self.columns.len(),
            rows.flat_map(Rows::into_values).collect(),
        )
    }
}

/// False alarms of background motion that did not set the bound.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct HeldOutAlarms {
    /// A minute, at the bound that the other half of the background sets.
    pub per_minute: f64,
    /// Minutes of background.
    pub minutes: f64,
}

/// Sets the bound of the model's second look by the scores that background motion reaches. Gives the rate of false alarms of each half of the
/// background at the bound that the other half sets; nothing without a second look or background.
///
/// # Errors
/// As [`TemplateModel::check`], or `progress` cancels.
pub fn set_bound(
    model: &mut TemplateModel,
    set: &TrainSet,
    params: &TrainParams,
    progress: &dyn Progress,
) -> Result<Option<HeldOutAlarms>, TrainError> {
    let Some(look) = &model.look else {
        return Ok(None);
    };
    let is_few = !look.atlas.is_empty();
    let halves = BackgroundScores::of_halves(model, set, params, progress)?;
    let asked = params.alarms_per_minute;
    let background = BackgroundScores::of_all(&halves);
    let bound = |rate: f64| background.bound(rate, asked, is_few);
    let alarms = |set_by: usize, counted: usize| {
        let bound = halves[set_by].bound(asked, asked, is_few);
        halves[counted]
            .scores
            .partition_point(|score| *score > bound)
    };
    let held_out = (background.minutes > 0.0).then(|| HeldOutAlarms {
        per_minute: (alarms(0, 1) + alarms(1, 0)) as f64 / background.minutes,
        minutes: background.minutes,
    });
    let operating = ALARM_RATES.map(|alarms_per_minute| OperatingPoint {
        alarms_per_minute,
        threshold: bound(alarms_per_minute),
    });
    if let Some(look) = &mut model.look {
        look.bound = bound(asked);
        look.operating = operating.to_vec();
    }
    Ok(held_out)
}

/// How much lower the score may be at `rate` than at the rate that was asked for, where background motion comes near the classes too seldom to
/// say: the largest distance grows as that of [matches](CAP_EXPONENT) does.
fn wider(rate: f64, asked: f64) -> f32 {
    match rate > 0.0 && asked > 0.0 {
        true => (CAP_EXPONENT * portable::ln(rate / asked)) as f32,
        false => 0.0,
    }
}

/// An engine whose margins, over a bound of 0 and for anyone, are the scores of the second look of `model`, which stays as it was: it may be
/// too large for a copy.
fn engine_of_scores(model: &mut TemplateModel) -> Result<TemplateEngine, TemplateModelError> {
    let aside = (
        model.calibration.take(),
        model.held.take(),
        model.activities.take(),
    );
    let open = |look: &mut SecondLook| {
        let bound = std::mem::take(&mut look.bound);
        let performer = std::mem::replace(&mut look.performer, PerformerKind::Anyone);
        (bound, performer)
    };
    let closed = model.look.as_mut().map(open);
    let engine = TemplateEngine::new(model);
    (model.calibration, model.held, model.activities) = aside;
    if let (Some(look), Some(closed)) = (&mut model.look, closed) {
        (look.bound, look.performer) = closed;
    }
    engine
}

/// Scores of what a model reports in background motion, whatever its bound, largest first.
struct BackgroundScores {
    scores: Vec<f32>,
    minutes: f64,
}

impl BackgroundScores {
    /// Of every other stream, and of those between them.
    fn of_halves(
        model: &mut TemplateModel,
        set: &TrainSet,
        params: &TrainParams,
        progress: &dyn Progress,
    ) -> Result<[Self; 2], TrainError> {
        let streams = set.streams.iter();
        let background = streams.filter(|s| s.source != StreamKind::Labelled);
        let background = background.chain(&set.everyday);
        let background: Vec<&Rows> = background.map(|s| &s.rows).collect();
        let engine = engine_of_scores(model)?;
        let done = AtomicUsize::new(0);
        let scores = |rows: &&Rows| {
            if progress.cancelled() {
                return Err(TrainError::Cancelled);
            }
            let mut scores: Vec<f32> = Vec::new();
            engine.clone().detect(rows, |found| {
                scores.push(-(portable::ln(1.0 - found.score) as f32));
            });
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress.report("judging background", done, background.len());
            Ok(scores)
        };
        let of_stream: Vec<Vec<f32>> = background
            .par_iter()
            .map(scores)
            .collect::<Result<_, TrainError>>()?;
        let hz = params.features.tick_hz();
        Ok([0, 1].map(|half| {
            let mut scores: Vec<f32> = of_stream
                .iter()
                .skip(half)
                .step_by(2)
                .flatten()
                .copied()
                .collect();
            scores.sort_by(|a, b| b.total_cmp(a));
            let ticks: usize = background
                .iter()
                .skip(half)
                .step_by(2)
                .map(|rows| rows.len())
                .sum();
            Self {
                scores,
                minutes: ticks as f64 / hz / 60.0,
            }
        }))
    }

    /// Of both halves.
    fn of_all(halves: &[Self; 2]) -> Self {
        let mut scores: Vec<f32> = halves
            .iter()
            .flat_map(|half| &half.scores)
            .copied()
            .collect();
        scores.sort_by(|a, b| b.total_cmp(a));
        Self {
            scores,
            minutes: halves.iter().map(|half| half.minutes).sum(),
        }
    }

    /// The bound for `rate` false alarms a minute, where `asked` is what training was asked for.
    fn bound(&self, rate: f64, asked: f64, is_few: bool) -> f32 {
        let exceeded = self.exceeded(rate);
        let bound = match is_few {
            true => {
                let step = BACKGROUND_SHARE * (exceeded - self.exceeded(asked));
                BOUND_OF_FEW + step - wider(rate, asked)
            }
            false => BOUND + BACKGROUND_SHARE * exceeded,
        };
        bound.clamp(LEAST_BOUND, MOST_BOUND)
    }

    /// The score that is exceeded `rate` times a minute; 0 if none is.
    fn exceeded(&self, rate: f64) -> f32 {
        let allowed = (rate * self.minutes) as usize;
        self.scores.get(allowed).copied().unwrap_or(0.0)
    }
}
