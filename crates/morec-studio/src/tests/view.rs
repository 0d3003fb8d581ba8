//! The view and the player, by buttons and keys.

use std::collections::BTreeSet;

use egui::{Color32, Key, Modifiers, Pos2, Shape};
use egui_kittest::kittest::NodeT;
use morec::roles::Role;

use super::{Person, labelling, takes};
use crate::body::LimbShape;
use crate::state::{Command, FileCommand, Panel, PlayCommand, TrainCommand};

#[test]
fn the_performer_is_seen_from_each_side_nearer_and_farther() {
    let (_folder, mut person) = labelling(1);
    let camera = |person: &Person| person.state().camera;
    person.click("Front");
    let front = camera(&person);
    person.click("Side");
    let turned = camera(&person).yaw - front.yaw;
    assert!((turned - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
    person.click("Top");
    assert!(camera(&person).pitch > 1.3);
    let place = person.place("Performer");
    let middle = place.center();
    person.drag(middle, middle + egui::vec2(80.0, 0.0));
    assert!(camera(&person).yaw < front.yaw, "a drag turns");
    let before = camera(&person).distance;
    person.window.event(egui::Event::PointerMoved(middle));
    person.window.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: egui::vec2(0.0, 120.0),
        modifiers: Modifiers::NONE,
    });
    person.frames(20);
    assert!(camera(&person).distance < before, "the wheel comes nearer");
    person.click("Reset");
    let reset = camera(&person);
    assert!((reset.distance - crate::body::Camera::default().distance).abs() < 1e-9);
    person.click("Follow");
    assert!(!camera(&person).follow);
    person.click("Onion skin");
    assert!(person.state().onion);
    person.click("Trail");
    person.click("left hand");
    assert_eq!(person.state().trail, Some(Role::LeftHand));
    assert!(person.sees("Trail: left hand"));
}

/// Lines of this width that the view hands to the painter, with their colours.
fn drawn(person: &Person, width: f32) -> Vec<([Pos2; 2], Color32)> {
    let view = person.place("Performer").expand(1.0);
    let shapes = person.window.output().shapes.iter();
    let shapes = shapes.filter(|s| view.contains_rect(s.clip_rect));
    let lines = shapes.filter_map(|s| match &s.shape {
        Shape::LineSegment { points, stroke } if stroke.width == width => {
            Some((*points, stroke.color))
        }
        _ => None,
    });
    lines.collect()
}

fn same(a: &[Pos2; 2], b: &[Pos2; 2]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.distance(*b) < 0.1)
}

/// The limbs of the shown clip at a moment, as the camera sees them.
fn limbs(person: &Person, secs: f64) -> Vec<[Pos2; 2]> {
    let view = person.state().camera.view(person.place("Performer"));
    let motion = person.state().player.motion.as_ref().unwrap();
    let pose = motion.pose(secs);
    let limbs = motion.body.limbs.iter();
    let line = |l: &LimbShape| view.line(&pose.positions[l.from], &pose.positions[l.to]);
    limbs.filter_map(line).collect()
}

/// Panics unless the onion skin is the poses 0.4 and 0.2 s ago in one colour, and those to come in another.
fn onion_is_right(person: &Person, at: f64) {
    let mut left = drawn(person, 3.0);
    let mut colours = Vec::new();
    for offset in [-0.4, -0.2, 0.2, 0.4] {
        let mut of_pose = BTreeSet::new();
        for line in limbs(person, at + offset) {
            let found = left.iter().position(|(drawn, _)| same(drawn, &line));
            let (_, colour) = left.remove(found.unwrap_or_else(|| panic!("{offset}: {line:?}")));
            of_pose.insert(colour.to_array());
        }
        assert_eq!(of_pose.len(), 1, "a pose has one colour");
        colours.push(of_pose.pop_first().unwrap());
    }
    assert!(left.is_empty(), "{} lines more", left.len());
    let blue = |colour: &[u8; 4]| i32::from(colour[2]) - i32::from(colour[0]);
    // What was is blue, what comes is orange; what is nearer in time is stronger.
    assert!(blue(&colours[1]) > blue(&colours[0]) && blue(&colours[0]) > blue(&colours[3]));
    assert!(blue(&colours[3]) > blue(&colours[2]), "{colours:?}");
}

