//! Steps of other programs are named before they are taken back; the last index comes back.

use egui::{Key, Modifiers};
use morec_db::MotionDb;
use morec_db::labels::WholeClip;

use super::{Person, made};

/// Another program labels a clip.
fn elsewhere(path: &std::path::Path) {
    let mut db = MotionDb::open(path).unwrap();
    db.set_program("morec");
    let clip = db.find_clip("cleo_1").unwrap().id;
    let whole = WholeClip {
        clip,
        class: Some("jump".to_owned()),
        subject: None,
    };
    db.label_clips(&[whole], "user", None).unwrap();
}

/// Before a database with a step of its own and a later one of another program.
fn with_both() -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 0);
    let mut person = Person::before(std::slice::from_ref(&path));
    person.click("ada_1");
    person.key(Key::Num1);
    person.settle();
    elsewhere(&path);
    while person.labels().len() < 2 {
        person.frames(1);
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    (folder, person)
}

impl Person {
    fn classes_labelled(&self) -> Vec<String> {
        self.labels().into_iter().map(|label| label.1).collect()
    }
}

#[test]
fn undo_says_whose_step_it_takes_back() {
    let (_folder, mut person) = with_both();
    person.key_with(Key::Z, Modifiers::COMMAND);
    person.settle();
    assert!(person.sees("The last change was made by morec"));
    assert!(person.sees("“label 1 whole clip jump”"));
    assert_eq!(person.labels().len(), 2, "nothing is done yet");
    person.click("Cancel");
    person.settle();
    assert_eq!(person.labels().len(), 2);
    person.key_with(Key::Z, Modifiers::COMMAND);
    person.frames(2);
    person.click("Undo it");
    person.settle();
    assert_eq!(person.classes_labelled(), ["gesture 1"]);
    // One's own needs no question.
    person.undo();
    assert!(person.labels().is_empty());
}

#[test]
fn undo_takes_back_ones_own_step_below_another() {
    let (_folder, mut person) = with_both();
    person.click("Undo");
    person.frames(2);
    assert!(person.sees_part("The last change made here: “label 1 whole clip gesture 1”"));
    person.click("Mine only");
    person.settle();
    assert_eq!(person.classes_labelled(), ["jump"]);
}

#[test]
fn the_last_index_comes_back_with_the_database() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 2);
    let mut person = Person::before(std::slice::from_ref(&path));
    assert!(person.state().train.index.is_none());
    let steps = person
        .state()
        .store
        .as_ref()
        .unwrap()
        .snapshot
        .history
        .len();
    person.key_with(Key::T, Modifiers::COMMAND);
    person.settle();
    let store = person.state().store.as_ref().unwrap();
    assert_eq!(store.snapshot.history.len(), steps, "undo is of labels");
    drop(person);
    let mut person = Person::before(std::slice::from_ref(&path));
    assert!(person.state().train.index.is_some());
    assert!(!person.state().train.is_stale());
    assert!(
        MotionDb::open(&path)
            .unwrap()
            .check()
            .unwrap()
            .faults
            .is_empty()
    );
    person.click("ada_1");
    person.settle();
    person.key(Key::Num1);
    person.settle();
    assert!(person.state().train.is_stale());
    drop(person);
    let person = Person::before(&[path]);
    assert!(person.state().train.is_stale(), "and so it is said");
}

#[test]
fn a_second_window_and_a_later_session_take_back_only_their_own_steps_unasked() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 0);
    let mut first = Person::before(std::slice::from_ref(&path));
    let mut second = Person::before(std::slice::from_ref(&path));
    first.click("ada_1");
    first.settle();
    first.key(Key::Num1);
    first.settle();
    while second.labels().is_empty() {
        second.frames(1);
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    second.key_with(Key::Z, Modifiers::COMMAND);
    second.settle();
    assert_eq!(second.labels().len(), 1, "not unasked");
    assert!(second.sees_part("The last change was made by the window of"));
    second.click("Cancel");
    drop(first);
    // Nor does a session of another day.
    let mut later = Person::before(std::slice::from_ref(&path));
    later.key_with(Key::Z, Modifiers::COMMAND);
    later.settle();
    assert_eq!(later.labels().len(), 1);
    later.click("Undo it");
    later.settle();
    assert!(later.labels().is_empty());
}
