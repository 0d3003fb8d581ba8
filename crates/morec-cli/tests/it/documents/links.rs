//! Links of the documents, and options that they mention in passing.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::{guide, others, root};
use crate::kit::Folder;

/// Options of other programs.
const FOREIGN: [&str; 17] = [
    "--release",
    "--workspace",
    "--open",
    "--nocapture",
    "--example",
    "--path",
    "--all-targets",
    "--cfg",
    "--seeds",
    "--rounds",
    "--ask",
    "--endpoint",
    "--from-files",
    "--likeliest",
    "--parts",
    "--scale",
    "--ray",
];

fn all() -> Vec<PathBuf> {
    let mut paths = guide();
    paths.extend(others());
    paths.push(root().join("CHANGELOG.md"));
    paths
}

/// The text outside of fenced blocks.
fn prose(text: &str) -> String {
    let mut fenced = false;
    let mut out = String::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if !fenced {
            out.push_str(line);
            out.push('\n');
        }
    }
    out
}

/// The targets of all links.
fn targets(text: &str) -> Vec<&str> {
    text.split("](")
        .skip(1)
        .filter_map(|rest| rest.split_once(')').map(|(target, _)| target))
        .collect()
}

/// The anchor that a heading gets on a page: lower case, words joined by hyphens, nothing else.
fn anchor(heading: &str) -> String {
    heading
        .trim_start_matches('#')
        .trim()
        .to_lowercase()
        .chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

/// The fault of a link of the document `from`; `None` if it is right.
fn fault(from: &Path, target: &str) -> Option<String> {
    if target.contains("://") {
        return None;
    }
    let (path, wanted) = target.split_once('#').unwrap_or((target, ""));
    let file = match path {
        "" => from.to_owned(),
        path => from.parent().unwrap().join(path),
    };
    if !file.exists() {
        return Some("no such file".to_owned());
    }
    if wanted.is_empty() {
        return None;
    }
    let text = prose(&std::fs::read_to_string(&file).unwrap());
    let known = text
        .lines()
        .any(|l| l.starts_with('#') && anchor(l) == wanted);
    (!known).then(|| "no such heading".to_owned())
}

#[test]
fn links_lead_somewhere() {
    let mut faults = Vec::new();
    for path in all() {
        let text = prose(&std::fs::read_to_string(&path).unwrap());
        for target in targets(&text) {
            if let Some(fault) = fault(&path, target) {
                faults.push(format!("{}: {target}: {fault}", path.display()));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn anchors_are_those_of_headings() {
    assert_eq!(anchor("## What misses its aim"), "what-misses-its-aim");
    assert_eq!(
        anchor("### Live stages (`SvrdmParams`)"),
        "live-stages-svrdmparams"
    );
    assert!(fault(&root().join("README.md"), "README.md#no-such-heading").is_some());
    assert!(fault(&root().join("README.md"), "no-such-file.md").is_some());
}

/// The help of a command and of all its subcommands.
fn help(folder: &Folder, words: &[&str], text: &mut String) {
    let shown = folder.morec(&[words, &["--help-all"]].concat()).ok();
    let commands: Vec<String> = shown
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|word| *word != "help")
        .map(str::to_owned)
        .collect();
    text.push_str(&shown);
    for command in commands {
        help(folder, &[words, &[&command]].concat(), text);
    }
}

/// Words that look like long options.
fn options(text: &str) -> BTreeSet<&str> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-'))
        .filter(|word| {
            word.starts_with("--") && word[2..].starts_with(|c: char| c.is_ascii_lowercase())
        })
        .collect()
}

#[test]
fn options_in_the_text_exist() {
    let mut text = String::new();
    help(&Folder::with(&[]), &[], &mut text);
    let known = options(&text);
    assert!(known.contains("--background") && known.contains("--one-a-clip"));
    for path in guide() {
        let text = prose(&std::fs::read_to_string(&path).unwrap());
        let inline: String = text
            .split('`')
            .skip(1)
            .step_by(2)
            .collect::<Vec<_>>()
            .join(" ");
        for option in options(&inline) {
            let exists = known.contains(option) || FOREIGN.contains(&option);
            assert!(exists, "{}: {option} is no option", path.display());
        }
    }
}
