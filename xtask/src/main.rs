//! Tools of morec's developers: `cargo xtask --help`.

mod judge;
mod soak;

use std::process::ExitCode;

use clap::Parser;

/// Tools of morec's developers; no part of what is installed.
#[derive(Parser)]
#[command(name = "xtask")]
enum Tool {
    Judge(judge::Args),
    Soak(soak::Args),
}

fn main() -> ExitCode {
    let done = match Tool::parse() {
        Tool::Judge(args) => judge::run(&args),
        Tool::Soak(args) => soak::run(&args),
    };
    done.unwrap_or_else(|error| {
        eprintln!("xtask: {error:#}");
        ExitCode::FAILURE
    })
}
