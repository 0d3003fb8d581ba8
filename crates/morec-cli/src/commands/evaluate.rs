//! `morec evaluate`: detections held against labels.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use morec::classes::ClassId;
use morec::eval::{
    ClipDetection, DetectionVerdict, Evaluation, GroundTruth, StreamInfo, Timeline, event_pairs,
    timelines,
};
use morec::explain::{Miss, Performance, deviation, explain};
use morec::formats::Warning;
use morec::import::ImportOptions;
use morec::labels::Mark;
use morec::labels::{ClipLength, Resolved, read_detections, some_of};
use morec::live::{Detection, Model};
use morec::report::Report;
use rayon::prelude::*;

use super::recognize::open_index;
use crate::figures;
use crate::files::{self, ReadArgs};
use crate::json;
use crate::labels;
use crate::lengths::lengths;
use crate::material::{LoadedClip, load_clips};
use crate::motion::ReportMotion;
use crate::output;

/// Measure detections against labels.
///
/// Prints thesis accuracy with its four counts, F1 at overlaps of 0.1, 0.25, 0.5 and 0.75, false alarms a minute,
/// delay, errors of starts and stops, P_C/P_E/P_R and the confusion matrix, over all clips and class by class.
///
/// Labels and detections are tables of tab-separated text with a header: `clip`, `class`, and `start`, `stop`
/// (frames of the clip, stop exclusive) or `start_secs`, `stop_secs`. In a labelled clip, what has no label counts
/// as none of the classes. Clips that no label names are left out, unless --unknown says that they hold none of
/// the classes.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 measured; 1 a file cannot be read or nothing can be measured; 2 wrong command line.\n\n\
    Example: morec recognize signs.index new/ -o found.tsv\n         \
    morec evaluate --labels labels.tsv --found found.tsv --clips new/ --report report.html"
)]
pub struct Args {
    /// Labels, in a form that `morec db label` reads; of tables columns clip, class, and start, stop or start_secs,
    /// stop_secs, or neither for whole clips
    #[arg(long, alias = "truth", value_name = "FILE|DIR")]
    labels: PathBuf,
    /// Detections, as `morec recognize` writes them or with as little as clip, start, stop, class; - reads them
    /// from standard input
    #[arg(long, value_name = "TSV")]
    found: PathBuf,
    /// Clips, or folders of clips, that were searched: they tell each clip's rate and length
    #[arg(long, value_name = "DIR|CLIP", num_args = 1.., required = true)]
    clips: Vec<PathBuf>,
    /// Clips, or folders, that hold none of the classes: what is found there counts apart from the rest
    #[arg(long, value_name = "DIR|CLIP", num_args = 1..)]
    unknown: Vec<PathBuf>,
    /// Classes that count, separated by commas; samples of others are taken as unlabelled, and a clip with samples
    /// of others only as unknown [default: every class of the labels]
    #[arg(long, value_delimiter = ',', value_name = "CLASSES")]
    classes: Vec<String>,
    /// The index that recognised: says of each missed sample what kept it from being reported, and in the report how well the others were
    /// performed
    #[arg(long, value_name = "INDEX")]
    index: Option<PathBuf>,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
    /// Write a page of HTML too, one file without outside links
    #[arg(long, value_name = "HTML")]
    report: Option<PathBuf>,
    #[command(flatten)]
    read: ReadArgs,
}

