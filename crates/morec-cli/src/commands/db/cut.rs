//! `morec db cut`: cut every clip where its behaviour changes.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use anyhow::Result;
use morec::features::FeatureParams;
use morec::pivots::{PivotMap, PivotSet, PoseParams, pose_rows_of_clip};
use morec::progress::Progress;
use morec::segment::{
    KernelParams, PpcaParams, StillKind, StillParams, kernel_cuts, segment, still_stretches,
};
use morec_db::rows::ClipRows;
use morec_db::{ClipFilter, ClipId, ClipInfo, DbError, MotionDb, Segment, SegmentKind};
use rayon::prelude::*;
use serde::Serialize;

use crate::database;
use crate::progress::Bar;
use crate::table::Table;

/// Cut clips where their behaviour changes, and mark stillness and T-poses
///
/// Kernel change points make segments as alike within as they can be, for a price a cut; the thesis's method models the
/// poses so far and cuts where those ahead stop fitting. What is found is kept in the database in place of earlier cuts,
/// by whatever method.
#[derive(clap::Args)]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Clips whose name matches (`*` any text, `?` one character)
    #[arg(long, value_name = "PATTERN")]
    name: Option<String>,
    /// How to cut
    #[arg(long, value_enum, default_value = "kernel")]
    method: Method,
    /// Length of the windows whose statistics are compared, seconds (kernel)
    #[arg(long, value_name = "SECS", default_value_t = KernelParams::default().window_secs)]
    window: f64,
    /// What a cut costs: more, and there are fewer (kernel)
    #[arg(long, value_name = "P", default_value_t = KernelParams::default().penalty)]
    penalty: f64,
    /// No segment is shorter, seconds (kernel)
    #[arg(long, value_name = "SECS", default_value_t = KernelParams::default().least_secs)]
    least: f64,
    /// How far the misfit must rise before a cut, in multiples of what fitting poses have: more, and there are fewer
    /// (ppca)
    #[arg(long, value_name = "R", default_value_t = PpcaParams::default().rise)]
    rise: f64,
    /// Print one JSON array: for each clip its cuts and still stretches
    #[arg(long)]
    json: bool,
}

/// A method of segmentation.
#[derive(clap::ValueEnum, Clone, Copy, Debug)]
enum Method {
    /// Kernel change points over feature rows
    Kernel,
    /// Probabilistic principal components over joint rotations, as in the thesis of 2009 with its distance corrected
    Ppca,
}

impl Method {
    /// Its name in the database.
    fn name(self) -> &'static str {
        match self {
            Method::Kernel => "kernel",
            Method::Ppca => "ppca",
        }
    }
}

#[derive(Serialize)]
struct Cut {
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

/// How to cut, checked.
enum Cutter {
    Kernel(KernelParams),
    Ppca(PpcaParams),
}

impl Cutter {
    fn new(args: &Args) -> Result<Self> {
        let kernel = KernelParams {
            window_secs: args.window,
            penalty: args.penalty,
            least_secs: args.least,
            ..KernelParams::default()
        };
        let ppca = PpcaParams {
            rise: args.rise,
            ..PpcaParams::default()
        };
        kernel
            .check()
            .and_then(|()| ppca.check())
            .map_err(anyhow::Error::msg)?;
        Ok(match args.method {
            Method::Kernel => Self::Kernel(kernel),
            Method::Ppca => Self::Ppca(ppca),
        })
    }

    /// Seconds at which a clip is cut.
    fn cuts(&self, db: &Mutex<MotionDb>, clip: &ClipInfo, rows: &ClipRows) -> Result<Vec<f64>> {
        match self {
            Self::Kernel(params) => Ok(kernel_cuts(&rows.rows, &FeatureParams::default(), params)?),
            Self::Ppca(params) => {
                let stored = db
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .clip(clip.id)?;
                let (set, poses) = (PivotSet::thesis(), PoseParams::default());
                let map = PivotMap::of_clip(&set, &stored.clip, &stored.roles)?;
                let rows = pose_rows_of_clip(&stored.clip, &set, &map, &stored.rest, &poses);
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
pub fn run(args: &Args) -> Result<ExitCode> {
    let cutter = Cutter::new(args)?;
    let mut db = database::open(&args.db)?;
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
        match cutter.cuts(&db, clip, rows) {
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
        super::print_json(&cuts)?;
    } else {
        print(&cuts)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// A clip that was cut: what is told of it and what is kept.
type Done = (ClipId, Cut, Vec<Segment>);

fn nothing(clip: &ClipInfo) -> Cut {
    Cut {
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
        Cut {
            cuts_secs: cuts,
            still,
            ..nothing(clip)
        },
        segments,
    )
}

fn print(cuts: &[Cut]) -> Result<()> {
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
    super::print_table(
        &table,
        &format!("{segments} segments of {} clips\n", cuts.len()),
    )
}
