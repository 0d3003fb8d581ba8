//! `unsafe` in the places that are known for it.

use std::path::Path;

use crate::sources;

/// Crates whose sources may hold `unsafe`: the C ABI, and bindings that are generated.
const BINDINGS: [&str; 3] = ["morec-capi", "morec-godot", "morec-wasm"];

/// Modules that may, and why.
const MODULES: &[(&str, &str, &str)] = &[(
    "morec",
    "templates/dot.rs",
    "processors' own instructions for products of 16-bit numbers",
)];

#[test]
fn unsafe_code_is_in_the_modules_that_are_known_for_it() {
    let mut found = vec![];
    for (folder, files) in sources::by_crate() {
        let holds = |text: &str| text.contains("(unsafe_code") || text.contains("unsafe {");
        let files = files.iter().filter(|(_, text)| holds(text));
        found.extend(files.map(|(path, _)| (folder.clone(), path.clone())));
    }
    found.retain(|(folder, _)| !BINDINGS.contains(&folder.as_str()));
    let known = MODULES
        .iter()
        .map(|(folder, path, _)| ((*folder).to_owned(), Path::new(path).to_owned()));
    assert_eq!(found, known.collect::<Vec<_>>());
}
