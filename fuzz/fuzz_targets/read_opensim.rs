#![no_main]
//! Any bytes read as joint angles of a small leg, and as the model of a small motion: no panic, no NaN, every frame whole.

use libfuzzer_sys::fuzz_target;
use morec::formats::opensim::{read_model, read_motion};
use morec::formats::{Limits, Loaded};

const LEG: &[u8] = include_bytes!("../../crates/morec/testdata/opensim/leg.osim");
const KICK: &[u8] = include_bytes!("../../crates/morec/testdata/opensim/kick.mot");

fuzz_target!(|bytes: &[u8]| {
    let limits = Limits {
        joints: 64,
        depth: 32,
        line_bytes: 4096,
        frames: 4096,
    };
    let (leg, _) = read_model(LEG, &limits).expect("the leg is a model");
    if let Ok(loaded) = read_motion(bytes, "clip", &leg, None, &limits) {
        check(&loaded);
    }
    if let Ok((model, _)) = read_model(bytes, &limits)
        && let Ok(loaded) = read_motion(KICK, "clip", &model, None, &limits)
    {
        check(&loaded);
    }
});

fn check(loaded: &Loaded) {
    for clip in &loaded.clips {
        assert_eq!(clip.rotations.len(), clip.frames * clip.skeleton.len());
        assert!(
            clip.rotations
                .iter()
                .all(|q| (q.coords.norm() - 1.0).abs() < 1e-6)
        );
        assert!(clip.tracks.iter().all(|t| t.positions.len() == clip.frames));
    }
}
