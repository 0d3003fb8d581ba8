use morec::formats::{Limits, bvh};
use morec::smooth::MeasuredNoise;
use morec::synth::{DatabaseSpec, database};

use crate::kit::{Folder, WAVE_BVH, data};

/// Two synthetic people waving.
fn folder() -> Folder {
    let spec = DatabaseSpec {
        people: 2,
        repetitions: 1,
        classes: vec!["wave"],
        ..Default::default()
    };
    let texts: Vec<(String, String)> = database(7, &spec)
        .iter()
        .enumerate()
        .map(|(i, take)| {
            let mut text = Vec::new();
            bvh::write(&take.clip, &mut text).unwrap();
            (format!("clips/{i}.bvh"), String::from_utf8(text).unwrap())
        })
        .collect();
    let files: Vec<(&str, &str)> = texts
        .iter()
        .map(|(path, text)| (path.as_str(), text.as_str()))
        .collect();
    Folder::with(&files)
}

fn clip(folder: &Folder, path: &str) -> morec::clip::Clip {
    let bytes = std::fs::read(folder.path().join(path)).unwrap();
    bvh::read(&bytes, "clip", &Default::default(), &Limits::default())
        .unwrap()
        .clips
        .remove(0)
}

/// Between rotations of the same joints in the same frames, radians.
fn largest_angle(before: &morec::clip::Clip, after: &morec::clip::Clip) -> f64 {
    assert_eq!(after.frames, before.frames);
    let pairs = before.rotations.iter().zip(&after.rotations);
    pairs.map(|(a, b)| a.angle_to(b)).fold(0.0, f64::max)
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_smoothed_clip_is_within_the_thresholds_that_are_printed() {
    let folder = folder();
    let args = [
        "smooth",
        "clips/0.bvh",
        "-o",
        "out.bvh",
        "--max-angle",
        "1",
        "--max-joint",
        "10",
        "--json",
    ];
    let printed = json(&folder.morec(&args).ok());
    let errors = &printed[0]["clips"][0]["errors"];
    let (before, after) = (clip(&folder, "clips/0.bvh"), clip(&folder, "out.bvh"));
    let most = largest_angle(&before, &after);
    let stated = errors["max_angle_rad"].as_f64().unwrap();
    assert!(
        (most - stated).abs() < 1e-5 && stated <= 1f64.to_radians(),
        "{most} {stated}"
    );
    assert!(errors["max_joint_position_metres"].as_f64().unwrap() <= 0.01);
    assert!(printed[0]["clips"][0]["byte_ratio"].as_f64().unwrap() > 10.0);
}

#[test]
fn the_stored_form_is_read_like_any_clip() {
    let folder = folder();
    let text = folder
        .morec(&["smooth", "clips/0.bvh", "-o", "0.mclip"])
        .ok();
    for word in [
        "keyframes",
        "values",
        "bytes",
        "angle",
        "position",
        "in world",
        "0.mclip",
    ] {
        assert!(text.contains(word), "{word}: {text}");
    }
    let inspected = folder.morec(&["inspect", "0.mclip"]).ok();
    assert!(
        inspected.contains("MCLIP") && inspected.contains("roles"),
        "{inspected}"
    );
    folder
        .morec(&["convert", "0.mclip", "-o", "again.bvh", "--rate", "60"])
        .ok();
    let (before, after) = (
        clip(&folder, "clips/0.bvh").resampled(60.0).unwrap(),
        clip(&folder, "again.bvh"),
    );
    assert!(largest_angle(&before, &after) < 0.6f64.to_radians());
}

#[test]
fn several_clips_go_into_a_folder() {
    let folder = folder();
    let text = folder
        .morec(&["smooth", "clips", "-o", "out", "--form", "mclip"])
        .ok();
    assert!(text.contains("all 2") && text.contains("1:"), "{text}");
    let mut names: Vec<_> = std::fs::read_dir(folder.path().join("out"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["0.mclip", "1.mclip"]);
    // A folder of stored clips is a folder of clips.
    assert!(folder.morec(&["inspect", "out"]).ok().contains("1.mclip"));
}

#[test]
fn a_channel_is_drawn() {
    let folder = folder();
    let args = [
        "smooth",
        "clips/0.bvh",
        "--plot",
        "Hips",
        "a.svg",
        "--plot",
        "Hips.px",
        "b.svg",
    ];
    folder.morec(&args).ok();
    let svg = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert!(svg("a.svg").contains("rotation of Hips"));
    assert!(svg("b.svg").contains("position of Hips") && svg("b.svg").contains("control points"));
    let ran = folder.morec(&["smooth", "clips/0.bvh", "--plot", "Nose", "a.svg"]);
    assert!(
        ran.code == Some(1) && ran.err.contains("no such joint"),
        "{ran:?}"
    );
    let ran = folder.morec(&["smooth", "clips/0.bvh", "--plot", "Hips.q", "a.svg"]);
    assert!(
        ran.code == Some(1) && ran.err.contains("expected one of x, y"),
        "{ran:?}"
    );
}

#[test]
fn nothing_is_overwritten_or_half_done() {
    let folder = folder();
    let before = std::fs::read(folder.path().join("clips/0.bvh")).unwrap();
    let ran = folder.morec(&["smooth", "clips", "-o", "clips"]);
    assert!(
        ran.code == Some(1) && ran.err.contains("overwritten"),
        "{ran:?}"
    );
    assert_eq!(
        std::fs::read(folder.path().join("clips/0.bvh")).unwrap(),
        before
    );
    let ran = folder.morec(&["smooth", "clips/0.bvh", "-o", "out.txt"]);
    assert!(ran.code == Some(1) && ran.err.contains(".mclip"), "{ran:?}");
    assert_eq!(
        folder
            .morec(&["smooth", "clips/0.bvh", "--max-angle", "0"])
            .code,
        Some(2)
    );
    std::fs::write(folder.path().join("clips/bad.mclip"), b"MCLIP\n\x01\0").unwrap();
    let ran = folder.morec(&["smooth", "clips", "-o", "out"]);
    assert!(
        ran.code == Some(1) && ran.err.contains("bad.mclip: byte 6"),
        "{ran:?}"
    );
    assert!(
        folder.path().join("out/1.bvh").exists(),
        "the others are done all the same"
    );
}

#[test]
fn the_smallest_clips_can_be_smoothed() {
    let folder = Folder::with(&[("wave.bvh", WAVE_BVH)]);
    folder.morec(&["smooth", "wave.bvh", "-o", "out.bvh"]).ok();
    assert_eq!(
        clip(&folder, "out.bvh").frames,
        clip(&folder, "wave.bvh").frames
    );
}

#[test]
fn real_clips_are_a_fifteenth_of_their_files() {
    let Some(data) = data() else { return };
    let clips = data.join("referee/clips/signals_2.bvh");
    let folder = Folder::with(&[]);
    let args = [
        "smooth",
        clips.to_str().unwrap(),
        "--max-joint",
        "5",
        "--json",
    ];
    let printed = json(&folder.morec(&args).ok());
    let report = &printed[0]["clips"][0];
    assert!(report["byte_ratio"].as_f64().unwrap() > 15.0, "{report}");
}

#[test]
fn thresholds_may_come_from_the_noise() {
    let folder = folder();
    let report = |args: &[&str]| json(&folder.morec(args).ok());
    let auto = report(&["smooth", "clips/0.bvh", "--auto", "--json"]);
    let usual = report(&["smooth", "clips/0.bvh", "--json"]);
    let angle = |report: &serde_json::Value| {
        report[0]["clips"][0]["thresholds"]["angle_rad"]
            .as_f64()
            .unwrap()
            .to_degrees()
    };
    assert!((angle(&usual) - 0.5).abs() < 1e-9);
    let noise = MeasuredNoise::of(&clip(&folder, "clips/0.bvh")).angle_rad;
    assert!(
        (angle(&auto) - 3.5 * noise.to_degrees()).abs() < 1e-6,
        "{auto}"
    );
}
