//! The command `morec`: parses the command line and runs the chosen command. Each command has a file in `commands`.

// First: its macros take the place of the standard library's in all files behind it.
#[macro_use]
mod console;

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
mod named;
mod output;
mod poses;
mod print;
mod progress;
mod show;
mod stats;
mod table;

use std::process::ExitCode;

use clap::{ArgAction, CommandFactory, Parser, Subcommand};

/// Index a motion-capture database, recognise its motions live.
#[derive(Parser)]
#[command(
    name = "morec",
    version = env!("MOREC_VERSION"),
    propagate_version = true,
    disable_help_flag = true,
    max_term_width = 80
)]
struct Cli {
    /// Print help
    #[arg(short, long, global = true, display_order = 998, action = ArgAction::HelpShort)]
    help: Option<bool>,
    /// Print help with all options and details
    #[arg(long, global = true, display_order = 999, action = ArgAction::HelpLong)]
    help_all: Option<bool>,
    #[command(subcommand)]
    command: Subcommands,
}

#[derive(Subcommand)]
enum Subcommands {
    Inspect(commands::inspect::Args),
    Convert(commands::convert::Args),
    Smooth(commands::smooth::Args),
    Play(commands::play::Args),
    Train(commands::train::Args),
    #[command(alias = "recognise")]
    Recognize(commands::recognize::Args),
    Classify(commands::classify::Args),
    Evaluate(commands::evaluate::Args),
    Agree(commands::agree::Args),
    Budget(commands::budget::Args),
    Crossval(commands::crossval::Args),
    Bench(commands::bench::Args),
    Cut(commands::cut::Args),
    Group(commands::group::Args),
    Discover(commands::discover::Args),
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
        Subcommands::Inspect(args) => commands::inspect::run(args),
        Subcommands::Convert(args) => commands::convert::run(args),
        Subcommands::Smooth(args) => commands::smooth::run(&args),
        Subcommands::Play(args) => commands::play::run(&args),
        Subcommands::Reproduce(args) => commands::reproduce::run(&args),
        Subcommands::Train(args) => commands::train::run(&args),
        Subcommands::Recognize(args) => commands::recognize::run(&args),
        Subcommands::Classify(args) => commands::classify::run(&args),
        Subcommands::Crossval(args) => commands::crossval::run(&args),
        Subcommands::Bench(args) => commands::bench::run(&args),
        Subcommands::Agree(args) => commands::agree::run(&args),
        Subcommands::Budget(args) => commands::budget::run(&args),
        Subcommands::Evaluate(args) => commands::evaluate::run(&args),
        Subcommands::Cut(args) => commands::cut::run(&args),
        Subcommands::Group(args) => commands::group::run(&args),
        Subcommands::Discover(args) => commands::discover::run(&args),
        Subcommands::Reduce(args) => commands::reduce::run(&args),
        Subcommands::Live(args) => commands::live::run(&args),
        Subcommands::Record(args) => commands::record::run(&args),
        Subcommands::Teach(args) => commands::teach::run(&args),
        Subcommands::Send(args) => commands::send::run(&args),
        Subcommands::Db(args) => commands::db::run(args),
        Subcommands::Demo(args) => commands::demo::run(&args),
        Subcommands::Completions(args) => commands::complete::completions(&args, Cli::command()),
        Subcommands::Man(args) => commands::complete::man(&args, Cli::command()),
        Subcommands::Studio(args) => commands::studio::run(&args),
    };
    match outcome.and_then(|code| console::finish().map(|()| code)) {
        Ok(code) => code,
        // The reader of our output has seen enough: no failure of ours.
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
mod advice;
#[cfg(test)]
mod studio_lines;
#[cfg(test)]
mod vocabulary;
