//! Stretches that came near a class in training, and whether they were it: what the verifier learns from.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::decode::{FAR, MIN_AGE_TICKS};
use crate::templates::{Evidence, Match};

use super::mining::{NearMiss, TemplateDistances};
use super::params::TrainParams;
use super::set::{StreamKind, TrainSample, TrainSet, TrainStream, overlap_share};

/// Ticks of a long stream that count as one piece: neighbours say the same.
const PIECE_TICKS: usize = 60;
/// Overlap with anything known above which a stretch is not judged by what else it overlaps.
const TOUCHES: f64 = 0.3;

/// A stretch that came near a class.
#[derive(Debug, Clone)]
pub struct VerifierExample {
    /// Whether it was the class.
    pub positive: bool,
    /// Which class, as its place in the set.
    pub class: usize,
    /// Its stream's place in the set.
    pub stream: usize,
    /// Which ticks.
    pub ticks: Range<usize>,
    /// How near it came.
    pub evidence: Evidence,
    /// The labelled sample it is, by its first tick.
    label: Option<usize>,
}

impl VerifierExample {
    /// The piece of stream it ends in.
    pub fn piece(&self, whole: bool) -> (usize, usize) {
        (
            self.stream,
            if whole {
                0
            } else {
                self.ticks.end / PIECE_TICKS
            },
        )
    }
}

/// What is known of every stream when it is seen as a new person's would be, without the stream's own person.
pub struct LeaveOneOutView<'a> {
    /// All streams.
    pub set: &'a TrainSet,
    /// The templates.
    pub samples: &'a [TrainSample],
    /// The negatives.
    pub negatives: &'a [NearMiss],
    /// Each stream against every negative.
    pub near_negatives: &'a [TemplateDistances],
}

impl LeaveOneOutView<'_> {
    /// Distance of the nearest negative that is not of the stream's own group.
    pub fn nearest_negative(&self, stream: usize, tick: usize) -> f32 {
        let streams = &self.set.streams;
        let strange = |n: usize| streams[self.negatives[n].stream].group != streams[stream].group;
        self.near_negatives[stream].nearest(tick, strange).distance
    }
}

/// Finds the stretches of all streams that come near a class.
pub struct CandidateFinder<'a> {
    seen: &'a LeaveOneOutView<'a>,
    /// Each stream against every template.
    distances: &'a [TemplateDistances],
    /// For each class, whether a single group shows it: then only the very sample is left out.
    single: Vec<bool>,
    /// Largest distance under which an unlabelled stretch of a labelled clip is probably an unlabelled sample.
    suspicious: f32,
    /// As the decoder has it.
    peak_ticks: usize,
}

impl<'a> CandidateFinder<'a> {
    /// Candidates among `distances`, where `threshold` is near enough.
    pub fn new(
        seen: &'a LeaveOneOutView<'a>,
        distances: &'a [TemplateDistances],
        threshold: f32,
        params: &TrainParams,
    ) -> Self {
        let groups = |class: usize| -> BTreeSet<&str> {
            let of_class = seen.samples.iter().filter(|s| s.class.index() == class);
            of_class.map(|s| s.group.as_str()).collect()
        };
        let classes = 0..seen.set.classes.len();
        Self {
            seen,
            distances,
            single: classes.map(|class| groups(class).len() < 2).collect(),
            suspicious: params.suspicious_below as f32 * threshold,
            peak_ticks: params.decode.peak_ticks,
        }
    }

    /// Every candidate of one stream. O(ticks · templates).
    pub fn examples(&self, stream: usize) -> Vec<VerifierExample> {
        let ticks = self.distances[stream].len();
        let classes = self.seen.set.classes.len();
        let near: Vec<Match> = (0..ticks)
            .flat_map(|t| self.nearest_by_class(stream, t))
            .collect();
        let at = |t: usize, class: usize| near[t * classes + class];
        let negative: Vec<f32> = (0..ticks)
            .map(|t| self.seen.nearest_negative(stream, t))
            .collect();
        let mut found = Vec::new();
        for t in 0..ticks {
            let around = t.saturating_sub(self.peak_ticks)..=(t + self.peak_ticks).min(ticks - 1);
            for class in 0..classes {
                let Match { distance, age } = at(t, class);
                let beaten = around.clone().any(|n| at(n, class).distance < distance);
                if distance >= FAR || age < MIN_AGE_TICKS || beaten {
                    continue;
                }
                let rivals = (0..classes).filter(|c| *c != class);
                let other = rivals
                    .flat_map(|c| around.clone().map(move |n| at(n, c).distance))
                    .fold(FAR, f32::min);
                let nearest_negative = around.clone().map(|n| negative[n]).fold(FAR, f32::min);
                let evidence = Evidence {
                    distance: distance.into(),
                    other: other.into(),
                    negative: nearest_negative.into(),
                };
                found.extend(self.judged(stream, class, t - age.min(t)..t + 1, evidence));
            }
        }
        found
    }

