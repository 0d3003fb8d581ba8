//! Cuts of the clips of a database, kept in it.

use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use anyhow::{Result, bail};
use morec::features::FeatureParams;
use morec::pivots::{PivotMap, PivotSet, PoseParams, pose_rows_of_clip};
use morec::progress::Progress;
use morec::segment::{StillKind, StillParams, kernel_cuts, segment, still_stretches};
use morec_db::rows::ClipRows;
use morec_db::{ClipFilter, ClipId, ClipInfo, DbError, MotionDb, Segment, SegmentKind};
use rayon::prelude::*;
use serde::Serialize;

use super::{Args, Cutter};
use crate::database;
use crate::progress::Bar;
use crate::table::Table;

#[derive(Serialize)]
struct StoredCuts {
    clip: String,
    secs: f64,
    cuts_secs: Vec<f64>,
    still: Vec<Still>,
}

#[derive(Serialize)]
struct Still {
    kind: SegmentKind,
    start_secs: f64,
    stop_secs: f64,
}

impl Cutter {
    /// Seconds at which a clip is cut.
    fn cuts(
        &self,
        db: &Mutex<MotionDb>,
        clip: &ClipInfo,
        rows: &ClipRows,
        set: &PivotSet,
    ) -> Result<Vec<f64>> {
        match self {
            Self::Kernel(params) => Ok(kernel_cuts(&rows.rows, &FeatureParams::default(), params)?),
            Self::Ppca(params) => {
                let stored = db
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .clip(clip.id)?;
                let poses = PoseParams::default();
                let map = PivotMap::of_clip(set, &stored.clip, &stored.roles)?;
                let rows = pose_rows_of_clip(&stored.clip, set, &map, &stored.rest, &poses);
                Ok(segment(&rows, poses.rate_hz, params)?
                    .cuts
                    .iter()
                    .map(|cut| cut.secs)
                    .collect())
            }
        }
    }
}

/// Cuts, keeps and prints.
pub fn run(path: &Path, cutter: &Cutter, args: &Args) -> Result<ExitCode> {
    if args.plot.is_some() {
        bail!("--plot draws a clip of a file, not of a database");
    }
    let set = args.poses.reader()?.set;
    let mut db = database::open(path)?;
    let bar = Bar::stoppable()?;
    let rows = db.rows(&FeatureParams::default(), &bar)?;
    let clips = db.find_clips(&ClipFilter {
        name: args.name.clone(),
        ..ClipFilter::default()
    })?;
    let (db, done) = (Mutex::new(db), AtomicUsize::new(0));
    let one = |clip: &ClipInfo| -> Result<Option<Done>> {
        if bar.cancelled() {
            return Err(DbError::Cancelled.into());
        }
        bar.report("cutting", done.fetch_add(1, Ordering::Relaxed), clips.len());
        let Some(rows) = rows.iter().find(|r| r.clip == clip.id) else {
            return Ok(Some((clip.id, nothing(clip), Vec::new())));
        };
        match cutter.cuts(&db, clip, rows, &set) {
            Ok(cuts) => Ok(Some(cut(clip, rows, cuts))),
            Err(error) => {
                bar.suspend(|| eprintln!("morec: left as it is: {}: {error:#}", clip.name));
                Ok(None)
            }
        }
    };
    let found: Vec<Option<Done>> = clips.par_iter().map(one).collect::<Result<_>>()?;
    let (mut ids, mut cuts, mut segments) = (Vec::new(), Vec::new(), Vec::new());
    for (id, cut, of_clip) in found.into_iter().flatten() {
        ids.push(id);
        cuts.push(cut);
        segments.extend(of_clip);
    }
    let mut db = db.into_inner().unwrap_or_else(PoisonError::into_inner);
    db.set_segments(args.method.name(), &ids, &segments)?;
    drop(bar);
    if args.json {
        crate::commands::db::print_json(&cuts)?;
    } else {
        print(&cuts)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// A clip that was cut: what is told of it and what is kept.
type Done = (ClipId, StoredCuts, Vec<Segment>);

fn nothing(clip: &ClipInfo) -> StoredCuts {
    StoredCuts {
        clip: clip.name.clone(),
        secs: clip.duration_secs(),
        cuts_secs: Vec::new(),
        still: Vec::new(),
    }
}

/// What is kept and told of a clip cut at `cuts`.
fn cut(clip: &ClipInfo, rows: &ClipRows, cuts: Vec<f64>) -> Done {
    let features = FeatureParams::default();
    let still = still_stretches(&rows.rows, rows.bones, &features, &StillParams::default());
    let stretch = |kind, start_secs, stop_secs| Segment {
        clip: clip.id,
        kind,
        start_secs,
        stop_secs,
    };
    let (tick, end) = (1.0 / features.tick_hz(), clip.duration_secs());
    let mut segments = Vec::new();
    if clip.rest_frames > 0 {
        segments.push(stretch(
            SegmentKind::Rest,
            0.0,
            clip.rest_frames as f64 / clip.rate_hz,
        ));
    }
    for (ticks, kind) in still {
        let kind = if kind == StillKind::TPose {
            SegmentKind::Rest
        } else {
            SegmentKind::Still
        };
        segments.push(stretch(
            kind,
            ticks.start as f64 * tick,
            (ticks.end as f64 * tick).min(end),
        ));
    }
    let still = segments
        .iter()
        .map(|s| Still {
            kind: s.kind,
            start_secs: s.start_secs,
            stop_secs: s.stop_secs,
        })
        .collect();
    let mut start = 0.0;
    for stop in cuts.iter().copied().chain([end]) {
        if stop > start {
            segments.push(stretch(SegmentKind::Motion, start, stop));
        }
        start = stop;
    }
    segments.retain(|s| s.stop_secs > s.start_secs);
    (
        clip.id,
        StoredCuts {
            cuts_secs: cuts,
            still,
            ..nothing(clip)
        },
        segments,
    )
}

fn print(cuts: &[StoredCuts]) -> Result<()> {
    const SHOWN: usize = 12;
    let mut table =
        Table::new(["clip", "secs", "still", "T-pose", "cuts"]).least(["T-pose", "still", "secs"]);
    for cut in cuts {
        let of = |kind| -> f64 {
            cut.still
                .iter()
                .filter(|s| s.kind == kind)
                .fold(0.0, |sum, s| sum + s.stop_secs - s.start_secs)
        };
        let mut at: Vec<String> = cut
            .cuts_secs
            .iter()
            .take(SHOWN)
            .map(|secs| format!("{secs:.1}"))
            .collect();
        if cut.cuts_secs.len() > SHOWN {
            at.push(format!("and {} more", cut.cuts_secs.len() - SHOWN));
        }
        table.row([
            cut.clip.clone(),
            format!("{:.1}", cut.secs),
            format!("{:.1}", of(SegmentKind::Still)),
            format!("{:.2}", of(SegmentKind::Rest)),
            at.join(" "),
        ]);
    }
    let segments: usize = cuts.iter().map(|c| c.cuts_secs.len() + 1).sum();
    crate::commands::db::print_table(
        &table,
        &format!("{segments} segments of {} clips\n", cuts.len()),
    )
}
