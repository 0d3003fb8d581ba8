//! `morec train`: trains an index from labelled clips.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context, Result};
use morec::index::MotionIndex;
use morec::labels::{ClassLengths, Sample, class_lengths};
use morec::train::TrainingReport;
use morec::train::thesis::SvrdmReport;
use morec_ops::KeptTraining;

use crate::database;
use crate::json::write_json;
use crate::material::{ClipMaterial, MaterialArgs};
use crate::output;
use crate::progress::StageBar;
use crate::table::TextTable;

/// Train an index from labelled clips.
///
/// Prints classes, background, thresholds and problems of the data. The background consists of the unlabelled parts of labelled
/// clips, the clips given with --background, and built-in everyday motion.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 trained; 1 reading or training failed; 2 wrong command line.\n\n\
    Example: morec train --clips takes/ --labels labels.tsv --background walks/ -o signs.index"
)]
pub struct Args {
    /// File to write the index to
    #[arg(short, long, value_name = "INDEX")]
    output: PathBuf,
    /// Print one JSON object: the training report
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    material: MaterialArgs,
}

/// Trains as `args` say, for an index that is to be written to `output`; returns what was learned, how, and from what.
pub fn trained(
    args: &MaterialArgs,
    output: &Path,
) -> Result<(MotionIndex, TrainingReport, ClipMaterial)> {
    let material = args.load(&[])?;
    // Before the work, not after it, and when it is known what is read.
    output::check_index(output)?;
    let (index, report) = args.settings.train(&material.data, &StageBar::new())?;
    Ok((index, report, material))
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let begun = Instant::now();
    let (index, report, material) = trained(&args.material, &args.output)?;
    let bytes = index.to_bytes()?;
    output::write_whole(&args.output, |out| out.write_all(&bytes))
        .with_context(|| args.output.display().to_string())?;
    if let Some(path) = &args.material.db {
        let name = args
            .output
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy();
        let mut db = database::open(path)?;
        db.store_index(&name, &bytes)?;
        let secs = begun.elapsed().as_secs_f64();
        let kept = KeptTraining::of(&report, secs, bytes.len());
        database::note_unkept(path, kept.keep(&mut db, &KeptTraining::title(&report)));
    }
    if args.json {
        let mut out = crate::console::stdout();
        write_json(&mut out, &report)?;
    } else {
        print_report(&report, bytes.len(), &material, &args.output);
    }
    Ok(ExitCode::SUCCESS)
}

fn print_report(report: &TrainingReport, bytes: usize, material: &ClipMaterial, output: &Path) {
    let lengths = class_lengths(material.data.samples.iter().map(Sample::length));
    let mut table = TextTable::new([
        "class", "samples", "people", "shortest", "median", "longest",
    ])
    .least(["shortest", "longest", "median"]);
    for class in &report.classes {
        let of_class = lengths.iter().find(|l| l.class == class.name);
        let secs = |secs: fn(&ClassLengths) -> f64| {
            of_class.map_or("–".to_owned(), |l| format!("{:.2} s", secs(l)))
        };
        table.row([
            class.name.clone(),
            class.samples.to_string(),
            class.people.to_string(),
            secs(|l| l.shortest_secs),
            secs(|l| l.median_secs),
            secs(|l| l.longest_secs),
        ]);
    }
    print!("{table}");
    println!("\nbones: {}", report.bones.join(", "));
    let secs: Vec<String> = report
        .background_secs
        .iter()
        .map(|(source, secs)| format!("{source} {secs:.0} s"))
        .collect();
    println!(
        "background: {}",
        if secs.is_empty() {
            "none".to_owned()
        } else {
            secs.join(", ")
        }
    );
    match &report.svrdm {
        None => print_templates(report),
        Some(svrdm) => print_svrdm(report, svrdm),
    }
    for note in &report.notes {
        println!("note: {note}");
    }
    let share = 100.0 * bytes as f64 / material.labelled_bytes.max(1) as f64;
    println!(
        "\n{}: {bytes} bytes, {share:.1} % of the labelled clips' files",
        output.display()
    );
}

fn print_templates(report: &TrainingReport) {
    if let Some(threshold) = report.threshold {
        let what = match report.judges_whole {
            true => "least score",
            false => "threshold",
        };
        println!("{what}: {threshold:.3}, set by {}", report.threshold_from);
    }
    let points: Vec<String> = report
        .operating
        .iter()
        .map(|p| format!("{} → {:.2}", p.alarms_per_minute, p.threshold))
        .collect();
    if !points.is_empty() {
        let of = if report.verified || report.judges_whole {
            "score"
        } else {
            "threshold"
        };
        println!("sensitivity, alarms a minute → {of}: {}", points.join(", "));
    }
    if let Some(held_out) = report.held_out {
        println!(
            "false alarms in background motion not used for the threshold: {:.2} a minute, in {:.0} minutes",
            held_out.per_minute, held_out.minutes
        );
    }
    let negatives: Vec<String> = report
        .negatives
        .iter()
        .map(|(source, n)| format!("{source} {n}"))
        .collect();
    println!(
        "hard negatives: {}",
        if negatives.is_empty() {
            "none".to_owned()
        } else {
            negatives.join(", ")
        }
    );
    let verified = if report.verified {
        "yes"
    } else {
        "no (needs 5 samples in half of the classes, 3 people, and background clips)"
    };
    println!("candidates verified: {verified}");
}

fn print_svrdm(report: &TrainingReport, svrdm: &SvrdmReport) {
    println!(
        "reduced to {} dimensions, which keep {:.1} % of the variance",
        svrdm.dims,
        100.0 * svrdm.quality
    );
    let unsure: Vec<String> = svrdm
        .unsure_signs
        .iter()
        .map(|s| format!("{:.0} %", 100.0 * s))
        .collect();
    println!(
        "samples whose sign is ambiguous, direction by direction: {}",
        unsure.join(", ")
    );
    let mut table = TextTable::new([
        "branch",
        "samples",
        "exemplars",
        "width",
        "width in the plane",
    ]);
    for branch in &svrdm.branches {
        table.row([
            branch.node.to_string(),
            format!("{} + {}", branch.samples[0], branch.samples[1]),
            format!("{} + {}", branch.exemplars[0], branch.exemplars[1]),
            format!("{:.4}", branch.sigma_full),
            format!("{:.4}", branch.sigma_reduced),
        ]);
    }
    print!("{table}");
    println!(
        "accepts from T = {:.2}, confidence {:.2}, set by {}",
        svrdm.accept, svrdm.min_confidence, report.threshold_from
    );
}
