use super::*;
use crate::import::{ImportOptions, normalize};
use crate::kinematics::WorldPose;
use crate::math::Axis;
use std::io::{Cursor, Write};

fn npy(shape: &str, values: &[f64]) -> Vec<u8> {
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\0".to_vec();
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.bytes());
    bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    bytes
}

fn npz(arrays: &[(&str, &str, &[f64])]) -> Vec<u8> {
    let mut out = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (key, shape, values) in arrays {
        let options = zip::write::SimpleFileOptions::default();
        out.start_file(format!("{key}.npy"), options).unwrap();
        out.write_all(&npy(shape, values)).unwrap();
    }
    out.finish().unwrap().into_inner()
}

fn open(bytes: &[u8]) -> Result<Loaded, ParseError> {
    read(bytes, "f", &Limits::default())
}

/// Poses of `joints` joints: standing in a world whose Z is up, the left elbow bent more and more, walking along X.
fn walk(joints: usize, frames: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut poses, mut trans) = (Vec::new(), Vec::new());
    for frame in 0..frames {
        let mut pose = vec![0.0; 3 * joints];
        pose[0] = std::f64::consts::FRAC_PI_2;
        pose[3 * 18 + 1] = -0.01 * frame as f64;
        poses.extend(pose);
        trans.extend([0.01 * frame as f64, 0.0, 0.97]);
    }
    (poses, trans)
}

#[test]
fn every_model_of_the_family_is_the_same_body() {
    let mut clips = Vec::new();
    for joints in [22, 24, 52, 55] {
        let (poses, trans) = walk(joints, 50);
        let bytes = npz(&[
            ("poses", &format!("(50, {})", 3 * joints), &poses),
            ("trans", "(50, 3)", &trans),
            ("mocap_framerate", "()", &[60.0]),
            ("betas", "(2,)", &[0.0, 0.0]),
        ]);
        clips.push(open(&bytes).unwrap().clips.remove(0));
    }
    let (poses, trans) = walk(22, 50);
    let root: Vec<f64> = poses.chunks(66).flat_map(|row| row[..3].to_vec()).collect();
    let body: Vec<f64> = poses.chunks(66).flat_map(|row| row[3..].to_vec()).collect();
    let bytes = npz(&[
        ("root_orient", "(50, 3)", &root),
        ("pose_body", "(50, 21, 3)", &body),
        ("trans", "(50, 3)", &trans),
        ("mocap_frame_rate", "()", &[60.0]),
    ]);
    clips.push(open(&bytes).unwrap().clips.remove(0));
    assert!(clips.windows(2).all(|pair| pair[0] == pair[1]));
    let clip = clips.remove(0);
    assert_eq!(
        (clip.frames, clip.rate_hz, clip.tracks.len()),
        (50, 60.0, 1)
    );
    // The forearm points to +X in the zero pose and turns about the body's Y, the world's Z, to the front, world −Y.
    let pose = WorldPose::of(&clip, 49);
    let forearm = (pose.positions[20] - pose.positions[18]).normalize();
    let expected = Axis::Z.rotation(-0.49) * Vec3::x();
    assert!((forearm - expected).norm() < 1e-9, "{forearm}");
    let imported = normalize(clip, &ImportOptions::default()).unwrap();
    assert_eq!(imported.report.up.to_string(), "z");
    assert_eq!(
        (imported.report.unit, imported.roles.missing().count()),
        (Some("m"), 0)
    );
}

#[test]
fn what_is_no_motion_is_said() {
    let error = open(&npz(&[
        ("betas", "(2,)", &[0.0; 2]),
        ("gender", "()", &[0.0]),
    ]))
    .unwrap_err();
    assert!(error.found.contains("betas, gender"), "{error}");
    let few = open(&npz(&[("poses", "(2, 9)", &[0.0; 18])])).unwrap_err();
    assert!(few.expected.contains("at least 22 joints"), "{few}");
    let short = open(&npz(&[
        ("poses", "(1, 66)", &[0.0; 66]),
        ("trans", "(2, 3)", &[0.0; 6]),
    ]));
    assert!(
        short
            .unwrap_err()
            .expected
            .contains("`trans` for each of 1 frames")
    );
}

#[test]
fn spoiled_frames_are_filled() {
    let (mut poses, _) = walk(22, 5);
    poses[2 * 66] = f64::NAN;
    let loaded = open(&npz(&[("poses", "(5, 66)", &poses)])).unwrap();
    assert_eq!(loaded.clips[0].repaired, [2..3]);
    assert!(
        loaded
            .warnings
            .iter()
            .any(|w| w.text.contains("120 Hz assumed"))
    );
}

#[test]
fn cut_and_altered_files_never_panic() {
    let (poses, trans) = walk(24, 3);
    let bytes = npz(&[("poses", "(3, 24, 3)", &poses), ("trans", "(3, 3)", &trans)]);
    crate::formats::mangle::each(&bytes, 500, |bytes| {
        if let Ok(loaded) = open(bytes) {
            crate::formats::mangle::check(&loaded);
        }
    });
}
