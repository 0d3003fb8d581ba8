//! `morec cut`: where a clip's behaviours begin and end.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use clap::ValueEnum;
use morec::segment::{Directions, PpcaParams, Segmentation, segment};
use serde::Serialize;

use crate::figures::write_json;
use crate::output;
use crate::poses::{PoseArgs, PosedClip};

/// Cut clips where their behaviour changes
///
/// No labels are needed: the poses so far are modelled, and a cut lies where the poses ahead stop fitting. Walking,
/// then jumping, are cut apart; one step is not cut from the next, as cycles of one behaviour stay together.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec cut 86_01.amc
  morec cut 86_01.amc --plot cuts.svg
  morec cut recordings/ --json > cuts.json
  morec cut long.bvh --rise 10          # fewer cuts")]
pub struct Args {
    /// Clips (BVH, AMC) or folders of clips
    #[arg(required = true, value_name = "CLIP")]
    clips: Vec<PathBuf>,
    /// How to cut
    #[arg(long, value_enum, default_value = "ppca")]
    method: Method,
    /// Which way to go through a clip: what begins is found forward, what ceases backward
    #[arg(long, value_enum, default_value = "both")]
    direction: Direction,
    /// How far the misfit must rise before a cut, in multiples of what fitting poses have
    #[arg(long, value_name = "R", default_value_t = PpcaParams::default().rise)]
    rise: f64,
    /// Share of the variance that the model of a segment keeps
    #[arg(long, value_name = "SHARE", default_value_t = PpcaParams::default().quality)]
    quality: f64,
    /// Print one JSON array: for each clip its cuts and the misfit over time
    #[arg(long)]
    json: bool,
    /// Draw the misfit over time with the cuts marked (one clip)
    #[arg(long, value_name = "SVG")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    poses: PoseArgs,
}

/// A method of segmentation.
#[derive(ValueEnum, Clone, Copy, Debug)]
enum Method {
    /// Probabilistic principal components, as in the thesis of 2009 with its distance corrected
    Ppca,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum Direction {
    /// From start to end
    Forward,
    /// From end to start
    Backward,
    /// Both, and the cuts of either
    Both,
}

#[derive(Serialize)]
struct Found {
    clip: String,
    rate_hz: f64,
    frames: usize,
    cuts: Vec<FoundCut>,
    forward: Vec<morec::segment::HPoint>,
    backward: Vec<morec::segment::HPoint>,
}

#[derive(Serialize)]
struct FoundCut {
    secs: f64,
    /// First frame of what begins here, counted from 0.
    frame: usize,
    forward: bool,
    backward: bool,
}

/// Reads, cuts and prints every clip.
pub fn run(args: &Args) -> Result<ExitCode> {
    let Method::Ppca = args.method;
    let params = params(args)?;
    let reader = args.poses.reader()?;
    let mut found = Vec::new();
    reader.each(&args.clips, |clip| {
        if args.plot.is_some() && !found.is_empty() {
            bail!("--plot draws one clip; give one, or leave --plot out");
        }
        let segmentation =
            segment(&clip.rows, reader.rate_hz(), &params).context(clip.name.clone())?;
        if let Some(path) = &args.plot {
            let svg = segmentation
                .chart(&format!("{}: misfit and cuts", clip.name), &[])
                .svg();
            output::write_whole(path, |out| out.write_all(svg.as_bytes()))
                .with_context(|| path.display().to_string())?;
        }
        found.push(Found::new(&clip, segmentation));
        Ok(())
    })?;
    let mut out = std::io::stdout().lock();
    if args.json {
        write_json(&mut out, &found)?;
    } else {
        found.iter().try_for_each(|f| f.write(&mut out))?;
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

fn params(args: &Args) -> Result<PpcaParams> {
    let directions = match args.direction {
        Direction::Forward => Directions::Forward,
        Direction::Backward => Directions::Backward,
        Direction::Both => Directions::Both,
    };
    let params = PpcaParams {
        rise: args.rise,
        quality: args.quality,
        directions,
        ..PpcaParams::default()
    };
    params.check().map_err(anyhow::Error::msg)?;
    Ok(params)
}

impl Found {
    fn new(clip: &PosedClip, found: Segmentation) -> Self {
        let rate_hz = clip.length.rate_hz;
        let cut = |c: &morec::segment::Cut| FoundCut {
            secs: c.secs,
            frame: (c.secs * rate_hz).round() as usize,
            forward: c.forward,
            backward: c.backward,
        };
        Self {
            clip: clip.name.clone(),
            rate_hz,
            frames: clip.length.frames,
            cuts: found.cuts.iter().map(cut).collect(),
            forward: found.forward,
            backward: found.backward,
        }
    }

    fn write(&self, out: &mut impl Write) -> std::io::Result<()> {
        let secs = self.frames as f64 / self.rate_hz;
        let (name, count) = (&self.clip, self.cuts.len());
        let plural = if count == 1 { "" } else { "s" };
        writeln!(out, "{name}: {count} cut{plural} in {secs:.2} s")?;
        for cut in &self.cuts {
            let found = match (cut.forward, cut.backward) {
                (true, true) => "both ways",
                (true, false) => "forward",
                _ => "backward",
            };
            writeln!(out, "  {:8.2} s  frame {:6}  {found}", cut.secs, cut.frame)?;
        }
        Ok(())
    }
}
