//! `morec db import`: imports clips into a database.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Result, bail};
use morec::files::FileReader;
use morec_db::{ImportCounts, ImportLog, ImportOutcome, MotionDb};
use morec_ops::ImportSettings;

use super::samples;
use crate::database;
use crate::files::{self, ReadArgs};
use crate::interrupt;
use crate::print;
use crate::progress::StageBar;

/// Import clips, or folders of clips
///
/// A file with the same content is imported once, whatever its name. After an interruption, the same command continues.
/// Unreadable files are listed with the reason, and so are near-duplicates among new clips (resampled, trimmed, mirrored).
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db import moves.mdb recordings/
  morec db import moves.mdb 13_29.amc --skeleton 13.asf --subject 13
  morec db import moves.mdb cleaned/take_1.bvh --in-place-of take_1

Ctrl-C finishes the current write and prints what was imported; the same command then continues.

Exit code 1 if a file was refused or a folder contains motion in an unsupported format, 130 if interrupted.")]
pub struct Args {
    /// The database; created if it does not exist
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Clips or folders; FILE#2 and FILE#name are one clip of a file
    #[arg(required = true, value_name = "DIR|CLIP")]
    clips: Vec<PathBuf>,
    /// Replace this clip by the one file given
    ///
    /// Name, tags and labels are kept; labels and cuts after the new end are removed and listed.
    #[arg(
        long,
        value_name = "CLIP",
        conflicts_with_all = ["source", "licence", "subject", "tags"]
    )]
    in_place_of: Option<String>,
    #[command(flatten)]
    settings: ImportSettings,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint`
    #[arg(long, value_name = "FILE")]
    roles: Option<PathBuf>,
    /// Print one JSON object: the outcome of every file
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    read: ReadArgs,
}

/// Imports and reports.
pub fn run(args: &Args) -> Result<ExitCode> {
    let begun = Instant::now();
    let expanded = files::expand_all(&args.clips)?;
    let left_out = files::say_left_out(&expanded);
    let paths = expanded.clips;
    let mut db = match args.db.exists() {
        true => database::open(&args.db)?,
        false => MotionDb::create(&args.db)?,
    };
    let mapping = files::mapping(args.roles.as_deref())?;
    let reader = args.read.reader_with(mapping);
    if let Some(clip) = &args.in_place_of {
        return replace(args, &mut db, clip, &paths, &reader);
    }
    let bar = StageBar::stoppable()?;
    let report = args.settings.run(&mut db, &paths, &reader, &bar)?;
    if args.json {
        print::print_json(&report)?;
    } else {
        let secs = begun.elapsed().as_secs_f64();
        print::print(text(&report.log, paths.len(), secs))?;
        for copy in &report.near_copies {
            print::print(format_args!("  {copy}\n"))?;
        }
    }
    let report = report.log;
    if report.cancelled {
        return Ok(interrupt::STOPPED.into());
    }
    let refused = report.counts().refused;
    Ok(if refused > 0 || left_out {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    })
}

fn replace(
    args: &Args,
    db: &mut MotionDb,
    clip: &str,
    paths: &[PathBuf],
    reader: &FileReader,
) -> Result<ExitCode> {
    let [path] = paths else {
        bail!("--in-place-of: expected one file, found {}", paths.len());
    };
    let replaced = db.replace_clip(clip, path, reader)?;
    if args.json {
        print::print_json(&replaced)?;
        return Ok(ExitCode::SUCCESS);
    }
    for warning in &replaced.warnings {
        eprintln!("morec: {}: {warning}", path.display());
    }
    print::print(format_args!(
        "{}: {:.2} s now, {:.2} s before; {} samples kept, {} removed, {} cuts removed; morec db undo restores the old file\n",
        replaced.clip,
        replaced.after_secs,
        replaced.before_secs,
        replaced.kept,
        replaced.removed.len(),
        replaced.cuts
    ))?;
    match replaced.removed.is_empty() {
        true => Ok(ExitCode::SUCCESS),
        false => samples::print(&replaced.removed, false),
    }
}

fn text(report: &ImportLog, files: usize, secs: f64) -> String {
    const SHOWN: usize = 20;
    let ImportCounts {
        imported,
        with_warnings,
        known,
        copies,
        refused,
    } = report.counts();
    let clips = report.clips().count();
    let mut lines = vec![format!(
        "{imported} files imported ({clips} clips, {with_warnings} files with notes), {known} known, {copies} copies, {refused} refused; {secs:.1} s"
    )];
    // The same note of a hundred files is one line: what differs is figures.
    let mut notes: Vec<(String, String, usize)> = Vec::new();
    for (path, outcome) in &report.files {
        let shown = path.display();
        match outcome {
            ImportOutcome::Refused(refused) => {
                lines.push(format!("  refused {shown}: {}", refused.reason))
            }
            ImportOutcome::Copy { of } => notes.push((
                String::new(),
                format!("  {shown} is a copy of {}", of.display()),
                1,
            )),
            ImportOutcome::Imported { warnings, .. } => {
                for warning in warnings {
                    let kind: String = warning.chars().filter(|c| !c.is_ascii_digit()).collect();
                    match notes.iter_mut().find(|(known, ..)| *known == kind) {
                        Some((.., count)) => *count += 1,
                        None => notes.push((kind, format!("  {shown}: {warning}"), 1)),
                    }
                }
            }
            ImportOutcome::Known => {}
        }
    }
    let notes: Vec<String> = notes
        .into_iter()
        .map(|(_, text, count)| {
            if count > 1 {
                format!("{text} (and {} more like it)", count - 1)
            } else {
                text
            }
        })
        .collect();
    let more = notes.len().saturating_sub(SHOWN);
    lines.extend(notes.into_iter().take(SHOWN));
    if more > 0 {
        lines.push(format!("  and {more} more notes (--json has all)"));
    }
    if report.cancelled {
        let left = files - report.files.len();
        lines.push(format!(
            "stopped: {left} files were not read; the same command continues"
        ));
    }
    lines.join("\n") + "\n"
}
