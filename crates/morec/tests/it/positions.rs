//! The same motion as a skeleton and as points in every format of points: the same detections.

use std::io;

use morec::clip::Clip;
use morec::features::{BoneSet, for_each_pose};
use morec::formats::{Limits, Loaded, ParseError, c3d, jsonl, table, trc};
use morec::import::{ImportOptions, Take, normalize};
use morec::live::{
    Detection, EventOptions, Frame, Performer, PerformerId, Phase, Rig, recognize_clip,
};
use morec::math::Vec3;
use morec::roles::LEGS;
use morec::synth::{DatabaseSpec, database};

use crate::{kit, made};

fn recognised(imported: &Take) -> Vec<Detection> {
    let model = made::model();
    let rest = &imported.report.rest_frames;
    recognize_clip(&model, &imported.clip, &imported.roles, rest).unwrap()
}

fn ready(clip: Clip) -> Take {
    normalize(clip, &ImportOptions::default()).unwrap()
}

type Writer = fn(&Clip, &mut dyn io::Write) -> io::Result<()>;
type Reader = fn(&[u8], &str, Option<f64>, &Limits) -> Result<Loaded, ParseError>;

/// A table with a row for each frame and three columns for each point.
fn write_csv(clip: &Clip, out: &mut dyn io::Write) -> io::Result<()> {
    write!(out, "time")?;
    for joint in clip.skeleton.joints() {
        write!(out, ",{0}_x,{0}_y,{0}_z", joint.name)?;
    }
    for frame in 0..clip.frames {
        write!(out, "\n{}", frame as f64 / clip.rate_hz)?;
        for track in &clip.tracks {
            let at = track.positions[frame];
            write!(out, ",{:.6},{:.6},{:.6}", at.x, at.y, at.z)?;
        }
    }
    writeln!(out)
}

#[test]
fn the_same_motion_as_points_is_recognised_alike() {
    let spec = DatabaseSpec {
        people: 1,
        repetitions: 2,
        rate_hz: 30.0,
        ..DatabaseSpec::default()
    };
    let take = database(4, &spec).remove(0);
    let skeleton = ready(take.clip.clone());
    let expected = recognised(&skeleton);
    assert!(expected.len() >= 5, "{} detections", expected.len());
    let formats: [(&str, Writer, Reader); 4] = [
        ("C3D", c3d::write, c3d::read),
        ("TRC", trc::write, trc::read),
        ("CSV", write_csv, table::read),
        ("JSON lines", jsonl::write, jsonl::read),
    ];
    // Z up and in millimetres, as laboratories have it.
    let mut points = take.clip.to_points(Some(0.001));
    for position in points.tracks.iter_mut().flat_map(|t| &mut t.positions) {
        *position = morec::math::Vec3::new(position.x, -position.z, position.y) * 1000.0;
    }
    for (name, write, read) in formats {
        let mut bytes = Vec::new();
        write(&points, &mut bytes).unwrap();
        let loaded = read(&bytes, "take", None, &Limits::default()).unwrap();
        let imported = ready(loaded.clips[0].clone());
        assert_eq!(imported.report.up.to_string(), "z", "{name}");
        assert_eq!(imported.report.unit, Some("mm"), "{name}");
        assert_eq!(imported.report.point_set, Some("joint names"), "{name}");
        let found = recognised(&imported);
        assert_eq!(found.len(), expected.len(), "{name}");
        for (found, expected) in found.iter().zip(&expected) {
            assert_eq!(found.class, expected.class, "{name}");
            assert!(found.span.is_near(expected.span, 0.05), "{name}");
        }
    }
}

/// The method of 2009 says what it lacks.
/// Whoever declares a whole body and sits at a desk is recognised by what is seen of it; what comes into view later counts from then on.
#[test]
fn parts_that_were_announced_and_are_never_seen_are_left_out() {
    let spec = DatabaseSpec {
        people: 1,
        repetitions: 2,
        ..DatabaseSpec::default()
    };
    let take = ready(database(4, &spec).remove(0).clip);
    let model = made::model();
    // Sees the legs from then on.
    let recognised = |legs_from_secs: f64| {
        let mut performer = Performer::new(&model, PerformerId(0), &EventOptions::default());
        performer.set_rig(&Rig::of_roles().into());
        // As a caller does who has announced everything.
        performer.announce(BoneSet::BODY).unwrap();
        let (mut frame, mut found) = (Frame::default(), Vec::new());
        let mut looked_at = vec![BoneSet::BODY.len()];
        for_each_pose(
            &take.clip,
            &take.roles,
            &take.report.rest_frames,
            |secs, pose| {
                let mut pose = *pose;
                if secs < legs_from_secs {
                    for role in LEGS.concat() {
                        pose.set(role, Vec3::repeat(f64::NAN));
                    }
                }
                frame.time_secs = secs;
                frame.set_key_pose(&pose);
                let ends = performer.push(&frame).iter();
                let ends = ends.filter(|event| event.phase == Phase::End);
                found.extend(ends.map(|event| (event.class, event.span.stop_secs)));
                let bones = performer.bones().unwrap().len();
                if looked_at.last() != Some(&bones) {
                    looked_at.push(bones);
                }
            },
        );
        let ends = performer.finish().iter();
        let ends = ends.filter(|event| event.phase == Phase::End);
        found.extend(ends.map(|event| (event.class, event.span.stop_secs)));
        (looked_at, found)
    };
    let (looked_at, all) = recognised(0.0);
    assert_eq!(looked_at.len(), 1);
    let (looked_at, upper) = recognised(f64::INFINITY);
    assert!(
        looked_at.len() == 2 && looked_at[1] < looked_at[0],
        "{looked_at:?}"
    );
    assert!(
        all.len() >= 5 && upper.len() + 2 >= all.len(),
        "{upper:?}, {all:?}"
    );
    let (looked_at, later) = recognised(20.0);
    assert_eq!([looked_at[0], looked_at[2]], [11, 11]);
    let is_late = |(_, stop_secs): &&(_, f64)| *stop_secs > 25.0;
    let late = |found: &[(morec::ClassId, f64)]| -> Vec<_> {
        found
            .iter()
            .filter(is_late)
            .map(|(class, _)| *class)
            .collect()
    };
    assert_eq!(late(&later), late(&all));
}

