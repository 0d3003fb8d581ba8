//! `morec db`: a database of motion in one file. One file per subcommand.

mod check;
mod classes;
mod clips;
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
mod reports;
mod samples;
mod search;
mod strip;
mod vacuum;
mod words;

use std::process::ExitCode;

use anyhow::Result;
use clap::Subcommand;
use morec_db::DbError;

use crate::interrupt::STOPPED;

/// Keep clips, cuts, classes and labels in one file, and search them
///
/// One program can write at a time, any number can read. A crash loses nothing that was reported as done.
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
    /// Undo the last change, or a numbered step
    Undo(history::TurnArgs),
    /// Redo what was undone
    Redo(history::TurnArgs),
    Export(export::Args),
    Report(report::Args),
    Reports(reports::Args),
    Check(check::Args),
    Vacuum(vacuum::Args),
}

/// Does what was asked.
pub fn run(args: Args) -> Result<ExitCode> {
    match of(args) {
        Err(error) if matches!(error.downcast_ref(), Some(DbError::Cancelled)) => {
            eprintln!("morec: stopped; the database is unchanged");
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
        DbCommand::Reports(args) => reports::run(&args),
        DbCommand::Indexes(args) => indexes::run(&args),
        DbCommand::History(args) => history::run(&args),
        DbCommand::Undo(args) => history::undo(&args),
        DbCommand::Redo(args) => history::redo(&args),
        DbCommand::Export(args) => export::run(&args),
        DbCommand::Check(args) => check::run(&args),
        DbCommand::Vacuum(args) => vacuum::run(&args),
    }
}
