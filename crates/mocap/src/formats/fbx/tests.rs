use super::*;
use crate::import::{ImportOptions, normalize};
use crate::kinematics::WorldPose;
use crate::math::Axis;

/// A text file: hips and knee, the knee with a pre-rotation of 90° about X, turned by 0 to 90° about Z in one second at
/// 24 frames a second, 0.2 of a unit above the hips; lengths in centimetres.
const KNEE: &str = include_str!("../../../testdata/fbx/knee.fbx");

fn open(bytes: &[u8]) -> Result<Loaded, ParseError> {
    read(bytes, "f", &Limits::default())
}

#[test]
fn rotations_follow_the_pre_rotation() {
    let loaded = open(KNEE.as_bytes()).unwrap();
    let clip = &loaded.clips[0];
    let names: Vec<&str> = clip.skeleton.names().collect();
    assert_eq!(names, ["Hips", "Knee", "Foot"]);
    assert_eq!(
        (clip.frames, clip.rate_hz),
        (25, 24.0),
        "{:?}",
        loaded.warnings
    );
    for (frame, degrees) in [(0, 0.0), (12, 45.0), (24, 90.0)] {
        let turn =
            Axis::X.rotation(90f64.to_radians()) * Axis::Z.rotation(f64::to_radians(degrees));
        let pose = WorldPose::of(clip, frame);
        assert!(pose.rotations[1].angle_to(&turn) < 1e-6);
        let knee = Vec3::new(1.0, 100.0, 2.0) + Vec3::new(0.0, -40.0, 0.0);
        assert!((pose.positions[1] - knee).norm() < 1e-6);
        let foot = knee + turn * Vec3::new(0.0, 0.0, 40.0);
        assert!(
            (pose.positions[2] - foot).norm() < 1e-6,
            "{}",
            pose.positions[2]
        );
    }
}

#[test]
fn what_cannot_be_read_is_said_plainly() {
    let still = KNEE.replace("AnimationCurve:", "AnimationNothing:");
    assert!(
        open(still.as_bytes())
            .unwrap_err()
            .found
            .contains("skeleton of 3 joints, without animation")
    );
    let error = open(b"Kaydara FBX Binary  \0\x1a\0\xd0\x07\0\0\0\0\0\0\0\0\0\0\0").unwrap_err();
    assert!(error.found.contains("FBX"), "{error}");
    assert!(open(&KNEE.as_bytes()[..700]).is_err());
    let few = Limits {
        joints: 2,
        ..Limits::default()
    };
    assert!(read(KNEE.as_bytes(), "f", &few).is_err());
}

#[test]
fn cut_and_altered_files_never_panic() {
    crate::formats::mangle::each(KNEE.as_bytes(), 300, |bytes| {
        if let Ok(loaded) = open(bytes) {
            crate::formats::mangle::check(&loaded);
        }
    });
    if let Some(bytes) = crate::formats::mangle::real("animation_with_skeleton.fbx") {
        crate::formats::mangle::each(&bytes, 20, |bytes| {
            if let Ok(loaded) = open(bytes) {
                crate::formats::mangle::check(&loaded);
            }
        });
    }
}

#[test]
fn real_files_are_read() {
    let (Some(person), Some(bones)) = (
        crate::formats::mangle::real("template.fbx"),
        crate::formats::mangle::real("animation_with_skeleton.fbx"),
    ) else {
        return;
    };
    let loaded = open(&person).unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let clip = loaded.clips.into_iter().next().unwrap();
    assert_eq!(
        (clip.frames, clip.rate_hz, clip.skeleton.len()),
        (251, 60.0, 24)
    );
    let imported = normalize(clip, &ImportOptions::default()).unwrap();
    assert_eq!(imported.report.unit, Some("cm"));
    assert_eq!(imported.report.up.to_string(), "y");
    assert_eq!(imported.roles.missing().count(), 0);
    let clips = open(&bones).unwrap().clips;
    let names: Vec<&str> = clips.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["f#Bone", "f#Bone.007"]);
    assert!(
        clips
            .iter()
            .all(|c| (c.frames, c.skeleton.len()) == (21, 8))
    );
}
