//! Skeletons that are no bodies.

use super::super::{find, find_moving};
use super::*;
use crate::clip::Joint;

/// A skeleton of chains: the joint each begins at, its names, and its points.
struct Made {
    joints: Vec<Joint>,
    positions: Vec<Vec3>,
}

impl Made {
    fn new(root: &str, at: [f64; 3]) -> Self {
        let mut made = Self {
            joints: Vec::new(),
            positions: Vec::new(),
        };
        made.add(root, None, at);
        made
    }

    fn add(&mut self, name: &str, parent: Option<usize>, at: [f64; 3]) -> usize {
        let at = Vec3::from(at);
        let from = parent.map_or_else(Vec3::zeros, |p| self.positions[p]);
        self.joints.push(Joint {
            name: name.to_owned(),
            parent,
            offset: at - from,
            tip: None,
        });
        self.positions.push(at);
        self.joints.len() - 1
    }

    fn chain(&mut self, from: usize, names: &[&str], points: &[[f64; 3]]) -> usize {
        let named = names.iter().zip(points);
        named.fold(from, |parent, (name, point)| {
            self.add(name, Some(parent), *point)
        })
    }

    /// A chain on each side; `?` in names becomes `L` and `R`.
    fn both(&mut self, from: usize, names: &[&str], points: &[[f64; 3]]) {
        for (side, sign) in [("L", 1.0), ("R", -1.0)] {
            let names: Vec<String> = names.iter().map(|name| name.replace('?', side)).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let points: Vec<[f64; 3]> = points.iter().map(|&[x, y, z]| [sign * x, y, z]).collect();
            self.chain(from, &names, &points);
        }
    }

    fn doubts(self) -> Vec<String> {
        let skeleton = Skeleton::new(self.joints).unwrap();
        let map = find(&skeleton).map;
        check(&skeleton, &map, &[self.positions])
    }
}

fn is_told(made: Made) {
    let doubts = made.doubts();
    assert!(
        doubts
            .iter()
            .any(|d| d.contains("probably not a human body")),
        "{doubts:?}"
    );
}

const FRONT: [[f64; 3]; 4] = [
    [8.0, 95.0, 60.0],
    [8.0, 60.0, 58.0],
    [8.0, 25.0, 60.0],
    [8.0, 5.0, 64.0],
];
const HIND: [[f64; 3]; 4] = [
    [8.0, 95.0, -60.0],
    [8.0, 60.0, -52.0],
    [8.0, 28.0, -66.0],
    [8.0, 5.0, -60.0],
];

fn quadruped(front: [&str; 4], hind: [&str; 4], spine: [&str; 3], tail: [&str; 3]) -> Made {
    let mut made = Made::new(spine[0], [0.0, 100.0, -60.0]);
    let top = made.chain(0, &spine[1..], &[[0.0, 105.0, 0.0], [0.0, 105.0, 55.0]]);
    made.both(0, &hind, &HIND);
    made.both(top, &front, &FRONT);
    made.chain(
        top,
        &["Neck", "Head"],
        &[[0.0, 120.0, 75.0], [0.0, 140.0, 95.0]],
    );
    made.chain(
        0,
        &tail,
        &[[0.0, 100.0, -75.0], [0.0, 90.0, -90.0], [0.0, 80.0, -100.0]],
    );
    made
}

#[test]
fn dogs_and_horses_are_told_whatever_their_joints_are_called() {
    let people = (
        ["?Arm", "?ForeArm", "?Hand", "?HandEnd"],
        ["?UpLeg", "?Leg", "?Foot", "?Toe"],
    );
    let horses = (
        ["?FrontLeg", "?FrontKnee", "?FrontAnkle", "?FrontHoof"],
        ["?HindLeg", "?HindKnee", "?HindAnkle", "?HindHoof"],
    );
    let none = (["a?1", "a?2", "a?3", "a?4"], ["b?1", "b?2", "b?3", "b?4"]);
    for (front, hind) in [people, horses, none] {
        is_told(quadruped(
            front,
            hind,
            ["Hips", "Spine", "Chest"],
            ["Tail", "Tail1", "Tail2"],
        ));
        is_told(quadruped(
            front,
            hind,
            ["n0", "n1", "n2"],
            ["n3", "n4", "n5"],
        ));
    }
}

