//! `morec agree`: how far two annotators agree.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, anyhow, bail};
use morec::labels::{
    ClipDetection, ClipLength, GroundTruth, Labels, SharedClips, StreamInfo, some_of,
};
use morec_measure::eval::{ClassAgreement, Evaluation, Kappa, LabelAgreement, timelines};
use morec_measure::report::Report;

use crate::database;
use crate::figures::{self, figure};
use crate::files::ReadArgs;
use crate::json::write_json;
use crate::labels::{self, LabelArgs};
use crate::lengths::lengths_of;
use crate::output;
use crate::table::TextTable;

/// Measure how far two annotators agree
///
/// Compares the labels of two annotators, in two files, one file or a database, over the clips that both labelled. Prints Cohen's kappa by units of time, the event agreement beyond
/// chance (events match if they have the same class and overlap by half), and for each class the differences between starts and
/// stops of matching events.
///
/// Kappa depends on the length of the unit, which is printed with it. The chance agreement of events is the mean F1 after moving
/// the second annotator's events by random times.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec agree ann.tsv ben.tsv --clips clips/
  morec agree ann.eaf ben.eaf --tier gestures --time-unit 0.5
  morec agree boris_1.csv boris_2.csv --json
  morec agree both.tsv --annotators ann,ben          # by the column annotator
  morec agree moves.mdb

Exit codes: 0 compared; 1 a file cannot be read or no clip is
labelled by both annotators; 2 wrong command line.")]
pub struct Args {
    /// Labels of the first annotator, or of both, in any supported form
    ///
    /// Without B: a file with a column annotator, or a database whose labels have annotators.
    #[arg(value_name = "A|DB")]
    a: PathBuf,
    /// Labels of the second annotator
    #[arg(value_name = "B")]
    b: Option<PathBuf>,
    /// The two annotators in A, if it has labels of more
    #[arg(long, value_name = "A,B", value_delimiter = ',', conflicts_with = "b")]
    annotators: Vec<String>,
    /// The labelled clips, for frame rates and lengths
    ///
    /// Without this option, labels must be in seconds, and each clip ends with its last label.
    #[arg(long, value_name = "DIR|CLIP", num_args = 1..)]
    clips: Vec<PathBuf>,
    /// Length of the unit of time for kappa, seconds
    #[arg(long, value_name = "SECS", default_value_t = 0.1, value_parser = unit)]
    time_unit: f64,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
    /// Write a page of HTML too
    ///
    /// Timelines show the labels of both annotators; the second annotator's are drawn as detections.
    #[arg(long, value_name = "HTML")]
    report: Option<PathBuf>,
    #[command(flatten)]
    reading: LabelArgs,
    #[command(flatten)]
    read: ReadArgs,
}

