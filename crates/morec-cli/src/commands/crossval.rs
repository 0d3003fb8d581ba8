//! `morec crossval`: how good would an index be on what it has not seen.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::ValueEnum;
use morec::crossval::Tested;
use morec::crossval::{By, CrossvalOptions, Material, Outcome, Tests, crossval};
use morec::eval::{Evaluation, MEASURED_OVERLAP, timelines};
use morec::labels::Sample;
use morec::perturb::Perturbation;
use morec::report::{Report, TrainedClass};

use crate::figures;
use crate::material::{self, MaterialArgs};
use crate::progress::Bar;
use crate::table::Table;

/// Cross-validate: train without a part of the labels, recognise that part, and measure.
///
/// --by half trains on half of each class's samples (rounded up) and recognises all clips; --by clip and --by
/// person leave out one clip or person after the other. Prints what `morec evaluate` prints.
///
/// A clip may be named both as --background and as --unknown: it is then background except in the folds that leave
/// its person out, in which it is tested.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 measured; 1 something cannot be read or trained; 2 wrong command line.\n\n\
    Example: morec crossval --clips takes/ --labels labels.tsv --people people.tsv --by person --report out/"
)]
pub struct Args {
    #[command(flatten)]
    material: MaterialArgs,
    /// What is left out of training in turn
    #[arg(long, value_enum)]
    by: Split,
    /// Other clips to test on, each in the fold of its person; what --clips and --labels name then only teaches
    #[arg(long, value_name = "DIR|CLIP", num_args = 1.., requires = "test_labels")]
    test: Vec<PathBuf>,
    /// Labels of --test, with a column person
    #[arg(long, value_name = "TSV", requires = "test")]
    test_labels: Option<PathBuf>,
    /// Let at most N samples of each class teach, from its people in turn
    #[arg(long, value_name = "N")]
    samples: Option<usize>,
    /// Also test copies that are worse in one way each, separated by commas: white:METRES, slow:METRES, const:METRES,
    /// tilt:DEGREES, speed:FACTOR (of durations), drop:SHARE, repeat:SHARE, spikes:SHARE, cam:FACTOR, rate:HZ, mirror
    #[arg(long, value_delimiter = ',', value_name = "KIND:SIZE")]
    perturb: Vec<Perturbation>,
    /// Seed of the shuffle that halves the samples
    #[arg(long, default_value_t = 1, value_name = "N")]
    seed: u64,
    /// Clips or folders that hold none of the classes, also by file stem: what is recognised in them is a false
    /// alarm
    #[arg(long, value_name = "DIR|CLIP", num_args = 1..)]
    unknown: Vec<PathBuf>,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
    /// Write report.html, one file without outside links, into this folder
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
}

/// What is left out.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Split {
    /// Half of each class's samples
    Half,
    /// One clip after the other
    Clip,
    /// One person after the other
    Person,
    /// Nothing: each person teaches alone and is tested in their own clips of --test
    Own,
}

