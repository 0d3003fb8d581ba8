//! Data flows one way: what recognises live knows nothing of training, files or measuring.

use std::fs;
use std::path::{Path, PathBuf};

/// What live recognition must do without.
const OFFLINE: [&str; 9] = [
    "train", "crossval", "formats", "labels", "eval", "report", "synth", "index", "smooth",
];

/// Modules of the live path.
const LIVE: [&str; 8] = [
    "live",
    "decode",
    "diagnosis",
    "features",
    "templates",
    "pivots",
    "pca",
    "svrdm",
];

struct Source {
    /// Module at the top: `live` for `live/recognizer.rs`.
    module: String,
    /// Depth below the crate's root: 0 for `lib.rs`, 1 for `live/mod.rs`, 2 for `live/recognizer.rs`.
    depth: usize,
    path: PathBuf,
    /// Without comments and tests.
    code: String,
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut folders, mut sources) = (vec![root.clone()], vec![]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let stem = path.file_stem().unwrap().to_str().unwrap();
            if path.is_dir() {
                folders.extend((stem != "tests").then_some(path));
            } else if path.extension().is_some_and(|e| e == "rs") && stem != "tests" {
                let within: Vec<_> = path
                    .strip_prefix(&root)
                    .unwrap()
                    .with_extension("")
                    .iter()
                    .map(|p| p.to_str().unwrap().to_owned())
                    .collect();
                let is_root = matches!(stem, "mod" | "lib");
                let code = code(&fs::read_to_string(&path).unwrap());
                sources.push(Source {
                    module: within[0].clone(),
                    depth: within.len() - usize::from(is_root),
                    path,
                    code,
                });
            }
        }
    }
    sources
}

/// `text` without line comments and without what follows `#[cfg(test)] mod … {`, which this project puts last.
fn code(text: &str) -> String {
    let lines: Vec<&str> = text
        .lines()
        .filter(|l| !l.trim_start().starts_with("//"))
        .collect();
    let code = lines.join("\n");
    match code
        .match_indices("#[cfg(test)]")
        .find(|(at, _)| code[*at..].lines().nth(1).is_some_and(|l| l.contains('{')))
    {
        Some((at, _)) => code[..at].to_owned(),
        None => code,
    }
}

/// The top modules that `code` names by `crate::…`, or by as many `super::` as lead to the root from `depth`.
fn imports(code: &str, depth: usize) -> Vec<String> {
    let up = "super::".repeat(depth.max(1));
    let mut found = vec![];
    for start in ["crate::", &up] {
        for (at, _) in code.match_indices(start) {
            let preceded = code[..at]
                .ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':' || c == '$');
            if !preceded {
                found.extend(heads(&code[at + start.len()..]));
            }
        }
    }
    found
}

/// First names of a path or of a group of paths: `a` of `a::b`, `a` and `c` of `{a::{b, x}, c}`.
fn heads(path: &str) -> Vec<String> {
    let name = |text: &str| {
        text.trim_start()
            .chars()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect::<String>()
    };
    let Some(group) = path.strip_prefix('{') else {
        return vec![name(path)];
    };
    let (mut depth, mut found) = (0, vec![name(group)]);
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => found.push(name(&group[at + 1..])),
            _ => {}
        }
    }
    found.retain(|n| !n.is_empty());
    found
}

#[test]
fn imports_are_read_in_every_form() {
    let text = "use crate::train::{align, mining};\nuse crate::{a::{b, c}, eval,\n synth::Rng};\nfn f() { crate::report::x() }\n\
                // crate::labels\nuse othercrate::index;\nuse super::super::formats::Limits;\n\
                #[cfg(test)]\nmod tests {\n use crate::crossval; }";
    let found = imports(&code(text), 2);
    assert_eq!(found, ["train", "a", "eval", "synth", "report", "formats"]);
}

#[test]
fn the_live_path_stands_alone() {
    let sources = sources();
    let live: Vec<&Source> = sources
        .iter()
        .filter(|s| LIVE.contains(&s.module.as_str()))
        .collect();
    assert!(
        LIVE.iter().all(|m| live.iter().any(|s| s.module == *m)),
        "a module of the live path is gone"
    );
    let read: usize = live.iter().map(|s| imports(&s.code, s.depth).len()).sum();
    assert!(read > 10, "only {read} imports were read");
    for source in live {
        for module in imports(&source.code, source.depth) {
            assert!(
                !OFFLINE.contains(&module.as_str()),
                "{} imports {module}",
                source.path.display()
            );
        }
    }
}

#[test]
fn the_library_touches_no_file_and_prints_nothing() {
    let forbidden = [
        "std::fs",
        "std::net",
        "std::process",
        "std::env",
        "println!",
        "print!",
        "dbg!",
        "File::open",
    ];
    let sources = sources();
    assert!(sources.len() > 50);
    // What opens files is the module of that name, and paths given to it.
    for source in sources.iter().filter(|s| s.module != "files") {
        for word in forbidden {
            assert!(
                !source.code.contains(word),
                "{} says {word}",
                source.path.display()
            );
        }
    }
}
