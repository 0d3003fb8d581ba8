//! `morec studio`: starts the window, if it is installed.

use std::ffi::OsString;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::{Command, ExitCode};

use anyhow::{Context, Result, bail};

/// The program of the window.
const PROGRAM: &str = "morec-studio";

/// Open the studio: view, label, train and recognise in a window
///
/// The window is the program `morec-studio`, started from the folder of this command or from the search path.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: those of morec-studio; 1 if it is not installed.\n\n\
    Examples:\n  morec studio\n  morec studio moves.mdb\n  morec studio takes/ walk.bvh"
)]
pub struct Args {
    /// A database or clips, and options of morec-studio
    #[arg(
        value_name = "FILE.mdb|CLIPS",
        trailing_var_arg = true,
        allow_hyphen_values = true
    )]
    arguments: Vec<OsString>,
}

/// Starts it and waits until it is closed.
pub fn run(args: &Args) -> Result<ExitCode> {
    let beside = beside().filter(|path| path.is_file());
    let program = beside.unwrap_or_else(|| PathBuf::from(PROGRAM));
    let status = match Command::new(&program).args(&args.arguments).status() {
        Err(error) if error.kind() == ErrorKind::NotFound => bail!(
            "the studio is a separate program and is not installed; install it from a clone of the repository with cargo install \
             --path crates/{PROGRAM} --features window, or run it with cargo run --release -p {PROGRAM} --features window"
        ),
        started => started.with_context(|| program.display().to_string())?,
    };
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}

/// Its path if both were installed together.
fn beside() -> Option<PathBuf> {
    let own = std::env::current_exe().ok()?;
    Some(own.with_file_name(format!("{PROGRAM}{}", std::env::consts::EXE_SUFFIX)))
}
