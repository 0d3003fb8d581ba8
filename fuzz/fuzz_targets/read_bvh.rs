#![no_main]
//! Any bytes read as BVH: no panic, no NaN, and what was read can be written and read again.

use libfuzzer_sys::fuzz_target;
use morec::formats::Limits;
use morec::formats::bvh::{self, BvhOptions};
use morec_fuzz::{LIMITS, check};

fuzz_target!(|bytes: &[u8]| {
    let Ok(loaded) = bvh::read(bytes, "clip", &BvhOptions::default(), &LIMITS) else {
        return;
    };
    for clip in &loaded.clips {
        check(clip);
        let mut written = Vec::new();
        bvh::write(clip, &mut written).expect("memory takes every byte");
        let again = bvh::read(&written, "clip", &BvhOptions::default(), &Limits::default())
            .expect("what was written can be read");
        assert_eq!(again.clips[0].frames, clip.frames);
        assert_eq!(again.clips[0].skeleton.len(), clip.skeleton.len());
    }
});
