//! One performance beside another: which moment of the second belongs to a moment of the first.

use std::path::Path;
use std::sync::Arc;

use morec::TimeSpan;
use morec::features::{FeatureParams, RowLayout, Rows, bones_of_clip, mirrored_rows, rows_of_clip};
use morec::train::align as warp;
use morec_db::{DbError, MotionDb};
use morec_measure::explain::{MotionDeviation, deviation_from};

use super::progress::{JobError, JobProgress};
use super::{nearest, similar};
use crate::body::{Aligned, ClipMotion};
use crate::format;
use crate::stretch::Stretch;
use morec_ops::{OperationError, Unlearned, rebuilt_from};

/// The table of the alignment has this many cells at most; longer stretches are compared at the same pace.
const CELLS: usize = 4_000_000;

/// The stretch that another one is compared with.
#[derive(Debug, Clone, PartialEq)]
pub enum Partner {
    /// This one; its mirror image if true.
    Given(Stretch, bool),
    /// The one most like it in the database.
    Nearest,
    /// The nearest accepted label of a class, but for some.
    NearestOf(String, Unlearned),
}

/// Aligns `of` with another stretch of the database at `path`.
pub fn align(
    path: &Path,
    of: Stretch,
    with: Partner,
    progress: &JobProgress,
) -> Result<Arc<Aligned>, JobError> {
    let none = match &with {
        Partner::NearestOf(class, but) if *but != Unlearned::default() => {
            format!("No other label of {class} was used in training here")
        }
        Partner::NearestOf(class, _) => {
            format!("No other label of {class} to compare with")
        }
        _ => "The database contains nothing similar".to_owned(),
    };
    match aligned(path, of, with, progress) {
        Ok(Some(aligned)) => Ok(Arc::new(aligned)),
        Ok(None) => Err(JobError::Failed(none)),
        Err(error) => Err(JobError::of("Nothing was compared", error)),
    }
}

/// A stretch beside itself, its clip rebuilt from `dims` principal components of its poses (Bucur 2009, Eq. 3.10).
pub fn reduced(path: &Path, of: Stretch, dims: usize) -> Result<Arc<Aligned>, JobError> {
    let failed = |error: OperationError| JobError::of("Nothing was compared", error);
    let db = MotionDb::open(path).map_err(|error| failed(error.into()))?;
    let mut stored = db.clip(of.clip).map_err(|error| failed(error.into()))?;
    let whole = [(&stored.clip, &stored.roles, stored.rest.clone())];
    if let Some(rebuilt) = rebuilt_from(&whole, dims).map_err(failed)?.pop() {
        stored.clip = rebuilt;
    }
    stored.clip.name = format::count(dims, "component");
    let hz = FeatureParams::default().tick_hz();
    let ticks = (of.span.duration_secs() * hz).ceil() as usize + 1;
    Ok(Arc::new(Aligned {
        of,
        with: of,
        mirrored: false,
        motion: Arc::new(ClipMotion::of(of.clip, stored)),
        path: (0..ticks)
            .map(|t| of.span.start_secs + t as f64 / hz)
            .collect(),
        tick_hz: hz,
        deviation: None,
    }))
}

fn aligned(
    path: &Path,
    of: Stretch,
    with: Partner,
    progress: &JobProgress,
) -> Result<Option<Aligned>, DbError> {
    let mut db = MotionDb::open(path)?;
    let (with, mirrored) = match with {
        Partner::Given(stretch, mirrored) => (stretch, mirrored),
        Partner::NearestOf(class, but) => {
            match nearest::label_of(&mut db, &of, &class, &but, progress)? {
                Some(stretch) => (stretch, false),
                None => return Ok(None),
            }
        }
        Partner::Nearest => {
            let hits = similar::hits(&mut db, &of, true, 1, progress)?;
            let Some(hit) = hits.into_iter().flatten().next() else {
                return Ok(None);
            };
            let stretch = Stretch::from(&hit);
            (stretch, hit.mirrored)
        }
    };
    let first = ClipMotion::of(of.clip, db.clip(of.clip)?);
    let motion = Arc::new(ClipMotion::of(with.clip, db.clip(with.clip)?));
    let params = FeatureParams::default();
    let (path, deviation) = path_of((&first, &of), (&motion, &with), mirrored, &params);
    Ok(Some(Aligned {
        of,
        with,
        mirrored,
        motion,
        path,
        tick_hz: params.tick_hz(),
        deviation,
    }))
}

/// For every tick of the first stretch, the moment of the second; and how far the first is off.
fn path_of(
    (first, of): (&ClipMotion, &Stretch),
    (second, with): (&ClipMotion, &Stretch),
    mirrored: bool,
    params: &FeatureParams,
) -> (Vec<f64>, Option<MotionDeviation>) {
    let (of, with) = (of.span, with.span);
    let hz = params.tick_hz();
    let bones = |m: &ClipMotion| bones_of_clip(&m.clip, &m.roles, &m.rest);
    let common = bones(first).and(bones(second));
    // Velocities say how fast, and alignment is to forgive just that.
    let directions: Vec<usize> = RowLayout::of(common).directions().collect();
    let cut = |motion: &ClipMotion, span: TimeSpan| -> Rows {
        let rows = rows_of_clip(&motion.clip, &motion.roles, &motion.rest, common, params);
        rows.slice(span.frames_among(rows.len(), hz))
    };
    let a = cut(first, of);
    let mut b = cut(second, with);
    if mirrored && let Some(image) = mirrored_rows(&b, common) {
        b = image;
    }
    if a.len() * b.len() > CELLS || directions.is_empty() || b.is_empty() {
        let pace = with.duration_secs() / of.duration_secs().max(1e-9);
        let ticks = a.len().max(2);
        let even = (0..ticks).map(|tick| with.start_secs + pace * tick as f64 / hz);
        return (even.collect(), None);
    }
    let mut sums = vec![(0.0, 0usize); a.len()];
    for (i, j) in warp(&a.columns(&directions), &b.columns(&directions)) {
        sums[i].0 += j as f64;
        sums[i].1 += 1;
    }
    let path = sums
        .iter()
        .map(|(sum, count)| with.start_secs + sum / (*count).max(1) as f64 / hz);
    let deviation = deviation_from(&b, &a, common, of.start_secs, hz);
    (path.collect(), deviation)
}
