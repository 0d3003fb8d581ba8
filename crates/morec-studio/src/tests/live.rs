//! Teaching from what just happened.

use egui::Key;

use super::{Person, made, takes};
use crate::state::live::Choice;
use crate::state::{Command, LiveCommand, Panel};

#[test]
fn what_just_happened_is_marked_learned_and_recognised_and_undone() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    person.goes_to(Panel::Live);
    person.click("Start");
    person.settle();
    let take = &takes()[0];
    let wave = take.labels.iter().find(|l| l.class == "wave").unwrap();
    let now = |person: &Person| person.state().live.run.as_ref().unwrap().now_secs;
    while now(&person) < wave.stop_secs + 0.4 {
        person.frames(1);
    }
    person.key(Key::Num1);
    assert_eq!(person.state().live.marks.len(), 1);
    let (start, stop, _) = person.state().live.marks[0].clone();
    assert!(
        (start - wave.start_secs).abs() < 0.8 && (stop - wave.stop_secs).abs() < 0.8,
        "{start} {stop} {wave:?}"
    );
    // The stream goes on meanwhile.
    person.settle();
    assert!(
        person.state().live.index().is_some(),
        "trained with what was marked"
    );
    assert_eq!(person.labels().len(), 1);
    assert_eq!(person.labels()[0].1, "gesture 1");
    let later = take.labels.iter().rfind(|l| l.class == "wave").unwrap();
    while now(&person) < later.stop_secs + 1.5 && later.start_secs > wave.stop_secs {
        person.frames(1);
    }
    // If training outlasted the second wave, the clip comes round again.
    let end = take.clip.duration_secs() + wave.stop_secs + 3.0;
    while person.state().live.counts.is_empty() && now(&person) < 2.0 * end {
        person.frames(1);
    }
    assert!(person.sees("Recognised gesture 1"));
    person.click("Stop");
    person.undo();
    assert!(person.labels().is_empty());
}

#[test]
fn a_take_is_recorded_into_the_database_after_a_countdown() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    person.goes_to(Panel::Live);
    person.key(Key::Space);
    person.settle();
    person.key(Key::R);
    assert!(person.state().live.countdown.is_some());
    person.wait(3.2);
    assert!(person.state().live.take.is_some());
    person.wait(2.0);
    person.key(Key::R);
    person.settle();
    let store = person.state().store.as_ref().unwrap();
    let clip = store
        .snapshot
        .clips
        .iter()
        .find(|c| c.name == "take_001")
        .unwrap();
    assert!(
        (1.5..3.0).contains(&clip.duration_secs()),
        "{}",
        clip.duration_secs()
    );
    person.command(Command::Show(Panel::Library));
    assert!(person.sees("take_001"));
}

#[test]
fn a_device_is_listened_to_and_its_absence_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    person.goes_to(Panel::Live);
    let listen =
        |address: &str| Command::Live(LiveCommand::Choose(Choice::Network(address.to_owned())));
    person.command(listen("vmc://127.0.0.1:0"));
    person.click("Start");
    assert!(
        person
            .state()
            .live
            .run
            .as_ref()
            .unwrap()
            .name
            .starts_with("vmc://127.0.0.1:")
    );
    assert!(person.sees_part("Nothing has come yet"));
    person.click("Stop");
    // What is no address gives a sentence.
    person.command(listen("carrier://pigeon"));
    person.click("Start");
    assert!(person.state().live.run.is_none());
    assert!(!person.state().notices.is_empty());
}