    fn nearest_by_class(&self, stream: usize, tick: usize) -> Vec<Match> {
        let mut near = vec![
            Match {
                distance: FAR,
                age: 0
            };
            self.seen.set.classes.len()
        ];
        for (found, sample) in self.distances[stream].at(tick).zip(self.seen.samples) {
            let best = &mut near[sample.class.index()];
            if found.distance < best.distance && self.counts(stream, tick, &found, sample) {
                *best = found;
            }
        }
        near
    }

    fn counts(&self, stream: usize, tick: usize, found: &Match, sample: &TrainSample) -> bool {
        if !self.single[sample.class.index()] {
            return sample.group != self.seen.set.streams[stream].group;
        }
        let ticks = tick - found.age.min(tick)..tick + 1;
        sample.stream != stream || overlap_share(&ticks, &sample.ticks) <= TOUCHES
    }

    /// The candidate with what the labels say of it; `None` if they say too little.
    fn judged(
        &self,
        index: usize,
        class: usize,
        ticks: Range<usize>,
        evidence: Evidence,
    ) -> Option<VerifierExample> {
        let stream = &self.seen.set.streams[index];
        let mut label = None;
        let mut touches = false;
        for known in &stream.known {
            let share = overlap_share(&ticks, &known.ticks);
            match known.class {
                Some(of) if of.index() == class => {
                    touches |= share > 0.0;
                    label = label.or((share > 0.5).then_some(known.ticks.start));
                }
                Some(_) => {}
                None => touches |= share > TOUCHES,
            }
        }
        if label.is_none()
            && (touches || !self.is_background(stream, &ticks, evidence.distance as f32))
        {
            return None;
        }
        Some(VerifierExample {
            positive: label.is_some(),
            class,
            stream: index,
            ticks,
            evidence,
            label,
        })
    }

    /// Whether a stretch that is none of the class's samples may be held against the class.
    fn is_background(&self, stream: &TrainStream, ticks: &Range<usize>, distance: f32) -> bool {
        let on_other_class = stream.overlaps_known(ticks, TOUCHES);
        let suspicious = stream.source == StreamKind::Labelled && distance < self.suspicious;
        on_other_class || (stream.rest_is_background && !suspicious)
    }
}

/// How far candidates may be: twice what nine in ten samples need when their own person is left out, and no less
/// than the plain threshold.
pub fn reach(examples: &[VerifierExample], threshold: f32, params: &TrainParams) -> f32 {
    let mut best: BTreeMap<(usize, usize, usize), f64> = BTreeMap::new();
    for example in examples {
        if let Some(label) = example.label {
            let nearest = best
                .entry((example.class, example.stream, label))
                .or_insert(f64::INFINITY);
            *nearest = nearest.min(example.evidence.distance);
        }
    }
    let mut nearest: Vec<f64> = best.into_values().collect();
    nearest.sort_by(f64::total_cmp);
    let needed = nearest.get((0.9 * nearest.len().saturating_sub(1) as f64).round() as usize);
    needed.map_or(threshold, |d| threshold.max((params.reach * d) as f32))
}

/// The examples worth learning from: of each class and sign the nearest, few from any one piece.
pub fn select(
    examples: Vec<VerifierExample>,
    set: &TrainSet,
    reach: f32,
    params: &TrainParams,
) -> Vec<VerifierExample> {
    let mut chosen = Vec::new();
    for class in 0..set.classes.len() {
        for positive in [true, false] {
            let of = examples
                .iter()
                .filter(|e| e.class == class && e.positive == positive);
            let mut of: Vec<&VerifierExample> = of.collect();
            of.sort_by(|a, b| a.evidence.distance.total_cmp(&b.evidence.distance));
            let spread = few_from_each_piece(of, set, params);
            if positive {
                chosen.extend(spread.into_iter().cloned());
                continue;
            }
            let near = spread
                .iter()
                .filter(|e| e.evidence.distance <= f64::from(reach))
                .count();
            let spread = spread
                .into_iter()
                .take(near.max(params.min_negative_examples));
            let (background, others): (Vec<_>, Vec<_>) =
                spread.partition(|e| set.streams[e.stream].rest_is_background);
            let most = params.max_negative_examples;
            chosen.extend(
                background
                    .into_iter()
                    .take(most)
                    .chain(others.into_iter().take(most))
                    .cloned(),
            );
        }
    }
    chosen
}

fn few_from_each_piece<'e>(
    examples: Vec<&'e VerifierExample>,
    set: &TrainSet,
    params: &TrainParams,
) -> Vec<&'e VerifierExample> {
    let mut taken: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    let whole = |e: &VerifierExample| !set.streams[e.stream].rest_is_background;
    let mut few = |e: &&VerifierExample| {
        let count = taken.entry(e.piece(whole(e))).or_insert(0);
        *count += 1;
        *count <= params.examples_per_piece
    };
    examples.into_iter().filter(|e| few(e)).collect()
}
