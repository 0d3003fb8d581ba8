//! Rules about imports that cargo features cannot express; the layers themselves are features (`.ci/run`). For every library below
//! `morec`, too (by `#[path]`).

use std::fs;
use std::path::{Path, PathBuf};

/// Every source file of the library, its top module and its code without comments and tests.
fn sources() -> Vec<(PathBuf, String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut folders, mut sources) = (vec![root.clone()], vec![]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let stem = path.file_stem().unwrap().to_str().unwrap().to_owned();
            if path.is_dir() {
                folders.extend((stem != "tests").then_some(path));
            } else if path.extension().is_some_and(|e| e == "rs") && stem != "tests" {
                let within = path.strip_prefix(&root).unwrap().with_extension("");
                let module = within.iter().next().unwrap().to_str().unwrap().to_owned();
                let code = code(&fs::read_to_string(&path).unwrap());
                sources.push((path, module, code));
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
    let mut marks = code.match_indices("#[cfg(test)]");
    let tests = marks.find(|(at, _)| code[*at..].lines().nth(1).is_some_and(|l| l.contains('{')));
    match tests {
        Some((at, _)) => code[..at].to_owned(),
        None => code,
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
    assert!(sources.len() > 10);
    // What opens files is the module of that name, and paths given to it; and what tests share. An index notes when it was trained, and
    // SOURCE_DATE_EPOCH fixes that.
    for (path, _, code) in sources
        .iter()
        .filter(|(_, module, _)| !["files", "testing"].contains(&&**module))
    {
        let dated = path.ends_with("train/train_index.rs");
        for word in forbidden
            .into_iter()
            .filter(|word| !(dated && *word == "std::env"))
        {
            assert!(!code.contains(word), "{} says {word}", path.display());
        }
    }
}

/// What the standard library takes from the system differs in its last bits from one system to the next, and detections must not.
#[test]
fn recognition_takes_no_function_from_the_system() {
    let modules = "decode import math roles templates train";
    // Those of rows and of the method of 2009 are all for recognition.
    let all = ["morec-features", "morec-svrdm"].contains(&env!("CARGO_PKG_NAME"));
    let functions = "sin() cos() sin_cos() tan() asin() acos() atan() atan2( exp() ln() log2() log10() powf( hypot( cbrt() tanh()";
    for (path, _, code) in (sources().iter())
        .filter(|(_, module, _)| all || modules.split(' ').any(|name| name == module))
    {
        for function in functions.split(' ') {
            let call = format!(".{function}");
            let (file, there) = (path.display(), code.contains(&call));
            assert!(
                !there,
                "{file} says {call}: use that of crate::math::portable"
            );
        }
    }
}