/// Panics unless the trail is the path of this part of the body from a second ago to a second ahead.
fn trail_is_right(person: &Person, at: f64, role: Role) {
    let view = person.state().camera.view(person.place("Performer"));
    let motion = person.state().player.motion.as_ref().unwrap();
    let joint = motion.roles.joint(role).unwrap();
    let place = |step: i32| {
        let secs = at + f64::from(step) / 60.0;
        view.project(&motion.pose(secs).positions[joint]).unwrap().0
    };
    let drawn = drawn(person, 2.5);
    assert_eq!(drawn.len(), 120);
    for (step, (line, _)) in (-60..60).zip(&drawn) {
        let expected = [place(step), place(step + 1)];
        assert!(same(line, &expected), "{step}: {line:?} {expected:?}");
    }
    let longest = drawn.iter().map(|(l, _)| l[0].distance(l[1]));
    assert!(longest.fold(0.0, f32::max) > 1.0, "the part moves");
}

#[test]
fn onion_skin_and_trail_are_of_the_right_moments_and_part_in_each_clip() {
    let (folder, mut person) = labelling(1);
    // A clip of another rig, in which every joint but the root has another number.
    let text = std::fs::read_to_string(folder.path().join("ben_1.bvh")).unwrap();
    let channels = text.find("CHANNELS").unwrap();
    let end = channels + text[channels..].find('\n').unwrap() + 1;
    let tail = "JOINT Tail\n{\nOFFSET 0 0 -0.1\nCHANNELS 0\nEnd Site\n{\nOFFSET 0 0 -0.1\n}\n}\n";
    let tailed = folder.path().join("tailed.bvh");
    std::fs::write(&tailed, format!("{}{tail}{}", &text[..end], &text[end..])).unwrap();
    person.command(Command::File(FileCommand::Import(vec![tailed])));
    person.click("Onion skin");
    person.click("Trail");
    person.click("right hand");
    person.key(Key::Escape);
    let mut joints = BTreeSet::new();
    for clip in ["ada_1", "cleo_1", "tailed"] {
        person.click(&format!("Show {clip}"));
        person.settle();
        let motion = person.state().player.motion.as_ref().unwrap();
        assert_eq!(motion.clip.name, clip);
        joints.insert(motion.roles.joint(Role::RightHand));
        // A moment at which the hand moves, and one at which it stood elsewhere.
        let wave = takes()[0].labels[0].span.start_secs;
        for at in [wave + 0.5, wave + 1.5] {
            person.command(Command::Play(PlayCommand::Seek(at)));
            person.frames(2);
            let at = person.state().player.at_secs;
            onion_is_right(&person, at);
            trail_is_right(&person, at, Role::RightHand);
        }
    }
    assert_eq!(
        joints.len(),
        2,
        "the hand is another joint in the last clip"
    );
    // At the beginning nothing was before.
    person.key(Key::Home);
    person.frames(2);
    assert_eq!(drawn(&person, 2.5).len(), 60);
    let ahead = limbs(&person, 0.2).len() + limbs(&person, 0.4).len();
    assert_eq!(drawn(&person, 3.0).len(), ahead);
    person.click("Onion skin");
    assert!(drawn(&person, 3.0).is_empty());
}

#[test]
fn playing_is_steered_by_keys() {
    let (_folder, mut person) = labelling(1);
    let speed = |person: &Person| {
        let player = &person.state().player;
        (player.playing, player.speed)
    };
    person.command(Command::Play(PlayCommand::Seek(5.0)));
    person.key(Key::L);
    assert_eq!(speed(&person), (true, 1.0));
    for faster in [2.0, 4.0, 8.0, 8.0] {
        person.key(Key::L);
        assert_eq!(speed(&person), (true, faster));
    }
    person.key(Key::J);
    assert_eq!(speed(&person), (true, -1.0));
    person.key(Key::K);
    assert!(!person.state().player.playing);
    let frame = 1.0 / person.state().player.rate_hz();
    let at = |person: &Person| person.state().player.at_secs;
    person.command(Command::Play(PlayCommand::Seek(5.0)));
    for (key, modifiers, by) in [
        (Key::Period, Modifiers::NONE, frame),
        (Key::Comma, Modifiers::NONE, -frame),
        (Key::ArrowRight, Modifiers::NONE, frame),
        (Key::ArrowLeft, Modifiers::NONE, -frame),
        (Key::ArrowRight, Modifiers::SHIFT, 1.0),
        (Key::ArrowLeft, Modifiers::SHIFT, -1.0),
    ] {
        let before = at(&person);
        person.key_with(key, modifiers);
        assert!((at(&person) - before - by).abs() < 1e-6, "{key:?}");
    }
    person.key(Key::End);
    assert!(at(&person) > person.state().player.secs() - 2.0 * frame);
    person.key(Key::Home);
    assert_eq!(at(&person), 0.0);
    person.key(Key::Space);
    assert!(person.state().player.playing);
    person.key(Key::Space);
    assert!(!person.state().player.playing);
}

