//! Documents agree with the sources: folders, formats, decisions, the demo, sizes.

use std::collections::BTreeSet;
use std::fs;

use crate::markdown::{self, inline_code, tables};
use crate::sources::{self, read, root};

/// Folders directly in `path`.
fn folders(path: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(root().join(path)).unwrap().map(Result::unwrap);
    let folders = entries.filter(|entry| entry.path().is_dir());
    folders
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect()
}

fn named(cell: &str) -> BTreeSet<String> {
    inline_code(cell).map(str::to_owned).collect()
}

#[test]
fn architecture_names_the_folders_of_every_crate() {
    let text = read("ARCHITECTURE.md");
    let tables = tables(&text);
    let of_library = tables.iter().find(|t| t.header == ["folder", "does"]);
    let rows = of_library.map_or(&[][..], |table| &table.rows);
    let listed: BTreeSet<_> = rows.iter().flat_map(|row| named(row[0])).collect();
    let libraries = ["crates/mocap/src", "crates/morec/src"];
    let there: BTreeSet<_> = libraries.into_iter().flat_map(folders).collect();
    assert_eq!(listed, there);

    let others = tables
        .iter()
        .find(|t| t.header[0] == "crate" && t.header[1].starts_with("folders"));
    let rows = others.map_or(&[][..], |table| &table.rows);
    let mut crates: Vec<_> = folders("crates")
        .into_iter()
        .filter(|name| !["mocap", "morec"].contains(&&**name))
        .map(|name| (format!("crates/{name}/src"), name))
        .collect();
    crates.push(("xtask/src".to_owned(), "xtask".to_owned()));
    for (path, name) in crates {
        let row = rows.iter().find(|row| named(row[0]).contains(&name));
        let listed = row.map(|row| named(row[1])).unwrap_or_default();
        let there = folders(&path);
        let missing: Vec<_> = there.difference(&listed).collect();
        assert!(missing.is_empty(), "{name}: not named: {missing:?}");
        let file = |word: &String| root().join(&path).join(format!("{word}.rs")).exists();
        let gone: Vec<_> = listed
            .iter()
            .filter(|word| !word.ends_with('/') && !there.contains(*word) && !file(word))
            .collect();
        assert!(gone.is_empty(), "{name}: not there: {gone:?}");
    }
}

#[test]
fn architecture_names_every_crate() {
    let text = read("ARCHITECTURE.md");
    let table = tables(&text).into_iter().find(|t| t.section == "Crates");
    let rows = table.map(|table| table.rows).unwrap_or_default();
    let listed: BTreeSet<_> = rows.iter().flat_map(|row| named(row[0])).collect();
    let mut there: BTreeSet<_> = folders("crates")
        .iter()
        .map(|name| format!("crates/{name}"))
        .collect();
    there.extend(["xtask", "fuzz", "loom"].map(str::to_owned));
    assert_eq!(listed, there);
}

/// Variants of the library's enum of formats; each has a descriptor.
fn formats() -> usize {
    let text = read("crates/mocap/src/formats/mod.rs");
    let (_, body) = text.split_once("pub enum Format {").unwrap();
    let (body, _) = body.split_once("\n}").unwrap();
    let variants: Vec<_> = (body.lines().map(str::trim))
        .filter(|line| line.ends_with(',') && !line.starts_with("//"))
        .collect();
    for variant in &variants {
        let row = format!("    (Format::{variant} ");
        assert_eq!(text.matches(&row).count(), 1, "descriptors of {variant}");
    }
    variants.len()
}

#[test]
fn architecture_counts_the_formats() {
    let text = read("ARCHITECTURE.md");
    let expected = format!("in {} formats", formats());
    assert!(
        text.contains(&expected),
        "ARCHITECTURE.md lacks: {expected}"
    );
}

#[test]
fn the_demo_is_described_as_it_is() {
    let cast = read("crates/morec-cli/src/commands/demo/cast.rs");
    assert!(cast.contains("mocap.cs.cmu.edu") && cast.contains("referee"));
    let contributing = read("CONTRIBUTING.md");
    let line = contributing.lines().find(|line| line.contains("-- demo"));
    assert!(
        line.is_some_and(|line| line.contains("referees")),
        "{line:?}"
    );
    let readme = read("README.md");
    let (_, after) = readme
        .split_once("\ncargo run --release -- demo\n")
        .unwrap();
    let text = after.split("```").nth(1).unwrap();
    assert!(
        text.contains("referees") && text.contains("mocap.cs.cmu.edu"),
        "{text}"
    );
}

