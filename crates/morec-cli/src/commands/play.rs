//! `morec play`: plays clips in the terminal, or writes a page that plays them.

use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Error, Result, bail};
use morec::clip::Clip;
use morec::import::{ImportOptions, Take};
use morec::index::MotionIndex;
use morec::labels::ClipLength;
use morec::labels::Mark;
use morec::live::Detection;
use morec::live::recognize_clip;
use morec::roles::mapping::Mapping;
use morec_measure::player::{PlayedClip, PlayedVideo, page};
use morec_ops::{rebuilt_from, video_of_page};

use super::recognize::open_index;
use crate::files::{self, ReadArgs};
use crate::labels::{self, LabelArgs};
use crate::output;
use crate::show::{self, ShownClip};

/// Play clips in the terminal, or write a page that plays them
///
/// The body is shown from the front, with labels and detections below. With --output, one HTML file is written, in which you can
/// turn and zoom the body, move in time, and go to each label and detection from a list.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec play walk.bvh
  morec play new/signals_3.bvh --index signs.index --speed 2
  morec play clips/ --labels labels.tsv -o clips.html
  morec play walk.bvh --video walk.mp4 --video-offset 1.2 -o walk.html
  morec play walk.bvh --reduced 4 -o reduced.html")]
pub struct Args {
    /// Clips, or folders of clips
    #[arg(required = true, value_name = "CLIP")]
    clips: Vec<PathBuf>,
    /// Labels to show: a table, or a form that `morec db label` reads
    #[arg(long, value_name = "FILE|DIR")]
    labels: Option<PathBuf>,
    /// Also show what this index recognises
    #[arg(long, value_name = "INDEX")]
    index: Option<PathBuf>,
    /// Also show each clip rebuilt from N dimensions (page)
    ///
    /// The dimensions are principal components of the poses of all these clips, as in `morec reduce`.
    #[arg(long, value_name = "N", requires = "output")]
    reduced: Option<usize>,
    /// Video of the clip, which the page plays in step
    ///
    /// The page names the file and does not hold it: keep them together.
    #[arg(long, value_name = "VIDEO", requires = "output")]
    video: Option<PathBuf>,
    /// Time of the video at which the clip begins, seconds
    #[arg(
        long,
        value_name = "SECS",
        default_value_t = 0.0,
        allow_hyphen_values = true,
        requires = "video"
    )]
    video_offset: f64,
    /// Speed in the terminal; 1: as performed
    #[arg(long, value_name = "TIMES", default_value_t = 1.0, value_parser = speed)]
    speed: f64,
    /// File to write instead: a page of HTML
    #[arg(short, long, value_name = "HTML")]
    output: Option<PathBuf>,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint`
    #[arg(hide_short_help = true, long, value_name = "FILE")]
    roles: Option<PathBuf>,
    #[command(flatten)]
    reading: LabelArgs,
    #[command(flatten)]
    read: ReadArgs,
}

fn speed(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(speed) if (0.01..=1000.0).contains(&speed) => Ok(speed),
        _ => Err("expected a factor between 0.01 and 1000".to_owned()),
    }
}

/// Plays or writes.
pub fn run(args: &Args) -> Result<ExitCode> {
    if let Some(output) = &args.output {
        output::check_page(output)?;
    }
    let options = ImportOptions {
        mapping: files::mapping(args.roles.as_deref())?,
        ..ImportOptions::default()
    };
    let index = args.index.as_deref().map(open_index).transpose()?;
    let mut takes = Vec::new();
    let of_index = index.as_ref().is_some_and(MotionIndex::has_custom_roles);
    let of_roles = options.mapping.as_ref().is_some_and(Mapping::is_custom);
    let planar = of_index || of_roles;
    for path in files::expand_as(&args.clips, planar)? {
        takes.extend(files::takes_as(&path, &args.read, &options, planar)?);
    }
    takes.retain(|take| take.clip.frames > 0);
    if takes.is_empty() {
        bail!("none of the named files contains motion");
    }
    let mut labelled = labels(args.labels.as_deref(), &args.reading, &args.clips, &takes)?;
    let mut played = Vec::with_capacity(takes.len());
    for take in &mut takes {
        let said = match &index {
            Some(index) => said(take, index, options.mapping.is_none())?,
            None => Vec::new(),
        };
        let labels = labelled.remove(take.name()).unwrap_or_default();
        played.push((labels, said));
    }
    let beside = match args.reduced {
        Some(dims) => reduced(&takes, dims)?.into_iter().map(Some).collect(),
        None => vec![None; takes.len()],
    };
    match &args.output {
        Some(path) => {
            let video = video(args, path, takes.len())?;
            write_page(path, &takes, &beside, played, video.as_ref())?;
        }
        None => in_terminal(&takes, &played, args.speed)?,
    }
    Ok(ExitCode::SUCCESS)
}

/// The video as seen from the page, if one is given.
fn video(args: &Args, page: &Path, clips: usize) -> Result<Option<PlayedVideo>> {
    let Some(file) = &args.video else {
        return Ok(None);
    };
    if clips != 1 {
        bail!("--video: expected one clip, found {clips}");
    }
    let video = video_of_page(page, file, args.video_offset);
    Ok(Some(video.map_err(Error::msg)?))
}

/// The labels of each clip by its name.
fn labels(
    path: Option<&Path>,
    reading: &LabelArgs,
    clips: &[PathBuf],
    takes: &[Take],
) -> Result<BTreeMap<String, Vec<Mark>>> {
    let Some(path) = path else {
        return Ok(BTreeMap::new());
    };
    let labels = labels::read(path, reading, clips)?;
    let lengths: BTreeMap<String, ClipLength> = takes
        .iter()
        .map(|take| (take.name().to_owned(), (&take.clip).into()))
        .collect();
    let resolved = labels.resolve(&lengths);
    for warning in &resolved.warnings {
        eprintln!("morec: {}: {warning}", path.display());
    }
    let mut of_clip: BTreeMap<String, Vec<Mark>> = BTreeMap::new();
    for sample in resolved.samples {
        let label = Mark::new(sample.class, sample.span);
        of_clip.entry(sample.clip).or_default().push(label);
    }
    if of_clip.is_empty() {
        eprintln!("morec: {}: no label belongs to these clips", path.display());
    }
    Ok(of_clip)
}

/// Detections of the index, in the order of their report.
fn said(take: &mut Take, index: &MotionIndex, complete: bool) -> Result<Vec<Detection<String>>> {
    if complete {
        index.complete_roles(&mut take.roles, &take.clip.skeleton);
    }
    let found = recognize_clip(&index.model, &take.clip, &take.roles, take.rest())
        .with_context(|| take.name().to_owned())?;
    let named = |found: Detection| found.with_class(index.model.class_name(found.class).to_owned());
    let mut said: Vec<Detection<String>> = found.into_iter().map(named).collect();
    said.sort_by(|a, b| a.reported_secs.total_cmp(&b.reported_secs));
    Ok(said)
}

fn in_terminal(
    takes: &[Take],
    played: &[(Vec<Mark>, Vec<Detection<String>>)],
    speed: f64,
) -> Result<()> {
    let watched = std::io::stdout().is_terminal();
    for (take, (truth, said)) in takes.iter().zip(played) {
        if !watched {
            // Without a terminal, events are printed as lines.
            println!("{}: {:.2} s", take.name(), take.clip.duration_secs());
        }
        let scene = ShownClip {
            title: take.name(),
            clip: &take.clip,
            truth,
            said,
        };
        show::play(&scene, speed)?;
    }
    Ok(())
}

/// The clips rebuilt from so many dimensions.
fn reduced(takes: &[Take], dims: usize) -> Result<Vec<Clip>> {
    let clips = takes
        .iter()
        .map(|take| (&take.clip, &take.roles, take.rest().clone()));
    let clips: Vec<_> = clips.collect();
    rebuilt_from(&clips, dims).context("--reduced")
}

fn write_page(
    path: &Path,
    takes: &[Take],
    beside: &[Option<Clip>],
    played: Vec<(Vec<Mark>, Vec<Detection<String>>)>,
    video: Option<&PlayedVideo>,
) -> Result<()> {
    let clips: Vec<PlayedClip> = takes
        .iter()
        .zip(beside)
        .zip(played)
        .map(|((take, beside), (truth, said))| PlayedClip {
            clip: &take.clip,
            beside: beside.as_ref(),
            roles: &take.roles,
            span: None,
            labels: truth,
            detections: said
                .into_iter()
                .map(|s| Mark::new(s.class, s.span))
                .collect(),
            video: video.cloned(),
        })
        .collect();
    let title = match takes {
        [one] => one.name().to_owned(),
        several => format!("{} clips", several.len()),
    };
    let html = page(&title, &clips);
    output::write_whole(path, |out| out.write_all(html.as_bytes()))
        .with_context(|| path.display().to_string())
}
