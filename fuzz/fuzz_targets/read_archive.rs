#![no_main]
//! Any bytes as a file of whatever kind, packed or not: no panic.

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use morec_db::FileReader;

fuzz_target!(|bytes: &[u8]| {
    let _ = FileReader::default().open(Path::new("-"), bytes);
});
