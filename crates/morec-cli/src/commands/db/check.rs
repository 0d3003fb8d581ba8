//! `morec db check`: whether a database is whole.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use morec_db::MotionDb;

/// Read everything in a database and say what is wrong
#[derive(clap::Args)]
#[command(after_help = "Exit code 1 if anything is wrong.")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Checks and prints.
pub fn run(args: &Args) -> Result<ExitCode> {
    let health = MotionDb::open_read_only(&args.db)?.check()?;
    if args.json {
        super::print_json(&health)?;
    } else if health.faults.is_empty() {
        super::print(format_args!("whole: {} clips decoded\n", health.clips))?;
    } else {
        super::print(health.faults.join("\n") + "\n")?;
    }
    Ok(if health.faults.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
