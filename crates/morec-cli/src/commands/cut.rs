//! `morec cut`: finds where behaviours change, in clips or in a database.

mod args;
mod files;
mod stored;

use std::process::ExitCode;

use anyhow::{Result, bail};

pub use args::Args;

use crate::database;

/// Cuts clips, or the clips of a database.
pub fn run(args: &Args) -> Result<ExitCode> {
    match database::only(&args.inputs)? {
        Some(db) => stored::run(db, args),
        None if args.clip.is_some() => bail!("--clip chooses clips of a database"),
        None => files::run(args),
    }
}

/// The spelling of old, `morec db cut`.
pub fn run_stored(args: &Args) -> Result<ExitCode> {
    eprintln!("morec: `morec db cut` is `morec cut` now");
    match args.inputs.as_slice() {
        [db] => stored::run(db, args),
        _ => bail!("expected one database"),
    }
}
