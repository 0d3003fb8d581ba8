#![no_main]
//! Any bytes read as NumPy arrays of positions: no panic, no position that is not finite, and what was read can be prepared.

use libfuzzer_sys::fuzz_target;
use morec::formats::numpy;
use morec_fuzz::{LIMITS, check_points};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(loaded) = numpy::read(bytes, "clip", None, &LIMITS) {
        check_points(loaded);
    }
});
