//! `morec evaluate`: measures detections against labels.

use std::collections::BTreeSet;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Context;
use morec::formats::Warning;
use morec::import::ImportOptions;
use morec::labels::read_detections;
use morec::train::TrainClip;
use morec_measure::crossval::measure_as_taught;
use morec_measure::report::Report;
use morec_ops::EvaluateSettings;

use super::recognize::open_index;
use crate::figures;
use crate::files::{self, ReadArgs};
use crate::json;
use crate::labels::{self, LabelArgs};
use crate::lengths::lengths;
use crate::material::load_clips;
use crate::motion::ReportMotion;
use crate::output;

/// Measure detections against labels.
///
/// Prints how many samples were found, F1 of events and at overlaps of 0.1, 0.25, 0.5 and 0.75, false alarms a minute,
/// delay, errors of starts and stops, P_C/P_E/P_R and the confusion matrix, over all clips and for each class.
///
/// Tables are tab-separated with a header: `clip`, `class`, and `start`, `stop` (frames, stop exclusive) or
/// `start_secs`, `stop_secs`. In a labelled clip, unlabelled motion counts as none of the classes. Clips without labels are
/// ignored unless given as --unknown.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 measured; 1 a file cannot be read or nothing can be measured; 2 wrong command line.\n\n\
    Example: morec recognize signs.index new/ -o found.tsv\n         \
    morec evaluate --labels labels.tsv --found found.tsv --clips new/ --report report.html"
)]
pub struct Args {
    /// Labels: a table, or a form that `morec db label` reads
    #[arg(long, alias = "truth", value_name = "FILE|DIR")]
    labels: PathBuf,
    /// Detections of `morec recognize`; - is standard input
    ///
    /// Columns clip, class, start and stop are enough.
    #[arg(long, value_name = "TSV")]
    found: PathBuf,
    /// The clips, or folders of clips, that were recognised
    #[arg(long, value_name = "DIR|CLIP", num_args = 1.., required = true)]
    clips: Vec<PathBuf>,
    /// Test clips without any class: every detection is a false alarm
    #[arg(long, value_name = "DIR|CLIP", num_args = 1..)]
    unknown: Vec<PathBuf>,
    /// The index that was used: adds the reasons for missed samples
    ///
    /// The report then also compares recognised motions with the nearest sample.
    #[arg(long, value_name = "INDEX")]
    index: Option<PathBuf>,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
    /// Write a page of HTML too
    #[arg(long, value_name = "HTML")]
    report: Option<PathBuf>,
    #[command(flatten)]
    settings: EvaluateSettings,
    #[command(flatten)]
    reading: LabelArgs,
    #[command(flatten)]
    read: ReadArgs,
}

/// Runs the command.
pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    if let Some(path) = &args.report {
        output::check_ending(path, "a page of HTML", &["html", "htm"])?;
    }
    let labels = labels::read(&args.labels, &args.reading, &args.clips)?;
    let table =
        read_detections(&read(&args.found)?).with_context(|| args.found.display().to_string())?;
    warn(&args.labels, &labels.warnings);
    warn(&args.found, &table.warnings);
    let mut clips = lengths(&args.clips, &args.read)?;
    let unknown = lengths(&args.unknown, &args.read)?;
    let unknown_names: BTreeSet<String> = unknown.keys().cloned().collect();
    clips.extend(unknown);
    let mut resolved = labels.resolve(&clips);
    warn(&args.labels, &resolved.warnings);
    let of_whole_clips = resolved.samples.iter().any(|s| s.whole_clip);
    let moving = match of_whole_clips || args.index.is_some() {
        true => args.moving_clips()?,
        false => Vec::new(),
    };
    if measure_as_taught(&mut resolved.samples, &moving) > 0 {
        eprintln!("morec: labels of whole clips are measured without still ends, as in training");
    }
    let (founds, absent) = table.resolve(&clips);
    warn(&args.found, &absent);
    let settings = &args.settings;
    let mut measures = settings.evaluate(&clips, &unknown_names, resolved, founds)?;
    let notes = measures.notes.iter();
    notes.for_each(|note| eprintln!("morec: {note}"));
    let mut performances = Vec::new();
    if let Some(index) = &args.index {
        let model = open_index(index)?.model;
        measures.explain(&model, &moving);
        if args.report.is_some() {
            performances = measures.performances(&model, &moving);
        }
    }
    let (evaluation, timelines) = (&measures.evaluation, &measures.timelines);
    let misses = measures.misses.as_deref().unwrap_or_default();
    // Before anything is printed: a closed pipe does not lose the report.
    if let Some(path) = &args.report {
        let named = |path: &Path| path.display().to_string();
        let about = [
            ("labels".to_owned(), named(&args.labels)),
            ("detections".to_owned(), named(&args.found)),
        ];
        let title = "Detections against labels";
        let mut motion = ReportMotion::of(timelines);
        motion.add_files(&args.clips, &args.read)?;
        motion.add_files(&args.unknown, &args.read)?;
        let reel = motion.into_reel();
        let report = Report {
            title,
            about: &about,
            evaluation,
            timelines,
            training: &[],
            misses,
            performances: &performances,
            sensitivities: &[],
            perturbed: &[],
            motion: reel.as_ref(),
        };
        figures::write_report(path, &report)?;
    }
    let mut out = crate::console::stdout();
    if args.json {
        json::write_json(&mut out, &measures)?;
    } else {
        figures::write_tables(&mut out, evaluation)?;
        figures::write_misses(&mut out, misses)?;
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

impl Args {
    /// The clips once more, with their motion. What is left out of folders was said when they were recognised.
    fn moving_clips(&self) -> anyhow::Result<Vec<TrainClip>> {
        let paths = files::expand_all(&self.clips)?.clips;
        let clips = load_clips(&paths, &self.read, &ImportOptions::default())?;
        Ok(clips.into_iter().map(|loaded| loaded.clip).collect())
    }
}

fn read(path: &Path) -> anyhow::Result<Vec<u8>> {
    if path.as_os_str() == "-" {
        let mut bytes = Vec::new();
        std::io::stdin()
            .lock()
            .read_to_end(&mut bytes)
            .context("standard input")?;
        return Ok(bytes);
    }
    files::read(path)
}

fn warn(path: &Path, warnings: &[Warning]) {
    const SHOWN: usize = 10;
    for warning in warnings.iter().take(SHOWN) {
        eprintln!("morec: {}: {warning}", path.display());
    }
    if warnings.len() > SHOWN {
        eprintln!(
            "morec: {}: {} more warnings",
            path.display(),
            warnings.len() - SHOWN
        );
    }
}
