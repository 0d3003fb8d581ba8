//! For another platform (`.ci/platforms`): finds there what `examples/conformance.rs` wrote into a folder, to the bit.
//!
//!     conformance_check target/npm/cases

// It is no part of the library.
#![allow(clippy::print_stdout)]

#[allow(dead_code)] // Writing is the example's.
#[path = "mod.rs"]
mod cases;

use std::fs;
use std::path::PathBuf;

use morec::MotionIndex;

use cases::{Case, Outcome};

fn main() -> Outcome<()> {
    let folder = PathBuf::from(std::env::args_os().nth(1).ok_or("expected a folder")?);
    let cases: Vec<Case> = serde_json::from_slice(&fs::read(folder.join("cases.json"))?)?;
    for case in &cases {
        let (name, expected) = (&case.name, &case.detections);
        let bytes = fs::read(case.index_file(&folder))?;
        let index = MotionIndex::from_bytes(&bytes)?;
        if index.to_bytes()? != bytes {
            return Err(format!("{name}: the index is written otherwise").into());
        }
        let found = case.found_by(&index)?;
        if found != *expected {
            return Err(format!("{name}: expected {expected:?}, found {found:?}").into());
        }
        let count: usize = found
            .iter()
            .filter_map(|rows| Some(rows.as_array()?.len()))
            .sum();
        println!(
            "{name}: {count} detections, to the bit; {:.1} µs a push",
            case.push_us_of(&index.into())?
        );
    }
    Ok(())
}
