//! `morec inspect`: shows a clip and everything that is inferred about it.

mod draw;
mod report;

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec::import::{ImportOptions, SignedAxis, Take};
use morec::roles::mapping;

use crate::files::{self, ReadArgs};
use crate::json::write_json;
use crate::output;
use crate::progress::SlowProgress;
use draw::Drawing;
use report::summary::FolderSummary;
use report::{FileReport, InspectReport};

/// Show a clip: skeleton, roles, rate, units, repairs
///
/// One clip is shown joint by joint; several clips are shown in a few lines each, with a summary. A folder includes its
/// subfolders. Unit, up axis and rest pose are inferred from the motion, as in every other command. Exit code 1 if a file cannot
/// be read or a folder contains motion in an unsupported format.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec inspect walk.bvh
  morec inspect recordings/ --json
  morec inspect 13_29.amc --skeleton 13.asf --file-rate 60
  morec inspect odd.bvh --roles mine.tsv
  morec inspect odd.c3d --roles-template > mine.tsv
  morec inspect odd.bvh --draw
  morec inspect odd.bvh --draw -o odd.svg

A roles file has one role a line, a tab, and the joint's name (or - for none):
  hips<TAB>Pelvis
  left_shoulder<TAB>-
Names joined by + mean the middle of these joints or markers:
  left_knee<TAB>LKNE+LKNM")]
pub struct Args {
    /// Clips, skeletons (ASF) or folders; - is standard input
    ///
    /// FILE#2 and FILE#name are one clip of a file.
    #[arg(required = true, value_name = "CLIP")]
    clips: Vec<PathBuf>,
    /// Print one JSON array, with an object for each file
    #[arg(long)]
    json: bool,
    /// Print every joint of every clip
    #[arg(long, conflicts_with = "json")]
    full: bool,
    /// Draw the body, left and right in different colours
    #[arg(long, conflicts_with = "json")]
    draw: bool,
    /// File to write with --draw: one clip as SVG with joint names
    #[arg(short, long, value_name = "FILE", requires = "draw")]
    output: Option<PathBuf>,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint`
    #[arg(long, value_name = "FILE")]
    roles: Option<PathBuf>,
    /// Print a file for --roles to start from
    #[arg(long, conflicts_with_all = ["json", "draw", "full"])]
    roles_template: bool,
    /// Up axis of the files: x, y, z, -x, -y or -z [default: inferred]
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true)]
    up: Option<SignedAxis>,
    /// Metres in the files' unit of length, 0.01 for cm [default: inferred]
    #[arg(long, value_name = "METRES", value_parser = metres)]
    unit: Option<f64>,
    #[command(flatten)]
    read: ReadArgs,
}

/// Reads and shows every clip.
pub fn run(args: Args) -> Result<ExitCode> {
    let options = import_options(&args)?;
    let expanded = files::expand_all(&args.clips)?;
    let left_out = files::say_left_out(&expanded);
    let paths = expanded.clips;
    if args.roles_template {
        return roles_template(&paths, &args.read, &options);
    }
    let full = args.full || paths.len() == 1;
    if let Some(output) = &args.output {
        output::check_picture(output)?;
        if paths.len() != 1 {
            bail!(
                "--output writes the picture of one clip, but {} are given",
                paths.len()
            );
        }
    }
    let mut progress = SlowProgress::new(paths.len(), "reading clips");
    let mut failed = left_out;
    let mut reports: Vec<FileReport> = Vec::new();
    let mut summary = FolderSummary::default();
    for path in paths {
        let (report, drawings) = match inspect(&path, &args.read, &options) {
            Ok((report, takes)) => {
                let drawn = takes.iter().filter(|_| args.draw);
                let drawings = drawn.map(Drawing::of).collect();
                (FileReport::Read(Box::new(report)), drawings)
            }
            Err(error) => {
                failed = true;
                (FileReport::failed(&path, &error), Vec::new())
            }
        };
        summary.add(&report);
        if args.json {
            reports.push(report);
        } else {
            progress.suspend(|| print(&report, full))?;
            progress.suspend(|| draw(&drawings, &path, args.output.as_deref()))?;
        }
        progress.step();
    }
    drop(progress);
    if args.json {
        let mut out = crate::console::stdout();
        write_json(&mut out, &reports)?;
    } else {
        summary.write(&mut crate::console::stdout())?;
    }
    Ok(if failed {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    })
}

fn print(report: &FileReport, full: bool) -> Result<()> {
    match report {
        FileReport::Read(report) => report.write(&mut crate::console::stdout(), full)?,
        FileReport::Failed { error, .. } => eprintln!("morec: {error}"),
    }
    Ok(())
}

/// Shows pictures on the terminal, or writes the first one as SVG.
fn draw(drawings: &[Option<Drawing>], path: &Path, output: Option<&Path>) -> Result<()> {
    let nobody = "no body was found, so nothing can be drawn";
    if let (Some(output), Some(drawing)) = (output, drawings.first()) {
        let drawing = drawing
            .as_ref()
            .with_context(|| format!("{}: {nobody}", path.display()))?;
        let svg = drawing.svg(&path.display().to_string());
        return output::write_whole(output, |out| out.write_all(svg.as_bytes()))
            .with_context(|| output.display().to_string());
    }
    let mut out = std::io::stdout().lock();
    let look = crate::show::look();
    let colour = look.colour && out.is_terminal();
    for drawing in drawings {
        match drawing {
            Some(drawing) => write!(out, "\n{}", drawing.text(colour, look.unicode))?,
            None => writeln!(out, "\n  {nobody}")?,
        }
    }
    Ok(())
}

/// A roles file for the first clip of each file.
fn roles_template(paths: &[PathBuf], read: &ReadArgs, options: &ImportOptions) -> Result<ExitCode> {
    let mut out = crate::console::stdout();
    for path in paths {
        let opened = files::open_with(path, read, options.mapping.as_ref())?;
        let Some(clip) = opened.clips.first() else {
            bail!("{}: contains no clip", path.display());
        };
        let text = if clip.points.is_some() {
            mapping::template(&clip.skeleton.names().collect::<Vec<_>>())
        } else {
            let takes = opened.into_takes(options)?;
            let first = takes.first();
            first.map_or_else(String::new, |take| {
                mapping::write(&take.roles, &take.clip.skeleton)
            })
        };
        out.write_all(text.as_bytes())?;
    }
    Ok(ExitCode::SUCCESS)
}

fn inspect(
    path: &Path,
    read: &ReadArgs,
    options: &ImportOptions,
) -> Result<(InspectReport, Vec<Take>)> {
    let opened = files::open_with(path, read, options.mapping.as_ref())?;
    let (format, skeleton, warnings) = (
        opened.format,
        opened.skeleton.clone(),
        opened.warnings.clone(),
    );
    let takes = opened.into_takes(options);
    let takes = takes.with_context(|| format!("{}: --roles", path.display()))?;
    let report = InspectReport::new(path, format, skeleton, &takes, warnings);
    Ok((report, takes))
}

fn import_options(args: &Args) -> Result<ImportOptions> {
    let mapping = files::mapping(args.roles.as_deref())?;
    Ok(ImportOptions {
        up: args.up,
        metres_per_unit: args.unit,
        mapping,
        ..ImportOptions::default()
    })
}

fn metres(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(metres) if metres.is_finite() && metres > 0.0 => Ok(metres),
        _ => Err("expected a length in metres, above 0".to_owned()),
    }
}
