#![no_main]
//! Any bytes read as MVNX: no panic, no NaN, and what was read can be written as BVH.

use libfuzzer_sys::fuzz_target;
use morec::formats::mvnx;
use morec_fuzz::{LIMITS, check_rotations};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(loaded) = mvnx::read(bytes, "clip", &LIMITS) {
        check_rotations(&loaded);
    }
});
