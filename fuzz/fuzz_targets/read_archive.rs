#![no_main]
//! Any bytes as a file of whatever kind, packed or not: no panic.

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use morec::files::FileReader;

fuzz_target!(|bytes: &[u8]| {
    let _ = FileReader::default().parse(Path::new("clip"), bytes);
});
