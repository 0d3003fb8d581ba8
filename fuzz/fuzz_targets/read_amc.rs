#![no_main]
//! Any bytes read as a motion of a small arm: no panic, no NaN, every frame whole.

use libfuzzer_sys::fuzz_target;
use morec::formats::acclaim::{AmcOptions, read_amc, read_asf};
use morec_fuzz::{LIMITS, check};

const ARM: &[u8] = include_bytes!("../../crates/mocap/testdata/acclaim/arm.asf");

fuzz_target!(|bytes: &[u8]| {
    let (arm, _) = read_asf(ARM, &LIMITS).expect("the arm is a skeleton");
    if let Ok(loaded) = read_amc(bytes, "clip", &arm, &AmcOptions::default(), &LIMITS) {
        loaded.clips.iter().for_each(check);
    }
});
