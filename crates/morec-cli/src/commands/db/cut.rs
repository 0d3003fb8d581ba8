//! `morec db cut`: cut every clip where its behaviour changes.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use morec::features::FeatureParams;
use morec::segment::{KernelParams, StillKind, StillParams, kernel_cuts, still_stretches};
use morec_db::rows::ClipRows;
use morec_db::{ClipFilter, ClipInfo, MotionDb, Segment, SegmentKind};
use rayon::prelude::*;
use serde::Serialize;

use crate::progress::Bar;
use crate::table::Table;

/// Cut clips where their behaviour changes, and mark stillness and T-poses
///
/// Kernel change points: segments are as alike within as they can be, for a price a cut. What is found is kept in the
/// database in place of earlier cuts. (morec cut --method ppca has the thesis's method, for files.)
#[derive(clap::Args)]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Clips whose name matches (`*` any text, `?` one character)
    #[arg(long, value_name = "PATTERN")]
    name: Option<String>,
    /// Length of the windows whose statistics are compared, seconds
    #[arg(long, value_name = "SECS", default_value_t = KernelParams::default().window_secs)]
    window: f64,
    /// What a cut costs: more, and there are fewer
    #[arg(long, value_name = "P", default_value_t = KernelParams::default().penalty)]
    penalty: f64,
    /// No segment is shorter, seconds
    #[arg(long, value_name = "SECS", default_value_t = KernelParams::default().least_secs)]
    least: f64,
    /// Print one JSON array: for each clip its cuts and still stretches
    #[arg(long)]
    json: bool,
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

/// The method's name in the database.
pub const METHOD: &str = "kernel";

/// Cuts, keeps and prints.
pub fn run(args: &Args) -> Result<ExitCode> {
    let params = KernelParams {
        window_secs: args.window,
        penalty: args.penalty,
        least_secs: args.least,
        ..KernelParams::default()
    };
    params.check().map_err(anyhow::Error::msg)?;
    let mut db = MotionDb::open(&args.db)?;
    let features = FeatureParams::default();
    let rows = db.rows(&features, &Bar::new())?;
    let clips = db.clips(&ClipFilter { name: args.name.clone(), ..ClipFilter::default() })?;
    let found: Vec<(Cut, Vec<Segment>)> = clips
        .par_iter()
        .map(|clip| {
            let rows = rows.iter().find(|r| r.clip == clip.id);
            rows.map_or_else(|| Ok((nothing(clip), Vec::new())), |rows| cut(clip, rows, &features, &params))
        })
        .collect::<Result<_>>()?;
    let ids: Vec<_> = clips.iter().map(|c| c.id).collect();
    let (cuts, segments): (Vec<Cut>, Vec<Vec<Segment>>) = found.into_iter().unzip();
    db.set_segments(METHOD, &ids, &segments.concat())?;
    if args.json {
        super::print_json(&cuts)?;
    } else {
        super::print(text(&cuts))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn nothing(clip: &ClipInfo) -> Cut {
    Cut { clip: clip.name.clone(), secs: clip.duration_secs(), cuts_secs: Vec::new(), still: Vec::new() }
}

fn cut(
    clip: &ClipInfo,
    rows: &ClipRows,
    features: &FeatureParams,
    params: &KernelParams,
) -> Result<(Cut, Vec<Segment>)> {
    let cuts = kernel_cuts(&rows.rows, features, params).context(clip.name.clone())?;
    let still = still_stretches(&rows.rows, rows.bones, features, &StillParams::default());
    let segment = |kind, start_secs, stop_secs| Segment { clip: clip.id, kind, start_secs, stop_secs };
    let (tick, end) = (1.0 / features.tick_hz(), clip.duration_secs());
    let mut segments = Vec::new();
    if clip.rest_frames > 0 {
        segments.push(segment(SegmentKind::Rest, 0.0, clip.rest_frames as f64 / clip.rate_hz));
    }
    for (ticks, kind) in still {
        let kind = if kind == StillKind::TPose { SegmentKind::Rest } else { SegmentKind::Still };
        segments.push(segment(kind, ticks.start as f64 * tick, (ticks.end as f64 * tick).min(end)));
    }
    let still = segments
        .iter()
        .map(|s| Still { kind: s.kind, start_secs: s.start_secs, stop_secs: s.stop_secs })
        .collect();
    let mut start = 0.0;
    for stop in cuts.iter().copied().chain([end]) {
        if stop > start {
            segments.push(segment(SegmentKind::Motion, start, stop));
        }
        start = stop;
    }
    segments.retain(|s| s.stop_secs > s.start_secs);
    Ok((Cut { cuts_secs: cuts, still, ..nothing(clip) }, segments))
}

fn text(cuts: &[Cut]) -> String {
    const SHOWN: usize = 12;
    let mut table = Table::new(["clip", "secs", "still", "T-pose", "cuts"]);
    for cut in cuts {
        let of = |kind| -> f64 {
            cut.still.iter().filter(|s| s.kind == kind).fold(0.0, |sum, s| sum + s.stop_secs - s.start_secs)
        };
        let mut at: Vec<String> = cut.cuts_secs.iter().take(SHOWN).map(|secs| format!("{secs:.1}")).collect();
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
    format!("{table}{segments} segments of {} clips\n", cuts.len())
}
