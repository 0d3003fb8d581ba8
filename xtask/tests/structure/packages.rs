//! What is published can be read and built by itself: licence texts, links, files that the sources include.

use std::path::{Component, Path};

use crate::markdown::lines;
use crate::sources::{read, root};

/// Folders of what goes to a registry, with the README that is shown there.
const PACKAGES: [(&str, &str); 12] = [
    ("crates/mocap", "README.md"),
    ("crates/morec", "README.md"),
    ("crates/morec-capi", "README.md"),
    ("crates/morec-cli", "README.md"),
    ("crates/morec-db", "README.md"),
    ("crates/morec-features", "README.md"),
    ("crates/morec-live", "README.md"),
    ("crates/morec-measure", "README.md"),
    ("crates/morec-ops", "README.md"),
    ("crates/morec-svrdm", "README.md"),
    ("crates/morec-py", "README.md"),
    ("crates/morec-wasm", "npm/README.md"),
];

#[test]
fn every_crate_is_a_package_or_is_not_published() {
    for folder in std::fs::read_dir(root().join("crates")).unwrap() {
        let name = folder.unwrap().file_name().into_string().unwrap();
        let manifest = read(&format!("crates/{name}/Cargo.toml"));
        let listed = PACKAGES
            .iter()
            .find(|(path, _)| path.ends_with(&format!("/{name}")));
        let published = !manifest.contains("\npublish = false");
        assert!(listed.is_some() || !published, "{name} is not in the list");
        if let Some((_, readme)) = listed {
            assert!(
                manifest.contains(&format!("\nreadme = \"{readme}\"")),
                "{name}"
            );
            assert!(manifest.contains("\nrepository.workspace = true"), "{name}");
        }
    }
}

#[test]
fn packages_have_the_texts_of_their_licences() {
    // The npm package is given them when it is built.
    for (folder, _) in PACKAGES.iter().filter(|(path, _)| !path.ends_with("wasm")) {
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            assert!(
                read(&format!("{folder}/{licence}")) == read(licence),
                "{folder}: {licence}"
            );
        }
    }
}

/// Addresses of links that lead nowhere from a registry's page.
fn relative_links(text: &str) -> Vec<&str> {
    let prose = lines(text).filter(|(_, code)| !code);
    let links = prose.flat_map(|(line, _)| line.split("](").skip(1));
    links
        .map(|rest| rest.split(')').next().unwrap_or_default())
        .filter(|address| !address.starts_with("https://") && !address.starts_with('#'))
        .collect()
}

#[test]
fn links_of_packages_work_outside_of_the_repository() {
    let text = "[a](https://a.b) [c](#c) [d](../d.md)\n```\n[e](f)\n```\n";
    assert_eq!(relative_links(text), ["../d.md"]);
    for (folder, readme) in PACKAGES {
        let text = read(&format!("{folder}/{readme}"));
        let broken = relative_links(&text);
        assert!(broken.is_empty(), "{folder}/{readme}: {broken:?}");
    }
}

/// The path of `file`, included by a source in `folder`, below the package's folder; none if it lies outside.
fn within(folder: &Path, file: &str) -> Option<String> {
    let mut parts = vec![];
    for part in folder.join(file).components() {
        match part {
            Component::ParentDir => drop(parts.pop()?),
            part => parts.push(part.as_os_str().to_string_lossy().into_owned()),
        }
    }
    Some(parts.join("/"))
}

#[test]
fn sources_include_what_is_in_their_package() {
    assert_eq!(within(Path::new("src/a"), "../../b/c"), Some("b/c".into()));
    assert_eq!(within(Path::new("src"), "../../b"), None);
    let mut included = 0;
    for (folder, _) in PACKAGES {
        let manifest = read(&format!("{folder}/Cargo.toml"));
        let exclude = manifest.lines().find(|line| line.starts_with("exclude = "));
        let excluded: Vec<_> = exclude
            .into_iter()
            .flat_map(|line| line.split('"').skip(1).step_by(2))
            .collect();
        let sources = walk(&root().join(folder).join("src"));
        for path in sources {
            let text = std::fs::read_to_string(&path).unwrap();
            let inside = path.strip_prefix(root().join(folder)).unwrap();
            for word in ["include_str!(\"", "include_bytes!(\"", "#[path = \""] {
                for rest in text.split(word).skip(1) {
                    let file = rest.split('"').next().unwrap_or_default();
                    let file = within(inside.parent().unwrap(), file);
                    let packed = file.as_deref().is_some_and(|file| {
                        !excluded
                            .iter()
                            .any(|prefix| file.starts_with(&format!("{prefix}/")))
                    });
                    assert!(
                        packed,
                        "{} includes what is not in the package: {file:?}",
                        path.display()
                    );
                    included += 1;
                }
            }
        }
    }
    assert!(included > 20, "{included}");
}

/// The Rust files below a folder, tests among them.
fn walk(folder: &Path) -> Vec<std::path::PathBuf> {
    let (mut files, mut folders) = (vec![], vec![folder.to_owned()]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                files.push(path);
            }
        }
    }
    files
}
