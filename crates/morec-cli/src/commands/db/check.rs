//! `morec db check`: checks a database for damage.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use morec_db::Health;
use morec_ops::CopiedClip;
use serde::Serialize;

use crate::database;
use crate::print;
use crate::progress::StageBar;

/// Check everything in a database
#[derive(clap::Args)]
#[command(after_help = "Exit code 1 if anything is wrong.")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Also find near-duplicates, mirrored ones too
    #[arg(long)]
    copies: bool,
    /// Rebuild feature rows and checksums, then check
    ///
    /// The tables themselves are accepted unchanged.
    #[arg(long)]
    repair: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Checked {
    #[serde(flatten)]
    health: Health,
    #[serde(skip_serializing_if = "Option::is_none")]
    copies: Option<Vec<CopiedClip>>,
}

/// Checks and prints.
pub fn run(args: &Args) -> Result<ExitCode> {
    if args.repair {
        let made = database::open(&args.db)?.repair(&StageBar::new())?;
        eprintln!("morec: feature rows of {made} clips rebuilt");
    }
    let health = database::open_read_only(&args.db)?.check()?;
    let copies = match args.copies {
        true => Some(CopiedClip::among(
            &mut database::open_read_only(&args.db)?,
            None,
            &StageBar::stoppable()?,
        )?),
        false => None,
    };
    let code = if health.faults.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    };
    if args.json {
        print::print_json(&Checked { health, copies })?;
        return Ok(code);
    }
    match health.faults.as_slice() {
        [] => print::print(format_args!(
            "whole: {} clips decoded, {} with feature rows, {} indexes\n",
            health.clips, health.rows, health.indexes
        ))?,
        faults => print::print(faults.join("\n") + "\n")?,
    }
    for copy in copies.iter().flatten() {
        print::print(format_args!("{copy}\n"))?;
    }
    if copies.is_some_and(|c| c.is_empty()) {
        print::print("no near-duplicates\n")?;
    }
    Ok(code)
}
