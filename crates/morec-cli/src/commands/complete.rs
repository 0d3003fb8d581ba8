//! `morec completions` and `morec man`: shell completions and man pages, generated from the definition of the command line.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};

/// Print the completions of a shell
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec completions bash > ~/.local/share/bash-completion/completions/morec
  morec completions zsh > ~/.zfunc/_morec
  morec completions fish > ~/.config/fish/completions/morec.fish")]
pub struct Completions {
    /// The shell
    #[arg(value_enum)]
    shell: clap_complete::Shell,
}

/// Write a man page of every command into a folder
#[derive(clap::Args)]
#[command(after_help = "\
Example:
  morec man ~/.local/share/man/man1")]
pub struct Man {
    /// Folder to write to; created if it does not exist
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
}

/// Prints the completions.
pub fn completions(args: &Completions, mut command: clap::Command) -> Result<ExitCode> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, "morec", &mut script);
    std::io::stdout().lock().write_all(&script)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes `morec.1`, `morec-train.1` and so on.
pub fn man(args: &Man, command: clap::Command) -> Result<ExitCode> {
    let folder = &args.folder;
    std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    clap_mangen::generate_to(command, folder).with_context(|| folder.display().to_string())?;
    eprintln!("morec: man pages written to {}", folder.display());
    Ok(ExitCode::SUCCESS)
}
