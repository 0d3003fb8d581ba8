//! The program `morec-studio`.

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    morec_studio::run(&morec_studio::Args::parse())
}
