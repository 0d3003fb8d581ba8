//! The label of a class that is nearest to a stretch.

use std::collections::BTreeMap;

use morec::cluster::{resampled, squared_distance};
use morec::features::{BoneSet, FeatureParams, RowLayout, Rows};
use morec::train::align as warp;
use morec_db::labels::{SampleFilter, SampleState};
use morec_db::{ClipId, DbError, MotionDb};

use super::progress::JobProgress;
use crate::stretch::Stretch;
use morec_ops::Unlearned;

/// Rows that a stretch of any length becomes where it is compared at an even pace.
const POINTS: usize = 16;
/// Number of labels, the nearest at an even pace, that are compared along the warping path.
const WARPED: usize = 24;

/// The accepted label of `class` that is nearest to `of` along the warping path, by the directions of the bones that both
/// show; labels that overlap `of`, or are among `but`, are left out. `None` if there is none, or nothing to compare.
pub fn label_of(
    db: &mut MotionDb,
    of: &Stretch,
    class: &str,
    but: &Unlearned,
    progress: &JobProgress,
) -> Result<Option<Stretch>, DbError> {
    let params = FeatureParams::default();
    let samples = db.samples(&SampleFilter {
        class: Some(class.to_owned()),
        state: Some(SampleState::Accepted),
        ..SampleFilter::default()
    })?;
    let taught = samples
        .iter()
        .filter(|s| !but.holds(&s.clip_name, s.span()));
    let stretches = taught.map(Stretch::from);
    let others: Vec<Stretch> = stretches.filter(|s| !overlap(s, of)).collect();
    let clip_rows = db.rows(&params, progress)?;
    let rows: BTreeMap<ClipId, (&Rows, BoneSet)> = clip_rows
        .iter()
        .map(|r| (r.clip, (&r.rows, r.bones)))
        .collect();
    let Some((own, bones)) = rows.get(&of.clip).map(|r| (cut(r.0, of, &params), r.1)) else {
        return Ok(None);
    };
    let pair = |other: &Stretch| {
        let (all, theirs) = *rows.get(&other.clip)?;
        let common = bones.and(theirs);
        let directions: Vec<usize> = (0..3 * common.len()).collect();
        let of_bones = |rows: &Rows, bones| {
            rows.columns(&RowLayout::kept_columns(bones, common))
                .columns(&directions)
        };
        let other = of_bones(&cut(all, other, &params), theirs);
        let own = of_bones(&own, bones);
        let is_some = !own.is_empty() && !other.is_empty() && !directions.is_empty();
        is_some.then_some((own, other))
    };
    let mut near: Vec<(f64, Stretch)> = others
        .into_iter()
        .filter_map(|other| pair(&other).map(|(a, b)| (at_even_pace(&a, &b), other)))
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.truncate(WARPED);
    let warped = near.into_iter().filter_map(|(_, other)| {
        let (a, b) = pair(&other)?;
        Some((along_the_path(&a, &b), other))
    });
    let nearest = warped.min_by(|a, b| a.0.total_cmp(&b.0));
    Ok(nearest.map(|(_, stretch)| stretch))
}

fn overlap(a: &Stretch, b: &Stretch) -> bool {
    a.clip == b.clip && a.span.overlaps(b.span)
}

fn cut(rows: &Rows, stretch: &Stretch, params: &FeatureParams) -> Rows {
    rows.slice((stretch.span).frames_among(rows.len(), params.tick_hz()))
}

/// Mean squared distance a row and bone, both brought to one length.
fn at_even_pace(a: &Rows, b: &Rows) -> f64 {
    let distance = squared_distance(&resampled(a, POINTS), &resampled(b, POINTS), POINTS);
    distance / a.dim() as f64
}

/// Mean squared distance a pair of rows of the warping path and bone.
fn along_the_path(a: &Rows, b: &Rows) -> f64 {
    let path = warp(a, b);
    let cost = |&(i, j): &(usize, usize)| squared_distance(a.row(i), b.row(j), 1);
    let sum: f64 = path.iter().map(cost).sum();
    sum / (path.len().max(1) * a.dim()) as f64
}
