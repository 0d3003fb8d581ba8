//! `morec group`: groups similar samples or segments and compares the groups with the classes.

mod args;
mod files;
mod members;
mod posed;
mod stored;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, bail};

pub use args::Args;

use crate::database;

/// Groups samples of clips or of a database.
pub fn run(args: &Args) -> Result<ExitCode> {
    let inputs: Vec<PathBuf> = args.inputs.iter().chain(&args.clips).cloned().collect();
    match (database::only(&inputs)?, args.settings.method) {
        (Some(db), _) => stored::run(db, args),
        (None, method) if method.looks_at_poses() => posed::run(&inputs, args),
        (None, _) => files::run(&inputs, args),
    }
}

/// The spelling of old, `morec db group`.
pub fn run_stored(args: &Args) -> Result<ExitCode> {
    eprintln!("morec: `morec db group` is `morec group` now");
    match args.inputs.as_slice() {
        [db] => stored::run(db, args),
        _ => bail!("expected one database"),
    }
}
