#![no_main]
//! Any bytes read as glTF: no panic, no NaN, and what was read can be written as BVH.

use libfuzzer_sys::fuzz_target;
use morec::formats::gltf;
use morec_fuzz::{LIMITS, check_rotations};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(loaded) = gltf::read(bytes, "clip", &|_| Err(std::io::ErrorKind::NotFound.into()), &LIMITS) {
        check_rotations(&loaded);
    }
});
