//! Cutting clips where their behaviour changes, and the curves that say why.

use std::sync::Arc;

use morec::features::FeatureParams;
use morec::pivots::{PivotMap, PivotSet, PoseParams, pose_rows_of_clip};
use morec::progress::Progress;
use morec::segment::{
    CycleParams, KernelParams, MisfitSample, PpcaParams, StillKind, StillParams, cycles,
    kernel_cuts, segment, still_stretches,
};
use morec_db::rows::ClipRows;
use morec_db::{BY_HAND, ClipFilter, ClipId, ClipInfo};
use morec_ops::{CutMethod, CutSettings, OperationError};

use super::progress::{JobError, JobProgress};
use crate::body::ClipMotion;
use crate::store::DbPlace;

/// Result of cutting clips.
#[derive(Debug, Clone)]
pub struct CutSummary {
    pub clips: usize,
    pub segments: usize,
    /// Clips that somebody has cut by hand, which are left as they are.
    pub by_hand: usize,
    /// Clips that could not be cut, with the reason.
    pub left: Vec<(String, String)>,
}

/// Cuts, misfit, stillness and repetitions of one clip, for the timeline.
#[derive(Debug, Clone, Default)]
pub struct Curves {
    pub clip: Option<ClipId>,
    /// Cuts by kernel change points, seconds.
    pub kernel: Vec<f64>,
    /// Cuts by the thesis's method.
    pub ppca: Vec<f64>,
    /// The misfit of the thesis's method, forward and backward.
    pub forward: Vec<MisfitSample>,
    pub backward: Vec<MisfitSample>,
    /// Still stretches; whether each is a T-pose.
    pub still: Vec<(f64, f64, bool)>,
    /// Repetitions between kernel cuts: where each begins and ends.
    pub cycles: Vec<Vec<f64>>,
    /// Reason why a part could not be computed.
    pub note: Option<String>,
}

/// Cuts clips (all, if none are named) and keeps the cuts in place of earlier ones, as one step.
pub fn cut(
    db: &DbPlace,
    method: CutMethod,
    only: &[ClipId],
    progress: &JobProgress,
) -> Result<CutSummary, JobError> {
    cut_all(db, method, only, progress).map_err(|error| JobError::of("Cutting stopped", error))
}

fn cut_all(
    place: &DbPlace,
    method: CutMethod,
    only: &[ClipId],
    progress: &JobProgress,
) -> Result<CutSummary, OperationError> {
    let cutter = CutSettings::from(method).cutter(PivotSet::thesis())?;
    let mut db = place.open()?;
    let methods = db.cut_methods()?;
    let by_hand = |c: &ClipInfo| methods.get(&c.id).is_some_and(|m| m == BY_HAND);
    let (kept, clips): (Vec<ClipInfo>, Vec<ClipInfo>) = db
        .clips(&ClipFilter::default())?
        .into_iter()
        .filter(|c| only.is_empty() || only.contains(&c.id))
        .partition(by_hand);
    let report = db.cut(&clips, &cutter, progress)?;
    Ok(CutSummary {
        clips: report.cuts.len(),
        by_hand: kept.len(),
        segments: report.cuts.iter().map(|c| c.cuts_secs.len() + 1).sum(),
        left: report.left,
    })
}

fn kernel(rows: &ClipRows) -> Result<Vec<f64>, String> {
    let params = FeatureParams::default();
    kernel_cuts(&rows.rows, &params, &KernelParams::default()).map_err(|e| e.to_string())
}

/// Why the tracks of the method of 2009 are empty in a clip of positions.
pub const NO_ROTATIONS: &str =
    "this clip has positions without rotations, which the method of 2009 needs";

type Misfit = (Vec<f64>, Vec<MisfitSample>, Vec<MisfitSample>);

fn ppca(motion: &ClipMotion) -> Result<Misfit, String> {
    let (set, poses) = (PivotSet::thesis(), PoseParams::default());
    let map = PivotMap::of_clip(&set, &motion.clip, &motion.roles).map_err(|e| e.to_string())?;
    let rows = pose_rows_of_clip(&motion.clip, &set, &map, &motion.rest, &poses);
    let found = segment(&rows, poses.rate_hz, &PpcaParams::default()).map_err(|e| e.to_string())?;
    let cuts = found.cuts.iter().map(|cut| cut.secs).collect();
    Ok((cuts, found.forward, found.backward))
}

fn still(rows: &ClipRows) -> Vec<(f64, f64, bool)> {
    let features = FeatureParams::default();
    let tick = 1.0 / features.tick_hz();
    still_stretches(&rows.rows, rows.bones, &features, &StillParams::default())
        .into_iter()
        .map(|(ticks, kind)| {
            let t_pose = kind == StillKind::TPose;
            (ticks.start as f64 * tick, ticks.end as f64 * tick, t_pose)
        })
        .collect()
}

/// Computes what the timeline shows of one clip. Nothing is written.
pub fn curves(motion: &Arc<ClipMotion>, progress: &JobProgress) -> Result<Curves, JobError> {
    let params = FeatureParams::default();
    let bones = morec::features::bones_of_clip(&motion.clip, &motion.roles, &motion.rest);
    let mut curves = Curves {
        clip: Some(motion.id),
        ..Curves::default()
    };
    if bones.is_empty() {
        curves.note = Some("no body part is known, so the clip cannot be cut".to_owned());
        return Ok(curves);
    }
    let rows = ClipRows {
        clip: motion.id,
        bones,
        rows: morec::features::rows_of_clip(
            &motion.clip,
            &motion.roles,
            &motion.rest,
            bones,
            &params,
        ),
    };
    curves.still = still(&rows);
    match kernel(&rows) {
        Ok(cuts) => curves.kernel = cuts,
        Err(why) => curves.note = Some(why),
    }
    curves.cycles = repetitions(&rows, &curves.kernel, motion.secs(), params.tick_hz());
    if progress.cancelled() {
        return Err(JobError::Cancelled);
    }
    if !motion.clip.has_rotations() {
        curves.note = Some(NO_ROTATIONS.to_owned());
        return Ok(curves);
    }
    match ppca(motion) {
        Ok((_, forward, backward)) if forward.is_empty() && backward.is_empty() => {
            curves.note = Some("no misfit curve: this clip is too short for one".to_owned());
        }
        Ok((cuts, forward, backward)) => {
            (curves.ppca, curves.forward, curves.backward) = (cuts, forward, backward);
        }
        Err(why) => curves.note = Some(format!("no misfit curve: {why}")),
    }
    Ok(curves)
}

/// Bounds of the repetitions in segments that repeat at least twice, seconds.
fn repetitions(rows: &ClipRows, cuts: &[f64], end: f64, tick_hz: f64) -> Vec<Vec<f64>> {
    let mut found = Vec::new();
    let mut start = 0.0;
    for stop in cuts.iter().copied().chain([end]) {
        let tick = |secs: f64| ((secs * tick_hz).round() as usize).min(rows.rows.len());
        // A stretch of minutes takes long to correlate, and is no exercise.
        if stop - start < 120.0 && tick(start) < tick(stop) {
            let rows = rows.rows.slice(tick(start)..tick(stop));
            if let Some(c) = cycles(&rows, tick_hz, &CycleParams::default())
                .filter(|c| c.whole() >= 2 && c.correlation > 0.4)
            {
                found.push(c.bounds(stop - start).iter().map(|b| start + b).collect());
            }
        }
        start = stop;
    }
    found
}
