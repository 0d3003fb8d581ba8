#![no_main]
//! Any bytes read as FBX: no panic, no NaN, and what was read can be written as BVH.

use libfuzzer_sys::fuzz_target;
use morec::formats::{Limits, bvh, fbx};

fuzz_target!(|bytes: &[u8]| {
    let limits = Limits {
        joints: 64,
        depth: 32,
        frames: 4096,
        ..Limits::default()
    };
    let Ok(loaded) = fbx::read(bytes, "clip", &limits) else {
        return;
    };
    for clip in &loaded.clips {
        assert_eq!(clip.rotations.len(), clip.frames * clip.skeleton.len());
        assert!(
            clip.rotations
                .iter()
                .all(|q| (q.coords.norm() - 1.0).abs() < 1e-6)
        );
        assert!(clip.tracks.iter().all(|t| t.positions.len() == clip.frames));
        assert!(
            clip.tracks
                .iter()
                .flat_map(|t| t.positions.iter().flatten())
                .all(|v| v.is_finite())
        );
        assert!(clip.rate_hz.is_finite() && clip.rate_hz > 0.0);
        bvh::write(clip, &mut Vec::new()).expect("memory takes every byte");
    }
});
