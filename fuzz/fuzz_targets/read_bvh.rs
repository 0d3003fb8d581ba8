#![no_main]
//! Any bytes read as BVH: no panic, no NaN, and what was read can be written and read again.

use libfuzzer_sys::fuzz_target;
use morec::formats::Limits;
use morec::formats::bvh::{self, BvhOptions};

fuzz_target!(|bytes: &[u8]| {
    let limits = Limits {
        joints: 64,
        depth: 32,
        line_bytes: 4096,
        frames: 4096,
    };
    let Ok(loaded) = bvh::read(bytes, "clip", &BvhOptions::default(), &limits) else {
        return;
    };
    for clip in &loaded.clips {
        assert_eq!(clip.rotations.len(), clip.frames * clip.skeleton.len());
        assert!(
            clip.rotations
                .iter()
                .all(|q| (q.coords.norm() - 1.0).abs() < 1e-9)
        );
        assert!(clip.tracks.iter().all(|t| t.positions.len() == clip.frames));
        assert!(
            clip.tracks
                .iter()
                .flat_map(|t| t.positions.iter().flatten())
                .all(|v| v.is_finite())
        );
        assert!(clip.rate_hz.is_finite() && clip.rate_hz > 0.0);
        let mut written = Vec::new();
        bvh::write(clip, &mut written).expect("memory takes every byte");
        let again = bvh::read(&written, "clip", &BvhOptions::default(), &Limits::default())
            .expect("what was written can be read");
        assert_eq!(again.clips[0].frames, clip.frames);
        assert_eq!(again.clips[0].skeleton.len(), clip.skeleton.len());
    }
});
