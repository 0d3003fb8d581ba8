//! The command lines that are shown are those of the command.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::OnceLock;

use clap::Parser;
use morec_db::ClipUpdate;
use morec_db::labels::SampleState as Judged;

use super::{Person, labelling, made};
use crate::state::{Command, CutCommand, TimelineCommand};
use crate::store::Edit;

/// One command a line; the tests of the command parse each of them.
const LINES: &str = include_str!("../../../morec-cli/testdata/studio_commands.txt");

/// Options whose values are words of a list.
const ENUMERATED: [&str; 5] = ["--form", "--state", "--method", "--of", "--by"];

/// A command without its values: program, subcommands, options, and values that are words of a list.
fn shape(words: &[String]) -> Vec<String> {
    let subcommands = match words.get(1).map(String::as_str) {
        Some("db") => 3,
        _ if words[0] == "morec" => 2,
        _ => 1,
    };
    let mut shape: Vec<String> = words.iter().take(subcommands).cloned().collect();
    let mut options = BTreeSet::new();
    for (at, word) in words.iter().enumerate().skip(subcommands) {
        if word.starts_with('-') {
            let name = word.split('=').next().unwrap_or(word);
            let value = words.get(at + 1).filter(|_| ENUMERATED.contains(&name));
            options.insert(format!("{name} {}", value.map_or("", |v| v)));
        }
    }
    shape.extend(options);
    shape
}

/// Commands joined by `&&`, word by word.
fn commands(line: &str) -> Vec<Vec<String>> {
    let words = shlex::split(line).unwrap_or_else(|| panic!("not a line of a shell: {line}"));
    let commands = words.split(|word| word == "&&").map(<[String]>::to_vec);
    commands.filter(|words| !words.is_empty()).collect()
}

/// Panics if a shown line is missing from the lines that the command's tests parse.
pub fn check(line: &str) {
    static KNOWN: OnceLock<BTreeSet<Vec<String>>> = OnceLock::new();
    let known = KNOWN.get_or_init(|| {
        let lines = LINES.lines().filter(|line| line.starts_with("morec"));
        lines
            .flat_map(commands)
            .map(|words| shape(&words))
            .collect()
    });
    for words in commands(line) {
        let shape = shape(&words);
        assert!(known.contains(&shape), "no test parses {shape:?}: {line}");
    }
}

#[test]
fn lines_that_start_the_studio_are_parsed_by_it() {
    let lines = LINES
        .lines()
        .filter(|line| line.starts_with("morec-studio"));
    let mut count = 0;
    for words in lines.flat_map(commands) {
        count += 1;
        crate::Args::try_parse_from(&words).unwrap();
    }
    assert!(count > 1);
}

#[test]
#[should_panic(expected = "no test parses")]
fn an_option_that_no_test_parses_is_found() {
    check("morec db clips moves.mdb --name ada_1 --remove");
}

/// The line after an edit, without the folder.
fn line_of(person: &mut Person, folder: &Path, edit: Edit) -> String {
    person.command(Command::Edit(edit));
    let folder = format!("{}/", folder.display());
    person.state().command_line.replace(&folder, "")
}

#[test]
fn each_edit_shows_the_command_that_does_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    let snapshot = person.state().store.as_ref().unwrap().snapshot.clone();
    let (clip, second) = (snapshot.clips[0].id, snapshot.clips[1].id);
    let of_clip = |update: ClipUpdate| Edit::Describe {
        clips: vec![clip],
        update,
    };
    let samples = snapshot.samples_of(clip);
    let (a, b) = (samples[0].id, samples[1].id);
    let edits = [
        (
            of_clip(ClipUpdate {
                subject: Some(String::new()),
                ..ClipUpdate::default()
            }),
            "morec db clips moves.mdb --clip ada_1 --set-subject ''".to_owned(),
        ),
        (
            of_clip(ClipUpdate {
                source: Some("our lab".to_owned()),
                ..ClipUpdate::default()
            }),
            "morec db clips moves.mdb --clip ada_1 --set-source 'our lab'".to_owned(),
        ),
        (
            of_clip(ClipUpdate {
                licence: Some("CC-BY".to_owned()),
                ..ClipUpdate::default()
            }),
            "morec db clips moves.mdb --clip ada_1 --set-licence CC-BY".to_owned(),
        ),
        (
            of_clip(ClipUpdate {
                add_tags: vec!["slow".to_owned(), "old".to_owned()],
                ..ClipUpdate::default()
            }),
            "morec db clips moves.mdb --clip ada_1 --add-tag slow --add-tag old".to_owned(),
        ),
        (
            of_clip(ClipUpdate {
                remove_tags: vec!["old".to_owned()],
                ..ClipUpdate::default()
            }),
            "morec db clips moves.mdb --clip ada_1 --remove-tag old".to_owned(),
        ),
        (
            Edit::Background {
                clips: vec![clip, second],
                on: true,
            },
            "morec db clips moves.mdb --clip ada_1 --add-tag background && morec db clips moves.mdb --clip ben_1 \
             --add-tag background"
                .to_owned(),
        ),
        (
            Edit::Background {
                clips: vec![second],
                on: false,
            },
            "morec db clips moves.mdb --clip ben_1 --remove-tag background".to_owned(),
        ),
        (
            Edit::Judge {
                ids: vec![a],
                state: Judged::Rejected,
            },
            format!(
                "morec db label moves.mdb --clip ada_1 --class {} --start {:.3} --stop {:.3} --state rejected",
                samples[0].class, samples[0].start_secs, samples[0].stop_secs
            ),
        ),
        (
            Edit::Reclass {
                ids: vec![a, b],
                class: "gesture 1".to_owned(),
            },
            format!("morec db classes moves.mdb --split {},{} --into 'gesture 1'", a.0, b.0),
        ),
        (
            Edit::RenameClip {
                from: "ada_1".to_owned(),
                to: "ada walks".to_owned(),
            },
            "morec db clips moves.mdb --rename ada_1 'ada walks'".to_owned(),
        ),
        (
            Edit::RemoveClips(vec![clip, second]),
            "morec db clips moves.mdb --clip 'ada walks' --remove && morec db clips moves.mdb --clip ben_1 --remove"
                .to_owned(),
        ),
        (Edit::Undo(None), "morec db undo moves.mdb".to_owned()),
        (Edit::Redo, "morec db redo moves.mdb".to_owned()),
    ];
    for (edit, expected) in edits {
        assert_eq!(line_of(&mut person, folder.path(), edit), expected);
        assert!(
            person.state().notices.is_empty(),
            "{:?}",
            person.state().notices
        );
    }
    let all = person.state().store.as_ref().unwrap().snapshot.clone();
    assert_eq!(all.clips.len(), 1, "the two are removed again");
}

#[test]
fn an_action_without_a_command_shows_none() {
    let (_folder, mut person) = labelling(1);
    person.command(Command::Cuts(CutCommand::Add(1.5)));
    assert!(person.state().command_line.contains("--at"));
    person.command(Command::Cuts(CutCommand::Reset));
    assert_eq!(person.state().command_line, "");
    // The two methods of cutting.
    for (method, name) in [
        (morec_ops::CutMethod::Kernel, ""),
        (morec_ops::CutMethod::Ppca, " --method ppca"),
    ] {
        person.command(Command::Timeline(TimelineCommand::Cut(method)));
        let line = &person.state().command_line;
        assert!(line.ends_with(&format!("moves.mdb{name}")), "{line}");
    }
}