#[test]
fn rotations_are_not_made_up() {
    use morec::pivots::{NoPivots, PivotMap, PivotSet};
    let points = [("Hips".to_owned(), vec![morec::math::Vec3::zeros(); 3])];
    let clip = Clip::of_points("c".into(), 30.0, points, Default::default());
    let imported = ready(clip);
    let error = PivotMap::of_clip(&PivotSet::thesis(), &imported.clip, &imported.roles);
    assert_eq!(error.unwrap_err(), NoPivots::Rotations);
}

fn formats() -> Option<std::path::PathBuf> {
    let folder = kit::data()?.join("formats");
    folder.is_dir().then_some(folder)
}

#[test]
fn one_recording_in_two_formats_agrees() {
    let Some(folder) = formats() else { return };
    let bytes = |name: &str| std::fs::read(folder.join(name)).unwrap();
    let limits = Limits::default();
    let c3d = c3d::read(&bytes("mstudio.c3d"), "m", None, &limits).unwrap();
    let trc = trc::read(&bytes("mstudio.trc"), "m", None, &limits).unwrap();
    let (c3d, trc) = (ready(c3d.clips[0].clone()), ready(trc.clips[0].clone()));
    assert_eq!(c3d.clip.frames, trc.clip.frames);
    // The TRC has the hip and the neck as well, which make its points another set; the roles of the limbs are the same.
    assert_eq!(c3d.report.point_set, Some("OpenPose BODY_25"));
    assert_eq!(trc.report.point_set, Some("Halpe (26)"));
    assert_eq!(
        (c3d.report.up, c3d.clip.rate_hz),
        (trc.report.up, trc.clip.rate_hz)
    );
    for joint in c3d
        .clip
        .skeleton
        .joints()
        .iter()
        .filter(|joint| joint.parent.is_none())
    {
        let track = |imported: &Take| {
            let joint = imported.clip.skeleton.find(&joint.name)?;
            imported.clip.track(joint).cloned()
        };
        let (Some(a), Some(b)) = (track(&c3d), track(&trc)) else {
            continue;
        };
        for (a, b) in a.positions.iter().zip(&b.positions) {
            // The C3D is cut to whole millimetres on each axis: off by up to √3 mm.
            assert!((a - b).norm() < 1.8e-3, "{}: {a} {b}", joint.name);
        }
    }
    assert_eq!(recognised(&c3d).len(), recognised(&trc).len());
}

#[test]
fn real_files_are_what_they_are() {
    let Some(folder) = formats() else { return };
    // File, points, frames, rate, up, unit, roles, set.
    let cases = [
        ("probing_acromion.c3d", 41, 140, 69.5, "y", "m", 0, None),
        ("walking_optitrack.c3d", 12, 3361, 160.0, "z", "mm", 0, None),
        (
            "wrist_shot_dec_int.c3d",
            51,
            727,
            240.0,
            "z",
            "mm",
            16,
            Some("Plug-in Gait"),
        ),
        (
            "mstudio.c3d",
            27,
            137,
            120.0,
            "y",
            "mm",
            15,
            Some("OpenPose BODY_25"),
        ),
        (
            "mstudio.trc",
            29,
            137,
            120.0,
            "y",
            "m",
            15,
            Some("Halpe (26)"),
        ),
        (
            "subject01_walk1.trc",
            41,
            151,
            60.0,
            "y",
            "mm",
            14,
            Some("OpenSim gait"),
        ),
    ];
    for (file, points, frames, rate, up, unit, roles, set) in cases {
        let bytes = std::fs::read(folder.join(file)).unwrap();
        let read: Reader = if file.ends_with("trc") {
            trc::read
        } else {
            c3d::read
        };
        let clip = read(&bytes, file, None, &Limits::default())
            .unwrap()
            .clips
            .remove(0);
        assert_eq!(
            (clip.skeleton.len(), clip.frames),
            (points, frames),
            "{file}"
        );
        assert!((clip.rate_hz - rate).abs() < 1e-3, "{file}");
        let imported = ready(clip);
        assert_eq!(imported.report.up.to_string(), up, "{file}");
        assert_eq!(imported.report.unit, Some(unit), "{file}");
        assert_eq!(18 - imported.roles.missing().count(), roles, "{file}");
        assert_eq!(imported.report.point_set, set, "{file}");
    }
}
