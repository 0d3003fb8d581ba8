//! Edits through the window, and the way back from each.

use egui::{Key, pos2};
use morec_db::labels::SampleState as Judged;

use super::{Person, beginning, labelling, made, takes};
use crate::state::{Command, FileCommand, Panel};

#[test]
fn clips_are_imported_and_an_import_is_undone() {
    let folder = tempfile::tempdir().unwrap();
    let new = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 0);
    let mut person = Person::before(&[path]);
    std::fs::copy(folder.path().join("ada_1.bvh"), new.path().join("copy.bvh")).unwrap();
    let take = &takes()[1];
    let bytes = beginning(take, take.clip.frames / 2);
    std::fs::write(new.path().join("half.bvh"), bytes).unwrap();
    std::fs::write(new.path().join("broken.bvh"), "HIERARCHY\nROOT nobody").unwrap();
    // What a drop of a folder on the window does.
    let dropped = egui::DroppedFile {
        path: Some(new.path().to_owned()),
        ..Default::default()
    };
    person.window.input_mut().dropped_files.push(dropped);
    person.frames(2);
    person.window.input_mut().dropped_files.clear();
    person.settle();
    assert!(person.offers("half"), "the new clip is in the table");
    assert!(person.sees_part("1 file imported, 1 known already, 1 refused"));
    assert!(
        person.sees_part("broken.bvh: refused"),
        "and why a file was not imported"
    );
    person.undo();
    assert!(!person.offers("half"));
    person.redo();
    assert!(person.offers("half"));
}

#[test]
fn clips_are_found_as_somebody_types() {
    let (_folder, mut person) = labelling(0);
    person.goes_to(Panel::Library);
    assert!(person.offers("ada_1") && person.offers("ben_1"));
    person.click("Search clips");
    person.window.event(egui::Event::Text("ben".to_owned()));
    person.frames(3);
    assert!(person.offers("ben_1") && !person.offers("ada_1"));
}

#[test]
fn a_label_is_dragged_and_put_back() {
    let (_folder, mut person) = labelling(1);
    let before = person.labels();
    let label = person.state().shown_samples()[0].clone();
    let name = format!(
        "{} {:.2}–{:.2} s",
        label.class, label.start_secs, label.stop_secs
    );
    let middle = person.place(&name).center();
    person.drag(middle, middle + egui::vec2(60.0, 0.0));
    person.settle();
    let now = |person: &Person| {
        let mut shown = person.state().shown_samples().iter();
        shown.find(|s| s.id == label.id).unwrap().clone()
    };
    let moved = now(&person);
    let (was, is) = (
        label.stop_secs - label.start_secs,
        moved.stop_secs - moved.start_secs,
    );
    assert!(
        moved.start_secs > label.start_secs + 0.5,
        "{} {}",
        moved.start_secs,
        label.start_secs
    );
    assert!((was - is).abs() < 1e-6, "its length stays");
    assert!(person.state().command_line.contains("--move"));
    person.undo();
    assert_eq!(person.labels(), before);
    // By its end: only the stop moves.
    let rect = person.place(&name);
    let end = pos2(rect.right() - 2.0, rect.center().y);
    person.drag(end, end + egui::vec2(-12.0, 0.0));
    person.settle();
    let shorter = now(&person);
    assert!((shorter.start_secs - label.start_secs).abs() < 1e-6);
    assert!(shorter.stop_secs < label.stop_secs);
    person.undo();
    assert_eq!(person.labels(), before);
}

#[test]
fn labels_are_split_merged_nudged_removed() {
    let (_folder, mut person) = labelling(1);
    let before = person.labels();
    let label = person.state().shown_samples()[0].clone();
    let middle = 0.5 * (label.start_secs + label.stop_secs);
    person.command(Command::Play(crate::state::PlayCommand::Seek(middle)));
    person.key(Key::S);
    person.settle();
    assert_eq!(person.labels().len(), before.len() + 1);
    let ids: Vec<_> = person
        .state()
        .shown_samples()
        .iter()
        .filter(|s| {
            s.class == label.class
                && s.start_secs < label.stop_secs
                && s.stop_secs > label.start_secs
        })
        .map(|s| s.id)
        .collect();
    assert_eq!(ids.len(), 2);
    for id in ids {
        person.command(Command::Timeline(crate::state::TimelineCommand::Select {
            id: Some(id),
            add: true,
        }));
    }
    person.key(Key::M);
    person.settle();
    assert_eq!(person.labels(), before, "two halves are the whole again");
    person.undo();
    assert_eq!(person.labels().len(), before.len() + 1);
    person.undo();
    assert_eq!(person.labels(), before);
    let select = crate::state::TimelineCommand::Select {
        id: Some(label.id),
        add: false,
    };
    person.command(Command::Timeline(select));
    person.key_with(Key::ArrowRight, egui::Modifiers::COMMAND);
    person.settle();
    let nudged = person.state().shown_samples()[0].start_secs;
    assert!((nudged - label.start_secs - 1.0 / 60.0).abs() < 1e-4);
    person.key(Key::Delete);
    person.settle();
    assert_eq!(person.labels().len(), before.len() - 1);
    person.undo();
    person.undo();
    assert_eq!(person.labels(), before);
}

