//! Cuts the clips of a database where their behaviour changes, and stores the segments. Clips cut by hand are left unchanged.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use morec::TimeSpan;
use morec::discover::{DiscoverError, DiscoverParams, discover};
use morec::features::{BoneSet, FeatureParams, RowLayout, Rows};
use morec::pivots::{PivotMap, PivotSet, PoseParams, pose_rows_of_clip};
use morec::progress::Progress;
use morec::segment::{
    KernelParams, PpcaParams, StillKind, StillParams, kernel_cuts, segment, still_stretches,
};
use rayon::prelude::*;

use crate::rows::{ClipRows, rows_of};
use crate::{ClipId, ClipInfo, DbError, MotionDb, Segment, SegmentKind, StoredClip, segments};

/// The method of cuts that somebody has put into place, as [`MotionDb::cut_methods`] names it.
pub const BY_HAND: &str = "hand";

/// A method of cutting with its figures.
#[derive(Debug, Clone)]
pub enum Cutter {
    /// Kernel change points over feature rows.
    Kernel(KernelParams),
    /// Probabilistic principal components over the rotations of these pivots, as in the thesis of 2009 with its distance
    /// corrected.
    Ppca(PpcaParams, PivotSet),
    /// Ends of repetitions of all clips together.
    Repeats(DiscoverParams),
}

/// Cuts of a clip, and the stretches without motion.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ClipCuts {
    /// The clip's name.
    pub clip: String,
    /// Length, seconds.
    pub secs: f64,
    /// The cuts, in seconds from its beginning.
    pub cuts_secs: Vec<f64>,
    /// Stretches of stillness and of rest poses.
    pub still: Vec<Still>,
}

/// A stretch in which the performer stands still.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[allow(missing_docs)] // The names say it.
pub struct Still {
    pub kind: SegmentKind,
    #[serde(flatten)]
    pub span: TimeSpan,
}

/// Result of [`MotionDb::cut`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CutReport {
    /// The clips that were cut, in the order in which they were given.
    pub cuts: Vec<ClipCuts>,
    /// Clips that were left as they are, with the reason.
    pub left: Vec<(String, String)>,
}

impl Cutter {
    /// Its name in the database.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Kernel(_) => "kernel",
            Self::Ppca(..) => "ppca",
            Self::Repeats(_) => "repeats",
        }
    }

    /// Seconds at which a clip with these rows is cut; `stored` gives its motion, if that is needed.
    ///
    /// # Errors
    /// Why it cannot be cut: figures that make no sense, a skeleton without the joints that the method looks at.
    pub fn cuts(
        &self,
        rows: &ClipRows,
        stored: impl FnOnce() -> Result<StoredClip, DbError>,
    ) -> Result<Vec<f64>, DbError> {
        let invalid = |error: &dyn std::fmt::Display| DbError::Invalid(error.to_string());
        match self {
            Self::Kernel(params) => {
                kernel_cuts(&rows.rows, &FeatureParams::default(), params).map_err(|e| invalid(&e))
            }
            Self::Ppca(params, set) => {
                let stored = stored()?;
                let poses = PoseParams::default();
                let map = PivotMap::of_clip(set, &stored.clip, &stored.roles);
                let map = map.map_err(|e| invalid(&e))?;
                let rows = pose_rows_of_clip(&stored.clip, set, &map, &stored.rest, &poses);
                let found = segment(&rows, poses.rate_hz, params).map_err(|e| invalid(&e))?;
                Ok(found.cuts.iter().map(|cut| cut.secs).collect())
            }
            Self::Repeats(params) => {
                let one = std::slice::from_ref(rows);
                Ok(repeats(one, params, &())?
                    .remove(&rows.clip)
                    .unwrap_or_default())
            }
        }
    }

    fn check(&self) -> Result<(), DbError> {
        match self {
            Self::Kernel(params) => params.check(),
            Self::Ppca(params, _) => params.check(),
            Self::Repeats(_) => Ok(()),
        }
        .map_err(DbError::Invalid)
    }
}

