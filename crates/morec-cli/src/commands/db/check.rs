//! `morec db check`: whether a database is whole.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Result;
use morec_db::search::{NearCopy, SearchIndex, near_copies};
use morec_db::{ClipFilter, ClipId, Health, MotionDb};
use serde::Serialize;

use crate::progress::Bar;

/// Read everything in a database and say what is wrong
#[derive(clap::Args)]
#[command(after_help = "Exit code 1 if anything is wrong.")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Look for clips that are nearly others, mirror images among them
    #[arg(long)]
    copies: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Checked {
    #[serde(flatten)]
    health: Health,
    #[serde(skip_serializing_if = "Option::is_none")]
    copies: Option<Vec<Copy>>,
}

#[derive(Serialize)]
struct Copy {
    of: String,
    copy: String,
    start_secs: f64,
    stop_secs: f64,
    mirrored: bool,
    distance: f32,
}

/// Checks and prints.
pub fn run(args: &Args) -> Result<ExitCode> {
    let health = MotionDb::open_read_only(&args.db)?.check()?;
    let copies = if args.copies { Some(copies(&args.db)?) } else { None };
    let code = if health.faults.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    if args.json {
        super::print_json(&Checked { health, copies })?;
        return Ok(code);
    }
    match health.faults.as_slice() {
        [] => super::print(format_args!("whole: {} clips decoded\n", health.clips))?,
        faults => super::print(faults.join("\n") + "\n")?,
    }
    for copy in copies.iter().flatten() {
        let kind = if copy.mirrored { "the mirror image of" } else { "a near copy of" };
        let (start, stop) = (copy.start_secs, copy.stop_secs);
        let (a, b) = (&copy.copy, &copy.of);
        super::print(format_args!(
            "{a} is {kind} {b}, {start:.2} to {stop:.2} s (distance {:.4})\n",
            copy.distance
        ))?;
    }
    if copies.is_some_and(|c| c.is_empty()) {
        super::print("no clip is nearly another\n")?;
    }
    Ok(code)
}

fn copies(path: &Path) -> Result<Vec<Copy>> {
    let mut db = MotionDb::open_read_only(path)?;
    let index = SearchIndex::of_db(&mut db, &Bar::stoppable()?)?;
    let names: BTreeMap<ClipId, String> =
        db.clips(&ClipFilter::default())?.into_iter().map(|c| (c.id, c.name)).collect();
    let name = |id: ClipId| names.get(&id).cloned().unwrap_or_default();
    let copy = |c: NearCopy| Copy {
        of: name(c.of),
        copy: name(c.copy),
        start_secs: c.start_secs,
        stop_secs: c.stop_secs,
        mirrored: c.mirrored,
        distance: c.distance,
    };
    Ok(near_copies(&index).into_iter().map(copy).collect())
}
