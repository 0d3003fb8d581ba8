//! `morec convert`: clips become BVH, points over time, scenes, or tables of numbers.

mod folder;
mod form;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec::clip::Clip;
use morec::fitting::fit_skeleton;
use morec::formats::bvh;
use morec::import::{ImportOptions, normalize};
use morec::tables::Content;

use crate::files::{self, ReadArgs};
pub use form::{ClipForm, write_clip, write_take};

/// Write clips as BVH, C3D, TRC, GLB, VRMA, lines of JSON, NumPy archives or CSV
///
/// The ending of the output chooses: .bvh; .c3d, .trc and .jsonl with where joints and points are, without rotations; .glb
/// and .vrma for other programs and avatars; .npz with positions, rotations and feature rows by name; .csv with one of
/// these. In BVH and the formats of points lengths and axes stay as the clip has them (but lengths without a named unit in
/// C3D and TRC become millimetres); the others hold metres with Y up, as `morec inspect` understands the clip. Folders and
/// several clips are written into a folder, in the form that --form names. What was repaired in reading is said on
/// standard error.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec convert 13_29.amc -o 13_29.bvh
  morec convert walk.bvh -o walk30.bvh --rate 30
  morec convert gait.c3d -o gait.trc
  morec convert gait.c3d -o gait.bvh --fit
  morec convert dance.fbx -o dance.vrma
  morec convert walk.bvh -o walk.csv --table features
  morec convert clips/ -o arrays/ --form npz
  morec convert 13_29.amc --skeleton 13.asf -o - | head")]
pub struct Args {
    /// Clips in any format that is read, or folders of clips; - is standard input
    #[arg(required = true, value_name = "CLIP")]
    clips: Vec<PathBuf>,
    /// The file to write, or the folder for several clips; - is BVH on standard output
    #[arg(short, long, value_name = "FILE|FOLDER")]
    output: PathBuf,
    /// Write into a folder, in this form [default: bvh]
    #[arg(long, value_enum)]
    form: Option<ClipForm>,
    /// What a CSV holds
    #[arg(long, value_enum, default_value_t = CsvContent::Positions)]
    table: CsvContent,
    /// Resample to this rate; without it, every frame is kept as it is
    #[arg(long, value_name = "HZ", value_parser = files::rate)]
    rate: Option<f64>,
    /// Lay a skeleton of fixed bone lengths into clips of points, so that joints have rotations; how far it is from the
    /// points is said on standard error
    #[arg(long)]
    fit: bool,
    /// Which character to write, from 1, of a file that holds several
    #[arg(long, value_name = "N")]
    character: Option<usize>,
    /// Roles that override those found: a file of `role<TAB>joint` lines
    #[arg(long, value_name = "FILE")]
    roles: Option<PathBuf>,
    #[command(flatten)]
    read: ReadArgs,
}

/// What a CSV holds.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum CsvContent {
    /// Where the joints are, metres
    Positions,
    /// How each joint is turned in its parent's frame, quaternions
    Rotations,
    /// Feature rows, 30 a second
    Features,
}

impl From<CsvContent> for Content {
    fn from(table: CsvContent) -> Self {
        match table {
            CsvContent::Positions => Content::Positions,
            CsvContent::Rotations => Content::Rotations,
            CsvContent::Features => Content::Features,
        }
    }
}

/// How clips are to be written.
struct Wanted {
    content: Content,
    import: ImportOptions,
    rate_hz: Option<f64>,
    fit: bool,
}

impl Wanted {
    /// The clip at the rate, and with the rotations, that are asked for.
    fn prepared(&self, clip: Clip) -> Result<Clip> {
        let clip = match self.rate_hz {
            Some(rate_hz) => clip.resampled(rate_hz)?,
            None => clip,
        };
        match self.fit && !clip.has_rotations() {
            true => fitted(clip, &self.import),
            false => Ok(clip),
        }
    }
}

/// A skeleton laid into a clip of points.
fn fitted(clip: Clip, import: &ImportOptions) -> Result<Clip> {
    let take = normalize(clip, import)?;
    let fit = fit_skeleton(&take).with_context(|| take.clip.name.clone())?;
    let (role, worst) = fit.worst;
    eprintln!(
        "morec: {}: a skeleton of {} joints fits the points to {:.1} cm (root mean square; {role} to {:.1} cm); how straight limbs \
         are turned about themselves is not known",
        take.clip.name,
        fit.clip.skeleton.len(),
        100.0 * fit.rms_metres,
        100.0 * worst
    );
    Ok(fit.clip)
}

/// Reads, resamples if asked to, and writes.
pub fn run(args: Args) -> Result<ExitCode> {
    let wanted = Wanted {
        content: args.table.into(),
        import: ImportOptions {
            mapping: files::mapping(args.roles.as_deref())?,
            ..ImportOptions::default()
        },
        rate_hz: args.rate,
        fit: args.fit,
    };
    let into_folder =
        args.clips.len() > 1 || args.clips.iter().any(|path| path.is_dir()) || args.form.is_some();
    if into_folder {
        return folder::convert(&args, &wanted);
    }
    let (path, output) = (&args.clips[0], &args.output);
    let to_stdout = output == Path::new("-");
    let form = match to_stdout {
        true => ClipForm::Bvh,
        false => ClipForm::of(output).with_context(|| output.display().to_string())?,
    };
    if args.table != CsvContent::Positions && form != ClipForm::Csv {
        bail!("--table says what a .csv holds, and the output is none");
    }
    let opened = files::open(path, &args.read)?;
    for warning in &opened.warnings {
        eprintln!("morec: {}: {warning}", path.display());
    }
    let clip = one_of(opened.clips, args.character).with_context(|| path.display().to_string())?;
    let clip = wanted
        .prepared(clip)
        .with_context(|| path.display().to_string())?;
    if to_stdout {
        let mut out = std::io::stdout().lock();
        bvh::write(&clip, &mut out).context("standard output")?;
        out.flush().context("standard output")?;
    } else {
        form::write(clip, form, &wanted, output).with_context(|| output.display().to_string())?;
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
