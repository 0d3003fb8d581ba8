//! Tests that options have the same name, values and meaning in all commands, and that help fits the terminal.

use std::collections::BTreeMap;

use clap::{ArgAction, Command, CommandFactory};

/// Options that take something else from one command to another, and why they are called alike all the same.
const EXCEPTIONS: [(&str, &str); 8] = [
    (
        "by",
        "`crossval` leaves out by clip or person, `db label` says who judges",
    ),
    (
        "mirror",
        "training says which classes, streams and searches only whether",
    ),
    (
        "output",
        "its name says what is written: a file, an index, a page, a folder",
    ),
    (
        "plot",
        "`smooth` draws one of many channels, and is given which",
    ),
    (
        "remove",
        "of clips that were chosen, of samples by number, of an index by name",
    ),
    (
        "samples",
        "`crossval` counts them, `db classes` lists those of a class",
    ),
    (
        "skeleton",
        "AMC motions have an ASF, broadcasts of Axis a BVH",
    ),
    (
        "split",
        "`db cycles` splits what it found, `db classes` what is numbered",
    ),
];

/// Beginning of the help of an option, wherever there is one.
const MEANINGS: [(&str, &[&str]); 9] = [
    ("json", &["Print one JSON array", "Print one JSON object"]),
    ("limit", &["At most N", "List at most N"]),
    ("report", &["Write a page "]),
    (
        "clip",
        &[
            "Clips of ",
            "Samples of this clip",
            "Labels of this clip",
            "The clip that ",
        ],
    ),
    (
        "labels",
        &[
            "Labels: a table, or a form that `morec db label` reads",
            "Labels to show: a table, or a form that `morec db label` reads",
            "Labels of clips in files: a table, or a form that `morec db label` reads",
        ],
    ),
    ("output", &["File to write", "Folder for ", "Output"]),
    ("roles", &["Roles "]),
    (
        "class",
        &[
            "Clips with a sample of this class",
            "Labelled stretches of this class only",
            "Set one sample of this class",
            "Samples of this class",
            "Labels of this class only",
        ],
    ),
    ("subject", &["Person in the clips", "Clips of this person"]),
];

/// An option of a command: what it takes, and what its help says.
struct OptionUse {
    command: String,
    takes: String,
    short: Option<char>,
    help: String,
}

fn collect(command: &Command, path: &str, all: &mut BTreeMap<String, Vec<OptionUse>>) {
    for arg in command.get_arguments() {
        let Some(long) = arg.get_long().filter(|_| !arg.is_hide_set()) else {
            continue;
        };
        let takes = match arg.get_action() {
            ArgAction::Set | ArgAction::Append => {
                let names = arg.get_value_names().unwrap_or_default();
                let names: Vec<&str> = names.iter().map(|name| name.as_str()).collect();
                names.join(" ")
            }
            _ => String::new(),
        };
        all.entry(long.to_owned()).or_default().push(OptionUse {
            command: path.to_owned(),
            takes,
            short: arg.get_short(),
            help: arg.get_help().map(ToString::to_string).unwrap_or_default(),
        });
    }
    for below in command.get_subcommands() {
        collect(below, &format!("{path} {}", below.get_name()), all);
    }
}

fn options() -> BTreeMap<String, Vec<OptionUse>> {
    let mut all = BTreeMap::new();
    collect(&super::Cli::command(), "morec", &mut all);
    assert!(all.len() > 100, "{} options", all.len());
    all
}

#[test]
fn an_option_takes_the_same_everywhere() {
    for (long, uses) in options() {
        let differs = |other: &&OptionUse| {
            let first = &uses[0];
            (&other.takes, other.short) != (&first.takes, first.short)
        };
        let odd = uses.iter().find(differs);
        let excepted = EXCEPTIONS.iter().any(|(known, _)| *known == long);
        match odd {
            Some(odd) => assert!(
                excepted,
                "--{long} takes {:?} in {} and {:?} in {}",
                uses[0].takes, uses[0].command, odd.takes, odd.command
            ),
            None => assert!(!excepted, "--{long} is no exception any more"),
        }
    }
}

