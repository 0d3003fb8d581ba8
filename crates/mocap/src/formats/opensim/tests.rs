use super::*;
use crate::kinematics::WorldPose;
use crate::math::Vec3;

const LEG: &[u8] = include_bytes!("../../../testdata/opensim/leg.osim");
const LEG_OF_4: &[u8] = include_bytes!("../../../testdata/opensim/leg_of_4.osim");
const KICK: &[u8] = include_bytes!("../../../testdata/opensim/kick.mot");

fn read(model: &[u8], motion: &[u8]) -> Result<super::super::Loaded, ParseError> {
    let (model, _) = read_model(model, &Limits::default())?;
    read_motion(motion, "kick", &model, None, &Limits::default())
}

#[test]
fn a_leg_swings_about_its_joints() {
    let loaded = read(LEG, KICK).unwrap();
    let clip = &loaded.clips[0];
    let names: Vec<&str> = clip.skeleton.names().collect();
    assert_eq!(names, ["pelvis", "femur_r", "tibia_r", "foot_r"]);
    assert_eq!((clip.frames, clip.rate_hz), (3, 100.0));
    // Upright: everything hangs straight down.
    let at = |frame: usize, joint: usize| WorldPose::of(clip, frame).positions[joint];
    let near = |found: Vec3, x: f64, y: f64, z: f64| {
        assert!((found - Vec3::new(x, y, z)).norm() < 1e-9, "{found}");
    };
    near(at(0, 0), 0.0, 1.0, 0.0);
    near(at(0, 1), 0.0, 0.9, 0.1);
    near(at(0, 2), 0.0, 0.5, 0.1);
    near(at(0, 3), 0.0, 0.1, 0.1);
    // The hip flexed by 90 degrees about a point 5 cm before the thigh's origin: the thigh points along x.
    near(at(1, 2), 0.45, 0.85, 0.1);
    near(at(1, 3), 0.85, 0.85, 0.1);
    // The knee bent by 90 degrees as well: that slides the tibia by 2 cm along the thigh's own x, which points up.
    near(at(2, 2), 0.45, 0.87, 0.1);
    near(at(2, 3), 0.45, 0.47, 0.1);
}

#[test]
fn versions_of_a_model_are_the_same() {
    assert_eq!(
        read(LEG, KICK).unwrap().clips,
        read(LEG_OF_4, KICK).unwrap().clips
    );
    let renamed = String::from_utf8_lossy(KICK)
        .replace("hip_flexion_r", "/jointset/hip_r/hip_flexion_r/value");
    assert_eq!(
        read(LEG, KICK).unwrap().clips,
        read(LEG_OF_4, renamed.as_bytes()).unwrap().clips
    );
}

#[test]
fn what_cannot_be_read_is_said_with_its_place() {
    let model = String::from_utf8_lossy(LEG).into_owned();
    let motion = String::from_utf8_lossy(KICK).into_owned();
    let cases = [
        (
            model.replace("PinJoint", "EllipsoidJoint"),
            motion.clone(),
            "<EllipsoidJoint>",
        ),
        (
            model.replace("<parent_body>femur_r<", "<parent_body>thigh<"),
            motion.clone(),
            "`thigh`",
        ),
        (
            model.replace("<parent_body>ground<", "<parent_body>foot_r<"),
            motion.clone(),
            "circle",
        ),
        (
            model.replace("<x>0 1.5707963267948966</x>", "<x>0 0</x>"),
            motion.clone(),
            "does not increase",
        ),
        (
            model.replace("<axis>0 0 1</axis>", "<axis>0 0</axis>"),
            motion.clone(),
            "3 numbers in <axis>",
        ),
        ("<a/>".to_owned(), motion.clone(), "<OpenSimDocument>"),
        (model.clone(), motion.replace("endheader", ""), "endheader"),
        (
            model.clone(),
            motion
                .replace("hip", "arm")
                .replace("knee", "elbow")
                .replace("pelvis", "torso")
                .replace("ankle", "wrist"),
            "coordinates",
        ),
    ];
    for (model, motion, expected) in cases {
        let error = read(model.as_bytes(), motion.as_bytes())
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{expected}: {error}");
    }
}

#[test]
fn a_motion_that_lacks_things_is_read_as_far_as_it_goes() {
    let motion = String::from_utf8_lossy(KICK).into_owned();
    let short = motion.trim_end().rsplit_once('\t').unwrap().0.to_owned();
    let loaded = read(LEG, short.as_bytes()).unwrap();
    assert_eq!(loaded.clips[0].frames, 2);
    assert!(
        loaded
            .warnings
            .iter()
            .any(|w| w.text.contains("incomplete last row"))
    );
    let loaded = read(LEG, motion.replace("inDegrees=yes\n", "").as_bytes()).unwrap();
    assert!(loaded.warnings.iter().any(|w| w.text.contains("degrees")));
    assert_eq!(loaded.clips, read(LEG, KICK).unwrap().clips);
    let spoilt = motion.replacen("90", "?", 1);
    let loaded = read(LEG, spoilt.as_bytes()).unwrap();
    assert_eq!(
        (loaded.clips[0].frames, &loaded.clips[0].repaired[..]),
        (3, &[1..2][..])
    );
}