/// Runs the command.
pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    if let Some(path) = &args.report {
        output::check_ending(path, "a page of HTML", &["html", "htm"])?;
    }
    let labels = labels::read(&args.labels)?;
    let table =
        read_detections(&read(&args.found)?).with_context(|| args.found.display().to_string())?;
    warn(&args.labels, &labels.warnings);
    warn(&args.found, &table.warnings);
    let mut clips = lengths(&args.clips, &args.read)?;
    let unknown = lengths(&args.unknown, &args.read)?;
    let unknown_names: BTreeSet<String> = unknown.keys().cloned().collect();
    clips.extend(unknown);

    let resolved = labels.resolve(&clips);
    warn(&args.labels, &resolved.warnings);
    let cases = Cases::new(&clips, resolved, &unknown_names, &args.classes)?;
    cases
        .notes
        .iter()
        .for_each(|note| eprintln!("morec: {note}"));
    // Left-out clips keep their detections out, too, without a word for each.
    let (founds, strangers) = table.resolve(&clips);
    warn(&args.found, &strangers);
    let streams: BTreeSet<&str> = cases.streams.iter().map(|s| s.clip.as_str()).collect();
    let founds: Vec<_> = founds
        .into_iter()
        .filter(|f| streams.contains(f.clip.as_str()))
        .collect();

    let evaluation = Evaluation::of(&cases.streams, &cases.truths, &founds)?;
    let timelines = timelines(&cases.streams, &cases.truths, &founds)?;
    let (misses, performances) = match &args.index {
        Some(index) => args.explained(index, &cases, &founds, &timelines)?,
        None => Default::default(),
    };
    // Before anything is printed: whoever stops reading still gets the report.
    if let Some(path) = &args.report {
        let named = |path: &Path| path.display().to_string();
        let about = [
            ("labels".to_owned(), named(&args.labels)),
            ("detections".to_owned(), named(&args.found)),
        ];
        let title = "Detections against labels";
        let mut motion = ReportMotion::of(&timelines);
        motion.add_files(&args.clips, &args.read)?;
        motion.add_files(&args.unknown, &args.read)?;
        let reel = motion.into_reel();
        let report = Report {
            title,
            about: &about,
            evaluation: &evaluation,
            timelines: &timelines,
            training: &[],
            misses: &misses,
            performances: &performances,
            sensitivities: &[],
            perturbed: &[],
            motion: reel.as_ref(),
        };
        figures::write_report(path, &report)?;
    }
    let mut out = crate::console::stdout();
    if args.json {
        let missed = args.index.is_some().then_some(misses.as_slice());
        let evaluation = &evaluation;
        json::write_json(&mut out, &EvaluationMeasures { evaluation, missed })?;
    } else {
        figures::write_tables(&mut out, &evaluation)?;
        figures::write_misses(&mut out, &misses)?;
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

impl Args {
    /// Reasons why samples were missed; for a report, how well the others were performed. The clips are read once more, with their motion.
    fn explained(
        &self,
        index: &Path,
        cases: &Cases,
        founds: &[ClipDetection],
        timelines: &[Timeline],
    ) -> anyhow::Result<(Vec<Miss>, Vec<Performance>)> {
        let model = open_index(index)?.model;
        // What is left out was said when they were recognised.
        let paths = files::expand_all(&self.clips)?.clips;
        let clips = load_clips(&paths, &self.read, &ImportOptions::default())?;
        let misses_in = |loaded: &LoadedClip| {
            let clip = &loaded.clip;
            let here: Vec<&ClipDetection> = founds.iter().filter(|f| f.clip == clip.name).collect();
            let labelled: Vec<&GroundTruth> = cases
                .truths
                .iter()
                .filter(|t| t.clip == clip.name)
                .collect();
            let pairs = event_pairs(&labelled, &here);
            let missed = labelled.iter().zip(pairs).filter(|(_, p)| p.is_none());
            let sought: Vec<Mark<&str>> = missed.map(|(truth, _)| (*truth).into()).collect();
            let detected: Vec<Detection> =
                here.iter().filter_map(|f| detection(&model, f)).collect();
            let played = (&clip.clip, &clip.roles, &clip.rest);
            explain(&model, played, &sought, &detected)
        };
        let misses = clips.par_iter().flat_map_iter(misses_in).collect();
        let drawn = if self.report.is_some() {
            timelines
        } else {
            &[]
        };
        let performed = drawn.par_iter().flat_map_iter(|timeline| {
            let clip = clips.iter().find(|c| c.clip.name == timeline.stream.clip);
            clip.map_or_else(Vec::new, |loaded| performances(&model, loaded, timeline))
        });
        Ok((misses, performed.collect()))
    }
}

/// How well the motions of a clip were performed that were recognised rightly.
fn performances(model: &Model, loaded: &LoadedClip, timeline: &Timeline) -> Vec<Performance> {
    let right = timeline.founds.iter();
    let right = right.filter(|(_, verdict)| *verdict == DetectionVerdict::Right);
    let (named, detected): (Vec<&ClipDetection>, Vec<Detection>) = right
        .filter_map(|(found, _)| Some((found, detection(model, found)?)))
        .unzip();
    let clip = &loaded.clip;
    let deviations = deviation(model, (&clip.clip, &clip.roles, &clip.rest), &detected);
    let performance = |(found, deviation): (&ClipDetection, Option<_>)| {
        Some(Performance {
            clip: found.clip.clone(),
            class: found.class.clone(),
            span: found.span,
            deviation: deviation?,
        })
    };
    let named = named.into_iter().zip(deviations);
    named.filter_map(performance).collect()
}

/// A row of a table of detections, where the index knows its class.
fn detection(model: &Model, found: &ClipDetection) -> Option<Detection> {
    let class = model.classes().iter().position(|c| c.name == found.class)?;
    Some(Detection {
        class: ClassId(class as u16),
        span: found.span,
        score: found.score.unwrap_or_default(),
        reported_secs: found.reported_secs.unwrap_or(found.span.stop_secs),
        repetitions: None,
    })
}

/// Everything measured, for JSON.
#[derive(serde::Serialize)]
struct EvaluationMeasures<'a> {
    #[serde(flatten)]
    evaluation: &'a Evaluation,
    #[serde(skip_serializing_if = "Option::is_none")]
    missed: Option<&'a [Miss]>,
}

/// Streams to evaluate, and their samples.
#[derive(Debug)]
struct Cases {
    streams: Vec<StreamInfo>,
    truths: Vec<GroundTruth>,
    /// Omissions, for the person at the terminal.
    notes: Vec<String>,
}

