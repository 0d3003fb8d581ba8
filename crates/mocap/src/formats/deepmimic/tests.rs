use super::*;
use crate::clip::Skeleton;
use crate::roles::{Role, find};

/// A frame that stands at `x` with the right knee bent by `knee` radians.
fn frame(secs: f64, x: f64, knee: f64) -> Vec<f64> {
    let mut values = vec![secs, x, 0.85, 0.0];
    for (.., turn) in JOINTS {
        match turn {
            Turn::Quaternion => values.extend([1.0, 0.0, 0.0, 0.0]),
            Turn::Hinge => values.push(0.0),
            Turn::Fixed => {}
        }
    }
    // Duration, place, root, chest, neck, hip.
    values[4 + 16] = knee;
    values
}

fn text(frames: &[Vec<f64>]) -> String {
    format!("{{\n\"Loop\": \"wrap\",\n\"Frames\":\n{frames:?}\n}}")
}

fn open(text: &str) -> Result<Loaded, ParseError> {
    read(text.as_bytes(), "walk", &Limits::default())
}

#[test]
fn the_humanoid_walks() {
    let frames: Vec<Vec<f64>> = (0..4)
        .map(|f| frame(if f < 3 { 0.033332 } else { 0.0 }, 0.1 * f as f64, -1.0))
        .collect();
    let text = text(&frames);
    assert!(looks_so(text.as_bytes()));
    let loaded = open(&text).unwrap();
    assert_eq!(loaded.warnings, []);
    let clip = &loaded.clips[0];
    assert_eq!((clip.frames, clip.rate_hz), (4, 30.0));
    let world = crate::kinematics::WorldPose::of(clip, 2).positions;
    assert!(
        (world[0] - Vec3::new(0.2, 0.85, 0.0)).norm() < 1e-9,
        "{world:?}"
    );
    // A knee bends backwards: who faces X has the ankle behind it.
    assert!(
        world[5].x < world[4].x - 0.3 && world[5].y > world[11].y,
        "{world:?}"
    );
    assert!(
        world[6].z > 0.1 && world[12].z < -0.1,
        "the right is along Z"
    );
}

#[test]
fn all_roles_but_the_torso_are_known() {
    let found = find(&Skeleton::new(joints()).unwrap());
    for (role, joint) in [
        (Role::Hips, "root"),
        (Role::LeftThigh, "left_hip"),
        (Role::RightShin, "right_knee"),
        (Role::LeftArm, "left_shoulder"),
        (Role::RightHand, "right_wrist"),
    ] {
        let at = found.map.joint(role).unwrap();
        assert_eq!(JOINTS[at].0, joint, "{role}");
    }
}

#[test]
fn frames_may_have_one_duration_for_all() {
    let frames: Vec<Vec<f64>> = (0..3).map(|_| frame(0.0, 0.0, 0.0)[1..].to_vec()).collect();
    let text =
        format!("{{\"LoopMode\": \"Wrap\", \"FrameDuration\": 0.01667, \"Frames\": {frames:?}}}");
    assert!(looks_so(text.as_bytes()));
    assert_eq!(open(&text).unwrap().clips[0].rate_hz, 60.0);
}

#[test]
fn what_is_no_motion_of_it_is_said() {
    let dog = text(&[vec![0.5; 19], vec![0.5; 19]]);
    assert!(looks_so(dog.as_bytes()));
    assert!(open(&dog).unwrap_err().found.contains("quadruped"));
    assert!(
        open(&text(&[vec![0.0; 44]])).is_err(),
        "no quaternion has a length"
    );
    let spoiled = text(&[frame(0.1, 0.0, 0.0), vec![0.1; 7], frame(0.1, 0.2, 0.0)]);
    let loaded = open(&spoiled).unwrap();
    assert_eq!(loaded.clips[0].repaired, [1..2]);
    assert_eq!(loaded.warnings.len(), 1);
    assert!(!looks_so(br#"{"Frames": [[{"x": 1}]], "Loop": "wrap"}"#));
    let whole = text(&[frame(0.1, 0.0, 0.0), frame(0.1, 0.0, 0.0)]);
    crate::formats::mangle::each(whole.as_bytes(), 400, |bytes| {
        let _ = looks_so(bytes);
        let _ = read(bytes, "a", &Limits::default());
    });
}
