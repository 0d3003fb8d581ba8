//! Test helpers for all crates: bodies, the folder of real clips, and the report of skipped tests. Not part of the public
//! interface.

use std::io::Write;
use std::path::{Path, PathBuf};

#[path = "test_bodies.rs"]
mod bodies;

pub use bodies::{at_a_desk, clip_of_hands, flat_hand, pushing};

/// Classes of signals among the clips of referees.
pub const SIGNALS: [&str; 7] = [
    "traveling",
    "illegal_dribble",
    "visible_count",
    "no_score",
    "hands_up",
    "pushing",
    "stop_clock",
];

/// The folder of real clips: `MOREC_DATA`, or `../shared/data` beside the repository. Where it is missing, says that the
/// calling test is skipped.
pub fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("MOREC_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"),
        PathBuf::from,
    );
    if folder.join("referee").is_dir() {
        return Some(folder);
    }
    skipped(&format!(
        "no motion data at {} (set MOREC_DATA)",
        folder.display()
    ));
    None
}

/// Says that the calling test is skipped, and why. Written to standard error directly: what `println!` and `eprintln!`
/// write is shown for failing tests only, unless `--nocapture` is given.
pub fn skipped(why: &str) {
    let test = std::thread::current();
    let name = test.name().unwrap_or("a test");
    // One call, so that lines of tests that run at the same time do not mix; a closed stream loses the message only.
    _ = std::io::stderr().write_all(format!("skipped: {name}: {why}\n").as_bytes());
}

/// A real file of the folder's `formats`; where it is missing, says that the calling test is skipped.
pub fn real_file(name: &str) -> Option<Vec<u8>> {
    let path = data()?.join("formats").join(name);
    let bytes = std::fs::read(&path).ok();
    if bytes.is_none() {
        skipped(&format!("no {}", path.display()));
    }
    bytes
}
