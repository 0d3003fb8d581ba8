//! The source files of every crate, without those of tests.

use std::fs;
use std::path::{Path, PathBuf};

/// For each crate its name, and its files: paths below its folder `src`, and their text.
pub fn by_crate() -> Vec<(String, Vec<(PathBuf, String)>)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
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
