//! Classes whose samples are as near to another class as to their own: where two are about as near, neither is reported.

use std::ops::Range;

use crate::classes::ClassId;
use crate::decode::DecodeParams;
use crate::templates::MatchGate;

use super::mining::Offer;
use super::params::TrainParams;
use super::set::{TrainSample, TrainSet, overlap_share};

/// A class much of whose samples another class matches as well as its own other samples do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AlikeClasses {
    /// The class.
    pub class: ClassId,
    /// The other.
    pub other: ClassId,
    /// Samples of the class that the other matches.
    pub samples: usize,
    /// Samples of the class.
    pub of: usize,
}

/// The nearest that each class comes to a sample where a rival would end, without the sample's own template.
#[derive(Debug, Clone)]
pub struct SampleRivals {
    class: ClassId,
    ticks: Range<usize>,
    /// Ticks at which a rival's match ends.
    ends: Range<usize>,
    nearest: Vec<f32>,
}

impl SampleRivals {
    /// Nothing near any of the samples of the stream at `place`, but for copies: nobody showed them. Rivals from `farthest` on are not
    /// asked for.
    pub fn of_stream(
        set: &TrainSet,
        samples: &[TrainSample],
        place: usize,
        (params, farthest): (&DecodeParams, f32),
    ) -> Vec<Self> {
        let stream = &set.streams[place];
        let is_original = |s: &&TrainSample| s.stream == place && !s.is_faster && !stream.is_copy;
        let rivals = |sample: &TrainSample| {
            let (around, last) = (params.rival_ticks, sample.ticks.end - 1);
            let mut nearest = vec![farthest; set.classes.len()];
            nearest[sample.class.index()] = f32::INFINITY;
            Self {
                class: sample.class,
                ticks: sample.ticks.clone(),
                ends: last.saturating_sub(around)..(last + around + 1).min(stream.rows.len()),
                nearest,
            }
        };
        samples.iter().filter(is_original).map(rivals).collect()
    }

    /// Ticks whose matches it asks for.
    pub fn ends(&self) -> Range<usize> {
        self.ends.clone()
    }

    /// Takes a match of `template` in the sample's stream, which is at `place`.
    pub fn take(
        &mut self,
        offer: &Offer<'_>,
        (template, place): (&TrainSample, usize),
        gate: MatchGate,
        params: &DecodeParams,
    ) {
        if !self.ends.contains(&offer.tick) {
            return;
        }
        let is_itself = template.stream == place && template.ticks == self.ticks;
        let covers = overlap_share(&offer.ticks(), &self.ticks);
        if is_itself || covers <= f64::from(params.rival_overlap) {
            return;
        }
        let nearest = &mut self.nearest[template.class.index()];
        if let Some(nearer) = offer.nearer(*nearest, gate) {
            *nearest = nearer.distance;
        }
    }
}

/// Pairs of which the other class matches at least half of the samples, as [`DecodeParams::rival_share`] has it; each
/// pair once, with the class of which it matches the larger part first. `samples` are those of all streams; what is farther than
/// `threshold` is not reported anyway. O(samples · classes + classes²).
pub fn alike_classes<'r>(
    set: &TrainSet,
    samples: impl Iterator<Item = &'r SampleRivals>,
    threshold: f32,
    params: &TrainParams,
) -> Vec<AlikeClasses> {
    let classes = set.classes.len();
    let (mut matched, mut shown) = (vec![0; classes * classes], vec![0; classes]);
    for SampleRivals { class, nearest, .. } in samples {
        let class = class.index();
        shown[class] += 1;
        let near = threshold.min(nearest[class] * params.decode.rival_share);
        for other in (0..classes).filter(|other| *other != class) {
            matched[class * classes + other] += usize::from(nearest[other] < near);
        }
    }
    let pair = |class: usize, other: usize| AlikeClasses {
        class: ClassId(class as u16),
        other: ClassId(other as u16),
        samples: matched[class * classes + other],
        of: shown[class],
    };
    let pairs = (0..classes).flat_map(|a| (a + 1..classes).map(move |b| (a, b)));
    pairs
        .map(|(a, b)| {
            let (one, two) = (pair(a, b), pair(b, a));
            match one.samples * two.of >= two.samples * one.of {
                true => one,
                false => two,
            }
        })
        .filter(|pair| pair.samples > 0 && 2 * pair.samples >= pair.of)
        .collect()
}