impl MotionDb {
    /// Cuts `clips` in parallel and keeps what is found in place of earlier cuts, by whatever method. A clip that was cut by
    /// hand is not cut again; the report lists it.
    ///
    /// # Errors
    /// Figures that make no sense; the database cannot be read or written; the listener cancelled. A clip that cannot be
    /// cut is no error but part of the report.
    pub fn cut(
        &mut self,
        clips: &[ClipInfo],
        cutter: &Cutter,
        progress: &dyn Progress,
    ) -> Result<CutReport, DbError> {
        cutter.check()?;
        let methods = self.cut_methods()?;
        let by_hand = |clip: &ClipInfo| methods.get(&clip.id).is_some_and(|m| m == BY_HAND);
        let (kept, clips): (Vec<ClipInfo>, Vec<ClipInfo>) =
            clips.iter().cloned().partition(by_hand);
        let rows = self.rows(&FeatureParams::default(), progress)?;
        let left = |clip: ClipInfo| (clip.name, "its cuts were set by hand".to_owned());
        let mut report = CutReport {
            left: kept.into_iter().map(left).collect(),
            ..CutReport::default()
        };
        let (mut ids, mut segments) = (Vec::new(), Vec::new());
        for (clip, cuts) in clips
            .iter()
            .zip(self.look(&clips, &rows, cutter, progress)?)
        {
            match cuts {
                Ok((cuts, of_clip)) => {
                    ids.push(clip.id);
                    report.cuts.push(cuts);
                    segments.extend(of_clip);
                }
                Err(error) => report.left.push((clip.name.clone(), error.to_string())),
            }
        }
        self.set_segments(cutter.name(), &ids, &segments)?;
        Ok(report)
    }

    /// Cuts a clip where somebody says, in seconds from its beginning, in place of earlier cuts; stretches of stillness stay,
    /// or are found if the clip was not cut before.
    ///
    /// # Errors
    /// A cut outside of the clip; the database cannot be read or written.
    pub fn cut_by_hand(&mut self, clip: &ClipInfo, cuts_secs: &[f64]) -> Result<(), DbError> {
        let end = clip.duration_secs();
        if let Some(cut) = cuts_secs.iter().find(|cut| !(**cut > 0.0 && **cut < end)) {
            return Err(DbError::Invalid(format!(
                "{}: expected cuts between 0 and {end:.3} s, found one at {cut:.3} s",
                clip.name
            )));
        }
        let mut cuts = cuts_secs.to_vec();
        cuts.sort_by(f64::total_cmp);
        let mut found = None;
        if self.segments_of(clip.id)?.is_empty() {
            let (bones, rows) = rows_of(&self.clip(clip.id)?, &FeatureParams::default());
            let rows = ClipRows {
                clip: clip.id,
                bones,
                rows,
            };
            found = Some(stretches(clip, &rows, Vec::new()).1);
        }
        self.edit(&format!("cut {} by hand", clip.name), |conn| {
            // Read within the transaction: changes of the stillness by another program stay.
            let before = segments::of_clip(conn, clip.id)?;
            let mut segments = match (before.is_empty(), found) {
                (false, _) => before,
                (true, Some(found)) => found,
                (true, None) => {
                    let why = "another program has removed its cuts: nothing was changed";
                    return Err(DbError::Invalid(format!("{}: {why}", clip.name)));
                }
            };
            segments.retain(|s| s.kind != SegmentKind::Motion);
            segments.extend(motions(clip, &cuts));
            segments::put(conn, BY_HAND, &[clip.id], &segments)
        })
    }

