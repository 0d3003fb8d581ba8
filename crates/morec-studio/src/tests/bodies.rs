//! Clips that show no person: animals, markers, two joints. What is drawn, and what is said of it.

use std::fmt::Write;
use std::path::PathBuf;

use super::{Person, made};
use crate::state::{Command, LibraryCommand, Panel, TrainCommand};

/// A joint of a made skeleton: name, parent, place from the parent.
type Made = (String, Option<usize>, [f64; 3]);

fn branch(joints: &[Made], at: usize, out: &mut String) {
    let (name, parent, [x, y, z]) = &joints[at];
    let (kind, channels) = match parent {
        None => (
            "ROOT",
            "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation",
        ),
        Some(_) => ("JOINT", "3 Zrotation Xrotation Yrotation"),
    };
    writeln!(
        out,
        "{kind} {name}\n{{\nOFFSET {x} {y} {z}\nCHANNELS {channels}"
    )
    .unwrap();
    let below: Vec<usize> = (0..joints.len())
        .filter(|&j| joints[j].1 == Some(at))
        .collect();
    for &child in &below {
        branch(joints, child, out);
    }
    if below.is_empty() {
        writeln!(out, "End Site\n{{\nOFFSET 0 1 0\n}}").unwrap();
    }
    writeln!(out, "}}").unwrap();
}

/// Two seconds of a body that sways.
fn bvh(joints: &[Made]) -> String {
    let mut text = "HIERARCHY\n".to_owned();
    branch(joints, 0, &mut text);
    text += "MOTION\nFrames: 120\nFrame Time: 0.0166667\n";
    for frame in 0..120 {
        let sway = (f64::from(frame) * 0.1).sin();
        let place = [5.0 * sway, joints[0].2[1], 0.0];
        let turns = vec![10.0 * sway; 3 * joints.len()];
        let values: Vec<String> = place
            .iter()
            .chain(&turns)
            .map(|v| format!("{v:.4}"))
            .collect();
        writeln!(text, "{}", values.join(" ")).unwrap();
    }
    text
}

/// Eight legs and two claws.
fn crab() -> Vec<Made> {
    let mut joints: Vec<Made> = vec![
        ("body".to_owned(), None, [0.0, 20.0, 0.0]),
        ("thorax".to_owned(), Some(0), [0.0, 0.0, 3.0]),
    ];
    let mut limb = |name: &str, steps: [[f64; 3]; 3]| {
        for (side, sign) in [("L", 1.0), ("R", -1.0)] {
            let mut parent = 1;
            for (at, [x, y, z]) in steps.iter().enumerate() {
                joints.push((
                    format!("{name}_{side}_{at}"),
                    Some(parent),
                    [sign * x, *y, *z],
                ));
                parent = joints.len() - 1;
            }
        }
    };
    for leg in 0..4 {
        let z = 1.0 - 3.0 * f64::from(leg);
        let steps = [[6.0, 0.0, z], [12.0, 6.0, 0.5 * z], [10.0, -26.0, 0.5 * z]];
        limb(&format!("leg{leg}"), steps);
    }
    limb(
        "claw",
        [[5.0, 0.0, 5.0], [9.0, 0.0, 8.0], [-4.0, 0.0, 10.0]],
    );
    joints
}

