//! Figures stand in `docs/figures.md`, each with the command that repeats it; README repeats some of them.

use std::collections::BTreeSet;

use crate::markdown::{self, inline_code, tables};
use crate::sources::{read, root};

/// Sections of `docs/figures.md` whose tables are not figures.
const OTHER_TABLES: [&str; 2] = ["Commands", "Clips"];

/// The least share of the bytes of `docs/figures.md` in tables and commands.
const LEAST_SHARE: f64 = 0.9;

/// The numbers of the section Commands: comments `# 1` of its block, and rows of its table.
fn defined(text: &str) -> BTreeSet<&str> {
    let (_, section) = text.split_once("\n## Commands\n").unwrap_or_default();
    let mut numbers = BTreeSet::new();
    for line in section.lines().take_while(|line| !line.starts_with("## ")) {
        let comment = line.strip_prefix("# ").or_else(|| line.strip_prefix("| "));
        let word = comment.and_then(|rest| rest.split_whitespace().next());
        numbers.extend(word.filter(|word| word.parse::<u32>().is_ok()));
    }
    numbers
}

/// What is wrong with the commands of the tables.
fn faults(text: &str) -> Vec<String> {
    let known = defined(text);
    let mut faults = vec![];
    for table in tables(text) {
        if OTHER_TABLES.contains(&table.section) {
            continue;
        }
        if table.header.last() != Some(&"command") {
            faults.push(format!("{}: no column of commands", table.section));
            continue;
        }
        for row in &table.rows {
            let last = row.last().copied().unwrap_or_default();
            let outside: String = last.split('`').step_by(2).collect();
            let numbers: Vec<_> = outside
                .split(|c: char| !c.is_ascii_digit())
                .filter(|n| !n.is_empty())
                .collect();
            let unknown: Vec<_> = numbers.iter().filter(|n| !known.contains(**n)).collect();
            if numbers.is_empty() && inline_code(last).next().is_none() {
                faults.push(format!("{}: no command for {}", table.section, row[0]));
            } else if !unknown.is_empty() || row.len() != table.header.len() {
                faults.push(format!("{}: {}: {last}", table.section, row[0]));
            }
        }
    }
    faults
}

#[test]
fn every_figure_has_its_command() {
    let text = "## A\n| what | command |\n|---|---|\n| a | |\n| b | 1 |\n| c | 2 |\n| d | `x` |\n| e | f | 1 |\n\
                ## B\n| what | value |\n|---|---|\n| g | 3 |\n\n## Commands\n# 1\nx\n## Clips\n# 2\n";
    let wrong = [
        "A: no command for a",
        "A: c: 2",
        "A: e: 1",
        "B: no column of commands",
    ];
    assert_eq!(faults(text), wrong);

    let text = read("docs/figures.md");
    assert!(tables(&text).iter().map(|t| t.rows.len()).sum::<usize>() > 60);
    let faults = faults(&text);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn scripts_of_the_commands_exist() {
    let text = read("docs/figures.md");
    for word in inline_code(&text).flat_map(str::split_whitespace) {
        if word.ends_with(".py") {
            let folders = ["docs/scripts", "crates/morec-py/benches"];
            let exists = |folder: &str| root().join(folder).join(word).exists();
            assert!(folders.into_iter().any(exists), "{word}");
        }
    }
}

#[test]
fn figures_are_tables() {
    let text = read("docs/figures.md");
    let kept = markdown::lines(&text).filter(|(line, code)| *code || line.starts_with('|'));
    let bytes: usize = kept.map(|(line, _)| line.len() + 1).sum();
    let share = bytes as f64 / text.len() as f64;
    assert!(
        share >= LEAST_SHARE,
        "{share:.3} of the page are tables and commands"
    );
}

/// Figures of `readme` that `figures` does not have: every row of a table with a column `morec` is one of `figures`, by what it
/// asks, with the same values.
fn not_in(readme: &str, figures: &str) -> Vec<String> {
    let known = tables(figures);
    let rows = |what: &str| {
        let all = known.iter().flat_map(|table| &table.rows);
        all.filter(|row| row[0] == what).collect::<Vec<_>>()
    };
    let mut missing = vec![];
    for table in tables(readme) {
        for row in table
            .rows
            .iter()
            .filter(|_| table.header.contains(&"morec"))
        {
            let same = |known: &Vec<&str>| row.iter().all(|cell| known.contains(cell));
            if !rows(row[0]).into_iter().any(same) {
                missing.push(row.join(" | "));
            }
        }
    }
    missing
}

#[test]
fn figures_of_readme_are_those_of_the_page() {
    let figures = "| what | morec | command |\n|---|---|---|\n| a | 1 | 1 |\n| b | 2 | 1 |\n";
    let front = |value| format!("| what | morec |\n|---|---|\n| a | {value} |\n");
    assert!(not_in(&front(1), figures).is_empty());
    assert_eq!(not_in(&front(2), figures), ["a | 2"]);

    let (readme, figures) = (read("README.md"), read("docs/figures.md"));
    let count: usize = tables(&readme).iter().map(|t| t.rows.len()).sum();
    assert!(count >= 4, "{count} figures");
    let missing = not_in(&readme, &figures);
    assert!(missing.is_empty(), "not in docs/figures.md: {missing:#?}");
    // A decimal in the text would be a figure that nothing holds. Versions of licences are none.
    let prose = markdown::prose(&readme).replace("Apache 2.0", "");
    let decimal = |w: &[u8]| w[0].is_ascii_digit() && w[1] == b'.' && w[2].is_ascii_digit();
    let found = prose.as_bytes().windows(3).position(decimal);
    assert_eq!(found.map(|at| &prose[at.saturating_sub(30)..at + 3]), None);
}
