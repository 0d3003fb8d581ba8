//! `morec convert`: any clip becomes BVH.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec::clip::Clip;
use morec::formats::bvh;

use crate::files::{self, ReadArgs};
use crate::output;

/// Write a clip as BVH
///
/// Lengths and axes stay as the clip has them: nothing is scaled or turned. Joints, their names and their
/// movements are kept. What was repaired in reading is said on standard error.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec convert 13_29.amc -o 13_29.bvh
  morec convert walk.bvh -o walk30.bvh --rate 30
  morec convert 13_29.amc --skeleton 13.asf -o - | head")]
pub struct Args {
    /// The clip: BVH, AMC with its ASF, or MCLIP; - is standard input
    clip: PathBuf,
    /// The BVH file to write; - is standard output
    #[arg(short, long, value_name = "BVH")]
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

fn one_of(mut clips: Vec<Clip>, character: Option<usize>) -> Result<Clip> {
    let count = clips.len();
    match character {
        None if count == 1 => Ok(clips.remove(0)),
        None => bail!("the file holds {count} characters; say which with --character"),
        Some(n) if (1..=count).contains(&n) => Ok(clips.remove(n - 1)),
        Some(n) => bail!("there is no character {n}; the file holds {count}"),
    }
}

/// Writes a clip as BVH, whole or not at all.
pub fn write_clip(clip: &Clip, path: &Path) -> Result<()> {
    output::write_whole(path, |out| bvh::write(clip, out))
}
