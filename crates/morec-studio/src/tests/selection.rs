//! What is selected is what keys and drags label, whether something plays or not.

use egui::{Key, Pos2, pos2};

use super::{Person, labelling};
use crate::state::{Command, PlayCommand, TimelineCommand};

/// Where a moment lies on a track, while the whole clip is in view.
fn at(person: &Person, track: &str, secs: f64) -> Pos2 {
    let ground = person.place(track);
    let share = (secs / person.state().player.secs()) as f32;
    pos2(ground.left() + share * ground.width(), ground.center().y)
}

/// Drags over the track of labels.
fn select(person: &mut Person) {
    let [from, to] = [0.2, 0.9].map(|secs| at(person, "Track Labels", secs));
    person.drag(from, to);
}

/// The first segment between two cuts that is long enough to be clicked.
fn some_segment(person: &Person) -> (f64, f64) {
    let cuts = person.state().cuts();
    let wide = cuts.windows(2).find(|pair| pair[1] - pair[0] > 1.0);
    wide.map(|pair| (pair[0], pair[1])).unwrap()
}

fn hundredths((start, stop): (f64, f64)) -> (i64, i64) {
    let round = |secs: f64| (secs * 100.0).round() as i64;
    (round(start), round(stop))
}

#[test]
fn a_class_key_labels_the_selected_stretch_while_playing() {
    let (_folder, mut person) = labelling(0);
    person.command(Command::Timeline(TimelineCommand::Snap(false)));
    select(&mut person);
    let range = person.state().timeline.range.unwrap();
    person.key(Key::Space);
    person.wait(2.0);
    person.hold(Key::Num1, 0.5);
    person.settle();
    let labels = person.labels();
    assert_eq!(labels.len(), 1);
    let (start, stop) = hundredths(range);
    assert!((labels[0].2 - start).abs() <= 2 && (labels[0].3 - stop).abs() <= 2);
    // Playing goes on, and the label can be given another class at once.
    assert!(person.state().player.playing);
    assert_eq!(person.state().selected().len(), 1);
    person.key(Key::Num2);
    person.settle();
    assert_eq!(person.labels()[0].1, "gesture 2");
    // Without a selection a key labels what passes again.
    person.key(Key::Escape);
    person.hold(Key::Num1, 0.5);
    person.settle();
    assert_eq!(person.labels().len(), 2);
}

#[test]
fn a_label_that_was_just_made_does_not_catch_the_keys_of_what_is_played_next() {
    let (_folder, mut person) = labelling(0);
    select(&mut person);
    person.key(Key::Num1);
    person.settle();
    assert_eq!(
        person.state().selected().len(),
        1,
        "a new label is selected"
    );
    person.key(Key::Space);
    person.hold(Key::Num2, 0.5);
    person.settle();
    let classes: Vec<String> = person.labels().into_iter().map(|l| l.1).collect();
    assert_eq!(classes.len(), 2);
    assert!(classes.contains(&"gesture 1".to_owned()) && classes.contains(&"gesture 2".to_owned()));
}

#[test]
fn a_click_between_two_cuts_selects_the_segment() {
    let (_folder, mut person) = labelling(1);
    let before = person.labels();
    let segment = some_segment(&person);
    let middle = at(&person, "Track of cuts", 0.5 * (segment.0 + segment.1));
    // Soon after another click it would be a double click.
    person.wait(1.0);
    person.click_at(middle);
    assert_eq!(person.state().timeline.range, Some(segment));
    person.key(Key::Num1);
    person.settle();
    let new: Vec<_> = person.labels();
    assert_eq!(new.len(), before.len() + 1);
    assert_eq!(person.state().selected().len(), 1);
    person.undo();
    assert_eq!(person.labels(), before);
}

#[test]
fn a_stretch_is_selected_on_every_track() {
    let (_folder, mut person) = labelling(1);
    for track in ["Recognised", "Misfit (thesis)", "Speed"] {
        let name = format!("Track {track}");
        person.command(Command::Timeline(TimelineCommand::Range(None)));
        let (from, to) = (at(&person, &name, 3.0), at(&person, &name, 5.0));
        person.drag(from, to);
        let range = person.state().timeline.range;
        assert!(
            range.is_some_and(|(a, b)| a < 3.5 && b > 4.5),
            "{track}: {range:?}"
        );
    }
    person.command(Command::Timeline(TimelineCommand::Range(None)));
    let (from, to) = (
        at(&person, "Track of cuts", 0.3),
        at(&person, "Track of cuts", 0.8),
    );
    person.drag(from, to);
    assert!(person.state().timeline.range.is_some());
}