#[test]
fn what_passes_while_a_key_is_held_gets_the_label_and_taps_count_repetitions() {
    let (_folder, mut person) = labelling(0);
    person.command(Command::Timeline(crate::state::TimelineCommand::Snap(
        false,
    )));
    person.key(Key::Space);
    person.wait(0.5);
    person.hold(Key::Num1, 1.0);
    person.settle();
    let labels = person.labels();
    assert_eq!(labels.len(), 1);
    assert_eq!(labels[0].1, "gesture 1", "a key without a class makes one");
    let secs = (labels[0].3 - labels[0].2) as f64 / 100.0;
    assert!((0.9..1.3).contains(&secs), "{secs}");
    for _ in 0..3 {
        person.key(Key::Num2);
        person.wait(0.8);
    }
    person.settle();
    let taps: Vec<_> = person
        .labels()
        .into_iter()
        .filter(|l| l.1 == "gesture 2")
        .collect();
    assert_eq!(taps.len(), 2, "three taps bound two repetitions: {taps:?}");
    assert_eq!(
        taps[0].3, taps[1].2,
        "each tap ends one and begins the next"
    );
    person.key(Key::K);
    person.undo();
    person.undo();
    person.undo();
    assert!(person.labels().is_empty());
}

#[test]
fn a_selected_stretch_is_labelled_by_a_click_on_a_class() {
    let (_folder, mut person) = labelling(1);
    let before = person.labels();
    let ground = person.place("Track wave");
    // Nobody moves in the first second.
    let secs = person.state().player.secs() as f32;
    let at = |at: f32| {
        pos2(
            ground.left() + at / secs * ground.width(),
            ground.center().y,
        )
    };
    person.drag(at(0.1), at(0.9));
    assert!(person.state().timeline.range.is_some());
    person.click("Class wave");
    person.settle();
    assert_eq!(person.labels().len(), before.len() + 1);
    person.undo();
    assert_eq!(person.labels(), before);
}

#[test]
fn clips_are_cut_and_labels_dragged_between_classes() {
    let (_folder, mut person) = labelling(1);
    person.click("Cut all clips");
    person.click("By kernel change points");
    person.settle();
    assert!(
        person.state().said.contains("segments"),
        "{}",
        person.state().said
    );
    person.undo();
    assert!(
        person.state().said.contains("undone: cut"),
        "{}",
        person.state().said
    );
    person.goes_to(Panel::Classes);
    person.settle();
    let before = person.labels();
    let wave = before.iter().find(|l| l.1 == "wave").unwrap().clone();
    let store = person.state().store.as_ref().unwrap();
    let sample = store
        .snapshot
        .samples
        .iter()
        .find(|s| s.class == "wave")
        .unwrap()
        .clone();
    let card = format!("wave in {} at {:.2} s", sample.clip_name, sample.start_secs);
    let (from, to) = (
        person.place(&card).center(),
        person.place("Column bow").center(),
    );
    person.drag(from, to);
    person.settle();
    assert!(!person.labels().contains(&wave), "it is of another class");
    assert_eq!(
        person.labels().iter().filter(|l| l.1 == "bow").count(),
        before.iter().filter(|l| l.1 == "bow").count() + 1
    );
    person.undo();
    assert_eq!(person.labels(), before);
}

#[test]
fn proposals_are_answered_with_two_keys() {
    let (_folder, mut person) = labelling(2);
    let before = person.labels();
    person.click("Propose");
    person.settle();
    let open = person.state().doubtful().len();
    assert!(open >= 2, "{open}");
    person.key(Key::N);
    person.settle();
    person.key(Key::A);
    person.settle();
    assert_eq!(person.labels().len(), before.len() + 1, "accepted");
    assert_eq!(person.state().selected().len(), 1, "and the next is shown");
    person.key(Key::R);
    person.settle();
    let store = person.state().store.as_ref().unwrap();
    assert!(
        store
            .snapshot
            .samples
            .iter()
            .any(|s| s.state == Judged::Rejected)
    );
    person.undo();
    person.undo();
    assert_eq!(person.labels(), before);
    // The proposals themselves are a step, too.
    assert_eq!(person.state().doubtful().len(), open);
    person.undo();
    assert!(person.state().doubtful().is_empty());
    person.redo();
    assert_eq!(person.state().doubtful().len(), open);
}

#[test]
fn what_another_program_changes_appears() {
    let (folder, mut person) = labelling(1);
    let mut db = morec_db::MotionDb::open(&folder.path().join("moves.mdb")).unwrap();
    db.rename_class("wave", "greeting").unwrap();
    let begun = std::time::Instant::now();
    while !person.sees("Class greeting") && begun.elapsed().as_secs() < 60 {
        person.frames(1);
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    assert!(person.sees("Class greeting"));
}

#[test]
fn a_copy_is_saved_and_goes_on() {
    let (folder, mut person) = labelling(1);
    let copy = folder.path().join("copy.mdb");
    let before = person.labels();
    person.command(Command::File(FileCommand::Save(copy.clone())));
    assert_eq!(person.state().store.as_ref().unwrap().path(), copy);
    assert_eq!(person.labels(), before);
}
