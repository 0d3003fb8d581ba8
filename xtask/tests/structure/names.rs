//! One type, one name; one name, one type: over all crates, private types too.

use std::collections::{BTreeMap, BTreeSet};

use crate::sources;

/// Names that several types may have, and why.
const SHARED: &[(&str, &str)] = &[(
    "Args",
    "the arguments of a subcommand, in the file of each; nobody sees two at once",
)];

/// The types that `text` declares, up to its module of tests. Associated types are indented and not counted.
fn declared(text: &str) -> Vec<&str> {
    let mut names = vec![];
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let next = lines.peek().copied().unwrap_or_default();
        if line == "#[cfg(test)]" && next.starts_with("mod ") && next.ends_with('{') {
            break;
        }
        let mut words = line.split_whitespace().peekable();
        words.next_if(|word| *word == "pub" || word.starts_with("pub("));
        // `pub(in crate::live)` has a blank inside.
        words.next_if(|word| word.ends_with(')'));
        let (Some(kind), Some(name)) = (words.next(), words.next()) else {
            continue;
        };
        let counts = match kind {
            "struct" | "enum" | "trait" | "union" => true,
            "type" => !line.starts_with(char::is_whitespace),
            _ => false,
        };
        let end = name.find(|c: char| !c.is_alphanumeric() && c != '_');
        if counts {
            names.push(&name[..end.unwrap_or(name.len())]);
        }
    }
    names
}

#[test]
fn declarations_are_found_wherever_they_stand() {
    let text = "pub struct Clip<'a> {\n}\n/// enum Comment\npub(in crate::live) enum Way {\n    type Item = u8;\n\
                type Rows = u8;\npub(crate) trait Told: Send {}\n    struct Inner(u8);\nlet union = 1;\n\
                #[cfg(test)]\nmod tests {\n    struct Hidden;\n}\n";
    assert_eq!(declared(text), ["Clip", "Way", "Rows", "Told", "Inner"]);
}

#[test]
fn no_name_is_used_for_two_types() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut count = 0;
    for (folder, files) in sources::by_crate() {
        count += files.len();
        for (path, text) in &files {
            for name in declared(text) {
                let place = format!("{folder}: {}", path.display());
                places.entry(name.to_owned()).or_default().push(place);
            }
        }
    }
    assert!(count > 500, "{count} files");
    places.retain(|_, files| files.len() > 1);
    let allowed: BTreeSet<&str> = SHARED.iter().map(|(name, _)| *name).collect();
    let unused: Vec<_> = allowed
        .iter()
        .filter(|name| !places.contains_key(**name))
        .collect();
    assert!(
        unused.is_empty(),
        "not shared any more, to be taken from the list: {unused:?}"
    );
    places.retain(|name, _| !allowed.contains(name.as_str()));
    assert!(places.is_empty(), "names of two types or more: {places:#?}");
}
