//! The device guide: its tables of parts, with synthetic landmarks piped through them.

use std::collections::BTreeMap;

use morec::features::for_each_pose;
use morec::import::{ImportOptions, normalize};
use morec::math::Vec3;
use morec::roles::Role;
use morec::synth::{Person, Script};
use serde_json::{Value, json};

use crate::kit::Folder;

const GUIDE: &str = include_str!("../../../../docs/guide/devices.md");
const INDEX: &[u8] = include_bytes!("../../../morec/testdata/index/v1.index");

/// The table `PARTS = {…}` of a chapter of the guide, which is JSON but for its last comma and a remark.
fn parts(chapter: &str) -> BTreeMap<String, Value> {
    let chapter = GUIDE.split(&format!("## {chapter}\n")).nth(1).unwrap();
    let table = chapter.split("PARTS = {").nth(1).unwrap();
    let table = table.split("\n}").next().unwrap();
    let lines: Vec<&str> = table
        .lines()
        .map(|l| l.split('#').next().unwrap())
        .collect();
    let table = lines.join(" ");
    serde_json::from_str(&format!("{{{}}}", table.trim().trim_end_matches(','))).unwrap()
}

/// Seconds and the places of the roles of somebody who waves, 30 times a second.
fn performance() -> Vec<(f64, BTreeMap<Role, Vec3>)> {
    let script = Script::new(5, Person::draw(5, 0))
        .rest(1.0)
        .play("wave")
        .rest(0.8);
    let made = normalize(
        script.film("made", 30.0).unwrap().clip,
        &ImportOptions::default(),
    )
    .unwrap();
    let mut poses = Vec::new();
    for_each_pose(
        &made.clip,
        &made.roles,
        &made.report.rest_frames,
        |secs, pose| {
            let places = Role::ALL
                .into_iter()
                .filter_map(|role| Some((role, pose.get(role)?)));
            poses.push((secs, places.collect()));
        },
    );
    poses
}

/// Output of `live` for lines of JSON.
fn live(lines: &[String]) -> String {
    let folder = Folder::with(&[("poses.jsonl", &(lines.join("\n") + "\n"))]);
    std::fs::write(folder.path().join("v1.index"), INDEX).unwrap();
    let ran = folder.morec_fed(
        &["live", "v1.index", "--listen", "json:-"],
        Some("poses.jsonl"),
    );
    assert_eq!(ran.code, Some(0), "{ran:?}");
    ran.err
}

fn assert_clean(said: &str, frames: usize) {
    assert!(said.contains(&format!(" {frames} frames,")), "{said}");
    for wrong in ["malformed", "error", "warning"] {
        assert!(!said.contains(wrong), "{wrong}: {said}");
    }
}

#[test]
fn landmarks_of_mediapipe_become_a_clean_stream_by_the_guides_table() {
    let table = parts("MediaPipe");
    let poses = performance();
    // Where the single landmarks are: those of one role each, and the ears at both sides of the head.
    let role_of = |number: u64| {
        let single = table
            .iter()
            .find(|(_, numbers)| **numbers == json!([number]));
        single.map(|(part, _)| Role::from_name(part).unwrap())
    };
    let line = |(secs, places): &(f64, BTreeMap<Role, Vec3>)| {
        // As the camera sees it: from the hips, Y down, Z away.
        let hips = 0.5 * (places[&Role::LeftThigh] + places[&Role::RightThigh]);
        let seen = |number: u64| {
            let at = match role_of(number) {
                Some(role) => places[&role],
                None => {
                    places[&Role::Head]
                        + Vec3::new(if number == 7 { 0.08 } else { -0.08 }, 0.05, 0.0)
                }
            } - hips;
            Vec3::new(at.x, -at.y, -at.z)
        };
        let positions: BTreeMap<&String, [f64; 3]> = table
            .iter()
            .map(|(part, numbers)| {
                let numbers: Vec<u64> = serde_json::from_value(numbers.clone()).unwrap();
                let middle = numbers.iter().map(|n| seen(*n)).sum::<Vec3>() / numbers.len() as f64;
                (part, [middle.x, -middle.y, -middle.z])
            })
            .collect();
        json!({"t": secs, "positions": positions}).to_string()
    };
    let lines: Vec<String> = poses.iter().map(line).collect();
    let said = live(&lines);
    assert_clean(&said, lines.len());
    assert!(said.contains("note: the hips never move"), "{said}");
    // The script's signs matter: without them morec says what to do.
    let unturned: Vec<String> = poses
        .iter()
        .map(|(secs, places)| {
            let positions: BTreeMap<&str, [f64; 3]> = places
                .iter()
                .map(|(role, p)| (role.name(), [p.x, -p.y, -p.z]))
                .collect();
            json!({"t": secs, "positions": positions}).to_string()
        })
        .collect();
    let said = live(&unturned);
    assert!(
        said.contains("error: the head is below the feet, so Y points down: send [x, -y, -z]"),
        "{said}"
    );
}

