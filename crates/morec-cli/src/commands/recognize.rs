//! `morec recognize`: recognises motions in clips, as in a live stream.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::ValueEnum;
use morec::features::all_bones_of_clip;
use morec::import::{ImportOptions, Take};
use morec::index::MotionIndex;
use morec::labels::{FOUND_HEADER, FoundLine, some_of};
use morec::live::{Detection, Model, PoseExtractor, RecognizerCache, recognize_clip_in_session};
use morec_live::vmc::Bundling;
use morec_measure::explain::{MotionDeviation, deviation};
use morec_ops::RecognizeSettings;

use super::send::bundling;
use crate::files::{ReadArgs, expand_as, mapping, open_planar, open_with, rate, read, say_doubts};
use crate::live::layout::LayoutArg;
use crate::live::network::NetworkArgs;
use crate::live::wire::recognise_over_vmc;
use crate::output::{self, Output};
use crate::progress::SlowProgress;
use crate::stats::Stats;
use morec_live::PlayableClip;

/// Recognise motions in clips, frame by frame as in a live stream.
///
/// Writes one line for each motion: clip, start, stop and reported_at in frames of the clip (stop exclusive), class,
/// score, and the times in seconds; if the index has activities, also the number of repetitions and the seconds of one.
///
/// Score: Probability that the detection is right, 0 to 1. The lowest accepted score is 0.05 to 0.44, depending on the index. For
/// held poses and indexes without calibration (svrdm, older files) it is the similarity to a sample instead.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 all clips done; 1 a file cannot be read (the others are done); 2 wrong command line.\n\n\
    Example: morec recognize signs.index new/ -o found.tsv\n         \
    cat take.bvh | morec recognize signs.index -"
)]
pub struct Args {
    /// Index file of `morec train`
    index: PathBuf,
    /// Clips, or folders of clips; - is standard input
    #[arg(required = true, value_name = "CLIP")]
    clips: Vec<PathBuf>,
    /// Format of detections
    #[arg(long, alias = "format", value_enum, default_value = "tsv")]
    form: OutputFormat,
    /// Add how each gesture differs from its nearest sample
    ///
    /// The mean angle, the pace, and the bone that differs most. Not for activities, held signs and the method of 2009.
    #[arg(long)]
    deviation: bool,
    /// File to write to [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print the speed of each stage on one core to standard error
    #[arg(long)]
    stats: bool,
    #[command(flatten)]
    settings: RecognizeSettings,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint`
    #[arg(hide_short_help = true, long, value_name = "FILE")]
    roles: Option<PathBuf>,
    /// Threads of recognition; detections are the same
    #[arg(hide_short_help = true, long, value_enum, default_value = "inline")]
    layout: LayoutArg,
    /// Recognise clips as if sent over VMC at N frames a second
    ///
    /// With the faults of --bundle, --loss, --reorder and --jitter.
    #[arg(long, value_name = "HZ", value_parser = rate)]
    over_vmc: Option<f64>,
    /// Bundling of VMC messages: whole, single or a number of bytes
    #[arg(hide_short_help = true, long, value_name = "whole|single|BYTES", default_value = "1500", value_parser = bundling)]
    bundle: Bundling,
    #[command(flatten)]
    conditions: NetworkArgs,
    #[command(flatten)]
    read: ReadArgs,
}

/// Forms of output.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputFormat {
    /// Tab-separated text with a header
    Tsv,
    /// One JSON object a line
    Jsonl,
}

/// Opens an index file; errors begin with its path.
pub fn open_index(path: &Path) -> Result<MotionIndex> {
    let bytes = read(path)?;
    MotionIndex::from_bytes(&bytes).with_context(|| path.display().to_string())
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let mut index = open_index(&args.index)?;
    index.model = args.settings.tuned(index.model)?;
    let mapping = mapping(args.roles.as_deref())?;
    let options = ImportOptions {
        mapping,
        ..ImportOptions::default()
    };
    let paths = expand_as(&args.clips, index.has_custom_roles())?;
    let form = (args.form, "a table of detections (--form)");
    let failed = write_rows(args.output.as_deref(), form, |out| {
        recognize_all(out, &paths, &index, &options, args)
    })?;
    Ok(if failed {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    })
}

/// Calls `write` with the file `path`, which replaces another only when all is written, or with standard output. `what` names the table
/// where the ending of `path` promises another format.
pub fn write_rows(
    path: Option<&Path>,
    (form, what): (OutputFormat, &str),
    write: impl FnOnce(&mut dyn Write) -> Result<bool>,
) -> Result<bool> {
    let Some(path) = path else {
        return write(&mut crate::console::stdout());
    };
    let shown = || path.display().to_string();
    let own = match form {
        OutputFormat::Tsv => ["tsv", "txt"],
        OutputFormat::Jsonl => ["jsonl", "json"],
    };
    output::check(path).with_context(shown)?;
    output::check_ending(path, what, &own)?;
    let mut out = Output::create(path).with_context(shown)?;
    let written = write(&mut out)?;
    out.finish().with_context(shown)?;
    Ok(written)
}

/// Writes what is found in every clip; gives whether one of them could not be read.
fn recognize_all(
    out: &mut dyn Write,
    paths: &[PathBuf],
    index: &MotionIndex,
    options: &ImportOptions,
    args: &Args,
) -> Result<bool> {
    if args.form == OutputFormat::Tsv {
        let repeated = if has_activities(index) {
            REPETITION_COLUMNS
        } else {
            ""
        };
        let deviation = if args.deviation {
            DEVIATION_COLUMNS
        } else {
            ""
        };
        writeln!(out, "{FOUND_HEADER}{repeated}{deviation}")?;
    }
    let mut stats = Stats::default();
    let mut failed = false;
    let mut without = Vec::new();
    let mut progress = SlowProgress::new(paths.len(), "recognising");
    let recognizers = RecognizerCache::new(&index.model);
    for path in paths {
        let found = recognize_file(path, index, &recognizers, options, args, &mut stats);
        let Some(found) = progress.step_of(found) else {
            failed = true;
            continue;
        };
        if found.is_empty() {
            without.push(path.display().to_string());
        }
        found
            .iter()
            .try_for_each(|f| write_found(out, args, f, index))?;
    }
    out.flush()?;
    drop(progress);
    if !without.is_empty() {
        let (count, all) = (without.len(), paths.len());
        let names = some_of(&without);
        eprintln!("morec: no motion was recognised in {count} of {all} files: {names}");
    }
    if args.stats {
        eprint!("{stats}");
    }
    Ok(failed)
}

/// A detection and what its line says of the clip.
struct FoundInClip {
    clip: String,
    rate_hz: f64,
    detection: Detection,
    deviation: Option<MotionDeviation>,
}

/// What an index with activities adds to a line.
const REPETITION_COLUMNS: &str = "\trepetitions\tperiod_secs";

/// What `--deviation` adds to a line.
const DEVIATION_COLUMNS: &str = "\toff_degrees\tpace\tworst_bone\tworst_degrees\tworst_secs";

fn has_activities(index: &MotionIndex) -> bool {
    matches!(&index.model, Model::Templates(model) if model.activities.is_some())
}

fn recognize_file(
    path: &Path,
    index: &MotionIndex,
    recognizers: &RecognizerCache,
    options: &ImportOptions,
    args: &Args,
    stats: &mut Stats,
) -> Result<Vec<FoundInClip>> {
    let shown = || path.display().to_string();
    let opened = stats.reading(|| match index.has_custom_roles() {
        true => open_planar(path, &args.read),
        false => open_with(path, &args.read, options.mapping.as_ref()),
    })?;
    let mut all = Vec::new();
    let takes = opened.into_takes(options).with_context(shown)?;
    say_doubts(path, &takes);
    for mut imported in takes {
        adapt(&mut imported, index, path, options.mapping.is_none());
        let found = match args.over_vmc {
            Some(rate_hz) => over_vmc(&imported, rate_hz, index, args)?,
            None => {
                let (clip, roles, rest) = (&imported.clip, &imported.roles, imported.rest());
                let found = stats.recognising(clip.frames, || match args.layout {
                    LayoutArg::Inline => Ok(recognizers.recognize_clip(clip, roles, rest)?),
                    layout => {
                        let options = layout.options();
                        recognize_clip_in_session(&index.model, clip, roles, rest, &options)
                    }
                });
                found.with_context(|| format!("{} ({})", shown(), clip.name))?
            }
        };
        let clip = &imported.clip;
        if args.stats {
            stats.stages(&index.model, &imported)?;
        }
        let deviations = match args.deviation {
            true => deviation(
                &index.model,
                (clip, &imported.roles, imported.rest()),
                &found,
            ),
            false => vec![None; found.len()],
        };
        let in_clip = |(detection, deviation)| FoundInClip {
            clip: clip.name.clone(),
            rate_hz: clip.rate_hz,
            detection,
            deviation,
        };
        all.extend(found.into_iter().zip(deviations).map(in_clip));
    }
    Ok(all)
}

fn over_vmc(
    imported: &Take,
    rate_hz: f64,
    index: &MotionIndex,
    args: &Args,
) -> Result<Vec<Detection>> {
    let loaded = PlayableClip::of(imported.clone(), Some(rate_hz))?;
    let (found, counts) = recognise_over_vmc(
        &index.model,
        &loaded,
        args.bundle,
        &args.conditions.accidents(),
    );
    if args.stats {
        eprintln!(
            "{}: {}",
            imported.clip.name,
            serde_json::to_string(&counts)?
        );
    }
    Ok(found)
}

/// Fills roles from the index's training clips, unless a mapping file has had its say, and says what stays missing.
pub fn adapt(imported: &mut Take, index: &MotionIndex, path: &Path, complete: bool) {
    if complete {
        index.complete_roles(&mut imported.roles, &imported.clip.skeleton);
    }
    if imported.clip.frames == 0 {
        return;
    }
    let (what, missing) = match &index.model {
        Model::Templates(_) => {
            let shown = all_bones_of_clip(&imported.clip, &imported.roles, imported.rest());
            ("bones", index.lacks(&imported.roles, shown).join(", "))
        }
        Model::Svrdm(_) => {
            // Without a root there is an error to come, which says more.
            let reader = PoseExtractor::new(&index.model, &imported.clip.skeleton, &imported.roles);
            (
                "joints",
                reader.map_or_else(
                    |_| String::new(),
                    |reader| reader.missing_pivots().join(", "),
                ),
            )
        }
    };
    if let Some(doubt) =
        index.heading_doubt(imported.roles.played().map(|(role, _)| role).collect())
    {
        eprintln!("morec: {}: {doubt}", path.display());
    }
    if !missing.is_empty() {
        eprintln!(
            "morec: {}: {what} of the index are missing in this clip and not used: {missing}",
            path.display()
        );
    }
}

fn write_found(
    out: &mut dyn Write,
    args: &Args,
    in_clip: &FoundInClip,
    index: &MotionIndex,
) -> std::io::Result<()> {
    let FoundInClip {
        clip,
        rate_hz,
        detection: found,
        deviation,
    } = in_clip;
    let line = FoundLine {
        clip,
        found: found.named(&index.model),
        rate_hz: *rate_hz,
    };
    match args.form {
        OutputFormat::Tsv => {
            write!(out, "{line}")?;
            match found.repetitions {
                Some(r) => write!(out, "\t{}\t{:.3}", r.count, r.period_secs)?,
                None if has_activities(index) => write!(out, "\t\t")?,
                None => (),
            }
            match deviation.as_ref().and_then(|d| Some((d, d.bones.first()?))) {
                Some((d, bone)) => writeln!(
                    out,
                    "\t{:.1}\t{:.2}\t{}\t{:.1}\t{:.2}",
                    d.off_degrees, d.pace, bone.bone, bone.worst_degrees, bone.worst_secs
                ),
                None if args.deviation => writeln!(out, "\t\t\t\t\t"),
                None => writeln!(out),
            }
        }
        OutputFormat::Jsonl => {
            let frame = |secs: f64| (secs * rate_hz).round() as u64;
            let mut object = serde_json::json!({
                "clip": clip, "start": frame(found.span.start_secs), "stop": frame(found.span.stop_secs), "class": line.found.class,
                "score": found.score, "reported_at": frame(found.reported_secs),
                "start_secs": found.span.start_secs, "stop_secs": found.span.stop_secs, "reported_secs": found.reported_secs,
            });
            if let Some(repeated) = found.repetitions {
                object["repetitions"] = repeated.count.into();
                object["period_secs"] = repeated.period_secs.into();
            }
            if let Some(deviation) = deviation {
                object["deviation"] = serde_json::to_value(deviation)?;
            }
            writeln!(out, "{object}")
        }
    }
}