#[test]
fn a_segment_is_dragged_to_a_class_in_the_list_and_onto_its_track() {
    let (_folder, mut person) = labelling(1);
    let before = person.labels();
    let segment = some_segment(&person);
    let middle = at(&person, "Track of cuts", 0.5 * (segment.0 + segment.1));
    for target in ["Class bow", "Track bow"] {
        person.wait(1.0);
        person.click_at(middle);
        let to = match target {
            "Class bow" => person.place(target).center(),
            _ => at(&person, target, 0.1),
        };
        person.drag(middle, to);
        person.settle();
        let new: Vec<_> = person.labels();
        assert_eq!(new.len(), before.len() + 1, "{target}");
        let bows =
            |labels: &[(i64, String, i64, i64)]| labels.iter().filter(|l| l.1 == "bow").count();
        assert_eq!(bows(&new), bows(&before) + 1, "{target}");
        person.undo();
        assert_eq!(person.labels(), before);
    }
}

#[test]
fn classes_stand_beside_groups_and_take_what_is_dragged_there() {
    let (_folder, mut person) = labelling(1);
    person.groups_cuts();
    let before = person.labels();
    let depth = person.state().classes.depth.clone();
    let groups = person.state().classes.groups.clone().unwrap();
    let member = groups.at(&depth)[0].members[0];
    let item = groups.items[member].clone();
    let card = format!("Stretch {member} of group 1");
    let (from, to) = (
        person.place(&card).center(),
        person.place("Column bow").center(),
    );
    person.drag(from, to);
    person.settle();
    let found = |person: &Person| {
        let (start, stop) = hundredths((item.of.span.start_secs, item.of.span.stop_secs));
        let labels = person.labels();
        let mut here = labels.into_iter().filter(|l| {
            l.0 == item.of.clip.0 && (l.2 - start).abs() <= 2 && (l.3 - stop).abs() <= 2
        });
        here.next().map(|l| l.1)
    };
    assert_eq!(found(&person).as_deref(), Some("bow"));
    assert_eq!(person.labels().len(), before.len() + 1);
    person.undo();
    assert_eq!(person.labels(), before);
    // A click plays and selects it, and a key labels it though it plays.
    person.wait(1.0);
    person.click(&card);
    person.settle();
    assert!(person.state().player.playing);
    assert_eq!(
        person.state().timeline.range,
        Some((item.of.span.start_secs, item.of.span.stop_secs))
    );
    person.key(Key::Num1);
    person.settle();
    assert_eq!(found(&person).as_deref(), Some("bow"));
    person.command(Command::Play(PlayCommand::Pause));
}

#[test]
fn typing_a_name_fires_no_shortcut() {
    let (_folder, mut person) = labelling(0);
    select(&mut person);
    person.key(Key::Num1);
    person.settle();
    let labels = person.labels();
    assert_eq!(labels.len(), 1);
    person.click("New class");
    person.window.event(egui::Event::Text("wavy".to_owned()));
    person.frames(2);
    for key in [Key::Delete, Key::S, Key::X, Key::Space] {
        person.key(key);
    }
    // In a text Ctrl Z takes back what was typed, not a label.
    person.key_with(Key::Z, egui::Modifiers::COMMAND);
    person.key_with(Key::T, egui::Modifiers::COMMAND);
    person.settle();
    assert_eq!(person.labels(), labels);
    assert!(!person.state().player.playing && !person.state().is_training());
    person.key(Key::Escape);
    // A name is typed from the first frame on in which it is asked for.
    let now = Some(("gesture 1".to_owned(), "gesture 1".to_owned()));
    let renaming = Command::Classes(crate::state::ClassCommand::Renaming(now));
    person.window.state_mut().state.apply(renaming);
    person.key(Key::Delete);
    person.settle();
    assert_eq!(person.labels(), labels);
}