/// Runs the command.
pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    if args.by == Split::Own && args.test.is_empty() {
        anyhow::bail!(
            "--by own tests each person in other clips: name them with --test and --test-labels"
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
    let of = Material {
        clips: &material.data.clips,
        samples: &material.data.samples,
        classes: &material.data.classes,
        unknown: &material.unknown,
        tests: tests.as_ref().map(|tests| Tests {
            clips: &tests.data.clips,
            samples: &tests.data.samples,
        }),
    };
    let outcome = crossval(&of, &args.options(), &args.material.recipe()?, &Bar::new())?;
    let tested = &outcome.tested;
    let evaluation = Evaluation::of(&tested.streams, &tested.truths, &tested.founds)?;
    let perturbed = perturbed_figures(&outcome)?;
    // Before anything is printed: whoever stops reading still gets the report.
    if let Some(folder) = &args.report {
        args.write_report(folder, &material, tested, &evaluation)?;
    }
    let mut out = std::io::stdout().lock();
    if args.json {
        let all = Measured {
            evaluation: &evaluation,
            perturbed: &perturbed,
        };
        figures::write_json(&mut out, &all)?;
    } else {
        figures::write_tables(&mut out, &evaluation)?;
        write_perturbed(&mut out, &evaluation, &perturbed)?;
        write_folds(&mut out, &outcome)?;
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

impl Args {
    fn options(&self) -> CrossvalOptions {
        let by = match self.by {
            Split::Half => By::Half { seed: self.seed },
            Split::Clip => By::Clip,
            Split::Person => By::Person,
            Split::Own => By::Own,
        };
        CrossvalOptions {
            by,
            samples_per_class: self.samples,
            perturbations: self.perturb.clone(),
        }
    }

    fn write_report(
        &self,
        folder: &Path,
        material: &material::Material,
        tested: &Tested,
        evaluation: &Evaluation,
    ) -> anyhow::Result<()> {
        let timelines = timelines(&tested.streams, &tested.truths, &tested.founds)?;
        let about = [
            ("labels".to_owned(), self.material.label_source()),
            ("left out".to_owned(), format!("{:?}", self.options().by)),
        ];
        let training = trained_classes(&material.data.samples, &material.data.classes);
        let report = Report {
            title: "Cross-validation",
            about: &about,
            evaluation,
            timelines: &timelines,
            training: &training,
        };
        figures::write_report(folder, &report)?;
        Ok(())
    }
}

/// Everything measured, for JSON.
#[derive(serde::Serialize)]
struct Measured<'a> {
    #[serde(flatten)]
    evaluation: &'a Evaluation,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    perturbed: &'a [PerturbedFigures],
}

/// The measures of copies that are worse in one way.
#[derive(serde::Serialize)]
struct PerturbedFigures {
    perturbation: String,
    evaluation: Evaluation,
}

fn perturbed_figures(outcome: &Outcome) -> anyhow::Result<Vec<PerturbedFigures>> {
    let measured = outcome.perturbed.iter().map(|(perturbation, tested)| {
        let evaluation = Evaluation::of(&tested.streams, &tested.truths, &tested.founds)?;
        Ok(PerturbedFigures {
            perturbation: perturbation.to_string(),
            evaluation,
        })
    });
    measured.collect()
}

fn write_perturbed(
    out: &mut impl Write,
    clean: &Evaluation,
    perturbed: &[PerturbedFigures],
) -> std::io::Result<()> {
    if perturbed.is_empty() {
        return Ok(());
    }
    let mut table = Table::new([
        "copy",
        "accuracy",
        "F1",
        "event F1",
        "found",
        "alarms/min",
        "delay",
    ]);
    let copies = perturbed
        .iter()
        .map(|p| (p.perturbation.as_str(), &p.evaluation));
    for (name, e) in std::iter::once(("as it is", clean)).chain(copies) {
        table.row(vec![
            name.to_owned(),
            figures::figure(e.thesis.accuracy),
            figures::figure(e.f1_at(MEASURED_OVERLAP)),
            figures::figure(e.events.f1),
            format!("{} of {}", e.events.matched, e.totals.samples),
            figures::figure(e.false_alarms.per_minute),
            figures::secs(e.delay.median_secs),
        ]);
    }
    writeln!(out, "\ncopies that are worse in one way")?;
    write!(out, "{table}")
}

fn write_folds(out: &mut impl Write, outcome: &Outcome) -> std::io::Result<()> {
    writeln!(out, "\nTraining, by what was left out")?;
    for fold in &outcome.folds {
        let training = &fold.training;
        let negatives: usize = training.negatives.values().sum();
        writeln!(
            out,
            "  {}: threshold {:.3} ({}), {negatives} hard negatives",
            fold.name, training.threshold, training.threshold_from
        )?;
        for note in &training.notes {
            writeln!(out, "    {note}")?;
        }
    }
    Ok(())
}

/// How many samples and people each class has, for the report's notes.
pub fn trained_classes(samples: &[Sample], classes: &[String]) -> Vec<TrainedClass> {
    let known = samples.iter().any(|s| s.person.is_some());
    let counted = classes.iter().map(|class| {
        let of_class: Vec<&Sample> = samples.iter().filter(|s| s.class == *class).collect();
        let people: BTreeSet<&String> = of_class.iter().filter_map(|s| s.person.as_ref()).collect();
        TrainedClass {
            class: class.clone(),
            samples: of_class.len(),
            people: known.then_some(people.len()),
        }
    });
    counted.collect()
}
