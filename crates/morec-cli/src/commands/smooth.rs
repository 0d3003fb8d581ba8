//! `morec smooth`: approximates clips by keyframes and Bézier curves, and reports errors and sizes.

mod output;
mod picture;
mod report;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result, bail};
use morec::clip::Clip;
use morec::import::{ImportOptions, Stated, normalize};
use morec::progress::Progress as _;
use morec::smooth::{MeasuredNoise, SmoothParams, compress};
use rayon::prelude::*;

use crate::files::{self, ReadArgs};
use crate::json::write_json;
use crate::progress::StageBar;
use output::{MotionForm, MotionTarget};
use report::{CompressionReport, CompressionResult};

/// Smooth clips into keyframes and Bézier curves
///
/// Each channel (the rotation of a joint, or the position of a joint that moves in its parent's frame) is replaced by cubic
/// Bézier curves. The curves are fitted by least squares and split until they are within the thresholds everywhere. Noise below
/// the thresholds disappears, and the curves can be sampled at any rate.
///
/// Writes sampled BVH, or .mclip, the stored form, which every command reads. Prints errors and sizes: values compares the
/// numbers in control points with the numbers in frames, bytes the stored form with the file.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec smooth walk.bvh                         only print sizes and errors
  morec smooth walk.bvh -o smooth.bvh --max-angle 1
  morec smooth jittery/ -o smooth/ --auto
  morec smooth recordings/ -o stored/ --form mclip --max-joint 5
  morec smooth walk.bvh --plot Hips hips.svg --plot LeftArm.x arm.svg

Exit codes: 0 all clips done; 1 a file cannot be read or written (the others are done); 2 wrong
command line.")]
pub struct Args {
    /// Clips (BVH, AMC, MCLIP) or folders of clips; - is standard input
    #[arg(required = true, value_name = "CLIP")]
    clips: Vec<PathBuf>,
    /// Output: a .bvh or .mclip file, or a folder [default: write nothing]
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Form of the files in a folder [default: bvh]
    #[arg(long, value_enum, requires = "output")]
    form: Option<MotionForm>,
    /// Largest error of a joint's rotation, degrees
    #[arg(long, value_name = "DEGREES", default_value = "0.5", value_parser = figure)]
    max_angle: f64,
    /// Set both thresholds from the clip's sensor noise
    ///
    /// 3.5 standard deviations of the noise, at least 0.1 degrees and 0.5 mm. Replaces --max-angle and --max-position.
    #[arg(long, conflicts_with_all = ["max_angle", "max_position"])]
    auto: bool,
    /// Largest error of a moving joint in its parent's frame, millimetres
    #[arg(long, value_name = "MM", default_value = "5", value_parser = figure)]
    max_position: f64,
    /// Largest error of any joint in the world, millimetres [default: no bound]
    ///
    /// Without a bound, errors along a chain of joints add up.
    #[arg(long, value_name = "MM", value_parser = figure)]
    max_joint: Option<f64>,
    /// Frame rate of the BVH [default: the clip's]
    #[arg(long, value_name = "HZ", value_parser = files::rate)]
    rate: Option<f64>,
    /// Metres in the files' unit of length, 0.01 for cm [default: inferred]
    #[arg(long, value_name = "METRES", value_parser = figure)]
    unit: Option<f64>,
    /// Draw a channel with its curves as SVG; can be repeated
    ///
    /// The name of a joint draws its rotation; NAME.x, .y, .z or .w draws one component with its control points; NAME.position
    /// draws the position, NAME.px, .py or .pz one coordinate.
    #[arg(long, num_args = 2, value_names = ["JOINT[.CHANNEL]", "SVG"])]
    plot: Vec<String>,
    /// Print one JSON array, with an object for each file
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    read: ReadArgs,
}

fn figure(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("expected a number above 0".to_owned()),
    }
}

/// Compresses every clip, writes, and says what came of it.
pub fn run(args: &Args) -> Result<ExitCode> {
    let paths = files::expand(&args.clips)?;
    let target = MotionTarget::new(args.output.as_deref(), args.form, &args.clips, &paths)?;
    if !args.plot.is_empty() && paths.len() > 1 {
        bail!("--plot draws one clip; {} are given", paths.len());
    }
    let (bar, done) = (StageBar::new(), AtomicUsize::new(0));
    let reports: Vec<CompressionResult> = paths
        .par_iter()
        .map(|path| {
            let report = match smooth(path, args, &target) {
                Ok(clips) => CompressionResult::Done {
                    path: path.clone(),
                    clips,
                },
                Err(error) => CompressionResult::failed(path, &error),
            };
            bar.report(
                "smoothing clips",
                done.fetch_add(1, Ordering::Relaxed) + 1,
                paths.len(),
            );
            report
        })
        .collect();
    drop(bar);
    for report in &reports {
        if let CompressionResult::Failed { error, .. } = report {
            eprintln!("morec: {error}");
        }
    }
    let mut out = crate::console::stdout();
    if args.json {
        write_json(&mut out, &reports)?;
    } else {
        report::write(&mut out, &reports)?;
    }
    let failed = reports
        .iter()
        .any(|report| matches!(report, CompressionResult::Failed { .. }));
    Ok(if failed {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    })
}

/// One file, from reading to writing: a report for each character in it.
fn smooth(path: &Path, args: &Args, target: &MotionTarget) -> Result<Vec<CompressionReport>> {
    let opened = files::open(path, &args.read)?;
    for warning in &opened.warnings {
        eprintln!("morec: {}: {warning}", path.display());
    }
    let shown = || path.display().to_string();
    let file_bytes = std::fs::metadata(path).map(|data| data.len()).ok();
    let several = opened.clips.len() > 1;
    let mut reports = Vec::new();
    for (i, clip) in opened.clips.into_iter().enumerate() {
        if clip.frames == 0 {
            bail!("{}: no frames to smooth", path.display());
        }
        let compressed =
            compress(&clip, &params(&clip, opened.stated, args)?, &()).with_context(shown)?;
        let bytes = compressed.to_bytes();
        let character = several.then_some(i + 1);
        let written = target.path(path, character);
        if let Some(output) = &written {
            let rate_hz = args.rate.unwrap_or(clip.rate_hz);
            target
                .write(output, &compressed, &bytes, rate_hz)
                .with_context(|| output.display().to_string())?;
        }
        for plot in args.plot.chunks_exact(2) {
            picture::write(&clip, &compressed, &plot[0], Path::new(&plot[1]))?;
        }
        let file_bytes = file_bytes.filter(|_| !several);
        reports.push(CompressionReport::new(
            &compressed,
            written,
            bytes.len(),
            file_bytes,
        ));
    }
    Ok(reports)
}

/// Thresholds in the clip's own unit of length.
fn params(clip: &Clip, stated: Option<Stated>, args: &Args) -> Result<SmoothParams> {
    let metres_per_unit = match args.unit {
        Some(unit) => unit,
        None => {
            let options = ImportOptions {
                stated,
                ..ImportOptions::default()
            };
            normalize(clip.clone(), &options)?.report.metres_per_unit
        }
    };
    let params = SmoothParams {
        angle_rad: args.max_angle.to_radians(),
        position_metres: args.max_position / 1e3,
        joint_position_metres: args.max_joint.map(|mm| mm / 1e3),
        metres_per_unit,
    };
    Ok(match args.auto {
        true => MeasuredNoise::of(clip).thresholds(params),
        false => params,
    })
}
