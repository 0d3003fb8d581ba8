#![no_main]
//! Any bytes read as NTU RGB+D's skeletons: no panic, no position that is not finite, and what was read can be prepared.

use libfuzzer_sys::fuzz_target;
use morec::formats::ntu;
use morec_fuzz::{LIMITS, check_points};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(loaded) = ntu::read(bytes, "clip", None, &LIMITS) {
        check_points(loaded);
    }
});
