//! The documents stay true: their commands run, their options exist, their links lead somewhere.
//!
//! README and every chapter of `docs/guide/` run on synthetic clips that carry the names of the text ([`fixture`]); commands
//! of all other documents are checked for their options only. A comment on the line above a block changes that:
//!
//! - `<!-- check: options -->`: nothing runs, options are checked;
//! - `<!-- check: real clips -->`: it runs only where the real clips are;
//! - `<!-- check: output -->`: it also runs on the real clips, where they are, and prints the lines that it shows;
//! - `<!-- check: output everywhere -->`: it prints the lines that it shows, whatever clips there are;
//! - `<!-- check: none -->`: nothing is checked.
//!
//! `morec live` listens to a clip wherever its index is in the folder; elsewhere, and of `morec send`, options are checked.

mod blocks;
mod fixture;
mod links;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::kit;
use blocks::{Block, Check, blocks};
use fixture::Fixture;

/// The folder of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The Markdown files in a folder of the repository, in order.
fn documents_in(folder: &str) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(root().join(folder))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "md"))
        .collect();
    paths.sort();
    paths
}

/// Documents whose commands are run.
fn guide() -> Vec<PathBuf> {
    let mut paths = vec![root().join("README.md")];
    paths.extend(documents_in("docs/guide"));
    paths
}

/// Documents whose commands are checked for their options.
fn others() -> Vec<PathBuf> {
    let mut paths = vec![
        root().join("ARCHITECTURE.md"),
        root().join("CONTRIBUTING.md"),
        root().join("crates/morec-capi/README.md"),
    ];
    paths.extend(documents_in("docs"));
    paths.extend(documents_in("docs/formats"));
    paths
}

/// Way in which the commands of a block are run.
#[derive(Clone, Copy, PartialEq)]
enum Mode {
    /// All but those that wait for the network or do not end.
    Run,
    /// The same, and what they print is compared with what the block shows.
    Compare,
    /// With `--help` behind them: an option or value that does not exist is an error before that.
    Options,
}

/// The shell's functions in place of the commands that a block names.
fn prelude(mode: Mode) -> &'static str {
    match mode {
        Mode::Run | Mode::Compare => {
            r#"
set -e
morec() {
    case "$1" in
        send) "$MOREC" "$@" --help >/dev/null ;;
        live) if [ -f "$2" ]; then live "$@"; else "$MOREC" "$@" --help >/dev/null; fi ;;
        *) "$MOREC" "$@" ;;
    esac
}
# Listens to a clip in place of a tracker or a camera, and runs `true` in place of programs.
live() {
    left=$#
    option=
    while [ "$left" -gt 0 ]; do
        word=$1
        shift
        case "$option $word" in
            "--listen json:-") ;;
            "--listen "*) word="clip://$CLIP?speed=0" ;;
            "--on "*) word="${word%%=*}=true" ;;
            "--emit ws:"*) word=ws://127.0.0.1:0 ;;
        esac
        option=$word
        set -- "$@" "$word"
        left=$((left - 1))
    done
    "$MOREC" "$@" --quiet
}
cargo() { [ "$*" != "run --release -- demo" ] || "$MOREC" demo --quiet; }
"#
        }
        Mode::Options => {
            r#"
morec() { "$MOREC" "$@" --help >/dev/null || exit; }
cargo() { :; }
"#
        }
    }
}

/// Runs the commands of a block in `folder` and returns what they print; the error says which failed and how.
fn run(block: &Block, mode: Mode, folder: &Path) -> Result<String, String> {
    let script = format!("set -u\n{}\nset -x\n{}\n:", prelude(mode), block.commands);
    let output = Command::new("sh")
        .args(["-c", &script])
        .env("MOREC", env!("CARGO_BIN_EXE_morec"))
        .env("CLIP", fixture::CLIP)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let printed = [&output.stdout[..], &output.stderr[..]].concat();
    let printed = String::from_utf8_lossy(&printed).into_owned();
    match output.status.success() {
        true => Ok(printed),
        false => Err(format!(
            "line {}, {}:\n{}\n{printed}",
            block.line, output.status, block.commands
        )),
    }
}

