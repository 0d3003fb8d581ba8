//! `morec convert`: any clip becomes BVH, or points over time.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec::clip::Clip;
use morec::formats::{bvh, c3d, jsonl, trc};
use morec::import::{ImportOptions, normalize};

use crate::files::{self, ReadArgs};
use crate::output;

/// Write a clip as BVH, or its points as C3D, TRC or lines of JSON
///
/// The ending of the output chooses: .c3d, .trc and .jsonl get where joints and points are, without rotations;
/// everything else is BVH. Lengths and axes stay as the clip has them: nothing is scaled (but lengths without a named unit
/// in C3D and TRC, which become millimetres) or turned. Joints, their names and their movements are kept; points in BVH
/// have no rotations. What was repaired in reading is said on standard error.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec convert 13_29.amc -o 13_29.bvh
  morec convert walk.bvh -o walk30.bvh --rate 30
  morec convert gait.c3d -o gait.trc
  morec convert 13_29.amc --skeleton 13.asf -o - | head")]
pub struct Args {
    /// The clip, in any format that is read; - is standard input
    clip: PathBuf,
    /// The file to write; - is BVH on standard output
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Resample to this rate; without it, every frame is kept as it is
    #[arg(long, value_name = "HZ", value_parser = files::rate)]
    rate: Option<f64>,
    /// Which character to write, from 1, of a file that holds several
    #[arg(long, value_name = "N")]
    character: Option<usize>,
    #[command(flatten)]
    read: ReadArgs,
}

/// Reads, resamples if asked to, and writes.
pub fn run(args: Args) -> Result<ExitCode> {
    let opened = files::open(&args.clip, &args.read)?;
    for warning in &opened.warnings {
        eprintln!("morec: {}: {warning}", args.clip.display());
    }
    let mut clip =
        one_of(opened.clips, args.character).with_context(|| args.clip.display().to_string())?;
    if let Some(rate_hz) = args.rate {
        clip = clip
            .resampled(rate_hz)
            .with_context(|| args.clip.display().to_string())?;
    }
    if args.output == Path::new("-") {
        let mut out = std::io::stdout().lock();
        bvh::write(&clip, &mut out).context("standard output")?;
        out.flush().context("standard output")?;
    } else {
        write_clip(&clip, &args.output).with_context(|| args.output.display().to_string())?;
    }
    Ok(ExitCode::SUCCESS)
}

/// What writes a clip in some format.
type WriteClip = fn(&Clip, &mut dyn Write) -> std::io::Result<()>;

/// Formats of points, by the ending of their files; everything else is written as BVH.
const POINTS: [(&str, WriteClip); 3] = [
    ("trc", trc::write),
    ("c3d", c3d::write),
    ("jsonl", jsonl::write),
];

fn one_of(mut clips: Vec<Clip>, character: Option<usize>) -> Result<Clip> {
    let count = clips.len();
    match character {
        None if count == 1 => Ok(clips.remove(0)),
        None => bail!("the file holds {count} characters; say which with --character"),
        Some(n) if (1..=count).contains(&n) => Ok(clips.remove(n - 1)),
        Some(n) => bail!("there is no character {n}; the file holds {count}"),
    }
}

/// Writes a clip in the format that the ending of `path` names, else as BVH; whole or not at all.
pub fn write_clip(clip: &Clip, path: &Path) -> Result<()> {
    let ending = path.extension().unwrap_or_default();
    match POINTS
        .iter()
        .find(|(known, _)| ending.eq_ignore_ascii_case(known))
    {
        Some((_, write)) => {
            let points = points_of(clip)?;
            output::write_whole(path, |out| write(&points, out))
        }
        None => output::write_whole(path, |out| bvh::write(clip, out)),
    }
}

/// Where the joints are; formats of points name their unit, so one is inferred where the clip says none.
fn points_of(clip: &Clip) -> Result<Clip> {
    if !clip.has_rotations() || clip.frames == 0 {
        return Ok(clip.clone());
    }
    let facts = normalize(clip.clone(), &ImportOptions::default())?.report;
    Ok(clip.to_points(Some(facts.metres_per_unit)))
}
