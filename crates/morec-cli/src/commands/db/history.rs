//! `morec db history`, `undo` and `redo`: lists, undoes and redoes changes.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use morec_db::{Effect, ReplayedStep};

use crate::database;
use crate::dates;
use crate::print;
use crate::table::TextTable;

/// List the changes of a database, newest first
///
/// Every command that changes a database is one step: imports, labels, classes, cuts, descriptions, removals, indexes.
/// Undone steps are listed until the next change.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db history moves.mdb
  morec db undo moves.mdb               # the last step
  morec db undo moves.mdb 12 --dry-run  # what undoing step 12 would do
  morec db redo moves.mdb")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// List at most N steps
    #[arg(long, value_name = "N", default_value_t = 30)]
    limit: usize,
    /// Print one JSON array
    #[arg(long)]
    json: bool,
}

/// Arguments of `undo` and `redo`.
#[derive(clap::Args)]
pub struct TurnArgs {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Number of the step, from morec db history [default: the last]
    #[arg(value_name = "STEP")]
    step: Option<i64>,
    /// Only print what would change
    #[arg(long)]
    dry_run: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Lists.
pub fn run(args: &Args) -> Result<ExitCode> {
    let mut steps = database::open_read_only(&args.db)?.history()?;
    let all = steps.len();
    steps.truncate(args.limit);
    if args.json {
        print::print_json(&steps)?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut table = TextTable::new(["step", "when", "what", "rows", ""]).least(["when", "rows"]);
    for step in &steps {
        let rows: Vec<String> = step
            .rows
            .iter()
            .map(|(table, count)| format!("{table} {count}"))
            .collect();
        table.row([
            step.id.to_string(),
            dates::to_the_second(step.set_secs),
            step.what.clone(),
            rows.join(", "),
            if step.undone { "undone" } else { "" }.to_owned(),
        ]);
    }
    let more = match all - steps.len() {
        0 => String::new(),
        more => format!("; {more} earlier ones not shown (--limit)"),
    };
    print::print_table(&table, &format!("{all} steps{more}\n"))?;
    Ok(ExitCode::SUCCESS)
}

/// Takes a step back.
pub fn undo(args: &TurnArgs) -> Result<ExitCode> {
    let mut db = database::open(&args.db)?;
    let turned = match args.dry_run {
        true => db.preview_undo(args.step)?,
        false => db.undo(args.step)?,
    };
    let (done, would) = ("undone", "would be undone");
    say(
        args,
        turned.as_ref(),
        if args.dry_run { would } else { done },
    )
}

/// Does a step again.
pub fn redo(args: &TurnArgs) -> Result<ExitCode> {
    let mut db = database::open(&args.db)?;
    let turned = match args.dry_run {
        true => db.preview_redo(args.step)?,
        false => db.redo(args.step)?,
    };
    let (done, would) = ("redone", "would be redone");
    say(
        args,
        turned.as_ref(),
        if args.dry_run { would } else { done },
    )
}

fn say(args: &TurnArgs, turned: Option<&ReplayedStep>, done: &str) -> Result<ExitCode> {
    if args.json {
        print::print_json(&turned)?;
        return Ok(ExitCode::SUCCESS);
    }
    print::print(match turned {
        Some(turned) => text(turned, done),
        None => format!("no step can be {done}\n"),
    })?;
    Ok(ExitCode::SUCCESS)
}

/// `undone: step 4, rename bow to nod (classes: 1 changed)`.
pub fn text(turned: &ReplayedStep, done: &str) -> String {
    let effect = |e: &Effect| {
        let counts = [
            (e.back, "come back"),
            (e.gone, "gone"),
            (e.changed, "changed"),
        ];
        let counts = counts.into_iter().filter(|(count, _)| *count > 0);
        let counts: Vec<String> = counts.map(|(n, what)| format!("{n} {what}")).collect();
        format!("{}: {}", e.table, counts.join(", "))
    };
    let effects: Vec<String> = turned.effects.iter().map(effect).collect();
    format!(
        "{done}: step {}, {} ({})\n",
        turned.step.id,
        turned.step.what,
        effects.join("; ")
    )
}
