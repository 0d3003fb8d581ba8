#![no_main]
//! Any bytes read as SMD: no panic, no position that is not finite, and what was read can be prepared.

use libfuzzer_sys::fuzz_target;
use morec::formats::{Limits, smd};
use morec::import::{ImportOptions, normalize};

fuzz_target!(|bytes: &[u8]| {
    let limits = Limits {
        joints: 64,
        depth: 32,
        line_bytes: 4096,
        frames: 4096,
    };
    let Ok(loaded) = smd::read(bytes, "clip", &limits) else {
        return;
    };
    for clip in loaded.clips {
        assert_eq!(clip.rotations.len(), clip.frames * clip.skeleton.len());
        assert!(clip.tracks.iter().all(|t| t.positions.len() == clip.frames));
        let mut values = clip
            .tracks
            .iter()
            .flat_map(|t| t.positions.iter().flatten());
        assert!(values.all(|v| v.is_finite()));
        assert!(clip.rate_hz.is_finite() && clip.rate_hz > 0.0);
        normalize(clip, &ImportOptions::default()).expect("no mapping that could be wrong");
    }
});