/// Wings, and legs with a joint more than a person's.
fn chicken() -> Vec<Made> {
    let mut joints: Vec<Made> = vec![
        ("Pelvis".to_owned(), None, [0.0, 24.0, 0.0]),
        ("Spine".to_owned(), Some(0), [0.0, 2.0, 5.0]),
        ("Chest".to_owned(), Some(1), [0.0, 1.0, 6.0]),
        ("Neck".to_owned(), Some(2), [0.0, 8.0, 4.0]),
        ("Head".to_owned(), Some(3), [0.0, 6.0, 2.0]),
        ("Beak".to_owned(), Some(4), [0.0, -1.0, 4.0]),
        ("Tail".to_owned(), Some(0), [0.0, 4.0, -8.0]),
    ];
    let wing = (
        2,
        vec![
            ("Wing1", [4.0, 1.0, -1.0]),
            ("Wing2", [6.0, -2.0, -4.0]),
            ("Wing3", [5.0, 0.0, -6.0]),
        ],
    );
    let leg = (
        0,
        vec![
            ("Thigh", [3.0, -2.0, 1.0]),
            ("Shin", [0.5, -7.0, 3.0]),
            ("Tarsus", [0.0, -8.0, -4.0]),
            ("Foot", [0.0, -6.0, 2.0]),
            ("Claw", [0.0, -1.0, 3.0]),
        ],
    );
    for (from, limb) in [wing, leg] {
        for (side, sign) in [("L", 1.0), ("R", -1.0)] {
            let mut parent = from;
            for (name, [x, y, z]) in &limb {
                joints.push((format!("{name}_{side}"), Some(parent), [sign * x, *y, *z]));
                parent = joints.len() - 1;
            }
        }
    }
    joints
}

/// Markers of nobody knows what, two metres apart at most, about a place far from the origin.
fn markers() -> String {
    trc(|frame, marker| {
        let away = 0.5 * marker;
        let sway = 0.1 * (frame * 0.1 + away).sin();
        [7.0 + away + sway, 1.0 + away, 5.0]
    })
}

/// Two seconds of five markers, each in every frame at a place in metres.
pub fn trc(place: impl Fn(f64, f64) -> [f64; 3]) -> String {
    let names = ["aa", "bb", "cc", "dd", "ee"];
    let mut text = "PathFileType\t4\t(X/Y/Z)\tmarkers.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n\
        60\t60\t120\t5\tm\n"
        .to_owned();
    text += &format!("Frame#\tTime\t{}\t\t\n", names.join("\t\t\t"));
    let axes: Vec<String> = (1..=5).map(|n| format!("X{n}\tY{n}\tZ{n}")).collect();
    text += &format!("\t\t{}\n\n", axes.join("\t"));
    for frame in 0..120 {
        write!(text, "{}\t{:.5}", frame + 1, f64::from(frame) / 60.0).unwrap();
        for marker in 0..5 {
            let [x, y, z] = place(f64::from(frame), f64::from(marker));
            write!(text, "\t{x:.4}\t{y:.4}\t{z:.4}").unwrap();
        }
        text.push('\n');
    }
    text
}

/// Before the library with one clip of these contents, and the clip's path.
pub fn with(name: &str, contents: &[u8]) -> (tempfile::TempDir, PathBuf, Person) {
    let folder = tempfile::tempdir().unwrap();
    let path: PathBuf = folder.path().join(name);
    std::fs::write(&path, contents).unwrap();
    let mut person = Person::before(std::slice::from_ref(&path));
    person.settle();
    assert!(person.state().player.motion.is_some());
    (folder, path, person)
}

fn thickest(body: &crate::body::Body) -> f64 {
    let radii = body.limbs.iter().map(|limb| limb.radii[0]);
    radii.fold(0.0, f64::max)
}

#[test]
fn animals_are_named_as_inspect_names_them_and_get_no_limbs_of_a_person() {
    for (name, joints) in [("crab.bvh", crab()), ("chicken.bvh", chicken())] {
        let (_folder, path, mut person) = with(name, bvh(&joints).as_bytes());
        let takes = morec::files::open_all(&path).unwrap();
        let doubts = takes[0].report.doubts.iter();
        let told = |doubt: &&String| doubt.contains("probably not a human body");
        let inspected = doubts.clone().find(told);
        let inspected = inspected.unwrap_or_else(|| panic!("{name}: {doubts:?}"));
        // The reason; the remedy is a click here.
        let reason = crate::store::sentence(inspected.split(". ").next().unwrap());
        for panel in [Panel::Library, Panel::Label] {
            person.goes_to(panel);
            assert!(person.sees_part(&reason), "{name}: {reason}");
        }
        let body = &person.state().player.motion.as_ref().unwrap().body;
        assert!(thickest(body) < 0.01, "{name}: {}", thickest(body));
        assert!(body.head.is_none(), "{name}");
    }
}

