//! One term for one thing: words that are not used, with the term of the glossary or the plain word instead.

use crate::{markdown, sources};

/// Not used anywhere, in names and messages neither.
const ANYWHERE: &[(&str, &str)] = &[
    ("made people", "synthetic people"),
    ("made samples", "synthetic samples"),
    ("figures of the method", "parameters of the method"),
    ("moving figure", "moving drawing"),
    ("rehearse", "dry run"),
    (
        "pip install morec",
        "pip install ./crates/morec-py: the package is not published",
    ),
];

/// Not used in documents.
const DOCUMENTS: &[(&str, &str)] = &[
    ("likest", "most similar"),
    ("whoever", "the person who"),
    ("told", "reported, distinguished, given"),
    ("is none of", "belongs to no"),
    ("teachers", "training subjects"),
];

/// The text in small letters with line breaks and signs of comments as blanks: a phrase may go over an end of a line.
fn running(text: &str) -> String {
    let lines = text.lines().map(|line| {
        let line = line.trim_start();
        line.trim_start_matches(['/', '!', '*', '#', '>']).trim()
    });
    lines.collect::<Vec<_>>().join(" ").to_lowercase()
}

/// True if `phrase` stands in `text`, which is in small letters, as whole words.
fn has(text: &str, phrase: &str) -> bool {
    let word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    text.match_indices(phrase).any(|(at, _)| {
        let (before, after) = (&text[..at], &text[at + phrase.len()..]);
        !word(before.chars().next_back()) && !word(after.chars().next())
    })
}

fn faults(path: &str, text: &str) -> Vec<String> {
    let mut places = vec![(running(text), ANYWHERE)];
    if path.ends_with(".md") {
        places.push((running(&markdown::prose(text)), DOCUMENTS));
    }
    let mut faults = vec![];
    for (text, list) in places {
        for (phrase, instead) in list.iter().filter(|(phrase, _)| has(&text, phrase)) {
            faults.push(format!("{path}: \"{phrase}\": write {instead}"));
        }
    }
    faults
}

#[test]
fn phrases_are_found_over_ends_of_lines_and_as_whole_words() {
    let count = |path: &str, text: &str| faults(path, text).len();
    assert_eq!(count("a.rs", "/// Of made\n/// people"), 1);
    assert_eq!(count("a.rs", "let told = told(stolen);"), 0);
    assert_eq!(count("a.md", "Made people\nand `x`.\n```\ntold\n```\n"), 1);
    assert_eq!(count("a.md", "It is told, not retold."), 1);
}

#[test]
fn terms_are_those_of_the_glossary() {
    let files = sources::all_files(&["rs", "md", "py", "pyi", "h"]);
    assert!(files.len() > 800, "{}", files.len());
    let faults: Vec<_> = files
        .iter()
        .filter(|(path, _)| !path.starts_with("xtask/tests/structure/"))
        .flat_map(|(path, text)| faults(path, text))
        .collect();
    assert!(
        faults.is_empty(),
        "{} phrases:\n{}",
        faults.len(),
        faults.join("\n")
    );
}
