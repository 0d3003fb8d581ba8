//! `morec db samples`: samples by number, listed, moved and removed.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use morec_db::MotionDb;
use morec_db::labels::{DbSample, SampleFilter, SampleId, SampleState};

use crate::database;
use crate::named::by_name;
use crate::print;
use crate::table::TextTable;

/// List samples by number, remove or move them
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db samples moves.mdb --clip take_1
  morec db samples moves.mdb --remove 12,15
  morec db samples moves.mdb --move 12 --start 1.2 --stop 2.4
  morec db classes moves.mdb --split 12 --into nod      # another class")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Samples of this clip
    #[arg(long, value_name = "CLIP")]
    clip: Option<String>,
    /// Samples of this class
    #[arg(long, value_name = "CLASS")]
    class: Option<String>,
    /// Samples in this state
    #[arg(long, value_parser = by_name(&SampleState::ALL, SampleState::name))]
    state: Option<SampleState>,
    /// Samples by this annotator
    #[arg(long, value_name = "NAME")]
    annotator: Option<String>,
    /// Remove these samples (numbers, separated by commas)
    #[arg(long, value_delimiter = ',', value_name = "NUMBERS")]
    remove: Vec<i64>,
    /// Move this sample to --start and --stop
    #[arg(
        long = "move",
        value_name = "NUMBER",
        requires = "start",
        requires = "stop",
        conflicts_with = "remove"
    )]
    moved: Option<i64>,
    /// Start, seconds
    #[arg(long, value_name = "SECS", requires = "moved")]
    start: Option<f64>,
    /// Stop, seconds
    #[arg(long, value_name = "SECS", requires = "moved")]
    stop: Option<f64>,
    /// List at most N
    #[arg(long, value_name = "N")]
    limit: Option<usize>,
    /// Print one JSON array
    #[arg(long)]
    json: bool,
}

/// Changes, then lists.
pub fn run(args: &Args) -> Result<ExitCode> {
    if !args.remove.is_empty() {
        return remove(args);
    }
    if let (Some(number), Some(start), Some(stop)) = (args.moved, args.start, args.stop) {
        let mut db = database::open(&args.db)?;
        db.move_sample(SampleId(number), start, stop, "user")?;
        return print(&[db.sample(SampleId(number))?], args.json);
    }
    let db = database::open_read_only(&args.db)?;
    let samples = db.samples(&filter(args, &db)?)?;
    let shown = samples.len().min(args.limit.unwrap_or(usize::MAX));
    print_some(&samples[..shown], samples.len(), args.json)
}

fn filter(args: &Args, db: &MotionDb) -> Result<SampleFilter> {
    if let Some(class) = &args.class {
        db.need_class(class)?;
    }
    let clip = args.clip.as_deref().map(|name| db.find_clip(name));
    Ok(SampleFilter {
        clip: clip.transpose()?.map(|info| info.id),
        class: args.class.clone(),
        state: args.state,
        annotator: args.annotator.clone(),
    })
}

fn remove(args: &Args) -> Result<ExitCode> {
    let mut db = database::open(&args.db)?;
    let there = db.samples(&SampleFilter::default())?;
    if let Some(number) = args
        .remove
        .iter()
        .find(|n| !there.iter().any(|s| s.id.0 == **n))
    {
        anyhow::bail!("sample {number} does not exist; nothing was removed");
    }
    let ids: Vec<SampleId> = args.remove.iter().copied().map(SampleId).collect();
    db.remove_samples(&ids)?;
    let removed: Vec<DbSample> = there.into_iter().filter(|s| ids.contains(&s.id)).collect();
    if !args.json {
        eprintln!("morec: removed:");
    }
    print(&removed, args.json)
}

/// The samples as a table, or as JSON.
pub fn print(samples: &[DbSample], json: bool) -> Result<ExitCode> {
    print_some(samples, samples.len(), json)
}

/// The same of some of a number.
fn print_some(samples: &[DbSample], all: usize, json: bool) -> Result<ExitCode> {
    if json {
        print::print_json(&samples)?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut table = TextTable::new([
        "clip",
        "number",
        "class",
        "start",
        "stop",
        "frames",
        "state",
        "score",
        "annotators",
        "by",
    ])
    .least(["by", "frames", "score", "annotators"]);
    for s in samples {
        let frames = s.frames();
        table.row([
            s.clip_name.clone(),
            s.id.0.to_string(),
            s.class.clone(),
            format!("{:.2}", s.start_secs),
            format!("{:.2}", s.stop_secs),
            format!("{}-{}", frames.start, frames.end),
            s.state.name().to_owned(),
            s.score
                .map_or_else(String::new, |score| format!("{score:.2}")),
            s.annotators.join(", "),
            s.set_by.clone(),
        ]);
    }
    print::print_table(&table, &print::counted(samples.len(), all, "samples"))?;
    Ok(ExitCode::SUCCESS)
}
