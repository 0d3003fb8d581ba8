//! `morec db init`: creates an empty database.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::print;
use anyhow::Result;
use morec_db::{MotionDb, SCHEMA};

/// Create an empty database
#[derive(clap::Args)]
pub struct Args {
    /// File to create; it must not exist
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Makes it.
pub fn run(args: &Args) -> Result<ExitCode> {
    MotionDb::create(&args.db)?;
    if args.json {
        print::print_json(&serde_json::json!({ "path": args.db, "schema": SCHEMA }))?;
    } else {
        print::print(format_args!("{}: an empty database\n", args.db.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}
