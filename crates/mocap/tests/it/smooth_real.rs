//! Real clips through curves, by the thresholds of a database.

use std::path::{Path, PathBuf};

use mocap::clip::Clip;
use mocap::formats::{Limits, acclaim, bvh, mclip};
use mocap::import::{ImportOptions, normalize};
use mocap::kinematics::WorldPose;
use mocap::smooth::{CompressedClip, SmoothParams, compress};

/// A few of each kind: long and short, 120 Hz and 30 Hz, moving roots and joints that all have positions.
fn clips(data: &Path) -> Vec<PathBuf> {
    let mut chosen = vec![data.join("segmentation/clips/86_01.amc")];
    for (folder, every) in [("referee", 9), ("everyday", 50), ("gestures", 80)] {
        let mut all: Vec<PathBuf> = std::fs::read_dir(data.join(folder).join("clips"))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        all.sort();
        chosen.extend(all.into_iter().step_by(every));
    }
    chosen
}

/// In metres, as a database would have it.
fn load(path: &Path, bytes: &[u8]) -> Clip {
    let loaded = if path.extension().is_some_and(|e| e == "amc") {
        let skeleton =
            std::fs::read(path.parent().unwrap().parent().unwrap().join("86.asf")).unwrap();
        let (asf, _) = acclaim::read_asf(&skeleton, &Limits::default()).unwrap();
        acclaim::read_amc(bytes, "clip", &asf, &Default::default(), &Limits::default()).unwrap()
    } else {
        bvh::read(bytes, "clip", &Default::default(), &Limits::default()).unwrap()
    };
    normalize(
        loaded.clips.into_iter().next().unwrap(),
        &ImportOptions::default(),
    )
    .unwrap()
    .clip
}

/// Largest angle, and largest distance between joints in the world.
fn distances(a: &Clip, b: &Clip) -> (f64, f64) {
    let angles = a
        .rotations
        .iter()
        .zip(&b.rotations)
        .map(|(a, b)| a.angle_to(b));
    let mut world = 0.0f64;
    for frame in 0..a.frames {
        let (a, b) = (WorldPose::of(a, frame), WorldPose::of(b, frame));
        let off = a
            .positions
            .iter()
            .zip(&b.positions)
            .map(|(a, b)| (a - b).norm());
        world = off.fold(world, f64::max);
    }
    (angles.fold(0.0, f64::max), world)
}

#[test]
fn real_clips_keep_to_half_a_degree_and_five_millimetres_in_a_fifteenth() {
    let Some(data) = mocap::testing::data() else {
        return;
    };
    let (mut file_bytes, mut stored_bytes) = (0, 0);
    for path in clips(&data) {
        let bytes = std::fs::read(&path).unwrap();
        let clip = load(&path, &bytes);
        let compressed = compress(&clip, &SmoothParams::database(), &()).unwrap();
        let stored = compressed.to_bytes();
        assert_eq!(
            CompressedClip::from_bytes(&stored).as_ref(),
            Ok(&compressed),
            "{}",
            path.display()
        );
        let again = mclip::read(&stored, "clip", &Limits::default())
            .unwrap()
            .clips
            .remove(0);
        let (angle, world) = distances(&clip, &again);
        assert!(
            angle <= 0.5f64.to_radians() + 1e-9,
            "{}: {angle} rad",
            path.display()
        );
        assert!(world <= 0.005 + 1e-9, "{}: {world} m", path.display());
        file_bytes += bytes.len();
        stored_bytes += stored.len();
    }
    assert!(
        15 * stored_bytes < file_bytes,
        "{stored_bytes} of {file_bytes}"
    );
}