    /// Segments of each clip, or the reason why there are none.
    fn look(
        &mut self,
        clips: &[ClipInfo],
        rows: &[ClipRows],
        cutter: &Cutter,
        progress: &dyn Progress,
    ) -> Result<Vec<Result<Done, DbError>>, DbError> {
        let together = match cutter {
            Cutter::Repeats(params) => {
                let chosen = rows
                    .iter()
                    .filter(|r| clips.iter().any(|clip| clip.id == r.clip));
                Some(repeats(
                    &chosen.cloned().collect::<Vec<_>>(),
                    params,
                    progress,
                )?)
            }
            _ => None,
        };
        // A connection serves one thread at a time.
        let (db, done) = (Mutex::new(self), AtomicUsize::new(0));
        let stored = |clip: ClipId| db.lock().unwrap_or_else(PoisonError::into_inner).clip(clip);
        let one = |clip: &ClipInfo| {
            if progress.cancelled() {
                return Err(DbError::Cancelled);
            }
            progress.report("cutting", done.fetch_add(1, Ordering::Relaxed), clips.len());
            let Some(rows) = rows.iter().find(|r| r.clip == clip.id) else {
                return Ok(Ok((nothing(clip), Vec::new())));
            };
            let cuts = match &together {
                Some(all) => Ok(all.get(&clip.id).cloned().unwrap_or_default()),
                None => cutter.cuts(rows, || stored(clip.id)),
            };
            Ok(cuts.map(|cuts| stretches(clip, rows, cuts)))
        };
        clips.par_iter().map(one).collect()
    }
}

/// Ends of repetitions in each clip, found by the bones that all of them show.
fn repeats(
    clips: &[ClipRows],
    params: &DiscoverParams,
    progress: &dyn Progress,
) -> Result<BTreeMap<ClipId, Vec<f64>>, DbError> {
    let bones = clips.iter().map(|clip| clip.bones).reduce(BoneSet::and);
    let bones = bones.unwrap_or(BoneSet::NONE);
    let common = |of: &ClipRows| of.rows.columns(&RowLayout::kept_columns(of.bones, bones));
    let rows: Vec<Rows> = clips.iter().map(common).collect();
    let tick_hz = FeatureParams::default().tick_hz();
    let found = discover(&rows, tick_hz, params, progress).map_err(|error| match error {
        DiscoverError::Cancelled => DbError::Cancelled,
        other => DbError::Invalid(other.to_string()),
    })?;
    let cuts = |(number, of): (usize, &ClipRows)| {
        let end_secs = of.rows.len() as f64 / tick_hz;
        (of.clip, found.cuts_of(number, end_secs))
    };
    Ok(clips.iter().enumerate().map(cuts).collect())
}

/// A clip that was cut: what is reported of it and what is kept.
type Done = (ClipCuts, Vec<Segment>);

fn nothing(clip: &ClipInfo) -> ClipCuts {
    ClipCuts {
        clip: clip.name.clone(),
        secs: clip.duration_secs(),
        cuts_secs: Vec::new(),
        still: Vec::new(),
    }
}

/// Segments to keep, and the report, of a clip cut at `cuts`.
fn stretches(clip: &ClipInfo, rows: &ClipRows, cuts: Vec<f64>) -> Done {
    let features = FeatureParams::default();
    let still = still_stretches(&rows.rows, rows.bones, &features, &StillParams::default());
    let stretch = |kind, start_secs, stop_secs| Segment {
        clip: clip.id,
        kind,
        span: TimeSpan::new(start_secs, stop_secs),
    };
    let (tick, end) = (1.0 / features.tick_hz(), clip.duration_secs());
    let mut segments = Vec::new();
    if clip.rest_frames > 0 {
        let stop_secs = clip.rest_frames as f64 / clip.rate_hz;
        segments.push(stretch(SegmentKind::Rest, 0.0, stop_secs));
    }
    for (ticks, kind) in still {
        let kind = match kind {
            StillKind::TPose => SegmentKind::Rest,
            _ => SegmentKind::Still,
        };
        let (start, stop) = (ticks.start as f64 * tick, ticks.end as f64 * tick);
        segments.push(stretch(kind, start, stop.min(end)));
    }
    let told = |s: &Segment| Still {
        kind: s.kind,
        span: s.span,
    };
    let still = segments.iter().map(told).collect();
    segments.extend(motions(clip, &cuts));
    segments.retain(|s| s.span.is_stretch());
    let cuts = ClipCuts {
        cuts_secs: cuts,
        still,
        ..nothing(clip)
    };
    (cuts, segments)
}

