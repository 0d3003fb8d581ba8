//! `morec crossval`: how good would an index be on what it has not seen.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::ValueEnum;
use morec::crossval::{By, Material, Outcome, crossval};
use morec::eval::{Evaluation, timelines};
use morec::labels::Sample;
use morec::report::{Report, TrainedClass};

use crate::figures;
use crate::material::MaterialArgs;
use crate::progress::Bar;

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
}

/// Runs the command.
pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let material = args.material.load(&args.unknown)?;
    let by = match args.by {
        Split::Half => By::Half { seed: args.seed },
        Split::Clip => By::Clip,
        Split::Person => By::Person,
    };
    let of = Material {
        clips: &material.clips,
        samples: &material.samples,
        classes: &material.classes,
        unknown: &material.unknown,
    };
    let outcome = crossval(&of, by, &args.material.recipe()?, &Bar::new())?;
    let evaluation = Evaluation::of(&outcome.streams, &outcome.truths, &outcome.founds)?;
    // Before anything is printed: whoever stops reading still gets the report.
    if let Some(folder) = &args.report {
        let timelines = timelines(&outcome.streams, &outcome.truths, &outcome.founds)?;
        let about = [
            ("labels".to_owned(), args.material.label_source()),
            ("left out".to_owned(), format!("{by:?}")),
        ];
        let training = trained_classes(&material.samples, &material.classes);
        let title = "Cross-validation";
        let report = Report {
            title,
            about: &about,
            evaluation: &evaluation,
            timelines: &timelines,
            training: &training,
        };
        figures::write_report(folder, &report)?;
    }
    let mut out = std::io::stdout().lock();
    if args.json {
        figures::write_json(&mut out, &evaluation)?;
    } else {
        figures::write_tables(&mut out, &evaluation)?;
        write_folds(&mut out, &outcome)?;
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
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
