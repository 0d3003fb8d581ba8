//! The command `morec`: what was typed becomes arguments, each command's file does the rest.

mod commands;
mod database;
mod dates;
mod figures;
mod files;
mod interrupt;
mod json;
mod labels;
mod lengths;
mod live;
mod material;
mod motion;
mod output;
mod poses;
mod progress;
mod show;
mod stats;
mod table;

use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

/// Index a motion-capture database, recognise its motions live.
#[derive(Parser)]
#[command(
    name = "morec",
    version = env!("MOREC_VERSION"),
    propagate_version = true,
    max_term_width = 100
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Inspect(commands::inspect::Args),
    Convert(commands::convert::Args),
    Smooth(commands::smooth::Args),
    Play(commands::play::Args),
    Train(commands::train::Args),
    Recognize(commands::recognize::Args),
    Evaluate(commands::evaluate::Args),
    Crossval(commands::crossval::Args),
    Cut(commands::cut::Args),
    Group(commands::group::Args),
    Reduce(commands::reduce::Args),
    Reproduce(commands::reproduce::Args),
    Live(commands::live::Args),
    Record(commands::record::Args),
    Teach(commands::teach::Args),
    Send(commands::send::Args),
    Db(commands::db::Args),
    Demo(commands::demo::Args),
    Completions(commands::complete::Completions),
    Man(commands::complete::Man),
    Studio(commands::studio::Args),
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let outcome = match cli.command {
        Command::Inspect(args) => commands::inspect::run(args),
        Command::Convert(args) => commands::convert::run(args),
        Command::Smooth(args) => commands::smooth::run(&args),
        Command::Play(args) => commands::play::run(&args),
        Command::Reproduce(args) => commands::reproduce::run(&args),
        Command::Train(args) => commands::train::run(&args),
        Command::Recognize(args) => commands::recognize::run(&args),
        Command::Crossval(args) => commands::crossval::run(&args),
        Command::Evaluate(args) => commands::evaluate::run(&args),
        Command::Cut(args) => commands::cut::run(&args),
        Command::Group(args) => commands::group::run(&args),
        Command::Reduce(args) => commands::reduce::run(&args),
        Command::Live(args) => commands::live::run(&args),
        Command::Record(args) => commands::record::run(&args),
        Command::Teach(args) => commands::teach::run(&args),
        Command::Send(args) => commands::send::run(&args),
        Command::Db(args) => commands::db::run(args),
        Command::Demo(args) => commands::demo::run(&args),
        Command::Completions(args) => commands::complete::completions(&args, Cli::command()),
        Command::Man(args) => commands::complete::man(&args, Cli::command()),
        Command::Studio(args) => commands::studio::run(&args),
    };
    match outcome {
        Ok(code) => code,
        // Whoever reads our output has seen enough: that is not a failure of ours.
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("morec: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<std::io::Error>())
        .any(|io| io.kind() == std::io::ErrorKind::BrokenPipe)
}

#[cfg(test)]
mod vocabulary;
