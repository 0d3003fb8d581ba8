//! Distance thresholds: for all classes together, and for each by itself.

use crate::decode::FAR;

use super::mining::TemplateDistances;
use super::params::TrainParams;
use super::set::{StreamKind, TrainSample, TrainSet, TrainStream, overlap_share};

/// A match belongs to what it shares more than this part of the shorter with.
const TOUCHES: f64 = 0.3;

/// A share of the smallest distance that background motion has to any template, and what set it.
///
/// Clips that the user calls background count in full. Of made everyday motion a tenth may come nearer: some of it
/// may happen to be one of the classes, and what comes that near becomes a hard negative.
pub fn global_threshold(
    set: &TrainSet,
    distances: &[TemplateDistances],
    params: &TrainParams,
) -> (f32, String) {
    let of = |source: StreamKind, share: f64| {
        let streams = set
            .streams
            .iter()
            .zip(distances)
            .filter(|(s, _)| s.source == source);
        let mut nearest: Vec<(f32, &str)> = streams
            .map(|(s, d)| (d.smallest(), s.name.as_str()))
            .collect();
        nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
        nearest
            .get((share * nearest.len() as f64) as usize)
            .copied()
    };
    let clips = of(StreamKind::Background, 0.0);
    let everyday = of(StreamKind::Everyday, params.everyday_may_pass);
    let nearest = clips
        .into_iter()
        .chain(everyday)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    match nearest {
        Some((distance, name)) if distance < FAR / 2.0 => (
            params.background_share as f32 * distance,
            format!("background clip {name}"),
        ),
        _ => (
            params.fallback_threshold as f32,
            "no background: a general value".to_owned(),
        ),
    }
}

/// Each class's own threshold: a share of the smallest distance that motion which is not the class has to its
/// templates, between the common threshold and [`TrainParams::class_range`] times it.
///
/// The class that background comes nearest to sets the common threshold, and others suffer for it: a kick is five
/// times as far from everything else as a step is. Background and everyday motion count as for the common
/// threshold, samples of other classes in full. Unlabelled stretches do not: what comes near there is a negative,
/// or a sample that nobody labelled. Empty where there is neither background nor everyday motion to measure by.
/// O(ticks · templates).
pub fn of_classes(
    set: &TrainSet,
    samples: &[TrainSample],
    distances: &[TemplateDistances],
    threshold: f32,
    params: &TrainParams,
) -> Vec<f32> {
    if set.streams.iter().all(|s| s.source == StreamKind::Labelled) {
        return Vec::new();
    }
    let streams = || set.streams.iter().zip(distances);
    let of_class = |class: usize| {
        let counts = |template: usize| samples[template].class.index() == class;
        let background = |source: StreamKind, share: f64| {
            let of = streams().filter(|(s, _)| s.source == source);
            let mut nearest: Vec<f32> = of.map(|(_, d)| nearest_anywhere(d, &counts)).collect();
            nearest.sort_by(f32::total_cmp);
            nearest
                .get((share * nearest.len() as f64) as usize)
                .copied()
                .unwrap_or(FAR)
        };
        let others = streams().filter(|(s, _)| s.source == StreamKind::Labelled);
        let others = others
            .map(|(s, d)| nearest_on_others(s, d, class, &counts))
            .fold(FAR, f32::min);
        let everyday = background(StreamKind::Everyday, params.everyday_may_pass);
        let nearest = background(StreamKind::Background, 0.0)
            .min(everyday)
            .min(others);
        let most = params.class_range as f32 * threshold;
        (params.class_share as f32 * nearest)
            .min(most)
            .max(threshold)
    };
    (0..set.classes.len()).map(of_class).collect()
}

fn nearest_anywhere(distances: &TemplateDistances, counts: &impl Fn(usize) -> bool) -> f32 {
    (0..distances.len())
        .map(|t| distances.nearest(t, counts).distance)
        .fold(FAR, f32::min)
}

/// The smallest distance of a match that lies on a sample of another class, and on none of this or of unknown class.
fn nearest_on_others(
    stream: &TrainStream,
    distances: &TemplateDistances,
    class: usize,
    counts: &impl Fn(usize) -> bool,
) -> f32 {
    let mut nearest = FAR;
    for t in 0..distances.len() {
        let found = distances.nearest(t, counts);
        if found.distance >= nearest {
            continue;
        }
        let ticks = t - found.age.min(t)..t + 1;
        let mut touched = stream
            .known
            .iter()
            .filter(|k| overlap_share(&ticks, &k.ticks) > TOUCHES)
            .peekable();
        let on_others = touched.peek().is_some()
            && touched.all(|k| k.class.is_some_and(|c| c.index() != class));
        if on_others {
            nearest = found.distance;
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classes::ClassId;
    use crate::decode::DecodeParams;
    use crate::features::Rows;
    use crate::templates::Matcher;
    use crate::train::LabelledSpan;

    fn stream(
        name: &str,
        source: StreamKind,
        values: Vec<f32>,
        known: Vec<LabelledSpan>,
    ) -> TrainStream {
        let rows = Rows::from_values(1, values);
        let (group, rest_is_background) = (name.to_owned(), true);
        TrainStream {
            name: name.into(),
            group,
            person: None,
            source,
            rest_is_background,
            is_copy: false,
            rows,
            known,
        }
    }

    /// Classes at 0, 10 and 12 for four ticks each, too far apart for a match to lie on two of them, and background that
    /// stays at `background`.
    fn trained(background: Option<f32>) -> Vec<f32> {
        let samples = [0.0, 10.0, 12.0];
        let values = samples
            .iter()
            .flat_map(|v| [vec![5.0; 8], vec![*v; 4]].concat())
            .collect();
        let known = (0..3).map(|c| {
            let start = 8 + 12 * usize::from(c);
            LabelledSpan {
                ticks: start..start + 4,
                class: Some(ClassId(c)),
            }
        });
        let mut set = TrainSet {
            classes: vec!["a".into(), "b".into(), "c".into()],
            ..TrainSet::default()
        };
        set.streams.push(stream(
            "labelled",
            StreamKind::Labelled,
            values,
            known.collect(),
        ));
        let background =
            background.map(|v| stream("b", StreamKind::Background, vec![v; 8], vec![]));
        set.streams.extend(background);
        let samples = set.samples();
        let mut bank = Matcher::new(
            &samples.iter().map(|s| s.rows.clone()).collect::<Vec<_>>(),
            1,
            &DecodeParams::reference(),
        );
        let distances: Vec<_> = set
            .streams
            .iter()
            .map(|s| TemplateDistances::of(std::slice::from_mut(&mut bank), &s.rows))
            .collect();
        let params = TrainParams {
            class_share: 0.5,
            class_range: 3.0,
            ..TrainParams::default()
        };
        of_classes(&set, &samples, &distances, 1.0, &params)
    }

    #[test]
    fn a_class_far_from_everything_else_may_reach_farther() {
        // Background is 2² from a; b and c are 2² from each other; neither falls below the common threshold.
        assert_eq!(trained(Some(-2.0)), [2.0, 2.0, 2.0]);
        assert_eq!(trained(Some(-1.0)), [1.0, 2.0, 2.0]);
        assert_eq!(
            trained(Some(-30.0)),
            [3.0, 2.0, 2.0],
            "never above its range"
        );
    }

    #[test]
    fn without_background_there_is_nothing_to_measure_by() {
        assert!(trained(None).is_empty());
    }
}
