//! `morec db info`: prints the size and content of a database.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use morec_db::DbSummary;

use crate::database;
use crate::print::{self, megabytes};

/// Print the contents of a database in numbers
#[derive(clap::Args)]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Remove the entries of files that could not be read
    #[arg(long)]
    forget_refused: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Counts and prints.
pub fn run(args: &Args) -> Result<ExitCode> {
    if args.forget_refused {
        database::open(&args.db)?.forget_refused()?;
    }
    let summary = database::open_read_only(&args.db)?.summary()?;
    if args.json {
        print::print_json(&summary)?;
    } else {
        print::print(text(&summary))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn text(s: &DbSummary) -> String {
    let ratio = |bytes: u64| match bytes {
        0 => String::new(),
        bytes => format!(" (1:{:.1})", s.source_bytes as f64 / bytes as f64),
    };
    let (angle, mm) = (s.max_angle_rad.to_degrees(), 1e3 * s.max_position_metres);
    format!(
        "clips      {} of {} files, {} skeletons, {:.1} min; {} files refused\n\
         size       {}{} for {} of clip files; motion {}{}, feature rows {}{}\n\
         motion     at most {angle:.2} degrees and {mm:.1} mm from the files'\n\
         labels     {} classes, {} samples, {} proposed, {} rejected\n\
         cuts       {} segments\n\
         indexes    {}\n",
        s.clips,
        s.files,
        s.skeletons,
        s.secs / 60.0,
        s.refused,
        megabytes(s.file_bytes),
        ratio(s.file_bytes),
        megabytes(s.source_bytes),
        megabytes(s.motion_bytes),
        ratio(s.motion_bytes),
        megabytes(s.row_bytes),
        ratio(s.row_bytes),
        s.classes,
        s.accepted,
        s.proposed,
        s.rejected,
        s.segments,
        s.indexes,
    )
}
