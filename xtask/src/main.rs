//! Tools of morec's developers: `cargo xtask --help`.

mod soak;

use std::process::ExitCode;

use clap::Parser;

/// Tools of morec's developers; no part of what is installed.
#[derive(Parser)]
#[command(name = "xtask")]
enum Tool {
    Soak(soak::Args),
}

fn main() -> ExitCode {
    let Tool::Soak(args) = Tool::parse();
    soak::run(&args).unwrap_or_else(|error| {
        eprintln!("xtask: {error:#}");
        ExitCode::FAILURE
    })
}