impl Cases {
    /// Sorts clips into known, unknown and left out. `classes` empty: all count.
    fn new(
        clips: &BTreeMap<String, ClipLength>,
        resolved: Resolved,
        unknown: &BTreeSet<String>,
        classes: &[String],
    ) -> anyhow::Result<Self> {
        let labelled: BTreeSet<String> = resolved.samples.iter().map(|s| s.clip.clone()).collect();
        if let Some(class) = classes
            .iter()
            .find(|c| !resolved.samples.iter().any(|s| s.class == **c))
        {
            bail!("--classes names {class}, which no label of these clips has");
        }
        let mut notes = Vec::new();
        if !resolved.absent.is_empty() {
            let rows: usize = resolved.absent.values().sum();
            let names = some_of(resolved.absent.keys());
            notes.push(format!(
                "{rows} labels are of clips that --clips does not hold; left out: {names}"
            ));
        }
        let counts = |class: &str| classes.is_empty() || classes.iter().any(|c| c == class);
        let counted = resolved.samples.into_iter().filter(|s| counts(&s.class));
        let (lost, kept): (Vec<_>, Vec<_>) = counted.partition(|s| unknown.contains(&s.clip));
        if !lost.is_empty() {
            notes.push(format!(
                "{} labels lie in clips that --unknown names; left out",
                lost.len()
            ));
        }
        let truths: Vec<GroundTruth> = kept.into_iter().map(GroundTruth::from).collect();
        let known: BTreeSet<&str> = truths.iter().map(|t| t.clip.as_str()).collect();
        let (used, unlabelled): (Vec<_>, Vec<_>) = clips
            .iter()
            .partition(|(name, _)| labelled.contains(*name) || unknown.contains(*name));
        if !unlabelled.is_empty() {
            let names = some_of(unlabelled.iter().map(|(name, _)| *name));
            let count = unlabelled.len();
            notes.push(format!(
                "{count} clips have no label; left out (--unknown if they hold no class): {names}"
            ));
        }
        let streams = used.into_iter().map(|(name, length)| StreamInfo {
            clip: name.clone(),
            duration_secs: length.duration_secs(),
            unknown: !known.contains(name.as_str()),
        });
        let streams: Vec<StreamInfo> = streams.filter(|s| s.duration_secs > 0.0).collect();
        if streams.is_empty() {
            bail!(
                "nothing to measure: no label names any of the clips, and none is given with --unknown"
            );
        }
        Ok(Self {
            streams,
            truths,
            notes,
        })
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

#[cfg(test)]
mod tests {
    use super::*;

    fn cases(labels: &str, unknown: &[&str], classes: &[&str]) -> anyhow::Result<Cases> {
        let length = ClipLength {
            frames: 300,
            rate_hz: 30.0,
        };
        let clips: BTreeMap<String, ClipLength> =
            ["a", "b", "c"].map(|name| (name.to_owned(), length)).into();
        let resolved = morec::labels::Labels::read(labels.as_bytes())
            .unwrap()
            .resolve(&clips);
        let owned = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>();
        Cases::new(
            &clips,
            resolved,
            &owned(unknown).into_iter().collect(),
            &owned(classes),
        )
    }

    fn streams(cases: &Cases) -> Vec<(&str, bool)> {
        cases
            .streams
            .iter()
            .map(|s| (s.clip.as_str(), s.unknown))
            .collect()
    }

    const LABELS: &str = "clip\tclass\tstart\tstop\na\tx\t0\t30\nb\ty\t0\t30\nz\ty\t0\t30\n";

    #[test]
    fn clips_without_labels_are_left_out_unless_named_unknown() {
        let plain = cases(LABELS, &[], &[]).unwrap();
        assert_eq!(streams(&plain), [("a", false), ("b", false)]);
        assert!(
            plain.notes.iter().any(|n| n.ends_with("left out: z")),
            "{:?}",
            plain.notes
        );
        assert!(
            plain
                .notes
                .iter()
                .any(|n| n.starts_with("1 clips have no label")),
            "{:?}",
            plain.notes
        );
        let with_unknown = cases(LABELS, &["c", "b"], &[]).unwrap();
        assert_eq!(
            streams(&with_unknown),
            [("a", false), ("b", true), ("c", true)]
        );
        assert_eq!(with_unknown.truths.len(), 1);
        assert!(
            with_unknown
                .notes
                .iter()
                .any(|n| n.starts_with("1 labels lie in clips that --unknown"))
        );
    }

    #[test]
    fn a_clip_with_other_classes_only_is_unknown() {
        let only_x = cases(LABELS, &[], &["x"]).unwrap();
        assert_eq!(streams(&only_x), [("a", false), ("b", true)]);
        assert_eq!(only_x.truths.len(), 1);
        assert!(
            cases(LABELS, &[], &["walk"])
                .unwrap_err()
                .to_string()
                .contains("--classes names walk")
        );
    }

    #[test]
    fn nothing_to_measure_is_said() {
        assert!(
            cases("clip\tclass\nz\tx\n", &[], &[])
                .unwrap_err()
                .to_string()
                .contains("nothing to measure")
        );
    }
}