#[test]
fn a_person_is_not_doubted_and_is_drawn_as_one() {
    let folder = tempfile::tempdir().unwrap();
    let person = Person::before(&[made(folder.path(), 0)]);
    assert!(!person.sees_part("probably not a human body"));
    let motion = person.state().player.motion.clone().unwrap();
    assert!(motion.doubts.is_empty(), "{:?}", motion.doubts);
    assert!(thickest(&motion.body) > 0.05);
}

/// Places in the picture of the performer at which something small and round is drawn.
pub fn dots(person: &Person) -> Vec<egui::Pos2> {
    let view = person.place("Performer");
    let shapes = person.window.output().shapes.iter();
    let round = shapes.filter_map(|s| match &s.shape {
        egui::Shape::Circle(circle) if circle.radius < 4.0 => Some(circle.center),
        _ => None,
    });
    round.filter(|at| view.contains(*at)).collect()
}

/// The markers as C3D.
fn markers_c3d() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("markers.trc");
    std::fs::write(&path, markers()).unwrap();
    let takes = morec::files::open_all(&path).unwrap();
    let mut bytes = Vec::new();
    morec::formats::c3d::write(&takes[0].clip, &mut bytes).unwrap();
    bytes
}

#[test]
fn markers_are_drawn_and_framed_and_play() {
    for (name, contents) in [
        ("markers.trc", markers().into_bytes()),
        ("markers.c3d", markers_c3d()),
    ] {
        let (_folder, _, mut person) = with(name, &contents);
        for panel in [Panel::Library, Panel::Label] {
            person.goes_to(panel);
            let seen = dots(&person);
            assert_eq!(seen.len(), 5, "{name}: all of them lie in the picture");
            // Neither a heap in the middle nor cut off at the edge.
            let framed = egui::Rect::from_points(&seen);
            let view = person.place("Performer");
            let least = 0.2 * view.width().min(view.height());
            assert!(
                framed.size().max_elem() > least,
                "{name}: {framed} in {view}"
            );
        }
        assert!(person.sees_part("Only 5 points are drawn"), "{name}");
        let before = dots(&person);
        person.key(egui::Key::Space);
        person.wait(0.7);
        let after = dots(&person);
        assert!(person.state().player.at_secs > 0.5, "{name}");
        let moved = before.iter().zip(&after).map(|(a, b)| a.distance(*b));
        assert!(moved.fold(0.0, f32::max) > 1.0, "{name}: they stand still");
    }
}

#[test]
fn a_clip_of_two_joints_says_why_there_is_no_body() {
    let joints: Vec<Made> = vec![
        ("root".to_owned(), None, [0.0, 0.0, 0.0]),
        ("tip".to_owned(), Some(0), [0.0, 40.0, 0.0]),
    ];
    let text = bvh(&joints).replace("OFFSET 0 1 0", "OFFSET 0 0 0");
    let (_folder, _, mut person) = with("two.bvh", text.as_bytes());
    person.goes_to(Panel::Label);
    assert!(person.sees_part("joints are not enough for a body"));
    assert!(!dots(&person).is_empty());
}

#[test]
fn clips_of_positions_say_why_the_tracks_of_2009_are_empty() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 2)]);
    person.command(Command::Train(TrainCommand::Thesis));
    let path = folder.path().join("markers.trc");
    std::fs::write(&path, markers()).unwrap();
    person.command(Command::File(crate::state::FileCommand::Import(vec![path])));
    let snapshot = person.state().store.as_ref().unwrap().snapshot.clone();
    let clip = snapshot
        .clips
        .iter()
        .find(|c| c.name == "markers")
        .unwrap()
        .id;
    person.goes_to(Panel::Label);
    person.command(Command::Library(LibraryCommand::Open(clip)));
    let said = crate::jobs::cut::NO_ROTATIONS;
    assert!(person.sees(&format!("2009: confidence: {said}")));
    assert!(person.sees_part("Misfit (thesis): "));
    assert!(
        person.state().notices.is_empty(),
        "{:?}",
        person.state().notices
    );
}
