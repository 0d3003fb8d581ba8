//! Reads every BVH file of the motion data that lies beside the project, if it is there.

use std::path::PathBuf;

use mocap::clip::Clip;
use mocap::formats::bvh::{self, BvhOptions};
use mocap::formats::{Limits, Warning};
use mocap::kinematics::WorldPose;

use mocap::testing::data;

/// The clips of one folder with the number of lines in each table, counted the plain way.
fn clips(folder: &str) -> Vec<(Clip, Vec<Warning>, usize)> {
    let Some(data) = data() else {
        return Vec::new();
    };
    let mut paths: Vec<_> = std::fs::read_dir(data.join(folder).join("clips"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "bvh"))
        .collect();
    paths.sort();
    assert!(!paths.is_empty());
    let read = |path: PathBuf| {
        let bytes = std::fs::read(&path).unwrap();
        let mut loaded = bvh::read(&bytes, "clip", &BvhOptions::default(), &Limits::default())
            .unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let text = String::from_utf8(bytes).unwrap();
        let table = text.split_once("Frame Time:").unwrap().1;
        let lines = table
            .lines()
            .skip(1)
            .filter(|l| !l.trim().is_empty())
            .count();
        (loaded.clips.remove(0), loaded.warnings, lines)
    };
    paths.into_iter().map(read).collect()
}

/// Largest and smallest length of a bone over the clip.
fn bone(clip: &Clip, from: &str, to: &str) -> (f64, f64) {
    let joint = |name| {
        clip.skeleton
            .find(name)
            .unwrap_or_else(|| panic!("no joint {name}"))
    };
    let (from, to) = (joint(from), joint(to));
    let lengths = (0..clip.frames).map(|f| {
        let pose = WorldPose::of(clip, f);
        (pose.positions[to] - pose.positions[from]).norm()
    });
    lengths.fold((f64::INFINITY, 0.0), |(low, high), l| {
        (low.min(l), high.max(l))
    })
}

#[test]
fn referee_clips_are_read_whole() {
    for (clip, warnings, lines) in clips("referee") {
        assert_eq!(
            (clip.frames, clip.skeleton.len(), clip.rate_hz),
            (lines, 31, 120.0)
        );
        assert_eq!(clip.tracks.len(), 1);
        assert!(
            warnings.is_empty() || warnings.iter().all(|w| w.text.contains("declared")),
            "{warnings:?}"
        );
        let (low, high) = bone(&clip, "LeftUpLeg", "LeftLeg");
        assert!(low > 5.0 && high < 10.0 && high - low < 1e-9);
    }
}

#[test]
fn gesture_clips_are_read_whole() {
    for (clip, _, lines) in clips("gestures") {
        assert_eq!(
            (clip.frames, clip.skeleton.len(), clip.rate_hz),
            (lines, 20, 30.0)
        );
        assert!(clip.repaired.is_empty());
    }
}

#[test]
fn position_channels_on_every_joint_replace_offsets() {
    for (clip, warnings, lines) in clips("everyday") {
        assert_eq!(
            (clip.frames, clip.skeleton.len(), clip.rate_hz),
            (lines, 22, 30.0)
        );
        assert!(
            warnings
                .iter()
                .any(|w| w.text.contains("in place of OFFSET")),
            "{warnings:?}"
        );
        // The root and the hips travel; all other bones keep their lengths.
        let moving: Vec<_> = clip
            .tracks
            .iter()
            .map(|t| clip.skeleton.joints()[t.joint].name.as_str())
            .collect();
        assert_eq!(moving, ["joint_Root", "Hips"]);
        let (low, high) = bone(&clip, "UpperLeg_L", "LowerLeg_L");
        assert!(low > 20.0 && high < 60.0 && high - low < 1e-3);
    }
}
