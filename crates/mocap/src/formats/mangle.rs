//! Test helpers for readers: truncated and altered files, and properties that every result must have.

use super::Loaded;

/// Calls `each` with every `bytes` cut short at up to `count` places and altered `count` times; the same on every run.
pub(crate) fn each(bytes: &[u8], count: usize, mut each: impl FnMut(&[u8])) {
    for k in 0..count.min(bytes.len()) {
        each(&bytes[..k * bytes.len() / count.min(bytes.len())]);
    }
    // Knuth's MMIX constants.
    let mut state = 42u64;
    let mut random = move |below: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below.max(1)
    };
    for _ in 0..count {
        let mut altered = bytes.to_vec();
        for _ in 0..1 + random(4) {
            let at = random(altered.len());
            match random(4) {
                0 => altered[at] = random(256) as u8,
                1 => altered[at] ^= 1 << random(8),
                2 => _ = altered.remove(at),
                _ => altered.insert(at, altered[random(altered.len())]),
            }
        }
        each(&altered);
    }
}

/// Lengths agree, rotations are rotations, places are finite.
pub(super) fn check(loaded: &Loaded) {
    for clip in &loaded.clips {
        assert_eq!(clip.rotations.len(), clip.frames * clip.skeleton.len());
        let unit = |q: &crate::math::Quat| (q.coords.norm() - 1.0).abs() < 1e-6;
        assert!(clip.rotations.iter().all(unit), "{}", clip.name);
        for track in &clip.tracks {
            assert_eq!(track.positions.len(), clip.frames);
            assert!(track.positions.iter().flatten().all(|v| v.is_finite()));
        }
        let finite = |joint: &crate::clip::Joint| joint.offset.iter().all(|v| v.is_finite());
        assert!(clip.skeleton.joints().iter().all(finite));
        assert!(clip.rate_hz.is_finite() && clip.rate_hz > 0.0);
    }
}

pub(super) use crate::testing::real_file as real;
