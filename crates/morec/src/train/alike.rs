//! Classes whose samples are as near to another class as to their own: where two are about as near, neither is reported.

use crate::classes::ClassId;

use super::mining::TemplateDistances;
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

/// Pairs of which the other class matches at least half of the samples, as [`DecodeParams::rival_share`] has it; each
/// pair once, with the class of which it matches the larger part first. `distances` are those of every stream of `set` from
/// every template of `samples`; what is farther than `threshold` is not reported anyway. A sample is not compared with itself.
/// O(samples · templates).
///
/// [`DecodeParams::rival_share`]: crate::decode::DecodeParams::rival_share
pub fn alike_classes(
    set: &TrainSet,
    samples: &[TrainSample],
    distances: &[TemplateDistances],
    threshold: f32,
    params: &TrainParams,
) -> Vec<AlikeClasses> {
    let classes = set.classes.len();
    let (mut matched, mut shown) = (vec![0; classes * classes], vec![0; classes]);
    let is_original = |s: &&TrainSample| !s.is_faster && !set.streams[s.stream].is_copy;
    let originals = samples.iter().filter(is_original);
    for sample in originals {
        let of_class =
            nearest_by_class(sample, samples, &distances[sample.stream], classes, params);
        let class = sample.class.index();
        shown[class] += 1;
        let near = threshold.min(of_class[class] * params.decode.rival_share);
        for other in (0..classes).filter(|other| *other != class) {
            matched[class * classes + other] += usize::from(of_class[other] < near);
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

/// The nearest that each class comes to a sample where a rival would end, without the sample's own template.
fn nearest_by_class(
    sample: &TrainSample,
    templates: &[TrainSample],
    distances: &TemplateDistances,
    classes: usize,
    params: &TrainParams,
) -> Vec<f32> {
    let around = params.decode.rival_ticks;
    let last = sample.ticks.end - 1;
    let ends = last.saturating_sub(around)..(last + around + 1).min(distances.len());
    let mut nearest = vec![f32::INFINITY; classes];
    for end in ends {
        for (found, template) in distances.at(end).zip(templates) {
            let is_itself = template.stream == sample.stream && template.ticks == sample.ticks;
            let ticks = end - found.age.min(end)..end + 1;
            let covers = overlap_share(&ticks, &sample.ticks);
            if !is_itself && covers > f64::from(params.decode.rival_overlap) {
                let nearest = &mut nearest[template.class.index()];
                *nearest = nearest.min(found.distance);
            }
        }
    }
    nearest
}
