//! The source files of every crate, without those of tests, and the documents.

use std::fs;
use std::path::{Path, PathBuf};

/// The folder of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The text of a file of the repository.
pub fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// For each crate its name, and its files: paths below its folder `src`, and their text.
pub fn by_crate() -> Vec<(String, Vec<(PathBuf, String)>)> {
    let root = root();
    let mut crates = vec![root.join("xtask")];
    for member in fs::read_dir(root.join("crates")).unwrap() {
        crates.push(member.unwrap().path());
    }
    crates.sort();
    (crates.iter())
        .map(|folder| {
            let name = folder.file_name().unwrap().to_string_lossy().into_owned();
            (name, files(&folder.join("src")))
        })
        .collect()
}

fn files(source: &Path) -> Vec<(PathBuf, String)> {
    let (mut files, mut folders) = (vec![], vec![source.to_owned()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.file_stem().is_some_and(|stem| stem == "tests") {
                continue;
            }
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                files.push((path.strip_prefix(source).unwrap().to_owned(), text));
            }
        }
    }
    files.sort();
    files
}

/// All Markdown of the repository: paths below its folder, and text.
pub fn documents() -> Vec<(String, String)> {
    all_files(&["md"])
}

/// The files with these endings that belong to the repository, without what is built.
pub fn all_files(endings: &[&str]) -> Vec<(String, String)> {
    let root = root();
    let (mut files, mut folders) = (vec![], vec![root.clone()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if name.starts_with('.') || ["target", "testdata", "node_modules"].contains(&&*name) {
                continue;
            }
            let ending = path.extension().and_then(|ending| ending.to_str());
            if path.is_dir() {
                folders.push(path);
            } else if ending.is_some_and(|ending| endings.contains(&ending)) {
                let text = fs::read_to_string(&path).unwrap();
                let place = path.strip_prefix(&root).unwrap();
                files.push((place.to_string_lossy().replace('\\', "/"), text));
            }
        }
    }
    files.sort();
    files
}
