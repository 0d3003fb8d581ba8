//! Decides which classes are held poses, and computes these poses.

use std::collections::BTreeSet;

use crate::classes::ClassId;
use crate::features::{BoneSet, FeatureParams, Profile, RowLayout, Rows};
use crate::templates::{HeldPoses, PackedSymmetric, ReferenceRows, distance_from};

use super::params::TrainParams;
use super::scatter::{covariance, ridged, within_groups};
use super::set::{StreamKind, TrainSample, TrainSet, evenly};

/// Bones of a hand that is held move slower than this together, weighted and a second; those of a gesture ten times as fast.
const STILL: f32 = 1.0;
/// A hand that is held travels slower than this, in its lengths a second.
const STAYS: f32 = 0.5;
/// A pose is held for at least this long, in seconds, and need not be held longer than the second.
const LEAST_SECS: [f64; 2] = [0.4, 1.0];
/// Poses of a sample, from where it has been reached.
const POSES_OF_SAMPLE: usize = 5;
/// Poses of anything else at most.
const MOST_OTHERS: usize = 2000;
/// Fewer poses of anything else tell nothing apart.
const LEAST_OTHERS: usize = 50;
/// Distances are allowed to be this much larger than nine in ten between samples of a class.
const REACH: f32 = 1.5;
/// Ridge of the metric, as a share of the mean variance.
const RIDGE: f64 = 0.1;

/// The held classes of `samples`, which describe hands; `None` of other rows, and where there is no such class or nothing to tell it
/// from. O(samples² + ticks).
pub(super) fn learn(
    set: &TrainSet,
    samples: &[TrainSample],
    bones: BoneSet,
    params: &TrainParams,
) -> Option<HeldPoses> {
    if !matches!(Profile::of(bones), Profile::Hand | Profile::Hands) {
        return None;
    }
    let layout = RowLayout::of(bones);
    let held = held_classes(set, samples, layout, &params.features);
    let of_held: Vec<&TrainSample> = samples.iter().filter(|s| held.contains(&s.class)).collect();
    let others = others(set, samples, &held, layout);
    if of_held.is_empty() || others.len() < LEAST_OTHERS {
        return None;
    }
    let (mut poses, mut classes, mut sample_of) = (Rows::new(others.dim()), Vec::new(), Vec::new());
    for (number, sample) in of_held.iter().enumerate() {
        for row in kept_ticks(sample.rows.len()) {
            poses.push(&sample.rows.row(row)[layout.directions()]);
            classes.push(sample.class);
            sample_of.push(number);
        }
    }
    let total = covariance([&poses, &others].into_iter(), others.dim());
    let ridged = ridged(&within_groups(&poses, &classes), &total, RIDGE);
    let total = PackedSymmetric::pack(&total);
    let poses = ReferenceRows {
        rows: poses,
        classes,
        others,
        ridged,
        total,
    };
    let mapped = poses.metric().apply_all(&poses.rows);
    Some(HeldPoses {
        reach: REACH * usual_distance(&mapped, &poses.classes, &sample_of),
        least_ticks: least_ticks(&of_held, &params.features),
        poses,
    })
}

/// Classes most of whose samples stand still most of the time.
fn held_classes(
    set: &TrainSet,
    samples: &[TrainSample],
    layout: RowLayout,
    features: &FeatureParams,
) -> BTreeSet<ClassId> {
    let least = (LEAST_SECS[0] * features.tick_hz()) as usize;
    let is_held = |sample: &TrainSample| {
        let norm = |values: &[f32]| values.iter().map(|v| v * v).sum::<f32>().sqrt();
        let is_still = |row: &&[f32]| {
            let bones = norm(&row[layout.velocities()]) / features.velocity_weight.max(1e-6) as f32;
            // The last value of the root is its turning.
            let travel = &row[layout.root()][..RowLayout::ROOT - 1];
            let root = norm(travel) / features.root_weight.max(1e-6) as f32;
            bones < STILL && root < STAYS
        };
        let still = sample.rows.iter().filter(is_still).count();
        sample.rows.len() >= least && 2 * still > sample.rows.len()
    };
    let class = |number: usize| ClassId(number as u16);
    let held = (0..set.classes.len()).map(class).filter(|class| {
        let of_class = || samples.iter().filter(|s| s.class == *class);
        2 * of_class().filter(|s| is_held(s)).count() > of_class().count()
    });
    held.collect()
}

/// Evenly spaced ticks of a sample of `len`, once the pose is reached and before it is left.
fn kept_ticks(len: usize) -> impl Iterator<Item = usize> {
    let (first, last) = (len as f64 * 0.25, len as f64 * 0.9);
    let step = (last - first) / (POSES_OF_SAMPLE - 1) as f64;
    (0..POSES_OF_SAMPLE).map(move |i| ((first + step * i as f64) as usize).min(len - 1))
}

/// Poses of background, of unlabelled parts and of samples of other classes.
fn others(
    set: &TrainSet,
    samples: &[TrainSample],
    held: &BTreeSet<ClassId>,
    layout: RowLayout,
) -> Rows {
    let background = set.background(1).filter(|(_, stream)| {
        // Made motion is a body's.
        stream.source != StreamKind::Everyday
    });
    let parts = background.map(|(ticks, stream)| stream.rows.slice(ticks));
    let of_others = samples.iter().filter(|s| !held.contains(&s.class));
    let found: Vec<Rows> = parts.chain(of_others.map(|s| s.rows.clone())).collect();
    let found: Vec<&[f32]> = found.iter().flat_map(Rows::iter).collect();
    let mut rows = Rows::new(layout.directions().len());
    for row in evenly(&found, MOST_OTHERS) {
        rows.push(&row[layout.directions()]);
    }
    rows
}

/// Nine in ten poses are nearer to those of other samples of their class; unbounded where no class has two samples.
fn usual_distance(mapped: &Rows, classes: &[ClassId], sample_of: &[usize]) -> f32 {
    let mut distances: Vec<f32> = (0..mapped.len())
        .map(|i| {
            let counts = |j: usize| classes[j] == classes[i] && sample_of[j] != sample_of[i];
            distance_from(mapped.row(i), mapped, counts)
        })
        .filter(|distance| distance.is_finite())
        .collect();
    distances.sort_by(f32::total_cmp);
    let at = distances.len() * 9 / 10;
    distances
        .get(at)
        .copied()
        .unwrap_or(f32::MAX / 4.0)
        .max(1e-3)
}

/// Half as long as nearly all samples are.
fn least_ticks(samples: &[&TrainSample], features: &FeatureParams) -> usize {
    let mut lengths: Vec<usize> = samples.iter().map(|s| s.rows.len()).collect();
    lengths.sort_unstable();
    let short = lengths[lengths.len() / 10] as f64 / 2.0;
    let [least, most] = LEAST_SECS.map(|secs| secs * features.tick_hz());
    short.clamp(least, most) as usize
}