#[test]
fn an_option_means_the_same_everywhere() {
    let all = options();
    for (long, beginnings) in MEANINGS {
        for one in &all[long] {
            assert!(
                beginnings.iter().any(|begins| one.help.starts_with(begins)),
                "{} --{long}: {}",
                one.command,
                one.help
            );
        }
    }
}

/// Lines of help fit a terminal of 80 columns, whatever is said in them.
#[test]
fn help_fits_eighty_columns() {
    fn check(command: &mut Command, path: &str) {
        let help = command.render_long_help().to_string();
        // What is typed as a whole is not broken.
        for line in help.lines().filter(|line| !line.starts_with("Usage:")) {
            assert!(line.chars().count() <= 80, "{path}: {line}");
        }
        let examples = command.get_after_help().map(ToString::to_string);
        for line in examples.unwrap_or_default().lines() {
            let is_example = line.starts_with("  morec ");
            assert!(!is_example || line.chars().count() <= 80, "{path}: {line}");
        }
        for below in command.get_subcommands_mut() {
            let path = format!("{path} {}", below.get_name());
            check(below, &path);
        }
    }
    let mut command = super::Cli::command().term_width(80);
    command.build();
    check(&mut command, "morec");
}

/// An option's help is one line; what else there is to say is in its long form, which `--help-all` prints.
#[test]
fn help_is_short() {
    for (long, uses) in options() {
        for one in uses {
            let length = one.help.chars().count();
            assert!(length <= 80, "{} --{long}: {}", one.command, one.help);
        }
    }
    let mut command = super::Cli::command().term_width(80);
    command.build();
    for (name, most) in [("train", 90), ("live", 80)] {
        let command = command.find_subcommand_mut(name).unwrap();
        let lines = command.render_help().to_string().lines().count();
        assert!(lines <= most, "{name}: {lines} lines");
    }
}

/// What must be given stands in the first group of a help that has several; what only says how to read files, in the last.
#[test]
fn what_is_required_comes_first_and_groups_hold_together() {
    fn check(command: &Command, path: &str) {
        let arguments = || command.get_arguments().filter(|arg| !arg.is_hide_set());
        let mut groups: Vec<Option<&str>> = Vec::new();
        for arg in arguments().filter(|arg| !arg.is_positional()) {
            let heading = arg.get_help_heading();
            if !groups.contains(&heading) {
                groups.push(heading);
            }
        }
        let first = groups.iter().find(|heading| heading.is_some());
        for arg in arguments().filter(|arg| arg.is_required_set() && !arg.is_positional()) {
            let heading = arg.get_help_heading();
            let is_first = heading.is_none() || first == Some(&heading);
            assert!(is_first, "{path}: {} is in {heading:?}", arg.get_id());
        }
        for id in ["output", "json", "report"] {
            let heading = arguments()
                .find(|arg| arg.get_id() == id)
                .map(|arg| arg.get_help_heading());
            assert_ne!(heading, Some(Some("Reading clips")), "{path}: --{id}");
        }
        for below in command.get_subcommands() {
            check(below, &format!("{path} {}", below.get_name()));
        }
    }
    let mut command = super::Cli::command();
    command.build();
    check(&command, "morec");
    let train = command.find_subcommand("train").unwrap();
    let heading = |id: &str| {
        let mut arguments = train.get_arguments();
        arguments
            .find(|arg| arg.get_id() == id)
            .unwrap()
            .get_help_heading()
    };
    assert_eq!(heading("output"), None);
    assert_eq!(heading("clips"), Some("Clips and labels"));
    assert_eq!(heading("labels"), Some("Clips and labels"));
    assert_eq!(heading("mirror"), Some("Training"));
    assert_eq!(heading("file_rate"), Some("Reading clips"));
}
