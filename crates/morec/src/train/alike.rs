//! Finds classes whose samples are as near to another class as to their own; motions near to both would not be reported.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::classes::ClassId;
use crate::decode::{DecodeParams, FAR};
use crate::templates::{MatchGate, Matcher};

use super::comparison::TrainingContext;
use super::error::TrainError;
use super::mining::Offer;
use super::set::{TrainSample, TrainStream, overlap_share};

/// A class much of whose samples another class matches as well as its own other samples do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AlikeClasses {
    /// The class whose samples are matched.
    pub class: ClassId,
    /// The class that matches them.
    pub other: ClassId,
    /// Samples of the class that the other matches.
    pub samples: usize,
    /// Samples of the class.
    pub of: usize,
}

/// The nearest that each class comes to a sample where a rival would end, without the sample's own template.
#[derive(Debug, Clone)]
struct SampleRivals {
    class: ClassId,
    ticks: Range<usize>,
    /// Ticks at which a rival's match ends.
    ends: Range<usize>,
    /// For each class.
    nearest: Vec<f32>,
    /// Distances of the templates of its own class, whatever the gate; 0 of itself.
    own: Vec<f32>,
}

impl SampleRivals {
    /// Nothing near, and nothing from `farthest` on asked for, but of the sample's own class.
    fn new(
        context: &TrainingContext<'_>,
        (sample, class): (&TrainSample, &ClassTemplates),
        samples: &[TrainSample],
        farthest: f32,
    ) -> Self {
        let (around, last) = (context.params.decode.rival_ticks, sample.ticks.end - 1);
        let ticks = context.set.streams[sample.stream].rows.len();
        let mut nearest = vec![farthest; context.set.classes.len()];
        nearest[sample.class.index()] = f32::INFINITY;
        let is_itself = |t: &TrainSample| t.stream == sample.stream && t.ticks == sample.ticks;
        let own = class
            .places
            .iter()
            .map(|place| match is_itself(&samples[*place]) {
                true => 0.0,
                false => FAR,
            });
        Self {
            class: sample.class,
            ticks: sample.ticks.clone(),
            ends: last.saturating_sub(around)..(last + around + 1).min(ticks),
            nearest,
            own: own.collect(),
        }
    }

    /// Distance below which another class keeps the sample from being reported.
    fn near_enough(&self, threshold: f32, params: &DecodeParams) -> f32 {
        threshold.min(self.nearest[self.class.index()] * params.rival_share)
    }

    /// True if a match in the sample's stream would be a rival of it.
    fn is_met_by(&self, offer: &Offer<'_>, params: &DecodeParams) -> bool {
        let covers = overlap_share(&offer.ticks(), &self.ticks);
        self.ends.contains(&offer.tick) && covers > f64::from(params.rival_overlap)
    }

    /// Takes a match of a template of `class`.
    fn take(&mut self, offer: &Offer<'_>, class: ClassId, gate: MatchGate) {
        let nearest = &mut self.nearest[class.index()];
        if let Some(nearer) = offer.nearer(*nearest, gate) {
            *nearest = nearer.distance;
        }
    }

    /// Takes a match of the template at `place` of its own class.
    fn take_own(&mut self, offer: &Offer<'_>, place: usize, gate: MatchGate) {
        if self.own[place] == 0.0 {
            return;
        }
        self.take(offer, self.class, gate);
        if let Some(nearer) = offer.nearer(self.own[place], MatchGate::plain(0.0)) {
            self.own[place] = nearer.distance;
        }
    }
}

/// A template is its class's medoid if the samples of the class are nearest to it. Other templates of a class are compared with a sample
/// if the medoid is nearer than this many times the threshold.
const MEDOID_REACH: f32 = 2.5;

struct ClassTemplates {
    /// Among all samples.
    places: Vec<usize>,
    matcher: Matcher,
}

/// Templates of some classes, laid out, with their classes and their places among the class's templates.
fn parts_of(
    classes: &[ClassTemplates],
    some: &BTreeSet<usize>,
) -> (Vec<Matcher>, Vec<(ClassId, usize)>) {
    let matchers = some.iter().map(|class| classes[*class].matcher.clone());
    let templates = some.iter().flat_map(|class| {
        let places = 0..classes[*class].places.len();
        places.map(|place| (ClassId(*class as u16), place))
    });
    (matchers.collect(), templates.collect())
}

