#![no_main]
//! Any bytes read as a motion of a small arm: no panic, no NaN, every frame whole.

use libfuzzer_sys::fuzz_target;
use morec::formats::Limits;
use morec::formats::acclaim::{AmcOptions, read_amc, read_asf};

const ARM: &[u8] = include_bytes!("../../crates/morec/testdata/acclaim/arm.asf");

fuzz_target!(|bytes: &[u8]| {
    let limits = Limits {
        joints: 64,
        depth: 32,
        line_bytes: 4096,
        frames: 4096,
    };
    let (arm, _) = read_asf(ARM, &limits).expect("the arm is a skeleton");
    let Ok(loaded) = read_amc(bytes, "clip", &arm, &AmcOptions::default(), &limits) else {
        return;
    };
    for clip in &loaded.clips {
        assert!(clip.frames <= limits.frames);
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
        assert!(
            clip.repaired
                .iter()
                .all(|span| span.start < span.end && span.end <= clip.frames)
        );
    }
});
