//! `morec db vacuum`: returns unused space to the disk.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;

use crate::database;
use crate::print::{self, megabytes};

/// Return unused space to the disk
#[derive(clap::Args)]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Also drop feature rows; they are rebuilt when needed
    #[arg(long)]
    caches: bool,
    /// Also drop the history: earlier changes cannot be undone then
    #[arg(long)]
    history: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Shrinks it.
pub fn run(args: &Args) -> Result<ExitCode> {
    let mut db = database::open(&args.db)?;
    let before = db.summary()?.file_bytes;
    if args.history {
        db.forget_history()?;
    }
    db.vacuum(args.caches)?;
    let after = db.summary()?.file_bytes;
    if args.json {
        print::print_json(&serde_json::json!({ "bytes_before": before, "bytes_after": after }))?;
    } else {
        print::print(format_args!(
            "{} before, {} now\n",
            megabytes(before),
            megabytes(after)
        ))?;
    }
    Ok(ExitCode::SUCCESS)
}
