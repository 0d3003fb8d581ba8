//! Decides which classes are activities, and computes the windows that describe them.

use std::collections::{BTreeMap, BTreeSet};

use crate::classes::ClassId;
use crate::features::{BoneSet, Profile, RowLayout, Rows};
use crate::segment::{CycleParams, cycles};
use crate::templates::{
    Activities, Metric, PackedSymmetric, ReferenceRows, STEP_TICKS, TemplateSample, snapped,
    squared_distance, steps, windows_of,
};

use super::kind::{ClassKind, ClassLabels};
use super::params::TrainParams;
use super::scatter::{covariance, means_of_groups, ridged, within_groups};
use super::set::{StreamKind, TrainSample, TrainSet, TrainStream, evenly};

/// Length of a window, seconds; 2 to 3 are alike.
const WINDOW_SECS: f64 = 2.5;
/// Windows of anything else at most, of made everyday motion and of all other sources each.
const MOST_OTHERS: usize = 500;
/// Fewer windows of anything else describe motion of no class badly.
const LEAST_OTHERS: usize = 50;
/// Repetitions of a class that are kept at most; and as many mirrored ones.
const MOST_REPETITIONS: usize = 4;
/// Unlabelled windows nearer to a class than this share of the class's own windows probably show the class.
const OWN_SHARE: f64 = 0.9;

/// The activities of `samples`; `None` where there is none, and nothing to tell them from. O(windows · statistics²).
pub(super) fn learn(
    set: &TrainSet,
    samples: &[TrainSample],
    bones: BoneSet,
    params: &TrainParams,
) -> Option<Activities> {
    if !params.activities || Profile::of(bones) != Profile::Body {
        return None;
    }
    let layout = RowLayout::of(bones);
    let classes = activity_classes(set, samples, params);
    if classes.is_empty() {
        return None;
    }
    let window_ticks = (WINDOW_SECS * params.features.tick_hz()).round() as usize | 1;
    let windows = |rows: &Rows| windows_of(rows, layout, window_ticks);
    let dim = Activities::statistics(layout);
    // The mean of a motion and its mirror image would be neither.
    let (mut shown, mut groups) = (Rows::new(dim), Vec::new());
    for sample in samples.iter().filter(|s| classes.contains(&s.class)) {
        for window in windows(&sample.rows).iter() {
            shown.push(window);
            groups.push((sample.class, set.streams[sample.stream].is_copy));
        }
    }
    let total = covariance(std::iter::once(&shown), dim);
    let ridged = ridged(&within_groups(&shown, &groups), &total, params.rho);
    let total = PackedSymmetric::pack(&total);
    let metric = Metric::new(&ridged, &total);
    let means = means_of_groups(&shown, &groups);
    let own = OwnWindows::new(&metric, &means, &shown, &groups);
    let others = others(set, samples, &classes, windows, &own);
    let (repetitions, step) = repetitions(set, samples, &classes, params);
    (others.len() >= LEAST_OTHERS).then(|| Activities {
        windows: ReferenceRows {
            rows: Rows::from_values(dim, means.values().flatten().copied().collect()),
            classes: means.keys().map(|(class, _)| *class).collect(),
            others,
            ridged,
            total,
        },
        window_ticks,
        share: 1.0,
        repetitions,
        step,
    })
}

/// The repetition in the middle of each sample, of some samples of each class and of as many mirrored ones; and the steps of their values.
fn repetitions(
    set: &TrainSet,
    samples: &[TrainSample],
    classes: &BTreeSet<ClassId>,
    params: &TrainParams,
) -> (Vec<TemplateSample>, Vec<f32>) {
    let tick_hz = params.features.tick_hz();
    let mut of_class: BTreeMap<(ClassId, bool), Vec<Rows>> = BTreeMap::new();
    for sample in samples.iter().filter(|s| classes.contains(&s.class)) {
        let ticks = sample.rows.len();
        let found = cycles(&sample.rows, tick_hz, &CycleParams::default());
        let period = found.map_or(0, |c| (c.period_secs * tick_hz).round() as usize);
        if (1..=ticks).contains(&period) {
            let first = (ticks - period) / 2;
            let group = (sample.class, set.streams[sample.stream].is_copy);
            let one = sample.rows.slice(first..first + period);
            of_class.entry(group).or_default().push(one);
        }
    }
    let kept =
        || (of_class.iter()).flat_map(|(of, all)| evenly(all, MOST_REPETITIONS).map(|r| (of.0, r)));
    let dim = samples.first().map_or(0, |sample| sample.rows.dim());
    let step = steps(kept().map(|(_, rows)| rows), dim);
    let sample = |(class, rows): (ClassId, &Rows)| TemplateSample {
        class,
        rows: snapped(rows.clone(), &step),
    };
    (kept().map(sample).collect(), step)
}

