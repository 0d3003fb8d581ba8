use super::*;
use crate::import::{ImportOptions, SignedAxis, normalize};
use crate::kinematics::WorldPose;
use crate::math::Axis;

const SEGMENTS: [&str; 5] = ["Pelvis", "L5", "RightUpperLeg", "LeftUpperLeg", "Prop1"];

/// A file of `frames` frames; frame `f` is turned by a tenth of `f` about Z and lies at `(f, 0, 1)`.
fn file(version: u32, frames: usize) -> String {
    let mut text = format!(
        "<?xml version=\"1.0\"?><mvnx version=\"{version}\" xmlns=\"http://www.xsens.com/mvn/mvnx\">\
         <subject label=\"A\" frameRate=\"60\" segmentCount=\"5\"><segments>"
    );
    for (id, label) in SEGMENTS.iter().enumerate() {
        text.push_str(&format!("<segment label=\"{label}\" id=\"{}\"/>", id + 1));
    }
    text.push_str("</segments><frames>\n");
    let mut frame = |kind: &str, f: usize| {
        let turn = Axis::Z.rotation(0.1 * f as f64);
        let (mut turns, mut places) = (String::new(), String::new());
        for j in 0..SEGMENTS.len() {
            turns.push_str(&format!("{} {} {} {} ", turn.w, turn.i, turn.j, turn.k));
            let place = turn * Vec3::new(0.1 * j as f64, 0.0, 0.2 * j as f64);
            let place = place + Vec3::new(f as f64, 0.0, 1.0);
            places.push_str(&format!("{:.6} {:.6} {:.6} ", place.x, place.y, place.z));
        }
        text.push_str(&format!(
            "<frame time=\"{}\" type=\"{kind}\"><orientation>{turns}</orientation>\
             <position>{places}</position></frame>\n",
            f * 1000 / 60
        ));
    };
    frame("tpose", 99);
    for f in 0..frames {
        frame("normal", f);
    }
    text.push_str("</frames></subject></mvnx>");
    text
}

#[test]
fn poses_are_those_of_the_file() {
    let loaded = read(file(4, 5).as_bytes(), "f", &Limits::default()).unwrap();
    let clip = &loaded.clips[0];
    assert_eq!((clip.frames, clip.rate_hz), (5, 60.0));
    let parents: Vec<_> = clip.skeleton.joints().iter().map(|j| j.parent).collect();
    assert_eq!(parents, [None, Some(0), Some(0), Some(0), None]);
    assert_eq!(loaded.warnings.len(), 1, "{:?}", loaded.warnings);
    assert!(loaded.warnings[0].text.contains("Prop1"));
    let pose = WorldPose::of(clip, 3);
    let expected = Axis::Z.rotation(0.3) * Vec3::new(0.3, 0.0, 0.6) + Vec3::new(3.0, 0.0, 1.0);
    assert!((pose.positions[3] - expected).norm() < 1e-5);
    assert!(pose.rotations[3].angle_to(&Axis::Z.rotation(0.3)) < 1e-6);
}

#[test]
fn spoiled_frames_are_filled_and_cut_files_end_early() {
    let whole = file(3, 6);
    let spoiled = whole.replacen("<position>2.0", "<position>two ", 1);
    assert_ne!(spoiled, whole);
    let loaded = read(spoiled.as_bytes(), "f", &Limits::default()).unwrap();
    assert_eq!(loaded.clips[0].repaired, [2..3]);
    assert!(loaded.warnings.iter().any(|w| w.text.contains("1 of 6")));
    let cut = &whole[..whole.rfind("<position>").unwrap()];
    let loaded = read(cut.as_bytes(), "f", &Limits::default()).unwrap();
    assert_eq!(loaded.clips[0].frames, 5);
    assert!(loaded.warnings[0].text.contains("last whole frame"));
}

#[test]
fn what_is_not_there_is_said() {
    let error = |text: &str| read(text.as_bytes(), "f", &Limits::default()).unwrap_err();
    assert!(error("<mvnx/>").expected.contains("<subject>"));
    assert!(error("<a/>").expected.contains("<mvnx>"));
    assert!(
        error("<mvnx><subject/></mvnx>")
            .expected
            .contains("<segments>")
    );
    let none = file(4, 3).replace("position>", "acceleration>");
    assert!(error(&none).expected.contains("<position>"));
    let few = Limits {
        joints: 3,
        ..Limits::default()
    };
    assert!(read(file(4, 3).as_bytes(), "f", &few).is_err());
}

#[test]
fn cut_and_altered_files_never_panic() {
    crate::formats::mangle::each(file(4, 3).as_bytes(), 400, |bytes| {
        if let Ok(loaded) = read(bytes, "f", &Limits::default()) {
            crate::formats::mangle::check(&loaded);
        }
    });
}

#[test]
fn a_real_recording_is_a_person_in_metres() {
    let Some(bytes) = crate::formats::mangle::real("meri_020.mvnx") else {
        return;
    };
    let loaded = read(&bytes, "meri", &Limits::default()).unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let clip = loaded.clips.into_iter().next().unwrap();
    assert_eq!(
        (clip.frames, clip.rate_hz, clip.skeleton.len()),
        (4, 240.0, 23)
    );
    let imported = normalize(clip, &ImportOptions::default()).unwrap();
    assert_eq!(imported.report.unit, Some("m"));
    assert_eq!(imported.report.up.to_string(), "z");
    assert_ne!(imported.report.up, SignedAxis::Y);
    assert_eq!(imported.roles.missing().count(), 0);
}