fn unit(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(secs) if (0.001..=3600.0).contains(&secs) => Ok(secs),
        _ => Err("expected 0.001 to 3600 seconds".to_owned()),
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    if let Some(path) = &args.report {
        output::check_ending(path, "a page of HTML", &["html", "htm"])?;
    }
    let Both {
        labels,
        names,
        lengths,
    } = match &args.b {
        Some(b) => of_two_files(args, b)?,
        None => of_one(args)?,
    };
    let read = |name: &String, labels: &Labels| {
        let resolved = labels.resolve(&lengths);
        for warning in labels.warnings.iter().chain(&resolved.warnings) {
            eprintln!("morec: {name}: {warning}");
        }
        let samples = resolved.samples.into_iter().map(GroundTruth::from);
        samples.collect::<Vec<_>>()
    };
    let (mut a, mut b) = (read(&names[0], &labels[0]), read(&names[1], &labels[1]));
    let streams = shared_streams(&mut a, &mut b, &lengths)?;
    let agreement = LabelAgreement::of(&streams, &a, &b, args.time_unit)?;
    if let Some(path) = &args.report {
        let b: Vec<ClipDetection> = b.iter().map(ClipDetection::from).collect();
        let about = [("A", &names[0]), ("B", &names[1])]
            .map(|(letter, name)| (letter.to_owned(), name.clone()));
        let report = Report {
            title: "Labels of B against labels of A",
            about: &about,
            evaluation: &Evaluation::of(&streams, &a, &b)?,
            timelines: &timelines(&streams, &a, &b)?,
            training: &[],
            misses: &[],
            performances: &[],
            sensitivities: &[],
            perturbed: &[],
            motion: None,
        };
        figures::write_report(path, &report)?;
    }
    let mut out = crate::console::stdout();
    match args.json {
        true => write_json(&mut out, &agreement)?,
        false => write(&mut out, &agreement)?,
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

/// Labels of two annotators, what these are called, and the clips.
struct Both {
    labels: [Labels; 2],
    names: [String; 2],
    lengths: BTreeMap<String, ClipLength>,
}

fn of_two_files(args: &Args, b: &PathBuf) -> Result<Both> {
    let read = |path: &PathBuf| labels::read(path, &args.reading, &args.clips);
    let labels = [read(&args.a)?, read(b)?];
    let files = [(&args.a, &labels[0]), (b, &labels[1])];
    let lengths = lengths_of(&args.clips, &args.read, &files)?;
    Ok(Both {
        labels,
        names: [&args.a, b].map(|path| path.display().to_string()),
        lengths,
    })
}

/// Of a file or a database with the labels of both.
fn of_one(args: &Args) -> Result<Both> {
    let (all, lengths) = match database::only(std::slice::from_ref(&args.a))? {
        Some(path) => {
            let db = database::open_read_only(path)?;
            (labels::of_database(&db)?, database::lengths(&db)?)
        }
        None => {
            let all = labels::read(&args.a, &args.reading, &args.clips)?;
            let lengths = lengths_of(&args.clips, &args.read, &[(&args.a, &all)])?;
            (all, lengths)
        }
    };
    let names = two_annotators(args, &all)?;
    let of = |name: &String| Labels {
        rows: (all.rows.iter())
            .filter(|row| row.annotator.as_ref() == Some(name))
            .cloned()
            .collect(),
        warnings: Vec::new(),
    };
    for warning in &all.warnings {
        eprintln!("morec: {}: {warning}", args.a.display());
    }
    Ok(Both {
        labels: [of(&names[0]), of(&names[1])],
        names,
        lengths,
    })
}

/// The annotators that `--annotators` names, or else the only two of the labels.
fn two_annotators(args: &Args, all: &Labels) -> Result<[String; 2]> {
    let named = all.rows.iter().filter_map(|row| row.annotator.clone());
    let known: Vec<String> = named.collect::<BTreeSet<_>>().into_iter().collect();
    let found = || match known.is_empty() {
        true => "labels without an annotator".to_owned(),
        false => known.join(", "),
    };
    let path = args.a.display();
    if let Some(name) = args.annotators.iter().find(|name| !known.contains(name)) {
        bail!("{path}: expected labels by {name}, found {}", found());
    }
    let names = match args.annotators.is_empty() {
        true => known.clone(),
        false => args.annotators.clone(),
    };
    names.try_into().map_err(|names: Vec<String>| match args.annotators.is_empty() {
        true => anyhow!("{path}: expected labels by two annotators, found {}; name two with --annotators, or give a second file", found()),
        false => anyhow!("--annotators: expected two names, found {}", names.len()),
    })
}

/// The clips that both name; the labels of others are left out, which is printed.
fn shared_streams(
    a: &mut Vec<GroundTruth>,
    b: &mut Vec<GroundTruth>,
    lengths: &BTreeMap<String, ClipLength>,
) -> Result<Vec<StreamInfo>> {
    let shared = SharedClips::of(a, b, lengths);
    for (who, alone) in ["A", "B"].into_iter().zip(&shared.alone) {
        if !alone.is_empty() {
            let (count, names) = (alone.len(), some_of(alone));
            eprintln!("morec: {count} clips are labelled by {who} only and left out: {names}");
        }
    }
    if shared.streams.is_empty() {
        let [a, b] = shared.alone.map(|alone| alone.len());
        bail!("no clip is labelled by both annotators: A labels {a}, B labels {b} clips");
    }
    Ok(shared.streams)
}

fn write(out: &mut impl Write, agreement: &LabelAgreement) -> io::Result<()> {
    let LabelAgreement {
        clips,
        secs,
        unit_secs,
        time,
        events,
        ..
    } = agreement;
    let plural = if *clips == 1 { "" } else { "s" };
    writeln!(
        out,
        "{clips} clip{plural}, {secs:.1} s; {} events of A, {} of B, {} in common\n",
        events.of_a, events.of_b, events.matched
    )?;
    let Kappa {
        kappa,
        observed,
        chance,
        ..
    } = time;
    writeln!(
        out,
        "Cohen's kappa            {:>6}   units of {unit_secs} s: {} agree, {} by chance",
        figure(*kappa),
        figure(*observed),
        figure(*chance)
    )?;
    writeln!(
        out,
        "events beyond chance     {:>6}   F1 {}, {} by chance",
        figure(events.corrected),
        figure(events.f1),
        figure(events.chance)
    )?;
    let bounds = &events.boundaries;
    for (name, bias, apart, most) in [
        (
            "starts apart, median",
            bounds.start_median_secs,
            bounds.start_median_abs_secs,
            events.start_p90_secs,
        ),
        (
            "stops apart, median",
            bounds.stop_median_secs,
            bounds.stop_median_abs_secs,
            events.stop_p90_secs,
        ),
    ] {
        writeln!(
            out,
            "{name:<24} {:>6}   ms; 90 % within {} ms, B later by {} ms",
            millis(apart),
            millis(most),
            millis(bias)
        )?;
    }
    let mut table = TextTable::new([
        "class",
        "A",
        "B",
        "both",
        "kappa",
        "F1",
        "beyond chance",
        "starts ms",
        "stops ms",
    ]);
    for ClassAgreement {
        class,
        time,
        events,
    } in &agreement.classes
    {
        let bounds = &events.boundaries;
        table.row([
            class.clone(),
            events.of_a.to_string(),
            events.of_b.to_string(),
            events.matched.to_string(),
            figure(time.kappa),
            figure(events.f1),
            figure(events.corrected),
            millis(bounds.start_median_abs_secs),
            millis(bounds.stop_median_abs_secs),
        ]);
    }
    write!(out, "\n{table}")?;
    write_confusion(out, agreement)
}

/// The labels that differ most, in seconds of time.
fn write_confusion(out: &mut impl Write, agreement: &LabelAgreement) -> io::Result<()> {
    const SHOWN: usize = 10;
    let of = &agreement.confusion;
    let name = |k: usize| of.classes.get(k).map_or("no label", String::as_str);
    let mut differ: Vec<(usize, usize, usize)> = Vec::new();
    for (row, units) in of.units.iter().enumerate() {
        let others = units
            .iter()
            .enumerate()
            .filter(|(column, units)| *column != row && **units > 0);
        differ.extend(others.map(|(column, units)| (*units, row, column)));
    }
    if differ.is_empty() {
        return Ok(());
    }
    differ.sort_by(|a, b| b.0.cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    writeln!(out, "\nwhere they differ most")?;
    let mut table = TextTable::new(["A", "B", "seconds"]);
    for (units, row, column) in differ.into_iter().take(SHOWN) {
        let secs = units as f64 * agreement.unit_secs;
        table.row([
            name(row).to_owned(),
            name(column).to_owned(),
            format!("{secs:.1}"),
        ]);
    }
    write!(out, "{table}")
}

fn millis(secs: Option<f64>) -> String {
    secs.map_or_else(|| "–".to_owned(), |secs| format!("{:.0}", 1e3 * secs))
}
