//! No files of one crate need each other, nor do its top-level modules: a reader of one comes to an end.

mod modules;
mod uses;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::sources;
use modules::Modules;
pub use modules::is_test;
use uses::{Uses, uses};

/// `lib.rs`, `main.rs` and `mod.rs` are the module of their folder, every other file one of its own name.
fn module_of(path: &Path) -> Vec<String> {
    let parts = path.with_extension("");
    let mut parts: Vec<String> = (parts.iter())
        .map(|part| part.to_string_lossy().into_owned())
        .collect();
    let root = parts.len() == 1 && (parts[0] == "lib" || parts[0] == "main");
    if root || parts.last().is_some_and(|last| last == "mod") {
        parts.pop();
    }
    parts
}

/// Reads a crate's files, whose paths are those below its folder of sources.
fn arrows(files: &[(&Path, &str)]) -> Vec<Uses> {
    let parsed: Vec<_> = (files.iter())
        .map(|(path, text)| {
            let parsed = syn::parse_file(text);
            let parsed = parsed.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            (module_of(path), parsed.items)
        })
        .collect();
    let mut modules = Modules::default();
    for (file, (path, items)) in parsed.iter().enumerate() {
        modules.add(path, file, items);
    }
    (parsed.iter().enumerate())
        .map(|(file, (path, items))| {
            let mut used = uses(&modules, path, items);
            used.remove(&file);
            used
        })
        .collect()
}

/// Groups of files of which each is reached from each other one.
fn circles(arrows: &[Uses]) -> Vec<Vec<usize>> {
    let reached: Vec<BTreeSet<&usize>> = (arrows.iter())
        .map(|first| {
            let mut reached = BTreeSet::from_iter(first.keys());
            let mut open = Vec::from_iter(first.keys());
            while let Some(file) = open.pop() {
                open.extend(arrows[*file].keys().filter(|file| reached.insert(file)));
            }
            reached
        })
        .collect();
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for file in 0..arrows.len() {
        let mut mutual = (reached[file].iter()).filter(|other| reached[***other].contains(&file));
        if let Some(first) = mutual.next() {
            groups.entry(**first).or_default().push(file);
        }
    }
    groups.into_values().collect()
}

fn found(files: &[(&str, &str)]) -> Vec<Vec<usize>> {
    let files: Vec<_> = (files.iter())
        .map(|(path, text)| (Path::new(*path), *text))
        .collect();
    circles(&arrows(&files))
}

#[test]
fn circles_are_found_through_any_way_of_naming() {
    let a_to_b = |text| [("lib.rs", "mod a; mod b;"), ("a.rs", text), ("b.rs", "")];
    let b = "use crate::a::A; pub struct B(A); pub fn b() {} #[macro_export] macro_rules! c { () => {} }";
    for a in [
        "use crate::b::B; pub struct A;",
        "use super::b; pub struct A; fn f() { b::b() }",
        "use crate::{b::{self as other}}; pub struct A; fn f() { other::b() }",
        "pub struct A; fn f() { crate::b::b() }",
        "pub struct A; fn f() { assert!(crate::b::b() == ()) }",
        "pub struct A(Option<super::b::B>);",
        "use super::b::*; pub struct A; impl From<B> for A {}",
        "pub use crate::b::B; pub struct A; impl A { fn f(_: &B) {} }",
    ] {
        let mut files = a_to_b(a);
        assert!(found(&files).is_empty(), "{a}");
        files[2].1 = b;
        assert_eq!(found(&files), [[1, 2]], "{a}");
    }
    // Passing on, naming in tests and in comments is no use; nor is another crate's module of the same name.
    for a in [
        "pub use crate::b::B; pub struct A;",
        "pub struct A; #[cfg(test)] mod tests { use crate::b::B; }",
        "/// [`crate::b::B`]\npub struct A; // crate::b::b()",
        "pub struct A; fn f() { ::b::b() }",
    ] {
        let mut files = a_to_b(a);
        files[2].1 = b;
        assert!(found(&files).is_empty(), "{a}");
    }
}

