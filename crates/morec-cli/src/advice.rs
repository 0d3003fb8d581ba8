//! Tests that commands and options exist which help and messages advise.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::{Command, CommandFactory, Parser};
use mocap::testing::skipped;

use crate::Cli;

/// Options of cargo in the advice on the window, which a test of `morec studio` holds.
const CARGOS: [&str; 3] = ["path", "release", "features"];

/// Crates whose messages the command prints.
const CRATES: [&str; 6] = [
    "mocap",
    "morec",
    "morec-ops",
    "morec-live",
    "morec-db",
    "morec-cli",
];

/// Calls `visit` with every command and the words that begin it.
fn each_command(command: &Command, words: &str, visit: &mut impl FnMut(&Command, &str)) {
    visit(command, words);
    for below in command.get_subcommands() {
        let names = std::iter::once(below.get_name()).chain(below.get_all_aliases());
        for name in names {
            each_command(below, &format!("{words} {name}"), visit);
        }
    }
}

/// The command lines in a text of examples, without what a shell does with them and without comments.
fn examples(text: &str) -> Vec<String> {
    let joined: Vec<&str> = text.split("\\\n").map(str::trim_start).collect();
    let joined = joined.join(" ");
    let lines = joined.lines().filter_map(|line| {
        let line = line.trim_start();
        let line = line.strip_prefix("Example: ").unwrap_or(line);
        let at = match line.starts_with("morec ") {
            true => 0,
            false => line.find("| morec ")? + 2,
        };
        let line = &line[at..];
        let ends = [" | ", " > ", " < ", "   "].iter();
        let end = ends.filter_map(|sign| line.find(sign)).min();
        Some(line[..end.unwrap_or(line.len())].to_owned())
    });
    lines.collect()
}

#[test]
fn examples_of_the_help_are_commands() {
    let mut tried = 0;
    each_command(&Cli::command(), "morec", &mut |command, words| {
        let texts = [command.get_after_help(), command.get_after_long_help()];
        for text in texts.into_iter().flatten() {
            for line in examples(&text.to_string()) {
                tried += 1;
                let parsed = Cli::try_parse_from(shlex::split(&line).unwrap());
                if let Err(error) = parsed {
                    panic!("help of {words}: {line}: {error}");
                }
            }
        }
    });
    assert!(tried > 60, "{tried}");
}

/// The long options that a text names, without their dashes.
fn options(text: &str) -> Vec<&str> {
    let named = text.match_indices("--").filter_map(|(at, _)| {
        let before = text[..at].chars().next_back();
        let rest = &text[at + 2..];
        let is_of_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        let end = rest.find(|c| !is_of_name(c)).unwrap_or(rest.len());
        let name = rest[..end].trim_end_matches('-');
        let stands_alone = before.is_none_or(|c| !c.is_alphanumeric() && c != '-');
        let begins = name.starts_with(|c: char| c.is_ascii_lowercase());
        (stands_alone && begins).then_some(name)
    });
    named.collect()
}

/// The code of [`CRATES`], without comments and tests; none where the crate is read outside of its repository.
fn sources() -> Option<Vec<(PathBuf, String)>> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut open: Vec<PathBuf> = CRATES.map(|name| crates.join(name).join("src")).into();
    if !open.iter().all(|folder| folder.is_dir()) {
        skipped("the other crates are not beside this one");
        return None;
    }
    let mut found = Vec::new();
    while let Some(path) = open.pop() {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        // Names of colours in pages and pictures look alike; this file has examples of what is wrong.
        let is_other = ["tests", "plot", "player", "advice.rs"].contains(&&*name);
        if is_other || name.ends_with("tests.rs") {
            continue;
        }
        if path.is_dir() {
            let entries = std::fs::read_dir(&path).unwrap();
            open.extend(entries.map(|entry| entry.unwrap().path()));
        } else if name.ends_with(".rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            let code = text.split("#[cfg(test)]\nmod tests {").next();
            let lines = code.unwrap_or_default().lines();
            let lines = lines.filter(|line| !line.trim_start().starts_with("//"));
            found.push((path.clone(), lines.collect::<Vec<_>>().join("\n")));
        }
    }
    Some(found)
}

#[test]
fn options_and_commands_in_messages_exist() {
    let (mut known, mut commands) = (BTreeSet::new(), BTreeSet::new());
    known.extend(CARGOS.map(str::to_owned));
    let mut cli = Cli::command();
    cli.build();
    each_command(&cli, "morec", &mut |command, words| {
        commands.insert(words.to_owned());
        let longs = command.get_arguments().filter_map(|arg| arg.get_long());
        known.extend(longs.map(str::to_owned));
    });
    // Words that the command reads for its older names.
    commands.extend(["morec db cut", "morec db group"].map(str::to_owned));
    let Some(sources) = sources() else { return };
    assert!(sources.len() > 300, "{} files", sources.len());
    let mut wrong = Vec::new();
    for (path, code) in &sources {
        let mut note = |what: &str| wrong.push(format!("{}: {what}", path.display()));
        let unknown = options(code).into_iter().filter(|o| !known.contains(*o));
        unknown.for_each(|option| note(&format!("--{option}")));
        for (at, _) in code.match_indices("`morec ") {
            let line = code[at + 1..].split(['`', '\n', '\\']).next().unwrap_or("");
            let words: Vec<&str> = line.split_whitespace().collect();
            if !(2..=words.len()).any(|n| commands.contains(&words[..n].join(" "))) {
                note(line);
            }
        }
    }
    assert!(wrong.is_empty(), "no such option or command: {wrong:#?}");
}

#[test]
fn what_does_not_exist_would_be_noticed() {
    let text =
        "  morec a b   first\n  cat x | morec c -\nExample: morec d \\\n    --e > f\nno morec\n";
    assert_eq!(examples(text), ["morec a b", "morec c -", "morec d  --e"]);
    let text = "say --with FILE, a--b, -- or --one-two: ---";
    assert_eq!(options(text), ["with", "one-two"]);
}
