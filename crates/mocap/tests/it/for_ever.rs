//! Files of old releases, kept under `testdata/`: they open for ever, and show what they showed.

use std::path::PathBuf;

use mocap::clip::Clip;
use mocap::formats::{Limits, mclip};
use mocap::kinematics::WorldPose;
use mocap::smooth::{SmoothParams, VERSION, compress};

fn committed(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("testdata")
        .join(name)
}

fn read(name: &str) -> Vec<u8> {
    std::fs::read(committed(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A frame of a stored clip: where each joint is, metres.
type Places = Vec<[f64; 3]>;

fn places(clip: &Clip, frame: usize) -> Places {
    WorldPose::of(clip, frame)
        .positions
        .iter()
        .map(|p| [p.x, p.y, p.z])
        .collect()
}

/// Frames that are compared.
fn some(clip: &Clip) -> impl Iterator<Item = usize> {
    (0..clip.frames).step_by(clip.frames / 4)
}

#[test]
fn a_stored_clip_of_version_1_opens_for_ever_and_shows_what_it_did() {
    let loaded = mclip::read(&read("mclip/v1.mclip"), "old", &Limits::default()).unwrap();
    let clip = &loaded.clips[0];
    assert!(loaded.warnings.is_empty());
    let expected: (usize, f64, Vec<String>, Vec<Places>) =
        serde_json::from_slice(&read("mclip/v1.json")).unwrap();
    let names: Vec<String> = clip
        .skeleton
        .joints()
        .iter()
        .map(|joint| joint.name.clone())
        .collect();
    assert_eq!(
        (clip.frames, clip.rate_hz, names),
        (expected.0, expected.1, expected.2)
    );
    assert!(expected.3.len() >= 4);
    for (frame, expected) in some(clip).zip(&expected.3) {
        for (found, expected) in places(clip, frame).iter().zip(expected) {
            let off = (0..3)
                .map(|i| (found[i] - expected[i]).abs())
                .fold(0.0, f64::max);
            assert!(off < 1e-6, "frame {frame}: {off} m off");
        }
    }
}

/// Writes the files of these tests; only ever for a new version, under a new name.
#[test]
#[ignore = "writes testdata"]
fn write_files_of_this_version() {
    let write = |name: String, bytes: &[u8]| std::fs::write(committed(&name), bytes).unwrap();
    let loaded = mclip::read(&read("mclip/v1.mclip"), "old", &Limits::default()).unwrap();
    let bytes = compress(&loaded.clips[0], &SmoothParams::default(), &())
        .unwrap()
        .to_bytes();
    std::fs::create_dir_all(committed("mclip")).unwrap();
    write(format!("mclip/v{VERSION}.mclip"), &bytes);
    let clip = &mclip::read(&bytes, "new", &Limits::default())
        .unwrap()
        .clips[0];
    let names: Vec<&String> = clip
        .skeleton
        .joints()
        .iter()
        .map(|joint| &joint.name)
        .collect();
    let places: Vec<Places> = some(clip).map(|frame| places(clip, frame)).collect();
    let facts = serde_json::to_string(&(clip.frames, clip.rate_hz, names, places)).unwrap() + "\n";
    write(format!("mclip/v{VERSION}.json"), facts.as_bytes());
}
