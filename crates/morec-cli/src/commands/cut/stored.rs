//! Cuts the clips of a database and stores the cuts in it.

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Result, bail};
use morec_db::{ClipCuts, ClipFilter, SegmentKind};

use super::args::Args;
use crate::database;
use crate::print;
use crate::progress::StageBar;
use crate::table::TextTable;

/// Cuts, keeps and prints.
pub fn run(path: &Path, args: &Args) -> Result<ExitCode> {
    if args.plot.is_some() {
        bail!("--plot draws a clip of a file, not of a database");
    }
    let cutter = args.settings.cutter(args.poses.reader()?.set)?;
    let mut db = database::open(path)?;
    let bar = StageBar::stoppable()?;
    let clips = db.find_clips(&ClipFilter {
        name: args.clip.clone(),
        ..ClipFilter::default()
    })?;
    if !args.at.is_empty() {
        let [clip] = clips.as_slice() else {
            bail!("--at cuts one clip, but --clip chooses {}", clips.len());
        };
        db.cut_by_hand(clip, &args.at)?;
        let said = format!("{}: {} segments\n", clip.name, args.at.len() + 1);
        return print::print(said).map(|()| ExitCode::SUCCESS);
    }
    let report = db.cut(&clips, &cutter, &bar)?;
    drop(bar);
    for (clip, reason) in &report.left {
        eprintln!("morec: not changed: {clip}: {reason}");
    }
    if args.json {
        print::print_json(&report.cuts)?;
    } else {
        print(&report.cuts)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn print(cuts: &[ClipCuts]) -> Result<()> {
    const SHOWN: usize = 12;
    let mut table = TextTable::new(["clip", "secs", "still", "T-pose", "cuts"])
        .least(["T-pose", "still", "secs"]);
    for cut in cuts {
        let of = |kind| -> f64 {
            cut.still
                .iter()
                .filter(|s| s.kind == kind)
                // `sum` of nothing is -0, which would be printed.
                .fold(0.0, |secs, s| secs + s.span.duration_secs())
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
    print::print_table(
        &table,
        &format!("{segments} segments of {} clips\n", cuts.len()),
    )
}
