//! The examples, built by every compiler there is, statically and shared, with sanitizers where there are any, and run.

use std::fmt::Write as _;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::Command;

use morec::live::Detection;

use crate::compilers::{Compiler, Language, Link, succeed};
use crate::eight;
use crate::kit::{self, index};
use crate::made;
use mocap::testing::skipped;

/// Lines as the examples print them.
fn lines(found: &[Detection]) -> String {
    found.iter().fold(String::new(), |mut text, d| {
        let class = index().model.class_name(d.class);
        writeln!(
            text,
            "{class} {:.4} {:.4} {:.4}",
            d.span.start_secs, d.span.stop_secs, d.score
        )
        .unwrap();
        text
    })
}

/// A stream as `stream.c` reads it, and what is in it.
pub fn stream(path: &Path) -> String {
    let (bones, poses) = made::poses(&kit::take(60.0));
    let mut text = String::new();
    for (time_secs, pose) in &poses {
        write!(text, "{time_secs:?}").unwrap();
        kit::positions(pose)
            .iter()
            .for_each(|c| write!(text, " {c:?}").unwrap());
        text.push('\n');
    }
    std::fs::write(path, text).unwrap();
    let mut recognizer = morec::live::Recognizer::new(&index().model, bones).unwrap();
    let mut found = Vec::new();
    recognizer.push_all(&poses, &mut found);
    found.extend_from_slice(recognizer.finish());
    assert_eq!(found.len(), 2);
    lines(&found)
}

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")
}

#[test]
fn the_examples_build_and_run() {
    let compilers = Compiler::all();
    if cfg!(windows) || compilers.is_empty() {
        skipped("no compiler of C or C++ (cc, gcc, clang, c++, g++, clang++)");
        return;
    }
    let files = eight::files();
    let poses = files.path("poses.txt");
    let (of_stream, of_clip) = (stream(&poses), lines(&eight::expected()));
    for compiler in &compilers {
        let sanitizes = compiler.sanitizes(&files.folder);
        if !sanitizes {
            skipped(&format!("{}: sanitizers do not work", compiler.command));
        }
        for link in [Link::Static, Link::Shared] {
            for sanitize in [false, true] {
                // Sanitizers see the example's own code, which is the same with both links.
                if sanitize && (!sanitizes || link == Link::Static) {
                    continue;
                }
                let run = |source: &str, arguments: &[&str], input: Option<&Path>| {
                    let program = files.path(&format!("{}-{link:?}-{sanitize}", compiler.command));
                    compiler
                        .build(&examples().join(source), &program, link, sanitize)
                        .unwrap();
                    let mut command = Command::new(&program);
                    command.args(arguments);
                    if let Some(input) = input {
                        command.stdin(File::open(input).unwrap());
                    }
                    String::from_utf8(succeed(&mut command).unwrap().stdout).unwrap()
                };
                let (index, clip) = (files.index.to_str().unwrap(), files.clip.to_str().unwrap());
                let about = format!("{compiler:?}, {link:?}, sanitized: {sanitize}");
                assert_eq!(
                    run("stream.c", &[index], Some(&poses)),
                    of_stream,
                    "{about}"
                );
                let listing = match compiler.language {
                    Language::C => "listing_4_1.c",
                    Language::Cpp => "listing_4_1.cpp",
                };
                assert_eq!(
                    run(listing, &[index, clip, "inf"], None),
                    of_clip,
                    "{about}"
                );
                eprintln!("{about}: runs");
            }
        }
    }
}

#[test]
fn a_program_that_is_told_nonsense_says_so() {
    let Some(compiler) = Compiler::all()
        .into_iter()
        .find(|c| c.language == Language::C)
    else {
        skipped("no compiler of C (cc, gcc, clang)");
        return;
    };
    if cfg!(windows) {
        return;
    }
    let files = eight::files();
    let program = files.path("nonsense");
    compiler
        .build(
            &examples().join("listing_4_1.c"),
            &program,
            Link::Static,
            false,
        )
        .unwrap();
    let (index, clip) = (files.index.to_str().unwrap(), files.clip.to_str().unwrap());
    for (arguments, word) in [
        ([clip, clip, "1"], "not a morec index"),
        ([index, index, "1"], "gestures.index"),
        ([index, "nowhere.bvh", "1"], "nowhere.bvh"),
        ([index, clip, "-1"], "speed"),
    ] {
        let output = Command::new(&program).args(arguments).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(said.contains(word), "{arguments:?}: {said}");
    }
}

#[test]
fn the_header_may_be_included_twice_and_after_others() {
    let folder = eight::files();
    let source = folder.path("twice.c");
    let text = "#include <math.h>\n#include \"morec.h\"\n#include \"morec.h\"\n\
        int main(void) { MorecEvent e; MorecOptions o; MotionSeg s; return sizeof e == 120 && sizeof o == 56 && \
        sizeof s == 112 && MOREC_ROLE_RIGHT_HAND + 1 == MOREC_ROLE_COUNT ? 0 : 1; }\n";
    std::fs::write(&source, text).unwrap();
    for compiler in Compiler::all() {
        let program = folder.path(&format!("twice-{}", compiler.command));
        compiler
            .build(&source, &program, Link::Nothing, false)
            .unwrap();
        succeed(&mut Command::new(&program)).unwrap();
    }
}
