//! `morec studio` where the window is installed beside the command, and where it is not.

use std::process::Command;

use crate::kit::Folder;

/// The command alone in a folder, and a search path on which nothing is found.
fn alone(folder: &Folder) -> Command {
    let here = folder
        .path()
        .join(format!("morec{}", std::env::consts::EXE_SUFFIX));
    // A copy cannot be started while a process that another test begins meanwhile still has it open for writing.
    let command = env!("CARGO_BIN_EXE_morec");
    std::fs::hard_link(command, &here)
        .or_else(|_| std::fs::copy(command, &here).map(drop))
        .unwrap();
    let mut command = Command::new(here);
    command.env("PATH", folder.path().join("nothing"));
    command
}

#[test]
fn without_the_window_it_says_how_to_get_it() {
    let folder = Folder::with(&[]);
    let output = alone(&folder)
        .args(["studio", "moves.mdb"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).unwrap();
    // Both are commands that cargo carries out: the window needs its feature.
    let manifest = include_str!("../../../morec-studio/Cargo.toml");
    assert!(manifest.contains("required-features = [\"window\"]"));
    for advice in [
        "cargo install --path crates/morec-studio --features window",
        "cargo run --release -p morec-studio --features window",
    ] {
        assert!(said.contains(advice), "{said}");
    }
}

#[cfg(unix)]
#[test]
fn the_window_beside_the_command_is_started_with_the_words_that_were_typed() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::with(&[("morec-studio", "#!/bin/sh\necho \"$@\"\nexit 7\n")]);
    let window = folder.path().join("morec-studio");
    std::fs::set_permissions(&window, std::fs::Permissions::from_mode(0o755)).unwrap();
    let output = alone(&folder)
        .args(["studio", "moves.mdb", "--light"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(7), "its exit code is passed on");
    assert_eq!(
        String::from_utf8(output.stdout).unwrap(),
        "moves.mdb --light\n"
    );
}