#[test]
fn speeds_from_a_twentieth_to_eightfold_are_chosen_and_a_label_is_looped() {
    let (_folder, mut person) = labelling(1);
    person.click("Playing speed");
    person.click("0.05×");
    assert_eq!(person.state().player.speed, 0.05);
    person.wait(0.5);
    person.click("Playing speed");
    person.click("8×");
    assert_eq!(person.state().player.speed, 8.0);
    let sample = person.state().shown_samples()[0].clone();
    let (start, stop) = (sample.start_secs, sample.stop_secs);
    person.click(&format!("{} {start:.2}–{stop:.2} s", sample.class));
    person.key(Key::O);
    assert_eq!(person.state().player.looped, Some((start, stop)));
    person.key(Key::Space);
    person.wait(1.0);
    let player = &person.state().player;
    assert!(player.playing && (start..=stop).contains(&player.at_secs));
    person.key(Key::O);
    assert_eq!(person.state().player.looped, None);
}

#[test]
fn panels_pages_and_themes_are_reached_by_keys_and_buttons() {
    let (_folder, mut person) = labelling(1);
    for (panel, key) in Panel::ALL.into_iter().zip(crate::keys::CLASS_KEYS) {
        person.key_with(key, Modifiers::COMMAND);
        assert_eq!(person.state().panel, panel);
    }
    person.key(Key::F1);
    assert!(person.sees("Anywhere"));
    person.key(Key::Escape);
    assert!(!person.sees("Anywhere"));
    person.click("Light theme");
    assert!(!person.state().dark);
    person.click("Dark theme");
    assert!(person.state().dark);
}

#[test]
fn the_page_of_keys_has_room_in_a_small_window_and_a_shape_for_each_letter() {
    let (_folder, mut person) = labelling(1);
    person.window.set_size(egui::vec2(1280.0, 720.0));
    person.key(Key::F1);
    person.frames(10);
    let page = person.window.ctx.memory(|m| m.area_rect("Keys")).unwrap();
    assert!(page.width() < 1280.0 && page.height() < 720.0, "{page}");
    for (area, keys, what) in crate::keys::HELP {
        for text in [area, keys, what] {
            assert!(person.can_draw(text), "{text} has a letter without a shape");
        }
        let place = person.place(what);
        assert!(page.contains_rect(place), "{what}: {place} in {page}");
    }
}

#[test]
fn each_letter_that_is_shown_has_a_shape() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[super::made(folder.path(), 2)]);
    person.command(Command::Train(TrainCommand::Train));
    // Signs on buttons and in painted texts, whose names are others.
    assert!(person.can_draw("⏷⏶⏺⏮⏸▶◀🔁☀🌙⟳⟲✔✖⚠•−×…“”–·"));
    for panel in Panel::ALL {
        person.goes_to(panel);
        person.frames(3);
        let shown = person.window.root().children_recursive();
        let texts = shown.filter_map(|node| node.accesskit_node().label());
        let texts: Vec<String> = texts.collect();
        assert!(texts.len() > 10);
        for text in texts {
            assert!(person.can_draw(&text), "{panel:?}: {text}");
        }
    }
}

#[test]
fn a_step_in_the_middle_of_the_history_is_undone_by_its_name() {
    let (_folder, mut person) = labelling(1);
    let before = person.labels();
    let ids: Vec<_> = person
        .state()
        .shown_samples()
        .iter()
        .map(|s| s.id)
        .collect();
    for id in [ids[0], ids[2]] {
        let remove = crate::store::Edit::Remove(vec![id]);
        person.command(Command::Edit(remove));
    }
    person.key_with(Key::H, Modifiers::COMMAND);
    person.settle();
    let steps = &person.state().store.as_ref().unwrap().snapshot.history;
    let first = steps[1].clone();
    person.click(&format!("Undo step {}: {}", first.id, first.what));
    person.settle();
    assert_eq!(person.labels().len(), before.len() - 1);
    let line = &person.state().command_line;
    assert!(line.ends_with(&first.id.to_string()), "{line}");
    person.undo();
    assert_eq!(person.labels(), before);
}