/// The library recognises a stream without hips by the shoulders (`features::observe`): no document may deny it.
#[test]
fn documents_agree_about_hips() {
    let observe = read("crates/morec-features/src/observe.rs");
    assert!(observe.contains("fn shoulders_stand_in_for_hips_that_are_never_seen()"));
    for path in [
        "docs/guide/limits.md",
        "docs/guide/train.md",
        "docs/guide/live.md",
    ] {
        let text = markdown::prose(&read(path)).replace('\n', " ");
        let about: Vec<_> = text.split(". ").filter(|s| s.contains("hips")).collect();
        let shoulders = about
            .iter()
            .any(|s| s.contains("shoulders") || s.contains("left_arm"));
        assert!(
            shoulders,
            "{path} does not say what stands in for hips: {about:#?}"
        );
        let denied = about
            .iter()
            .find(|s| s.contains("not recognised") || s.contains("needs hips and"));
        assert_eq!(denied, None, "{path}");
    }
}

/// Faults of the page of decisions: entries without a reason, headings over nothing.
fn undecided(text: &str) -> Vec<String> {
    let mut faults = vec![];
    for table in tables(text) {
        for row in &table.rows {
            if row.len() != table.header.len() || row.iter().any(|cell| cell.is_empty()) {
                faults.push(format!("{}: {}", table.section, row.join(" | ")));
            }
        }
    }
    let mut heading = None;
    for line in text
        .lines()
        .filter(|line| !line.is_empty())
        .chain(["# end"])
    {
        let level = line.chars().take_while(|c| *c == '#').count();
        if let Some((above, before)) = heading
            && level > 0
            && level <= before
        {
            faults.push(format!("nothing under {above}"));
        }
        heading = (level > 0).then_some((line, level));
    }
    faults
}

#[test]
fn every_decision_has_a_reason() {
    let table = "| decision | reason |\n|---|---|\n";
    let text = format!("# A\n## B\n## C\n{table}| a | b |\n| a | |\n");
    assert_eq!(undecided(&text), ["C: a | ", "nothing under ## B"]);

    let text = read("docs/decisions.md");
    assert!(tables(&text).iter().map(|t| t.rows.len()).sum::<usize>() > 40);
    let faults = undecided(&text);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Crates that a manifest names on lines of their own.
fn dependencies() -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let crates = folders("crates")
        .into_iter()
        .map(|name| format!("crates/{name}/Cargo.toml"));
    let others = ["Cargo.toml", "xtask/Cargo.toml"].map(str::to_owned);
    for path in crates.chain(others) {
        let mut inside = false;
        for line in read(&path).lines() {
            if line.starts_with('[') {
                inside = line.ends_with("dependencies]");
            } else if let Some((name, _)) = line.split_once('=').filter(|_| inside) {
                let name = name.trim().trim_end_matches(".workspace");
                if !name.is_empty() && !name.contains(['"', '#', ' ']) {
                    names.insert(name.to_owned());
                }
            }
        }
    }
    names
}

#[test]
fn every_dependency_is_a_decision_and_none_is_refused() {
    let text = read("docs/decisions.md");
    let dependencies = dependencies();
    assert!(dependencies.len() > 30, "{dependencies:?}");
    let words: BTreeSet<_> = inline_code(&text).collect();
    let undecided: Vec<_> = dependencies
        .iter()
        .filter(|name| !name.starts_with("morec") && !words.contains(name.as_str()))
        .collect();
    assert!(
        undecided.is_empty(),
        "not in docs/decisions.md: {undecided:?}"
    );
    let refused = tables(&text)
        .into_iter()
        .find(|t| t.section == "Not taken")
        .unwrap();
    for row in &refused.rows {
        let taken: Vec<_> = inline_code(row[0])
            .filter(|name| dependencies.contains(*name))
            .collect();
        assert!(taken.is_empty(), "refused and taken: {taken:?}");
    }
}

#[test]
fn rust_in_documents_is_compiled() {
    let library = |path: &str| match path.strip_suffix("/README.md") {
        Some(folder) => (
            read(&format!("{folder}/src/lib.rs")),
            "../README.md".to_owned(),
        ),
        None => (read("xtask/src/lib.rs"), format!("../../{path}")),
    };
    let mut compiled = 0;
    for (path, text) in sources::documents() {
        let blocks: Vec<_> = text
            .lines()
            .filter(|line| line.starts_with("```rust"))
            .collect();
        if blocks.is_empty() {
            continue;
        }
        assert!(
            blocks.iter().all(|block| !block.contains("ignore")),
            "{path}: {blocks:?}"
        );
        let (text, named) = library(&path);
        assert!(
            text.contains(&format!("include_str!(\"{named}\")")),
            "{path}"
        );
        compiled += 1;
    }
    assert!(compiled >= 4);
}