/// Segments between the cuts.
fn motions(clip: &ClipInfo, cuts: &[f64]) -> Vec<Segment> {
    let end = clip.duration_secs();
    let mut start_secs = 0.0;
    let mut motions = Vec::with_capacity(cuts.len() + 1);
    for stop_secs in cuts.iter().copied().chain([end]) {
        if stop_secs > start_secs {
            motions.push(Segment {
                clip: clip.id,
                kind: SegmentKind::Motion,
                span: TimeSpan::new(start_secs, stop_secs),
            });
        }
        start_secs = stop_secs;
    }
    motions
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ClipFilter;
    use crate::testing::database_of_waves;

    #[test]
    fn cuts_by_hand_stay_until_they_are_taken_back() {
        let (_folder, mut db) = database_of_waves(2);
        let clips = db.clips(&ClipFilter::default()).unwrap();
        db.cut_by_hand(&clips[0], &[2.0, 1.0]).unwrap();
        let starts = |db: &MotionDb, clip: &ClipInfo| -> Vec<f64> {
            let segments = db.segments_of(clip.id).unwrap().into_iter();
            let motions = segments.filter(|s| s.kind == SegmentKind::Motion);
            motions.map(|s| s.span.start_secs).collect()
        };
        assert_eq!(starts(&db, &clips[0]), [0.0, 1.0, 2.0]);
        assert_eq!(db.cut_methods().unwrap()[&clips[0].id], BY_HAND);
        let still = |db: &MotionDb| db.segments_of(clips[0].id).unwrap().len() - 3;
        let report = db
            .cut(&clips, &Cutter::Kernel(KernelParams::default()), &())
            .unwrap();
        assert_eq!(report.cuts.len(), clips.len() - 1);
        assert_eq!(report.left[0].0, clips[0].name);
        assert_eq!(starts(&db, &clips[0]), [0.0, 1.0, 2.0]);
        let before = still(&db);
        db.cut_by_hand(&clips[0], &[1.0, 2.5]).unwrap();
        assert_eq!(starts(&db, &clips[0]), [0.0, 1.0, 2.5]);
        assert_eq!(still(&db), before, "stillness stays");
        for outside in [0.0, -1.0, f64::NAN, clips[0].duration_secs()] {
            assert!(matches!(
                db.cut_by_hand(&clips[0], &[outside]),
                Err(DbError::Invalid(_))
            ));
        }
    }

    /// One program changes what is still while another cuts: the first finds each of its changes again.
    #[test]
    fn cuts_take_back_nothing_that_another_program_changes_meanwhile() {
        let (folder, mut db) = database_of_waves(1);
        let clip = db.clips(&ClipFilter::default()).unwrap().remove(0);
        db.cut_by_hand(&clip, &[1.0]).unwrap();
        let mut other = MotionDb::open(&folder.path().join("test.mdb")).unwrap();
        let done = std::sync::atomic::AtomicBool::new(false);
        std::thread::scope(|scope| {
            let cutting = scope.spawn(|| {
                // An end, and room for the other writer: if that one fails, nobody waits for ever.
                for _ in 0..10_000 {
                    if done.load(Ordering::Relaxed) {
                        break;
                    }
                    other.cut_by_hand(&clip, &[1.5]).unwrap();
                    std::thread::sleep(std::time::Duration::from_millis(1));
                }
            });
            for change in 1..60 {
                let still = Segment {
                    clip: clip.id,
                    kind: SegmentKind::Still,
                    span: TimeSpan::new(0.0, 0.01 * f64::from(change)),
                };
                let still = [still];
                db.set_segments("test", &[clip.id], &still).unwrap();
                std::thread::yield_now();
                let mut now = db.segments_of(clip.id).unwrap();
                now.retain(|s| s.kind == SegmentKind::Still);
                if now != still {
                    done.store(true, Ordering::Relaxed);
                }
                assert_eq!(now, still);
            }
            done.store(true, Ordering::Relaxed);
            cutting.join().unwrap();
        });
    }
}
