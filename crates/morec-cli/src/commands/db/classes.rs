//! `morec db classes`: lists, renames, merges, splits and removes classes.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, bail};
use morec::labels::{ClassLengths, class_lengths};
use morec_db::MotionDb;
use morec_db::labels::{SampleFilter, SampleId, SampleState};

use super::samples;
use crate::database;
use crate::print;
use crate::table::TextTable;

/// List, rename, merge, split or remove classes
///
/// Every change can be undone: morec db undo DB.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db classes moves.mdb
  morec db classes moves.mdb --rename hopp hop
  morec db classes moves.mdb --merge hop,leap --into jump
  morec db classes moves.mdb --split 12,15,19 --into skip  # numbers: --samples
  morec db classes moves.mdb --forget 'group_*'")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Rename a class
    #[arg(long, num_args = 2, value_names = ["OLD", "NEW"])]
    rename: Vec<String>,
    /// Merge classes, separated by commas, into --into
    #[arg(long, value_delimiter = ',', value_name = "CLASSES", requires = "into")]
    merge: Vec<String>,
    /// Move samples (numbers, separated by commas) to --into
    #[arg(long, value_delimiter = ',', value_name = "NUMBERS", requires = "into")]
    split: Vec<i64>,
    /// Target class of --merge and --split, new or existing
    #[arg(long, value_name = "CLASS")]
    into: Option<String>,
    /// Remove a class and its samples; `*` any text, `?` one character
    #[arg(long, value_name = "CLASS|PATTERN")]
    forget: Option<String>,
    /// List the samples of this class with their numbers
    #[arg(long, value_name = "CLASS")]
    samples: Option<String>,
    /// Print one JSON array
    #[arg(long)]
    json: bool,
}

/// Changes, then lists.
pub fn run(args: &Args) -> Result<ExitCode> {
    let changes = [
        !args.rename.is_empty(),
        !args.merge.is_empty(),
        !args.split.is_empty(),
        args.forget.is_some(),
    ];
    let db = match changes.iter().filter(|c| **c).count() {
        0 => database::open_read_only(&args.db)?,
        1 => changed(args)?,
        _ => bail!("give one change at a time, so that each can be undone"),
    };
    if args.forget.is_some() && !args.json {
        return Ok(ExitCode::SUCCESS);
    }
    if let Some(class) = &args.samples {
        db.need_class(class)?;
        return samples_of(&db, class, args.json);
    }
    let classes = db.classes()?;
    if args.json {
        print::print_json(&classes)?;
        return Ok(ExitCode::SUCCESS);
    }
    let accepted = db.samples(&SampleFilter {
        state: Some(SampleState::Accepted),
        ..SampleFilter::default()
    })?;
    let lengths = class_lengths(accepted.iter().map(|s| {
        let secs = s.stop_secs - s.start_secs;
        (s.class.as_str(), s.subject.as_deref(), secs)
    }));
    let mut table = TextTable::new([
        "class", "samples", "people", "secs", "shortest", "median", "longest", "proposed",
        "rejected",
    ])
    .least([
        "rejected", "people", "secs", "proposed", "shortest", "longest", "median",
    ]);
    for class in &classes {
        let of_class = lengths.iter().find(|l| l.class == class.name);
        let secs = |secs: fn(&ClassLengths) -> f64| {
            of_class.map_or("–".to_owned(), |l| format!("{:.2}", secs(l)))
        };
        table.row([
            class.name.clone(),
            class.accepted.to_string(),
            of_class.map_or(0, |l| l.people).to_string(),
            format!("{:.1}", class.secs),
            secs(|l| l.shortest_secs),
            secs(|l| l.median_secs),
            secs(|l| l.longest_secs),
            class.proposed.to_string(),
            class.rejected.to_string(),
        ]);
    }
    print::print_table(&table, &format!("{} classes\n", classes.len()))?;
    Ok(ExitCode::SUCCESS)
}

fn changed(args: &Args) -> Result<MotionDb> {
    let mut db = database::open(&args.db)?;
    let into = args.into.as_deref().unwrap_or_default();
    if let [old, new] = args.rename.as_slice() {
        db.rename_class(old, new)?;
    } else if !args.merge.is_empty() {
        db.merge_classes(&args.merge, into)?;
    } else if let Some(pattern) = &args.forget {
        let (classes, samples) = db.remove_classes(pattern)?;
        if !args.json {
            print::print(format_args!(
                "removed: {classes} classes with {samples} samples\n"
            ))?;
        }
    } else {
        let ids: Vec<SampleId> = args.split.iter().copied().map(SampleId).collect();
        let moved = db.split_class(&ids, into)?;
        if moved < ids.len() {
            eprintln!(
                "morec: {moved} of {} samples moved; the others do not exist or have this class already",
                ids.len()
            );
        }
    }
    Ok(db)
}

fn samples_of(db: &MotionDb, class: &str, json: bool) -> Result<ExitCode> {
    let filter = morec_db::labels::SampleFilter {
        class: Some(class.to_owned()),
        ..Default::default()
    };
    let samples = db.samples(&filter)?;
    samples::print(&samples, json)?;
    Ok(ExitCode::SUCCESS)
}