#[test]
fn circles_are_found_through_what_a_module_passes_on() {
    let files = [
        ("lib.rs", "mod outer; mod far; pub use outer::A;"),
        ("outer/mod.rs", "mod a; mod b; pub use a::A; use b::b;"),
        ("outer/a.rs", "pub struct A; fn f() { super::b() }"),
        ("outer/b.rs", "pub fn b() { crate::far::far() }"),
        ("far.rs", "use crate::A; pub fn far() {}"),
    ];
    assert_eq!(found(&files), [[2, 3, 4]]);
}

#[test]
fn no_files_of_a_crate_need_each_other() {
    let mut lines = vec![];
    for (name, files) in sources::by_crate() {
        let read: Vec<_> = (files.iter())
            .map(|(path, text)| (path.as_path(), text.as_str()))
            .collect();
        let arrows = arrows(&read);
        let shown = |file: &usize| files[*file].0.display().to_string();
        for circle in circles(&arrows) {
            lines.push(format!("{name}: {} files", circle.len()));
            for file in &circle {
                for (used, names) in arrows[*file].iter().filter(|(f, _)| circle.contains(f)) {
                    let names = Vec::from_iter(names.iter().map(String::as_str)).join(", ");
                    lines.push(format!("    {} -> {}: {names}", shown(file), shown(used)));
                }
            }
        }
    }
    assert!(
        lines.is_empty(),
        "files that need each other:\n{}",
        lines.join("\n")
    );
}

/// The top-level modules of one crate, and what the files of each use of others.
fn module_arrows(files: &[(&Path, &str)]) -> (Vec<String>, Vec<Uses>) {
    let top: Vec<Option<String>> = (files.iter())
        .map(|(path, _)| module_of(path).into_iter().next())
        .collect();
    let names = Vec::from_iter(BTreeSet::from_iter(top.iter().flatten().cloned()));
    let number = |file: usize| {
        names
            .iter()
            .position(|name| Some(name) == top[file].as_ref())
    };
    let mut modules = vec![Uses::new(); names.len()];
    for (file, used) in arrows(files).into_iter().enumerate() {
        for (other, words) in used {
            if let (Some(from), Some(to)) = (number(file), number(other))
                && from != to
            {
                modules[from].entry(to).or_default().extend(words);
            }
        }
    }
    (names, modules)
}

#[test]
fn circles_of_modules_are_found_and_the_root_is_none() {
    let files = [
        (
            "lib.rs",
            "mod a; mod b; pub use a::A; pub fn f() { b::b() }",
        ),
        ("a/mod.rs", "mod inner; pub struct A; fn f() { inner::f() }"),
        ("a/inner.rs", "pub fn f() { crate::b::b() }"),
        ("b.rs", "use crate::A; pub fn b() {}"),
    ]
    .map(|(path, text)| (Path::new(path), text));
    let (names, arrows) = module_arrows(&files);
    assert_eq!(
        (names, circles(&arrows)),
        (vec!["a".into(), "b".into()], vec![vec![0, 1]])
    );
}

#[test]
fn no_modules_of_a_crate_need_each_other() {
    let mut lines = vec![];
    for (name, files) in sources::by_crate() {
        let read: Vec<_> = (files.iter())
            .map(|(path, text)| (path.as_path(), text.as_str()))
            .collect();
        let (names, arrows) = module_arrows(&read);
        for circle in circles(&arrows) {
            for from in &circle {
                for (to, words) in arrows[*from].iter().filter(|(to, _)| circle.contains(to)) {
                    let words = Vec::from_iter(words.iter().map(String::as_str)).join(", ");
                    lines.push(format!(
                        "{name}: {} -> {}: {words}",
                        names[*from], names[*to]
                    ));
                }
            }
        }
    }
    assert!(
        lines.is_empty(),
        "modules that need each other:\n{}",
        lines.join("\n")
    );
}