#[test]
fn joints_of_azure_kinect_become_a_clean_stream_by_the_guides_table() {
    let table = parts("Kinect");
    assert_eq!(table.len(), Role::BODY_COUNT);
    let names: std::collections::BTreeSet<&str> =
        table.values().filter_map(Value::as_str).collect();
    assert_eq!(names.len(), Role::BODY_COUNT, "each joint plays one part");
    let poses = performance();
    let line = |(secs, places): &(f64, BTreeMap<Role, Vec3>)| {
        let positions: BTreeMap<&String, [f64; 3]> = table
            .iter()
            .map(|(part, joint)| {
                let role = Role::from_name(part).unwrap();
                let side = |left: &str| joint.as_str().unwrap().ends_with(left);
                assert_eq!(part.starts_with("left"), side("_LEFT"), "{part}");
                // Millimetres in the camera's axes, three metres away, and back as the guide has it.
                let seen = Vec3::new(
                    places[&role].x,
                    1.0 - places[&role].y,
                    3.0 - places[&role].z,
                ) * 1000.0;
                (part, [seen.x, -seen.y, -seen.z])
            })
            .collect();
        json!({"t": secs, "positions": positions}).to_string()
    };
    let lines: Vec<String> = poses.iter().map(line).collect();
    assert_clean(&live(&lines), lines.len());
}

#[test]
fn the_joints_of_mocopi_are_found_by_themselves() {
    let below = |name: &str, parent: Option<usize>, at: [f64; 3]| (name.to_owned(), parent, at);
    let mut joints = vec![below("root", None, [0.0, 0.95, 0.0])];
    for n in 1..=7 {
        joints.push(below(&format!("torso_{n}"), Some(n - 1), [0.0, 0.065, 0.0]));
    }
    joints.push(below("neck_1", Some(7), [0.0, 0.05, 0.0]));
    joints.push(below("neck_2", Some(8), [0.0, 0.05, 0.0]));
    joints.push(below("head", Some(9), [0.0, 0.05, 0.02]));
    for (side, s) in [("l", 1.0), ("r", -1.0)] {
        let at = joints.len();
        joints.push(below(
            &format!("{side}_shoulder"),
            Some(7),
            [0.03 * s, 0.02, 0.0],
        ));
        joints.push(below(
            &format!("{side}_up_arm"),
            Some(at),
            [0.14 * s, 0.0, 0.0],
        ));
        joints.push(below(
            &format!("{side}_low_arm"),
            Some(at + 1),
            [0.28 * s, 0.0, 0.0],
        ));
        joints.push(below(
            &format!("{side}_hand"),
            Some(at + 2),
            [0.25 * s, 0.0, 0.0],
        ));
    }
    for (side, s) in [("l", 1.0), ("r", -1.0)] {
        let at = joints.len();
        joints.push(below(
            &format!("{side}_up_leg"),
            Some(0),
            [0.09 * s, -0.03, 0.0],
        ));
        joints.push(below(
            &format!("{side}_low_leg"),
            Some(at),
            [0.0, -0.42, 0.0],
        ));
        joints.push(below(
            &format!("{side}_foot"),
            Some(at + 1),
            [0.0, -0.42, 0.0],
        ));
        joints.push(below(
            &format!("{side}_toes"),
            Some(at + 2),
            [0.0, -0.06, 0.13],
        ));
    }
    assert_eq!(joints.len(), 27);
    let joint = |(name, parent, at): &(String, Option<usize>, [f64; 3])| morec::clip::Joint {
        name: name.clone(),
        parent: *parent,
        offset: Vec3::from(*at),
        tip: None,
    };
    let skeleton = morec::clip::Skeleton::new(joints.iter().map(joint).collect()).unwrap();
    let roles = morec::roles::RoleMap::find(&skeleton);
    for (role, name) in [
        (Role::Hips, "root"),
        (Role::Head, "head"),
        (Role::LeftArm, "l_up_arm"),
        (Role::LeftForearm, "l_low_arm"),
        (Role::LeftHand, "l_hand"),
        (Role::RightThigh, "r_up_leg"),
        (Role::RightShin, "r_low_leg"),
        (Role::RightFoot, "r_foot"),
    ] {
        let joint = roles
            .joint(role)
            .map(|j| skeleton.joints()[j].name.as_str());
        assert_eq!(joint, Some(name), "{role}");
    }
    assert_eq!(roles.missing().count(), 0);
}
