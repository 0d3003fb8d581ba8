#![no_main]
//! Any bytes as a file of whatever kind, packed or not: no panic.

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use morec::files::FileReader;
use morec_fuzz::LIMITS;

fuzz_target!(|bytes: &[u8]| {
    let reader = FileReader {
        limits: LIMITS,
        ..FileReader::default()
    };
    let _ = reader.parse(Path::new("clip"), bytes);
});
