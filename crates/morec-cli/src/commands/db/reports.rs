//! `morec db reports`: reports of trainings, cross-validations and learning curves that a database keeps.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use morec_db::{MotionDb, ReportInfo};
use serde_json::{Value, json};

use crate::database;
use crate::dates;
use crate::output;
use crate::print;
use crate::table::TextTable;

/// List kept reports of training, cross-validation and learning curves, or write them as JSON
///
/// `train --db`, `crossval --db` and the studio keep them, the last hundred of each kind.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db reports moves.mdb
  morec db reports moves.mdb -o reports.json
  morec db reports moves.mdb --only 12 -o report.json")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Only the report of this number
    #[arg(long, value_name = "NUMBER")]
    only: Option<i64>,
    /// File to write the reports to, with their contents, as JSON
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print one JSON array
    #[arg(long)]
    json: bool,
}

/// Writes, then lists.
pub fn run(args: &Args) -> Result<ExitCode> {
    if let Some(path) = &args.output {
        output::check_ending(path, "JSON", &["json"])?;
    }
    let db = database::open_read_only(&args.db)?;
    let mut reports = db.reports()?;
    if let Some(only) = args.only {
        // An error for a number that is not there.
        db.report(only)?;
        reports.retain(|report| report.id == only);
    }
    if let Some(path) = &args.output {
        let whole = reports.iter().map(|report| contents(&db, report));
        let text = match (args.only, whole.collect::<Result<Vec<Value>>>()?) {
            (Some(_), mut one) => one.swap_remove(0),
            (None, all) => json!(all),
        };
        output::write_whole(path, |out| writeln!(out, "{text:#}"))
            .with_context(|| path.display().to_string())?;
    }
    if args.json {
        print::print_json(&reports)?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut table = TextTable::new(["report", "kind", "made", "result"]);
    for report in &reports {
        table.row([
            report.id.to_string(),
            report.kind.title().to_owned(),
            dates::to_the_second(report.made_secs),
            report.title.clone(),
        ]);
    }
    print::print_table(&table, &format!("{} reports\n", reports.len()))?;
    Ok(ExitCode::SUCCESS)
}

fn contents(db: &MotionDb, report: &ReportInfo) -> Result<Value> {
    Ok(json!({ "about": report, "report": db.report(report.id)? }))
}