/// Classes that go on, by what is said of them or else by their samples.
fn activity_classes(
    set: &TrainSet,
    samples: &[TrainSample],
    params: &TrainParams,
) -> BTreeSet<ClassId> {
    let labels = labels_of(&set.streams, params.features.tick_hz());
    let goes_on = |class: &ClassId| {
        let labels = labels.get(&Some(*class)).copied().unwrap_or_default();
        params.kind(&set.classes[class.index()], &labels) == ClassKind::Activity
    };
    let taught: BTreeSet<ClassId> = samples.iter().map(|s| s.class).collect();
    taught.into_iter().filter(goes_on).collect()
}

/// The labels of each class in streams that somebody performed; of what is known to be none of the classes under `None`.
pub(super) fn labels_of(
    streams: &[TrainStream],
    tick_hz: f64,
) -> BTreeMap<Option<ClassId>, ClassLabels> {
    let secs = |ticks: usize| ticks as f64 / tick_hz;
    let performed = streams.iter().filter(|stream| !stream.is_copy);
    ClassLabels::of_clips(performed.map(|stream| {
        let known = stream.known.iter();
        let labels = known.map(|k| (k.class, secs(k.ticks.start)..secs(k.ticks.end)));
        (secs(stream.rows.len()), labels.collect())
    }))
}

/// How near the windows of each group are to its mean.
struct OwnWindows<'a> {
    metric: &'a Metric,
    /// Mapped means, and the squared distance within which most of the group's windows are.
    reaches: Vec<(Vec<f32>, f32)>,
}

impl<'a> OwnWindows<'a> {
    fn new<G: Ord + Copy>(
        metric: &'a Metric,
        means: &BTreeMap<G, Vec<f32>>,
        shown: &Rows,
        groups: &[G],
    ) -> Self {
        let mapped = metric.apply_all(shown);
        let reach = |(group, mean): (&G, &Vec<f32>)| {
            let mut at = vec![0.0; metric.dim()];
            metric.apply(mean, &mut at);
            let of_group = mapped.iter().zip(groups).filter(|(_, g)| *g == group);
            let mut distances: Vec<f32> = of_group
                .map(|(window, _)| squared_distance(window, &at))
                .collect();
            distances.sort_by(f32::total_cmp);
            let most = (distances.len() as f64 * OWN_SHARE) as usize;
            let reach = distances[most.min(distances.len() - 1)];
            (at, reach)
        };
        Self {
            metric,
            reaches: means.iter().map(reach).collect(),
        }
    }

    fn includes(&self, window: &[f32]) -> bool {
        let mut mapped = vec![0.0; self.metric.dim()];
        self.metric.apply(window, &mut mapped);
        let near = |(mean, reach): &(Vec<f32>, f32)| squared_distance(&mapped, mean) < *reach;
        self.reaches.iter().any(near)
    }
}

