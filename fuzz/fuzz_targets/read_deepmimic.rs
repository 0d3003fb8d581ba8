#![no_main]
//! Any bytes read as a motion of DeepMimic: no panic, no position that is not finite, and what was read can be prepared.

use libfuzzer_sys::fuzz_target;
use morec::formats::deepmimic;
use morec_fuzz::{LIMITS, check_points};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(loaded) = deepmimic::read(bytes, "clip", &LIMITS) {
        check_points(loaded);
    }
});
