#![no_main]
//! Any bytes read as HDF5 of poses: no panic, no position that is not finite, and what was read can be prepared.

use libfuzzer_sys::fuzz_target;
use morec::formats::hdf5;
use morec_fuzz::{LIMITS, check_points};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(loaded) = hdf5::read(bytes, "clip", None, &LIMITS) {
        check_points(loaded);
    }
});