/// Windows of background, of unlabelled parts and of samples of other classes.
fn others(
    set: &TrainSet,
    samples: &[TrainSample],
    activities: &BTreeSet<ClassId>,
    windows: impl Fn(&Rows) -> Rows,
    own: &OwnWindows<'_>,
) -> Rows {
    let (mut real, mut made) = (Vec::new(), Vec::new());
    for (ticks, stream) in set.background(STEP_TICKS) {
        let named = stream.source == StreamKind::Background;
        let into = match stream.source {
            StreamKind::Everyday => &mut made,
            _ => &mut real,
        };
        let found = windows(&stream.rows.slice(ticks));
        let found = found.iter().filter(|window| named || !own.includes(window));
        into.extend(found.map(<[f32]>::to_vec));
    }
    for sample in samples.iter().filter(|s| !activities.contains(&s.class)) {
        real.extend(windows(&sample.rows).iter().map(<[f32]>::to_vec));
    }
    let kept = evenly(&real, MOST_OTHERS).chain(evenly(&made, MOST_OTHERS));
    Rows::from_values(own.metric.dim(), kept.flatten().copied().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::train::{LabelledSpan, TrainStream};

    const TICK_SECS: f64 = 1.0 / 30.0;

    fn layout() -> RowLayout {
        RowLayout::of(BoneSet::BODY)
    }

    /// One bone swings, at any pace; another points the way of the motion.
    fn swing(secs: f64, hz: f64, way: f32) -> Rows {
        let mut rows = Rows::new(layout().dim());
        for tick in 0..(secs / TICK_SECS) as usize {
            let mut row = vec![0.0; layout().dim()];
            row[0] = (std::f64::consts::TAU * hz * tick as f64 * TICK_SECS).sin() as f32;
            row[4] = way;
            rows.push(&row);
        }
        rows
    }

    /// One way up and down again.
    fn raise(secs: f64) -> Rows {
        let mut rows = Rows::new(layout().dim());
        let ticks = (secs / TICK_SECS) as usize;
        for tick in 0..ticks {
            let mut row = vec![0.0; layout().dim()];
            row[7] = tick as f32 / ticks as f32;
            rows.push(&row);
        }
        rows
    }

    fn stream(rows: Rows, class: Option<u16>) -> TrainStream {
        let known = class.map(|class| LabelledSpan {
            ticks: 0..rows.len(),
            class: Some(ClassId(class)),
        });
        TrainStream {
            name: String::new(),
            group: String::new(),
            person: None,
            source: match class {
                Some(_) => StreamKind::Labelled,
                None => StreamKind::Background,
            },
            rest_is_background: true,
            is_copy: false,
            known: known.into_iter().collect(),
            rows,
        }
    }

    fn learned(params: &TrainParams) -> Option<Activities> {
        let classes = ["saw", "raise", "pump", "slow raise"];
        let set = TrainSet {
            classes: classes.map(str::to_owned).to_vec(),
            streams: vec![
                stream(swing(6.5, 1.0, 1.0), Some(0)),
                stream(swing(4.5, 1.4, 1.0), Some(0)),
                stream(raise(1.5), Some(1)),
                stream(raise(1.2), Some(1)),
                stream(swing(8.0, 0.8, -1.0), Some(2)),
                stream(raise(5.0), Some(3)),
                stream(swing(30.0, 0.1, 0.0), None),
            ],
            ..TrainSet::default()
        };
        learn(&set, &set.samples(), BoneSet::BODY, params)
    }

    #[test]
    fn what_goes_on_is_an_activity_and_what_was_said_holds() {
        let names = |params: &TrainParams| -> Vec<u16> {
            let found = learned(params);
            found.map_or_else(Vec::new, |a| {
                a.windows.classes.iter().map(|c| c.0).collect()
            })
        };
        let mut params = TrainParams::default();
        assert_eq!(names(&params), [0, 2]);
        params.set_kinds(&["slow raise".to_owned()], &["saw".to_owned()]);
        assert_eq!(names(&params), [2, 3]);
        params.activities = false;
        assert_eq!(names(&params), [] as [u16; 0]);
    }

    #[test]
    fn another_pace_is_the_same_activity_and_other_motion_is_none() {
        let activities = learned(&TrainParams::default()).unwrap();
        let nearest = |rows: &Rows| {
            let shares = activities.shares(layout(), rows);
            shares
                .into_iter()
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .unwrap()
        };
        let (class, share) = nearest(&swing(6.0, 1.2, 0.9));
        assert!(class == ClassId(0) && share < 0.7, "{share}");
        assert!(nearest(&swing(6.0, 0.1, 0.05)).1 > 1.0);
        assert!(nearest(&raise(1.4)).1 > 1.0);
    }
}
