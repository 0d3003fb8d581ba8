//! `cargo xtask judge`: recognition on every data set in every scenario, beside the last time.

mod draws;
mod measured;
mod sets;
mod trials;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use morec::classify::Classifier;
use morec::labels::{ClipDetection, GroundTruth, StreamInfo};
use morec::live::{Detection, Model, recognize_clip, recognize_poses};
use morec::train::{LabelSet, Recipe, StreamKind, TrainClip, TrainOptions, train_model};
use morec::{ClassId, TimeSpan};
use morec_measure::crossval::{Tested, perturbed};
use rayon::prelude::*;

use measured::{JudgeTable, beside, figures, from_tsv, to_tsv};
use sets::DataSets;
use trials::{Trial, TrialTest, trials};

/// Train and recognise on every data set that is there, in every scenario, and print one table.
///
/// Rows: the same person, one teacher and others, many teachers, by clip and by person, with and without background, worse copies,
/// "clips": cut clips of others, played as streams and classified as wholes; "silence" and "free motion": one teacher's index on motion
/// without its classes. Each figure is followed by its change since the
/// table before, which is kept in the folder of --out.
#[derive(clap::Args)]
#[command(
    after_help = "Columns: samples; precision, recall and F1 of events; F1 at half overlap; thesis accuracy; false alarms a minute; \
    calibration error; median delay in seconds; recall of the most probable detections with half a false alarm a minute.\n\n\
    Example: MOREC_DATA=../shared/data cargo xtask judge --only sessions"
)]
pub struct Args {
    /// Folder of the data sets [default: $MOREC_DATA or ../shared/data]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Only rows whose name contains this; may be repeated
    #[arg(long, value_name = "TEXT")]
    only: Vec<String>,
    /// One teacher's rows with five other draws of the samples that teach, too
    #[arg(long)]
    draws: bool,
    /// Folder of the tables
    #[arg(long, value_name = "DIR", default_value = "target/judge")]
    out: PathBuf,
    /// Keep the table under this name
    #[arg(long, default_value = "last")]
    name: String,
    /// Name of the table to compare with
    #[arg(long, default_value = "last")]
    against: String,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let began = Instant::now();
    let data = args.data.clone().unwrap_or_else(|| {
        std::env::var_os("MOREC_DATA").map_or_else(|| "../shared/data".into(), PathBuf::from)
    });
    let sets = DataSets::read(&data)?;
    let mut trials = trials(&sets);
    if args.draws {
        trials.extend(draws::draws(&sets));
    }
    let is_wanted = |row: &str| args.only.is_empty() || args.only.iter().any(|o| row.contains(o));
    for trial in &mut trials {
        trial.tests.retain(|t| is_wanted(&t.row));
    }
    trials.retain(|t| !t.tests.is_empty());
    if trials.is_empty() {
        bail!("no data set of these rows in {}", data.display());
    }
    let results: Vec<Vec<(String, Tested)>> =
        trials.par_iter().map(run_trial).collect::<Result<_>>()?;
    let mut rows = BTreeMap::<String, Tested>::new();
    for (row, tested) in results.into_iter().flatten() {
        let all = rows.entry(row).or_default();
        all.streams.extend(tested.streams);
        all.truths.extend(tested.truths);
        all.founds.extend(tested.founds);
    }
    let mut table = JudgeTable::new();
    for (row, tested) in rows {
        table.insert(row, figures(&tested)?);
    }
    std::fs::create_dir_all(&args.out)?;
    let path = |name: &str| args.out.join(name).with_extension("tsv");
    let before = std::fs::read_to_string(path(&args.against)).unwrap_or_default();
    print!("{}", beside(&table, &from_tsv(&before)));
    println!("{:.0} s", began.elapsed().as_secs_f64());
    let kept = path(&args.name);
    std::fs::write(&kept, to_tsv(&table)).with_context(|| kept.display().to_string())?;
    Ok(ExitCode::SUCCESS)
}

/// Trains and tests; gives what was found for the rows.
fn run_trial(trial: &Trial<'_>) -> Result<Vec<(String, Tested)>> {
    let as_kind = |source: StreamKind| {
        move |clip: &&TrainClip| TrainClip {
            source,
            ..(*clip).clone()
        }
    };
    let clips: Vec<TrainClip> = (trial.teachers.iter().map(as_kind(StreamKind::Labelled)))
        .chain(trial.background.iter().map(as_kind(StreamKind::Background)))
        .collect();
    let mut classes: Vec<String> = trial.lessons.iter().map(|s| s.class.clone()).collect();
    classes.sort();
    classes.dedup();
    let recipe = Recipe::from(TrainOptions::default());
    let labelling = LabelSet {
        samples: &trial.lessons,
        held_back: &trial.held_back,
        classes: &classes,
        unlabelled_is_background: recipe.unlabelled_is_background(),
    };
    let (model, _) = train_model(&clips, &labelling, &recipe, &())
        .with_context(|| format!("training by {}", trial.name))?;
    let tests = trial.tests.par_iter();
    tests
        .map(|test| Ok((test.row.clone(), run_test(&model, trial, test)?)))
        .collect()
}

fn run_test(model: &Model, trial: &Trial<'_>, test: &TrialTest<'_>) -> Result<Tested> {
    let clip = test.clip;
    let copy = test.copy.map(|copy| perturbed(clip, copy));
    let found = match &copy {
        Some(copy) => recognize_poses(model, &copy.poses)?,
        None if test.classified => classified(model, clip)?,
        None => recognize_clip(model, &clip.clip, &clip.roles, &clip.rest)?,
    };
    let in_copy = |secs: f64| copy.as_ref().map_or(secs, |c| c.secs_in_copy(secs));
    let name = format!("{} by {} in {}", clip.name, trial.name, test.row);
    let truth = |sample: &morec::labels::Sample| GroundTruth {
        clip: name.clone(),
        class: sample.class.clone(),
        span: sample.span.map(in_copy),
    };
    let detection = |d: &Detection| ClipDetection::new(&name, d.named(model));
    Ok(Tested {
        streams: vec![StreamInfo {
            clip: name.clone(),
            duration_secs: in_copy(clip.clip.duration_secs()),
            unknown: test.unknown,
        }],
        truths: test.truths.iter().map(truth).collect(),
        founds: found.iter().map(detection).collect(),
        misses: Vec::new(),
    })
}

/// The class of a whole clip as one detection.
fn classified(model: &Model, clip: &TrainClip) -> Result<Vec<Detection>> {
    let found = Classifier::new(model)?.classify(&clip.clip, &clip.roles, &clip.rest)?;
    let secs = clip.clip.duration_secs();
    let detection = |class: ClassId| Detection {
        class,
        span: TimeSpan::new(0.0, secs),
        score: found.probabilities[class.index()],
        reported_secs: secs,
        repetitions: None,
    };
    Ok(found.class.map(detection).into_iter().collect())
}