#[test]
fn crabs_and_spiders_are_told() {
    for claw in ["claw_?", "x?_"] {
        let mut crab = Made::new("body", [0.0, 20.0, 0.0]);
        let middle = crab.chain(0, &["thorax"], &[[0.0, 20.0, 3.0]]);
        for leg in 0..4 {
            let z = 4.0 - 3.0 * f64::from(leg);
            let names: Vec<String> = (1..4).map(|i| format!("leg_?_{leg}{i}")).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            crab.both(
                middle,
                &names,
                &[[6.0, 20.0, z], [18.0, 26.0, 1.5 * z], [28.0, 0.0, 2.0 * z]],
            );
        }
        let names: Vec<String> = (1..4).map(|i| format!("{claw}{i}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        crab.both(
            middle,
            &names,
            &[[5.0, 20.0, 8.0], [14.0, 20.0, 16.0], [10.0, 20.0, 26.0]],
        );
        is_told(crab);
    }
}

#[test]
fn snakes_fish_birds_and_props_are_told() {
    let spine: Vec<String> = (0..20).map(|i| format!("Bone{i:03}")).collect();
    let names: Vec<&str> = spine.iter().map(String::as_str).collect();
    let points: Vec<[f64; 3]> = (1..21).map(|i| [0.0, 5.0, 10.0 * f64::from(i)]).collect();
    let mut snake = Made::new("root", [0.0; 3]);
    snake.chain(0, &names, &points);
    is_told(snake);

    let mut fish = Made::new("root", [0.0; 3]);
    fish.chain(0, &names[..5], &points[..5]);
    fish.both(
        0,
        &["Fin?1", "Fin?2", "Fin?3"],
        &[[2.0, 0.0, 4.0], [6.0, 0.0, 3.0], [9.0, 0.0, 1.0]],
    );
    is_told(fish);

    let mut bird = Made::new("Pelvis", [0.0, 30.0, 0.0]);
    let chest = bird.chain(
        0,
        &["Spine", "Chest"],
        &[[0.0, 32.0, 6.0], [0.0, 34.0, 12.0]],
    );
    bird.chain(
        chest,
        &["Neck", "Head"],
        &[[0.0, 40.0, 18.0], [0.0, 44.0, 22.0]],
    );
    bird.both(
        chest,
        &["Wing1?", "Wing2?", "Wing3?"],
        &[[5.0, 34.0, 12.0], [25.0, 36.0, 8.0], [50.0, 36.0, 0.0]],
    );
    bird.both(
        0,
        &["?Thigh", "?Shin", "?Foot"],
        &[[3.0, 28.0, 0.0], [3.0, 16.0, 3.0], [3.0, 1.0, 0.0]],
    );
    is_told(bird);

    let mut prop = Made::new("Cube", [0.0; 3]);
    prop.chain(
        0,
        &["Cube.001", "Handle"],
        &[[0.0, 10.0, 0.0], [0.0, 20.0, 0.0]],
    );
    is_told(prop);
}

/// A person with something more below the hips or at the chest.
fn person_with(names: [&str; 3], points: [[f64; 3]; 3], at: &str) -> Made {
    let (skeleton, poses) = person();
    let mut made = Made {
        joints: skeleton.joints().to_vec(),
        positions: poses[0].clone(),
    };
    let from = skeleton.find(at).unwrap();
    made.both(from, &names, &points);
    made
}

#[test]
fn further_limbs_are_told_and_hair_and_helpers_are_not() {
    let hind = [[12.0, 92.0, -60.0], [12.0, 50.0, -65.0], [12.0, 8.0, -60.0]];
    is_told(person_with(["?UpLeg2", "?Leg2", "?Foot2"], hind, "Hips"));
    is_told(person_with(["bone?1", "bone?2", "bone?3"], hind, "Hips"));
    let second_arms = [[18.0, 120.0, 0.0], [46.0, 110.0, 0.0], [71.0, 100.0, 20.0]];
    is_told(person_with(
        ["?Arm2", "?ForeArm2", "?Hand2"],
        second_arms,
        "Chest",
    ));
    let hair = [
        [6.0, 165.0, -8.0],
        [10.0, 130.0, -15.0],
        [10.0, 90.0, -15.0],
    ];
    let skirt = [[15.0, 85.0, -5.0], [20.0, 60.0, -10.0], [22.0, 35.0, -12.0]];
    let helpers = [[9.0, 90.0, 0.0], [9.0, 48.0, 1.0], [9.0, 8.0, 0.0]];
    for made in [
        person_with(["?Hair1", "?Hair2", "?Hair3"], hair, "Head"),
        person_with(["Skirt?1", "Skirt?2", "Skirt?3"], skirt, "Hips"),
        person_with(["?UpLegIK", "?LegIK", "?FootIK"], helpers, "Hips"),
    ] {
        let doubts = made.doubts();
        assert!(
            !doubts.iter().any(|d| d.contains("not a human body")),
            "{doubts:?}"
        );
    }
}

#[test]
fn rigs_of_hands_faces_and_cameras_are_told() {
    let mut hands = Made::new("World", [0.0, 100.0, 0.0]);
    hands.both(0, &["?Hand"], &[[30.0, 100.0, 30.0]]);
    for (hand, x) in [(1, 30.0), (2, -30.0)] {
        let side = if x > 0.0 { "Left" } else { "Right" };
        for (finger, name) in ["Thumb", "Index", "Middle", "Ring", "Pinky"]
            .iter()
            .enumerate()
        {
            let names: Vec<String> = (1..4).map(|k| format!("{side}Hand{name}{k}")).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let at = |k: f64| [x - 3.0 + 2.0 * finger as f64, 105.0 + 4.0 * k, 30.0];
            hands.chain(hand, &names, &[at(0.0), at(1.0), at(2.0)]);
        }
    }
    is_told(hands);

    let mut face = Made::new("head", [0.0, 160.0, 0.0]);
    face.chain(
        0,
        &["jaw", "chin"],
        &[[0.0, 155.0, 6.0], [0.0, 150.0, 10.0]],
    );
    for (name, at) in [
        ("eye_?", [3.0, 164.0, 8.0]),
        ("brow_?", [4.0, 166.0, 8.0]),
        ("lip_?", [2.0, 156.0, 9.0]),
    ] {
        face.both(0, &[name], &[at]);
    }
    is_told(face);

    let mut crane = Made::new("Dolly", [0.0; 3]);
    crane.chain(
        0,
        &["Crane", "Arm", "Head", "Camera"],
        &[
            [0.0, 50.0, 0.0],
            [0.0, 100.0, 0.0],
            [0.0, 200.0, 200.0],
            [0.0, 200.0, 220.0],
        ],
    );
    is_told(crane);
}

/// A person in a T-pose, and one who squats with the feet forward.
fn person() -> (Skeleton, Vec<Vec<Vec3>>) {
    let mut made = Made::new("Hips", [0.0, 95.0, 0.0]);
    let leg = ["?UpLeg", "?Leg", "?Foot", "?ToeBase"];
    let arm = ["?Shoulder", "?Arm", "?ForeArm", "?Hand"];
    made.both(
        0,
        &leg,
        &[
            [9.0, 90.0, 0.0],
            [9.0, 48.0, 1.0],
            [9.0, 8.0, 0.0],
            [9.0, 2.0, 13.0],
        ],
    );
    let chest = made.chain(
        0,
        &["Spine", "Chest"],
        &[[0.0, 105.0, 0.0], [0.0, 125.0, 0.0]],
    );
    made.both(
        chest,
        &arm,
        &[
            [4.0, 142.0, 0.0],
            [18.0, 143.0, 0.0],
            [46.0, 143.0, 0.0],
            [71.0, 143.0, 0.0],
        ],
    );
    made.chain(
        chest,
        &["Neck", "Head"],
        &[[0.0, 147.0, 0.0], [0.0, 158.0, 2.0]],
    );
    let skeleton = Skeleton::new(made.joints).unwrap();
    let mut squat = made.positions.clone();
    for (j, joint) in skeleton.joints().iter().enumerate() {
        let down = match joint.name.as_str() {
            "LLeg" | "RLeg" => Vec3::new(0.0, -15.0, 25.0),
            name if name.ends_with("Foot") || name.ends_with("ToeBase") => Vec3::zeros(),
            _ => Vec3::new(0.0, -30.0, -5.0),
        };
        squat[j] += down;
    }
    let poses = vec![made.positions, squat.clone(), squat.clone(), squat];
    (skeleton, poses)
}

#[test]
fn people_are_not_doubted() {
    let (skeleton, poses) = person();
    let found = find_moving(&skeleton, &poses);
    assert_eq!(found.notes, Vec::<String>::new());
    assert_eq!(check(&skeleton, &found.map, &poses), Vec::<String>::new());
}

#[test]
fn exchanged_names_follow_the_body_and_say_so() {
    let (skeleton, poses) = person();
    let exchanged = |joint: &Joint| {
        let name = match joint.name.as_bytes()[0] {
            b'L' => format!("R{}", &joint.name[1..]),
            b'R' => format!("L{}", &joint.name[1..]),
            _ => joint.name.clone(),
        };
        Joint {
            name,
            ..joint.clone()
        }
    };
    let wrong = Skeleton::new(skeleton.joints().iter().map(exchanged).collect()).unwrap();
    let found = find_moving(&wrong, &poses);
    assert_eq!(found.map, find_moving(&skeleton, &poses).map);
    assert!(
        found
            .notes
            .iter()
            .any(|n| n.contains("the body's direction is used")),
        "{found:?}"
    );
    // Said by a person, it stays, with a doubt.
    let mut map = found.map.clone();
    for role in Role::ALL {
        map.set(role, found.map.joint(role.opposite()));
    }
    let doubts = check(&wrong, &map, &poses);
    assert!(
        doubts.iter().any(|d| d.contains("knees bend backwards")),
        "{doubts:?}"
    );
}

#[test]
fn what_no_person_has_is_doubted() {
    let (skeleton, poses) = person();
    let right = find_moving(&skeleton, &poses).map;
    let with = |changes: &[(Role, &str)]| {
        let mut map = right.clone();
        for (role, name) in changes {
            map.set(*role, Some(skeleton.find(name).unwrap()));
        }
        check(&skeleton, &map, &poses).join("; ")
    };
    let doubts = with(&[(Role::LeftThigh, "Hips"), (Role::RightThigh, "Hips")]);
    assert!(
        doubts.contains("at the same point") && doubts.contains("left_thigh"),
        "{doubts}"
    );
    let doubts = with(&[(Role::Head, "LToeBase"), (Role::Neck, "LFoot")]);
    assert!(doubts.contains("below the hips"), "{doubts}");
    let doubts = with(&[
        (Role::LeftArm, "LForeArm"),
        (Role::LeftForearm, "LHand"),
        (Role::LeftHand, "LHand"),
    ]);
    assert!(
        doubts.contains("at the same point") || doubts.contains("does not fit a person"),
        "{doubts}"
    );
    let doubts = with(&[(Role::LeftShin, "LToeBase")]);
    assert!(doubts.contains("which does not fit a person"), "{doubts}");
}
