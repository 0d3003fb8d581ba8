//! Helpers of the fuzz targets of clip formats: limits that keep a run fast, and checks that hold of every clip that was read.

use morec::clip::Clip;
use morec::formats::{Limits, Loaded, bvh};
use morec::import::{ImportOptions, normalize};

/// Small enough for thousands of runs a second.
pub const LIMITS: Limits = Limits {
    joints: 64,
    depth: 32,
    line_bytes: 4096,
    frames: 4096,
    memory: 64 << 20,
};

/// Asserts that every frame is whole and every number finite, and that rotations have length 1.
///
/// # Panics
/// If one does not hold.
pub fn check(clip: &Clip) {
    assert!(clip.frames <= LIMITS.frames);
    assert_eq!(clip.rotations.len(), clip.frames * clip.skeleton.len());
    let mut lengths = clip.rotations.iter().map(|q| q.coords.norm());
    assert!(lengths.all(|length| (length - 1.0).abs() < 1e-6));
    assert!(clip.tracks.iter().all(|t| t.positions.len() == clip.frames));
    let mut values = clip
        .tracks
        .iter()
        .flat_map(|t| t.positions.iter().flatten());
    assert!(values.all(|v| v.is_finite()));
    let mut spans = clip.repaired.iter();
    assert!(spans.all(|span| span.start < span.end && span.end <= clip.frames));
    assert!(clip.rate_hz.is_finite() && clip.rate_hz > 0.0);
}

/// Checks clips with rotations, which can be written as BVH.
///
/// # Panics
/// If one of them is not whole.
pub fn check_rotations(loaded: &Loaded) {
    for clip in &loaded.clips {
        check(clip);
        bvh::write(clip, &mut Vec::new()).expect("memory takes every byte");
    }
}

/// Checks clips of points, which can be made ready.
///
/// # Panics
/// If one of them is not whole.
pub fn check_points(loaded: Loaded) {
    for clip in loaded.clips {
        check(&clip);
        normalize(clip, &ImportOptions::default()).expect("no mapping that could be wrong");
    }
}
