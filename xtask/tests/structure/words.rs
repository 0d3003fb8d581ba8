//! Plain words: phrases that are not used in documents, comments, help and messages, and what to write instead.

use crate::sources;

/// Words of the language that are only wrong in prose: looked for in documents and comments.
const PROSE: &[(&str, &str)] = &[
    ("told", "reported, distinguished, given"),
    ("speaks of", "refers to, covers"),
    ("speak of", "refer to, cover"),
];

/// Phrases that are wrong wherever they stand, in messages and names too.
const ANYWHERE: &[(&str, &str)] = &[
    ("so many", "N, this many, enough"),
    ("a new session?", "accuracy on a new recording"),
    ("silence at other motion?", "false alarms on other motion"),
    ("rather miss than invent", "prefers misses to false alarms"),
    ("made people", "synthetic people"),
    ("Made samples", "Synthetic samples"),
    ("are worked into", "are folded into"),
    ("began as a rebuilding", "started as a reimplementation"),
    (
        "who stands upright leans",
        "an upright performer appears tilted",
    ),
    ("are not written over", "are not overwritten"),
    ("look for their like", "search for similar motions"),
    ("those that tell most", "the most informative ones"),
    ("most telling", "most informative"),
    ("says all there is to say", "is the complete set"),
    (
        "none goes or changes what it means",
        "never removed or redefined",
    ),
    (
        "from its mirror image what it is not",
        "its mirror image as a negative",
    ),
    ("gain what others lose", "gain; others lose slightly"),
    ("its figures as the thesis", "the thesis' parameters"),
    ("what was there is kept", "the old file is kept"),
    ("for want of", "for lack of"),
    (
        "is not as it was, or is needed",
        "changed since or is in use",
    ),
    (
        "nothing of the last step was kept",
        "the last change was rolled back",
    ),
    (
        "no clip with a frame of motion among",
        "none of the named files contains motion",
    ),
    ("are told by where", "inferred from"),
    ("Nobody's yet", "Has no rig yet"),
    ("the one in the middle", "the median"),
    ("need not be. And", "may be"),
    ("Do not tell a motion", "Minimum seconds between two events"),
    ("tells other programs", "notifies other programs"),
    ("said 0.13 s after", "reported 0.13 s after"),
    ("it is good to know", "for information"),
    ("figures of the method", "parameters of the method"),
    ("figures of training", "parameters of training"),
    ("Figures of [`", "Parameters of [`"),
    ("no figure is called", "no parameter is called"),
    ("moving figure", "moving drawing"),
    ("with_figures", "with_parameters"),
    ("_figure.py", "_drawing.py: a figure is a measured number"),
    ("rehearse", "dry_run"),
    ("speakable", "sanitized"),
];

/// The text in small letters with line breaks and signs of comments as blanks: a phrase may go over an end of a line.
fn running(text: &str) -> String {
    let lines = text.lines().map(|line| {
        let line = line.trim_start();
        line.trim_start_matches(['/', '!', '*', '#', '>']).trim()
    });
    lines.collect::<Vec<_>>().join(" ").to_lowercase()
}

/// What is read as prose: Markdown outside of blocks, comments of Rust and C.
fn prose(path: &str, text: &str) -> String {
    if path.ends_with(".md") {
        return crate::markdown::lines(text)
            .map(|(line, code)| if code { "" } else { line })
            .collect::<Vec<_>>()
            .join("\n");
    }
    let comments = text.lines().filter_map(|line| {
        let line = line.trim_start();
        let comment = line.starts_with("//") || line.starts_with("* ") || line.starts_with("/*");
        comment.then_some(line)
    });
    comments.collect::<Vec<_>>().join("\n")
}

/// True if `phrase` stands in `text`, which is in small letters, as whole words.
fn has(text: &str, phrase: &str) -> bool {
    let phrase = phrase.to_lowercase();
    let word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    text.match_indices(&phrase).any(|(at, _)| {
        let name = phrase.starts_with('_') || phrase.contains('_');
        let (before, after) = (&text[..at], &text[at + phrase.len()..]);
        name || !word(before.chars().next_back()) && !word(after.chars().next())
    })
}

fn faults(path: &str, text: &str) -> Vec<String> {
    let places = [(prose(path, text), PROSE), (text.to_owned(), ANYWHERE)];
    let mut faults = vec![];
    for (text, list) in places {
        let text = running(&text);
        for (phrase, instead) in list.iter().filter(|(phrase, _)| has(&text, phrase)) {
            faults.push(format!("{path}: \"{phrase}\": write {instead}"));
        }
    }
    faults
}

#[test]
fn phrases_are_found_over_ends_of_lines_and_as_whole_words() {
    let count = |path: &str, text: &str| faults(path, text).len();
    assert_eq!(count("a.rs", "/// End after so\n/// many seconds"), 1);
    assert_eq!(count("a.rs", "// It is told.\nlet told = 1;"), 1);
    assert_eq!(count("a.rs", "let told = told(stolen);"), 0);
    assert_eq!(count("a.md", "Made people\nand `x`.\n```\ntold\n```\n"), 1);
    assert_eq!(count("a.md", "retold"), 0);
}

#[test]
fn plain_words_are_used() {
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
