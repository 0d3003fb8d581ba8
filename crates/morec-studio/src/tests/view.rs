//! The view and the player, by buttons and keys.

use egui::{Key, Modifiers};
use egui_kittest::kittest::NodeT;

use super::{Person, made};
use crate::state::{Command, Panel, PlayCommand, TrainCommand};

fn labelling() -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 1)]);
    person.goes_to(Panel::Label);
    (folder, person)
}

#[test]
fn the_performer_is_seen_from_each_side_nearer_and_farther() {
    let (_folder, mut person) = labelling();
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
    assert!(person.state().trail.is_some());
}

#[test]
fn playing_is_steered_by_keys() {
    let (_folder, mut person) = labelling();
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
    let (_folder, mut person) = labelling();
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
    let (_folder, mut person) = labelling();
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
    let (_folder, mut person) = labelling();
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
    let (_folder, mut person) = labelling();
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
