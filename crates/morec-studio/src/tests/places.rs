//! Keys and colours of classes stay with them.

use morec_db::MotionDb;
use morec_db::labels::WholeClip;

use super::{Person, made};
use crate::state::{ClassCommand, Command, Panel};

/// Labels a whole clip without the studio.
fn label(path: &std::path::Path, class: &str) {
    let mut db = MotionDb::open(path).unwrap();
    let clip = db.find_clip("cleo_1").unwrap().id;
    let whole = WholeClip {
        clip,
        class: Some(class.to_owned()),
        subject: None,
    };
    db.label_clips(&[whole], "test", None).unwrap();
}

fn places(person: &Person) -> Vec<(usize, String)> {
    let placed = person.state().classes.placed();
    placed
        .map(|(place, name)| (place, name.to_owned()))
        .collect()
}

fn named(places: &[(usize, &str)]) -> Vec<(usize, String)> {
    places
        .iter()
        .map(|(place, name)| (*place, (*name).to_owned()))
        .collect()
}

#[test]
fn a_class_that_comes_moves_no_key_at_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 1);
    let person = Person::before(std::slice::from_ref(&path));
    let before = named(&[(0, "bow"), (1, "clap"), (2, "wave")]);
    assert_eq!(
        places(&person),
        before,
        "as they were before places were kept"
    );
    drop(person);
    label(&path, "aaa");
    let person = Person::before(&[path]);
    let mut all = before;
    all.push((3, "aaa".to_owned()));
    assert_eq!(places(&person), all);
}

#[test]
fn a_class_that_goes_leaves_the_others_and_comes_back_to_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 1);
    let mut person = Person::before(std::slice::from_ref(&path));
    person.command(Command::Classes(ClassCommand::Remove("bow".to_owned())));
    assert_eq!(places(&person), named(&[(1, "clap"), (2, "wave")]));
    person.undo();
    assert_eq!(
        places(&person),
        named(&[(0, "bow"), (1, "clap"), (2, "wave")])
    );
    let rename = ClassCommand::Rename {
        from: "clap".to_owned(),
        to: "zap".to_owned(),
    };
    person.command(Command::Classes(rename));
    drop(person);
    let person = Person::before(&[path]);
    assert_eq!(
        places(&person),
        named(&[(0, "bow"), (1, "zap"), (2, "wave")])
    );
}

#[test]
fn a_key_is_given_by_hand_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), 1);
    let mut person = Person::before(std::slice::from_ref(&path));
    person.goes_to(Panel::Label);
    person.right_click("Class wave");
    person.click("Give it the key … ⏵");
    person.frames(3);
    person.click("1  bow");
    person.settle();
    let swapped = named(&[(0, "wave"), (1, "clap"), (2, "bow")]);
    assert_eq!(places(&person), swapped);
    // A class without a label keeps its place too.
    person.command(Command::Classes(ClassCommand::Add("early".to_owned())));
    person.command(Command::Classes(ClassCommand::Add("late".to_owned())));
    assert_eq!(person.state().classes.place("late"), Some(4));
    drop(person);
    label(&path, "late");
    let person = Person::before(&[path]);
    assert_eq!(person.state().classes.place("late"), Some(4));
    assert_eq!(places(&person)[..3], swapped);
}
