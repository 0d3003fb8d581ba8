use crate::kit::{Folder, WAVE_BVH};

#[test]
fn clips_are_played_as_lines_where_nobody_watches_and_as_a_page() {
    let folder = Folder::with(&[
        ("wave.bvh", WAVE_BVH),
        (
            "labels.tsv",
            "clip\tstart\tstop\tclass\nwave\t0\t2\thello\n",
        ),
    ]);
    let out = folder.morec(&["play", "wave.bvh"]).ok();
    assert!(out.starts_with("wave: "), "{out}");
    let ran = folder.morec(&[
        "play",
        "wave.bvh",
        "--labels",
        "labels.tsv",
        "-o",
        "page.html",
    ]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(
        page.contains("hello") && page.contains("const clips = ["),
        "{}",
        &page[..400]
    );
    let ran = folder.morec(&["play", "wave.bvh", "-o", "wave.bvh"]);
    assert_eq!(ran.code, Some(1), "the clip is not overwritten: {ran:?}");
}

#[test]
fn shells_and_man_know_every_command() {
    let folder = Folder::with(&[]);
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = folder.morec(&["completions", shell]).ok();
        assert!(
            script.contains("recognize") && script.contains("inspect"),
            "{shell}"
        );
    }
    let ran = folder.morec(&["man", "pages"]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    for page in ["morec.1", "morec-train.1", "morec-db-import.1"] {
        assert!(folder.path().join("pages").join(page).is_file(), "{page}");
    }
}

#[test]
fn the_version_names_the_commit_where_there_is_one() {
    let folder = Folder::with(&[]);
    let version = folder.morec(&["--version"]).ok();
    let mut words = version.split_whitespace();
    assert_eq!(words.next(), Some("morec"));
    assert_eq!(words.next(), Some(env!("CARGO_PKG_VERSION")));
    if let Some(commit) = words.next() {
        let hex = commit.trim_matches(['(', ')']);
        assert!(
            hex.len() >= 7 && hex.chars().all(|c| c.is_ascii_hexdigit()),
            "{version}"
        );
    }
}

#[test]
fn errors_are_said_once() {
    let folder = Folder::with(&[("x.vmd", "Vocaloid Motion Data 0002\0\0")]);
    let ran = folder.morec(&["inspect", "x.vmd"]);
    assert_eq!(
        ran.err.matches("which is not supported").count(),
        1,
        "{ran:?}"
    );
    assert!(ran.err.contains("MikuMikuDance"), "{ran:?}");
}
