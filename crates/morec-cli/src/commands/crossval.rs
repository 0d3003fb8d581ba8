//! `morec crossval`: measures how well an index would recognise motion outside its training data.

mod curve;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use morec::templates::ALARM_RATES;
use morec_measure::crossval::{CrossvalData, FoldReport, Tests};
use morec_measure::eval::{Evaluation, MEASURED_OVERLAP, timelines};
use morec_measure::explain::Miss;
use morec_measure::perturb::Perturbation;
use morec_measure::report::{Report, TrainedClass};
use morec_ops::{
    CrossvalMeasures, CrossvalSettings, KeptCrossval, LeftOut, Method, MissedLabel, Unlearned,
    tested_together,
};

use crate::database;
use crate::figures;
use crate::json;
use crate::material::MaterialArgs;
use crate::motion::ReportMotion;
use crate::output;
use crate::progress::StageBar;
use crate::table::TextTable;

/// Cross-validate: train without a part of the labels, recognise that part, measure.
///
/// --by half trains on half of each class's samples and recognises all clips; --by clip and --by person leave out each
/// clip or person in turn. Prints what `morec evaluate` prints.
///
/// A clip can be given both as --background and as --unknown: it is tested in the folds that leave its person out, and is
/// background in the other folds.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 measured; 1 reading or training failed; 2 wrong command line.\n\n\
    Example: morec crossval --clips takes/ --labels labels.tsv --people people.tsv --by person --report report.html"
)]
pub struct Args {
    #[command(flatten)]
    material: MaterialArgs,
    #[command(flatten)]
    settings: CrossvalSettings,
    /// Test on these clips, each in the fold of its person
    ///
    /// The clips of --clips and --labels are then used for training only.
    #[arg(long, value_name = "DIR|CLIP", num_args = 1.., requires = "test_labels")]
    test: Vec<PathBuf>,
    /// Labels of --test, with a column person
    #[arg(long, value_name = "FILE|DIR", requires = "test")]
    test_labels: Option<PathBuf>,
    /// Test clips without any class: every detection is a false alarm
    ///
    /// Clips, folders, or file stems.
    #[arg(long, value_name = "DIR|CLIP", num_args = 1..)]
    unknown: Vec<PathBuf>,
    /// Print a learning curve instead: F1 by number of samples and people
    ///
    /// Cross-validates with 1, 2, 4 … samples of each class and with 1, 2, 4 … people, three random draws each, and with all
    /// samples.
    #[arg(long, conflicts_with_all = ["report", "perturb", "sensitivities", "samples"], help_heading = "Output")]
    curve: bool,
    /// Draw the curve as SVG
    #[arg(long, value_name = "SVG", requires = "curve", help_heading = "Output")]
    plot: Option<PathBuf>,
    /// Print one JSON object instead of tables
    #[arg(long, help_heading = "Output")]
    json: bool,
    /// Write a page of HTML too
    #[arg(long, value_name = "HTML", help_heading = "Output")]
    report: Option<PathBuf>,
}

/// Runs the command.
pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    if let Some(path) = &args.report {
        output::check_ending(path, "a page of HTML", &["html", "htm"])?;
    }
    if args.settings.by == LeftOut::Own && args.test.is_empty() {
        anyhow::bail!(
            "--by own tests each person in other clips: give these with --test and --test-labels"
        );
    }
    let material = args.material.load(&args.unknown)?;
    let tests = match &args.test_labels {
        Some(labels) => Some(args.material.load_tests(
            &args.test,
            labels,
            &material.data.classes,
        )?),
        None => None,
    };
    let of = CrossvalData {
        clips: &material.data.clips,
        samples: &material.data.samples,
        classes: &material.data.classes,
        unknown: &material.data.unknown,
        tests: tests.as_ref().map(|tests| Tests {
            clips: &tests.clips,
            samples: &tests.samples,
        }),
    };
    let mut settings = args.settings.clone();
    if settings.sensitivities.is_empty() && args.report.is_some() {
        settings.sensitivities = ALARM_RATES.to_vec();
    }
    // Before the minutes that it may take.
    let divided = settings.divided(&of)?;
    let mut out = crate::console::stdout();
    if !args.json {
        // Standard output may be closed; the report is still written.
        _ = writeln!(out, "Left out: {divided}\n").and_then(|()| out.flush());
    }
    if args.curve {
        let curve = settings.learning_curve(&of, &args.material.settings, &StageBar::new())?;
        if let Some(db) = &args.material.db {
            let kept = database::open(db).and_then(|mut db| curve.keep(&mut db));
            database::note_unkept(db, kept);
        }
        curve::write(&curve, args.plot.as_deref(), args.json, &mut out)?;
        return Ok(ExitCode::SUCCESS);
    }
    let measures = settings.crossval(&of, &args.material.settings, &StageBar::new())?;
    let (tested, evaluation) = (&measures.tested, &measures.evaluation);
    if let Some(db) = &args.material.db {
        database::note_unkept(db, keep(db, args, &of, &measures));
    }
    // Before anything is printed: a closed pipe does not lose the report.
    if let Some(path) = &args.report {
        let timelines = timelines(&tested.streams, &tested.truths, &tested.founds)?;
        let about = [
            ("labels".to_owned(), args.material.label_source()),
            ("left out".to_owned(), measures.divided.clone()),
        ];
        let mut motion = ReportMotion::of(&timelines);
        match &args.material.db {
            Some(db) => motion.add_db(&database::open_read_only(db)?)?,
            None => motion.add_files(&args.material.clips, &args.material.read)?,
        }
        motion.add_files(&args.test, &args.material.read)?;
        let reel = motion.into_reel();
        let report = Report {
            title: "Cross-validation",
            about: &about,
            evaluation,
            timelines: &timelines,
            training: &TrainedClass::count(&material.data.samples, &material.data.classes),
            misses: &tested.misses,
            performances: &[],
            sensitivities: &measures.sensitivities,
            perturbed: &measures.perturbed,
            motion: reel.as_ref(),
        };
        figures::write_report(path, &report)?;
    }
    if args.json {
        let named = |p: &(Perturbation, Evaluation)| PerturbedFigures {
            perturbation: p.0.to_string(),
            evaluation: p.1.clone(),
        };
        let at_rate = |s: &(f64, Evaluation)| SensitivityFigures {
            alarms_per_minute: s.0,
            evaluation: s.1.clone(),
        };
        let all = CrossvalJson {
            left_out: &measures.divided,
            evaluation,
            missed: &tested.misses,
            perturbed: measures.perturbed.iter().map(named).collect(),
            sensitivities: measures.sensitivities.iter().map(at_rate).collect(),
        };
        json::write_json(&mut out, &all)?;
    } else {
        figures::write_tables(&mut out, evaluation)?;
        figures::write_misses(&mut out, &tested.misses)?;
        write_sensitivities(&mut out, &measures.sensitivities)?;
        write_perturbed(&mut out, evaluation, &measures.perturbed)?;
        write_folds(&mut out, &measures.folds)?;
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

/// Keeps the report in the database.
fn keep(
    path: &Path,
    args: &Args,
    of: &CrossvalData<'_>,
    measures: &CrossvalMeasures,
) -> anyhow::Result<()> {
    let tested = &measures.tested;
    let unlearned = Unlearned::of_folds(args.settings.fold_by(), of.clips, of.samples);
    let kept = KeptCrossval {
        by: args.settings.by,
        thesis: args.material.settings.method == Method::Svrdm,
        untested: Vec::new(),
        streams: tested.streams.clone(),
        truths: tested.truths.clone(),
        founds: tested.founds.clone(),
        missed: tested.misses.iter().map(MissedLabel::from).collect(),
        folds: tested_together(unlearned),
    };
    kept.keep(&mut database::open(path)?, &measures.evaluation)?;
    Ok(())
}

/// Everything measured, for JSON.
#[derive(serde::Serialize)]
struct CrossvalJson<'a> {
    /// What was left out in turn.
    left_out: &'a str,
    #[serde(flatten)]
    evaluation: &'a Evaluation,
    missed: &'a [Miss],
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sensitivities: Vec<SensitivityFigures>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    perturbed: Vec<PerturbedFigures>,
}

