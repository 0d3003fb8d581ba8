//! `morec db`: a database of motion in one file. One file per subcommand.

mod check;
mod classes;
mod clips;
mod copies;
mod cycles;
mod export;
mod history;
mod import;
mod indexes;
mod info;
mod init;
mod label;
pub mod page;
mod propose;
mod report;
mod samples;
mod search;
mod strip;
mod vacuum;

use std::io::{IsTerminal, Write};
use std::process::ExitCode;

use anyhow::Result;
use clap::Subcommand;
use morec::labels::ClipLength;
use morec_db::exchange::ClipLengths;
use morec_db::{ClipFilter, ClipInfo, DbError, MotionDb};
use serde::Serialize;

use crate::figures::write_json;
use crate::table::TextTable;

/// Keep clips, cuts, classes and labels in one file, and search them
///
/// One program writes to a database at a time, any number read beside it. A crash loses nothing that was said to be done.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db init moves.mdb
  morec db import moves.mdb recordings/ --licence CC-BY
  morec db label moves.mdb labels.tsv
  morec db search moves.mdb walk_01 --start 1 --stop 2")]
pub struct Args {
    #[command(subcommand)]
    command: DbCommand,
}

#[derive(Subcommand)]
enum DbCommand {
    Init(init::Args),
    Import(import::Args),
    Info(info::Args),
    Clips(clips::Args),
    #[command(hide = true)]
    Cut(crate::commands::cut::Args),
    Cycles(cycles::Args),
    #[command(hide = true)]
    Group(crate::commands::group::Args),
    Classes(classes::Args),
    Label(label::Args),
    Samples(samples::Args),
    Search(search::Args),
    Propose(propose::Args),
    Indexes(indexes::Args),
    History(history::Args),
    /// Take a change back: the last one, or a named step
    Undo(history::TurnArgs),
    /// Do again what was taken back
    Redo(history::TurnArgs),
    Export(export::Args),
    Report(report::Args),
    Check(check::Args),
    Vacuum(vacuum::Args),
}

/// Exit code of a command that was told to stop by Ctrl-C.
const STOPPED: u8 = 130;

/// Does what was asked.
pub fn run(args: Args) -> Result<ExitCode> {
    match of(args) {
        Err(error) if matches!(error.downcast_ref(), Some(DbError::Cancelled)) => {
            eprintln!("morec: stopped; the database is as it was before");
            Ok(STOPPED.into())
        }
        other => other,
    }
}

fn of(args: Args) -> Result<ExitCode> {
    match args.command {
        DbCommand::Init(args) => init::run(&args),
        DbCommand::Import(args) => import::run(&args),
        DbCommand::Info(args) => info::run(&args),
        DbCommand::Clips(args) => clips::run(&args),
        DbCommand::Cut(args) => crate::commands::cut::run_stored(&args),
        DbCommand::Cycles(args) => cycles::run(&args),
        DbCommand::Group(args) => crate::commands::group::run_stored(&args),
        DbCommand::Classes(args) => classes::run(&args),
        DbCommand::Label(args) => label::run(&args),
        DbCommand::Samples(args) => samples::run(&args),
        DbCommand::Search(args) => search::run(&args),
        DbCommand::Propose(args) => propose::run(&args),
        DbCommand::Report(args) => report::run(&args),
        DbCommand::Indexes(args) => indexes::run(&args),
        DbCommand::History(args) => history::run(&args),
        DbCommand::Undo(args) => history::undo(&args),
        DbCommand::Redo(args) => history::redo(&args),
        DbCommand::Export(args) => export::run(&args),
        DbCommand::Check(args) => check::run(&args),
        DbCommand::Vacuum(args) => vacuum::run(&args),
    }
}

/// The lengths of all clips by name.
fn lengths(db: &MotionDb) -> Result<ClipLengths> {
    let length = |c: ClipInfo| {
        (
            c.name,
            ClipLength {
                frames: c.frames,
                rate_hz: c.rate_hz,
            },
        )
    };
    Ok(db
        .clips(&ClipFilter::default())?
        .into_iter()
        .map(length)
        .collect())
}

/// One value as JSON on standard output.
pub fn print_json(value: &impl Serialize) -> Result<()> {
    let mut out = std::io::stdout().lock();
    write_json(&mut out, value)?;
    out.flush()?;
    Ok(())
}

/// Text on standard output.
pub fn print(text: impl std::fmt::Display) -> Result<()> {
    let mut out = std::io::stdout().lock();
    write!(out, "{text}")?;
    out.flush()?;
    Ok(())
}

/// A table that fits the terminal, and a last line below it. Whoever reads it through a pipe gets all of it, separated by
/// tabs, and the last line on standard error.
pub fn print_table(table: &TextTable, last: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    if std::io::stdout().is_terminal() {
        let width = terminal_size::terminal_size().map_or(80, |(width, _)| usize::from(width.0));
        write!(out, "{}{last}", table.fitted(width))?;
    } else {
        write!(out, "{}", table.tabbed())?;
        eprint!("{last}");
    }
    out.flush()?;
    Ok(())
}

/// `12.3 MB`.
fn megabytes(bytes: u64) -> String {
    match bytes {
        0..10_000 => format!("{:.1} kB", bytes as f64 / 1e3),
        10_000..1_000_000 => format!("{:.0} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

/// A share on the command line.
pub fn share(text: &str) -> std::result::Result<f64, String> {
    let value: f64 = text
        .parse()
        .map_err(|_| "expected a number from 0 to 1".to_owned())?;
    if (0.0..=1.0).contains(&value) {
        Ok(value)
    } else {
        Err("expected a number from 0 to 1".to_owned())
    }
}