/// Fails if `printed` lacks a line that the block shows.
fn compare(block: &Block, printed: &str) -> Result<(), String> {
    let lines: Vec<&str> = printed.lines().map(str::trim).collect();
    let missing = block
        .output
        .iter()
        .find(|line| !lines.contains(&line.as_str()));
    match missing {
        None => Ok(()),
        Some(line) => Err(format!(
            "line {}: this is not printed any more:\n{line}\nbut this is:\n{printed}",
            block.line
        )),
    }
}

/// Runs the blocks of one document that `wanted` chooses, in order, in a folder of its own; returns what failed.
fn run_document(
    path: &Path,
    fixture: &Fixture,
    wanted: impl Fn(&Block) -> Option<Mode>,
) -> Option<String> {
    let text = std::fs::read_to_string(path).unwrap();
    let chosen: Vec<(Block, Mode)> = blocks(&text)
        .into_iter()
        .filter_map(|block| wanted(&block).map(|mode| (block, mode)))
        .collect();
    if chosen.is_empty() {
        return None;
    }
    let folder = fixture.copy();
    let failed = chosen.iter().find_map(|(block, mode)| {
        let printed = run(block, *mode, folder.path());
        let compared = printed.and_then(|printed| match mode {
            Mode::Compare => compare(block, &printed),
            _ => Ok(()),
        });
        compared.err()
    });
    failed.map(|why| format!("{}, {why}", path.display()))
}

/// Runs documents beside each other; fails with everything that failed.
fn run_documents(
    paths: &[PathBuf],
    fixture: &Fixture,
    wanted: impl Fn(&Block) -> Option<Mode> + Sync,
) {
    let wanted = &wanted;
    let failed: Vec<String> = std::thread::scope(|scope| {
        let running: Vec<_> = paths
            .iter()
            .map(|path| scope.spawn(move || run_document(path, fixture, wanted)))
            .collect();
        running
            .into_iter()
            .filter_map(|r| r.join().unwrap())
            .collect()
    });
    assert!(
        failed.is_empty(),
        "commands that do not work (see the comment at the top of tests/it/documents/mod.rs):\n\n{}",
        failed.join("\n\n")
    );
}

#[test]
fn commands_of_readme_and_guide_run() {
    run_documents(&guide(), &Fixture::synthetic(), |block| match block.check {
        Check::Run | Check::Output => Some(Mode::Run),
        Check::OutputEverywhere => Some(Mode::Compare),
        Check::Options => Some(Mode::Options),
        Check::RealClips | Check::None => None,
    });
}

#[test]
#[ignore = "takes long and finds little that synthetic clips do not; .ci/nightly runs it"]
fn commands_on_real_clips_run_and_print_what_is_shown() {
    let Some(data) = kit::data() else { return };
    run_documents(&guide(), &Fixture::real(&data), |block| match block.check {
        Check::RealClips => Some(Mode::Run),
        Check::Output => Some(Mode::Compare),
        _ => None,
    });
}

#[test]
fn commands_of_other_documents_have_options_that_exist() {
    run_documents(&others(), &Fixture::empty(), |block| {
        (block.check != Check::None).then_some(Mode::Options)
    });
}

#[test]
fn a_command_that_does_not_work_is_noticed() {
    let fixture = Fixture::empty();
    let fails = |commands: &str, mode| {
        let text = format!("```sh\n{commands}\n```\n");
        run(&blocks(&text)[0], mode, fixture.copy().path()).is_err()
    };
    assert!(fails("morec inspect missing.bvh", Mode::Run));
    assert!(!fails("morec inspect missing.bvh", Mode::Options));
    assert!(fails(
        "morec inspect missing.bvh --no-such-option",
        Mode::Options
    ));
    assert!(fails("morec live x.index --no-such-option", Mode::Run));
    assert!(fails(
        "morec inspect --json > x.index\nmorec live x.index --listen webcam",
        Mode::Run
    ));
    assert!(fails("morec no-such-command", Mode::Options));
    let shown = &blocks("```console\n$ morec --version\nmorec 1\n…\nend\n```\n")[0];
    assert!(compare(shown, "begin\n morec 1\nmore\nend\n").is_ok());
    assert!(compare(shown, "begin\nmorec 2\nend\n").is_err());
}
