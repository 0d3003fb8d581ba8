//! Stretches that came near a class in training, right or wrong, from which the verifier is learned.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::decode::{FAR, MIN_AGE_TICKS};
use crate::templates::{Evidence, Match, MatchGate};

use super::mining::{NO_MATCH, Offer, keep_nearest, smallest};
use super::params::TrainParams;
use super::set::{StreamKind, TrainSample, TrainSet, TrainStream, overlap_share};

/// Ticks of a long stream that count as one piece: neighbours say the same.
const PIECE_TICKS: usize = 60;
/// Overlap with anything known above which a stretch is not judged by what else it overlaps.
const TOUCHES: f64 = 0.3;

/// A stretch that came near a class.
#[derive(Debug, Clone)]
pub struct VerifierExample {
    /// True if it was the class.
    pub positive: bool,
    /// Index of the class in the set.
    pub class: usize,
    /// Its stream's place in the set.
    pub stream: usize,
    /// Ticks from start to stop, the stop not included.
    pub ticks: Range<usize>,
    /// Its distances.
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

/// The templates of a training, each stream seen by a model without the stream's own person.
pub struct LeaveOneOutView<'a> {
    set: &'a TrainSet,
    samples: &'a [TrainSample],
    /// For each class, whether a single group shows it: then only the very sample is left out.
    single: Vec<bool>,
}

impl<'a> LeaveOneOutView<'a> {
    /// Templates of `samples`, in their order.
    pub fn new(set: &'a TrainSet, samples: &'a [TrainSample]) -> Self {
        let groups = |class: usize| -> BTreeSet<&str> {
            let of_class = samples.iter().filter(|s| s.class.index() == class);
            of_class.map(|s| s.group.as_str()).collect()
        };
        let classes = 0..set.classes.len();
        let single = classes.map(|class| groups(class).len() < 2).collect();
        Self {
            set,
            samples,
            single,
        }
    }

    /// Nothing near at any tick of the stream: for each tick the match of every class.
    pub fn none(&self, stream: usize) -> Vec<Match> {
        vec![NO_MATCH; self.set.streams[stream].rows.len() * self.set.classes.len()]
    }

    /// Keeps a match in `stream` that is the nearest of its class so far.
    pub fn take(&self, near: &mut [Match], offer: &Offer<'_>, stream: usize, gate: MatchGate) {
        let sample = &self.samples[offer.template];
        if self.counts(stream, &offer.ticks(), sample) {
            let class = offer.tick * self.set.classes.len() + sample.class.index();
            keep_nearest(&mut near[class], offer, gate);
        }
    }

    fn counts(&self, stream: usize, ticks: &Range<usize>, sample: &TrainSample) -> bool {
        if !self.single[sample.class.index()] {
            return sample.group != self.set.streams[stream].group;
        }
        sample.stream != stream || overlap_share(ticks, &sample.ticks) <= TOUCHES
    }
}

/// A stream's nearest matches by [`LeaveOneOutView`].
#[derive(Debug, Clone, Copy)]
pub struct NearStream<'a> {
    /// Its place in the set.
    pub stream: usize,
    /// For each tick, the nearest of every class.
    pub classes: &'a [Match],
    /// For each tick, the nearest negative of another group.
    pub negatives: &'a [Match],
}

/// Finds the stretches of all streams that come near a class.
pub struct CandidateFinder<'a> {
    set: &'a TrainSet,
    /// Largest distance under which an unlabelled stretch of a labelled clip is probably an unlabelled sample.
    suspicious: f32,
    /// As the decoder has it.
    peak_ticks: usize,
}

impl<'a> CandidateFinder<'a> {
    /// Candidates within `threshold`.
    pub fn new(set: &'a TrainSet, threshold: f32, params: &TrainParams) -> Self {
        Self {
            set,
            suspicious: params.suspicious_below as f32 * threshold,
            peak_ticks: params.decode.peak_ticks,
        }
    }

    /// Every candidate of one stream. O(ticks · classes).
    pub fn examples(&self, near: NearStream<'_>) -> Vec<VerifierExample> {
        let (ticks, classes) = (near.negatives.len(), self.set.classes.len());
        let mut found = Vec::new();
        // Of every class and of the negatives, the nearest around the tick.
        let mut nearest = vec![FAR; classes];
        for t in 0..ticks {
            let around = t.saturating_sub(self.peak_ticks)..(t + self.peak_ticks + 1).min(ticks);
            nearest.fill(FAR);
            for here in near.classes[around.start * classes..around.end * classes].chunks(classes) {
                let pairs = nearest.iter_mut().zip(here);
                pairs.for_each(|(nearest, m)| *nearest = nearest.min(m.distance));
            }
            let negative = smallest(&near.negatives[around]);
            for class in 0..classes {
                let Match { distance, age } = near.classes[t * classes + class];
                if distance >= FAR || age < MIN_AGE_TICKS || nearest[class] < distance {
                    continue;
                }
                let others = nearest[..class].iter().chain(&nearest[class + 1..]);
                let evidence = Evidence {
                    distance: distance.into(),
                    other: others.fold(FAR, |least, d| least.min(*d)).into(),
                    negative: negative.into(),
                };
                found.extend(self.judged(near.stream, class, t - age.min(t)..t + 1, evidence));
            }
        }
        found
    }

    /// The candidate with what the labels say of it; `None` if they say too little.
    fn judged(
        &self,
        index: usize,
        class: usize,
        ticks: Range<usize>,
        evidence: Evidence,
    ) -> Option<VerifierExample> {
        let stream = &self.set.streams[index];
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

    /// True if a stretch outside the class's samples may be a negative example of it.
    fn is_background(&self, stream: &TrainStream, ticks: &Range<usize>, distance: f32) -> bool {
        let on_other_class = stream.overlaps_known(ticks, TOUCHES);
        let suspicious = stream.source == StreamKind::Labelled && distance < self.suspicious;
        on_other_class || (stream.rest_is_background && !suspicious)
    }
}

/// Largest distance of candidates: twice what nine in ten samples need when their own person is left out, and no less
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