impl TrainingContext<'_> {
    /// Pairs of classes of which the other matches at least half of the samples, as [`DecodeParams::rival_share`] has it; each
    /// pair once, with the class of which it matches the larger part first. What is farther than `threshold` is not reported anyway.
    ///
    /// A sample meets the templates of its own class, then the [medoids](MEDOID_REACH) of the others, then all templates of those whose
    /// medoid is near: O(samples · (classes + near classes · templates of a class)) matches.
    pub fn alike(
        &self,
        samples: &[TrainSample],
        gate: MatchGate,
        threshold: f32,
    ) -> Result<Vec<AlikeClasses>, TrainError> {
        let count = self.set.classes.len();
        let mapped = self.mapped(samples.iter().map(|s| &s.rows));
        let mut places = vec![Vec::new(); count];
        for (place, sample) in samples.iter().enumerate() {
            places[sample.class.index()].push(place);
        }
        let classes = places.into_iter().map(|places| ClassTemplates {
            matcher: self.matcher(&mapped, &places),
            places,
        });
        let classes: Vec<ClassTemplates> = classes.collect();
        let stage = "comparing samples of a class";
        let own = self.each_stream(&[], stage, |_, place, stream| {
            self.own_classes((samples, &classes), (place, stream), gate, threshold)
        })?;
        let medoids = medoids(&classes, &own);
        let parts = self.parts(&mapped, &medoids);
        let medoids: Vec<ClassId> = medoids.iter().map(|m| samples[*m].class).collect();
        let stage = "comparing classes";
        let rivals = self.each_stream(&parts, stage, |parts, place, stream| {
            let mut rivals = own[place].clone();
            let near = self.near_classes((parts, &medoids), stream, &rivals, threshold);
            let (mut parts, templates) = parts_of(&classes, &near);
            self.meet(
                &mut parts,
                stream,
                (&mut rivals, threshold),
                |rival, offer| {
                    let (class, _) = templates[offer.template];
                    if class != rival.class {
                        rival.take(offer, class, gate);
                    }
                },
            );
            rivals
        })?;
        Ok(pairs(count, &rivals, threshold, &self.params.decode))
    }

    /// The samples of a stream, except copies, beside other templates of their classes.
    fn own_classes(
        &self,
        (samples, classes): (&[TrainSample], &[ClassTemplates]),
        (place, stream): (usize, &TrainStream),
        gate: MatchGate,
        threshold: f32,
    ) -> Vec<SampleRivals> {
        let is_shown = |s: &&TrainSample| s.stream == place && !s.is_faster && !stream.is_copy;
        let shown = samples.iter().filter(is_shown).map(|sample| {
            let class = &classes[sample.class.index()];
            SampleRivals::new(self, (sample, class), samples, threshold)
        });
        let mut rivals: Vec<SampleRivals> = shown.collect();
        let shown = rivals.iter().map(|rival| rival.class.index()).collect();
        let (mut parts, templates) = parts_of(classes, &shown);
        self.meet(&mut parts, stream, (&mut rivals, FAR), |rival, offer| {
            let (class, place) = templates[offer.template];
            if class == rival.class {
                rival.take_own(offer, place, gate);
            }
        });
        rivals
    }

    /// Classes whose medoid, of those in `parts`, is near to one of the samples of a stream that are of other classes.
    fn near_classes(
        &self,
        (parts, medoids): (&mut [Matcher], &[ClassId]),
        stream: &TrainStream,
        rivals: &[SampleRivals],
        threshold: f32,
    ) -> BTreeSet<usize> {
        let decode = &self.params.decode;
        let all = MatchGate::plain(0.0);
        let mut near = BTreeSet::new();
        let mut rivals = rivals.to_vec();
        let reach = MEDOID_REACH * threshold;
        self.meet(parts, stream, (&mut rivals, reach), |rival, offer| {
            let class = medoids[offer.template];
            let reach = MEDOID_REACH * rival.near_enough(threshold, decode);
            let is_new = class != rival.class && !near.contains(&class.index());
            if is_new && offer.nearer(reach, all).is_some() {
                near.insert(class.index());
            }
        });
        near
    }

    /// Gives `take` the matches nearer than `reach` that would be rivals of `rivals`, samples of `stream`.
    fn meet(
        &self,
        parts: &mut [Matcher],
        stream: &TrainStream,
        (rivals, reach): (&mut [SampleRivals], f32),
        mut take: impl FnMut(&mut SampleRivals, &Offer<'_>),
    ) {
        let mut wanted = vec![false; stream.rows.len()];
        for rival in rivals.iter() {
            wanted[rival.ends.clone()].fill(true);
        }
        self.matches(parts, stream, (&wanted, reach), |offer| {
            for rival in rivals.iter_mut() {
                if rival.is_met_by(offer, &self.params.decode) {
                    take(rival, offer);
                }
            }
        });
    }
}

/// The medoid of each class that has templates, among all samples.
fn medoids(classes: &[ClassTemplates], rivals: &[Vec<SampleRivals>]) -> Vec<usize> {
    let mut sums: Vec<Vec<f64>> = classes.iter().map(|c| vec![0.0; c.places.len()]).collect();
    for rival in rivals.iter().flatten() {
        let sums = &mut sums[rival.class.index()];
        let own = rival.own.iter().copied().map(f64::from);
        sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
    }
    let nearest = |(class, sums): (&ClassTemplates, &Vec<f64>)| {
        let templates = class.places.iter().copied().zip(sums);
        Some(templates.min_by(|a, b| a.1.total_cmp(b.1))?.0)
    };
    classes.iter().zip(&sums).filter_map(nearest).collect()
}

/// Pairs of `classes` classes by the samples of all streams. O(samples · classes + classes²).
fn pairs(
    classes: usize,
    rivals: &[Vec<SampleRivals>],
    threshold: f32,
    params: &DecodeParams,
) -> Vec<AlikeClasses> {
    let (mut matched, mut shown) = (vec![0; classes * classes], vec![0; classes]);
    for rival in rivals.iter().flatten() {
        let class = rival.class.index();
        shown[class] += 1;
        let near = rival.near_enough(threshold, params);
        for other in (0..classes).filter(|other| *other != class) {
            matched[class * classes + other] += usize::from(rival.nearest[other] < near);
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
