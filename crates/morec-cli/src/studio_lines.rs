//! The command lines that the studio shows are lines of this command.

use clap::{Command, CommandFactory, Parser};

use crate::Cli;

/// One command a line; the studio's tests hold what it shows against them.
const LINES: &str = include_str!("../testdata/studio_commands.txt");

fn lines() -> Vec<Vec<String>> {
    let lines = LINES.lines().filter(|line| line.starts_with("morec "));
    lines.map(|line| shlex::split(line).unwrap()).collect()
}

#[test]
fn every_command_that_the_studio_shows_is_parsed() {
    assert!(lines().len() > 40);
    for words in lines() {
        if let Err(error) = Cli::try_parse_from(&words) {
            panic!("{}: {error}", words.join(" "));
        }
    }
}

/// The subcommand that words begin with, and the words after it. Panics for a name that `--help` does not list.
fn found(words: &[String]) -> (Command, &[String]) {
    let (mut command, mut rest) = (Cli::command(), &words[1..]);
    while command.has_subcommands() {
        let shown = command.get_subcommands().find(|c| c.get_name() == rest[0]);
        let shown = shown.filter(|c| !c.is_hide_set()).cloned();
        command = shown.unwrap_or_else(|| panic!("no subcommand is listed as {}", rest[0]));
        rest = &rest[1..];
    }
    (command, rest)
}

#[test]
fn the_studio_shows_names_of_commands_and_options_as_help_lists_them() {
    for words in lines() {
        let (command, rest) = found(&words);
        for word in rest.iter().filter_map(|word| word.strip_prefix("--")) {
            let name = word.split('=').next().unwrap_or(word);
            let listed = command
                .get_arguments()
                .any(|arg| arg.get_long() == Some(name) && !arg.is_hide_set());
            assert!(listed, "--{name} of {}", words.join(" "));
        }
    }
}