/// The measures at another rate of false alarms.
#[derive(serde::Serialize)]
struct SensitivityFigures {
    alarms_per_minute: f64,
    evaluation: Evaluation,
}

/// The measures of copies that are worse in one way.
#[derive(serde::Serialize)]
struct PerturbedFigures {
    perturbation: String,
    evaluation: Evaluation,
}

fn write_sensitivities(
    out: &mut impl Write,
    sensitivities: &[(f64, Evaluation)],
) -> std::io::Result<()> {
    if sensitivities.is_empty() {
        return Ok(());
    }
    let mut table = TextTable::new([
        "sensitivity",
        "precision",
        "recall",
        "event F1",
        "alarms/min",
        "in unknown",
    ]);
    for (rate, e) in sensitivities {
        table.row(vec![
            rate.to_string(),
            figures::figure(e.events.precision),
            figures::figure(e.events.recall),
            figures::figure(e.events.f1),
            figures::figure(e.false_alarms.per_minute),
            figures::figure(e.unknown.per_minute),
        ]);
    }
    writeln!(
        out,
        "\nat other sensitivities (false alarms a minute in the background of training)"
    )?;
    write!(out, "{table}")
}

fn write_perturbed(
    out: &mut impl Write,
    clean: &Evaluation,
    perturbed: &[(Perturbation, Evaluation)],
) -> std::io::Result<()> {
    if perturbed.is_empty() {
        return Ok(());
    }
    let mut table = TextTable::new([
        "copy",
        "found",
        "event F1",
        "F1",
        "alarms/min",
        "delay",
        "accuracy",
    ]);
    let copies = perturbed.iter().map(|(p, e)| (p.to_string(), e));
    for (name, e) in std::iter::once(("as it is".to_owned(), clean)).chain(copies) {
        table.row(vec![
            name,
            format!("{} of {}", e.events.matched, e.totals.samples),
            figures::figure(e.events.f1),
            figures::figure(e.f1_at(MEASURED_OVERLAP)),
            figures::figure(e.false_alarms.per_minute),
            figures::secs(e.delay.median_secs),
            figures::figure(e.thesis.accuracy),
        ]);
    }
    writeln!(out, "\ncopies that are degraded in one way")?;
    write!(out, "{table}")
}

fn write_folds(out: &mut impl Write, folds: &[FoldReport]) -> std::io::Result<()> {
    writeln!(out, "\nTraining of each fold, by what was left out")?;
    for fold in folds {
        let training = &fold.training;
        let negatives: usize = training.negatives.values().sum();
        let accepted = match (training.threshold, &training.svrdm) {
            (Some(threshold), _) => format!("threshold {threshold:.3}"),
            (None, Some(svrdm)) => format!("least confidence {:.3}", svrdm.min_confidence),
            (None, None) => "no threshold".to_owned(),
        };
        writeln!(
            out,
            "  {}: {accepted} ({}), {negatives} hard negatives",
            fold.name, training.threshold_from
        )?;
        for note in &training.notes {
            writeln!(out, "    {note}")?;
        }
    }
    Ok(())
}
