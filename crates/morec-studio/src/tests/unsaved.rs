//! What has no file of its own is not lost without a question.

use std::path::PathBuf;
use std::sync::Arc;

use egui::{Key, ViewportCommand};

use super::{Person, made, takes};
use crate::state::{Command, Panel, TimelineCommand};
use crate::store::Edit;

/// Before clips that were named in place of a database, with a label set by hand.
fn with_a_label() -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    made(folder.path(), 0);
    let clips = takes().iter().take(2);
    let clips = clips.map(|take| folder.path().join(format!("{}.bvh", take.clip.name)));
    let mut person = Person::before(&clips.collect::<Vec<_>>());
    labels(&mut person);
    (folder, person)
}

fn labels(person: &mut Person) {
    person.goes_to(Panel::Label);
    let stretch = TimelineCommand::Range(Some((0.2, 1.2)));
    person.command(Command::Timeline(stretch));
    person.key(Key::Num1);
    person.settle();
    assert_eq!(person.labels().len(), 1);
}

impl Person {
    fn unsaved_files(&self) -> Vec<PathBuf> {
        let folders = std::fs::read_dir(self.unsaved.path()).unwrap();
        folders.map(|entry| entry.unwrap().path()).collect()
    }
}

#[test]
fn closing_an_unsaved_database_asks_and_cancel_goes_on() {
    let (_folder, mut person) = with_a_label();
    assert!(person.sees_part("Not saved yet"));
    assert!(!person.closes());
    assert!(person.sees("Save the database?"));
    assert!(person.sees_part("2 clips and 1 label"));
    // A key belongs to the question.
    person.key_with(Key::Z, egui::Modifiers::COMMAND);
    person.settle();
    assert_eq!(person.labels().len(), 1);
    person.click("Cancel");
    person.frames(3);
    assert!(!person.sees("Save the database?"));
    assert_eq!(person.labels().len(), 1);
    assert!(person.sees_part("Not saved yet"), "until it is");
}

#[test]
fn where_no_dialog_opens_the_path_is_typed_before_the_window_goes() {
    let (folder, mut person) = with_a_label();
    person.has_no_dialogs();
    let path = folder.path().join("mine.mdb");
    assert!(!person.closes());
    person.click("Save …");
    person.settle();
    assert!(person.sees_part("No file dialog can be opened"));
    assert!(!person.sees("Save the database?"), "it hides the field");
    person.key(Key::Escape);
    person.frames(3);
    assert!(person.sees("Save the database?"), "it is asked again");
    person.click("Save …");
    person.settle();
    person.types("Path", &path.to_string_lossy());
    assert!(person.told(&ViewportCommand::Close));
    let db = morec_db::MotionDb::open_read_only(&path).unwrap();
    assert_eq!(db.summary().unwrap().accepted, 1);
}

#[test]
fn a_database_that_is_saved_or_discarded_lets_the_window_go() {
    let (folder, mut person) = with_a_label();
    let path = folder.path().join("mine.mdb");
    assert!(!person.closes());
    // The dialog is cancelled first: the question stays.
    person.click("Save …");
    person.settle();
    assert!(person.sees("Save the database?"));
    person.will_choose(&[&path]);
    person.click("Save …");
    person.settle();
    assert!(person.told(&ViewportCommand::Close));
    assert!(person.closes());
    let db = morec_db::MotionDb::open_read_only(&path).unwrap();
    assert_eq!(db.summary().unwrap().accepted, 1);

    let (_folder, mut person) = with_a_label();
    assert!(!person.closes());
    person.click("Discard");
    person.settle();
    assert!(person.told(&ViewportCommand::Close));
    let unsaved = person.unsaved.clone();
    drop(person);
    assert!(std::fs::read_dir(unsaved.path()).unwrap().next().is_none());
}

#[test]
fn nothing_is_asked_where_nothing_is_lost() {
    let mut person = Person::before(&[]);
    assert!(!person.sees_part("Not saved yet"), "nothing was done");
    assert!(person.closes());
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    labels(&mut person);
    assert!(!person.sees_part("Not saved yet"), "it has a file");
    assert!(person.closes());
}

#[test]
fn opening_another_database_asks_too() {
    let (folder, mut person) = with_a_label();
    let other = folder.path().join("moves.mdb");
    person.will_choose(&[&other]);
    person.key_with(Key::O, egui::Modifiers::COMMAND);
    person.settle();
    assert!(person.sees("Save the database?"));
    assert_eq!(person.labels().len(), 1);
    person.click("Discard");
    person.settle();
    assert_eq!(person.state().store.as_ref().unwrap().path(), other);
    assert!(person.unsaved_files().is_empty());
}

#[test]
fn what_a_run_that_was_killed_left_is_offered_by_the_next() {
    let (_folder, person) = with_a_label();
    let unsaved = person.unsaved.clone();
    // Another window meanwhile is not offered what is open.
    let other = Person::again(&[], unsaved.clone());
    assert!(!other.sees_part("was not saved"));
    drop(other);
    // Without a question: as the system ends programs.
    drop(person);
    let mut person = Person::again(&[], unsaved.clone());
    assert!(person.sees_part("2 clips and 1 label"));
    person.click("Open it");
    person.settle();
    assert_eq!(person.labels().len(), 1);
    assert!(person.sees_part("Not saved yet"));
    assert!(!person.sees_part("was not saved"));
    // The label is of another window, which is asked about first.
    let edit = Edit::Undo(None);
    person.command(Command::Edit(edit));
    assert!(person.sees_part("The last change was made by the window of"));
    person.click("Undo it");
    person.settle();
    assert!(!person.sees_part("Not saved yet"), "nothing is done now");
    drop(person);
    assert!(std::fs::read_dir(unsaved.path()).unwrap().next().is_none());
}

#[test]
fn what_was_left_can_be_discarded() {
    let (_folder, person) = with_a_label();
    let unsaved = person.unsaved.clone();
    drop(person);
    let mut person = Person::again(&[], Arc::clone(&unsaved));
    // One click asks, and is no answer.
    person.click("Discard it …");
    person.settle();
    assert!(person.sees_part("was not saved"));
    assert!(person.sees("Remove the database for good?"));
    person.key(egui::Key::Escape);
    person.settle();
    assert!(!person.sees("Remove the database for good?"));
    let kept = person.unsaved_files().len();
    person.click("Discard it …");
    person.frames(2);
    person.click("Remove it");
    person.settle();
    assert_eq!(person.unsaved_files().len(), kept - 1);
    assert!(!person.sees_part("was not saved"));
    drop(person);
    assert!(std::fs::read_dir(unsaved.path()).unwrap().next().is_none());
}
