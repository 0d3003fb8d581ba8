//! Clips are described, renamed, removed, sorted; an import is cancelled; nothing named opens an example.

use super::{Person, made};
use crate::state::{Command, FileCommand};

fn library() -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    let person = Person::before(&[made(folder.path(), 1)]);
    (folder, person)
}

/// Name, person and tags of the clips.
fn described(person: &Person) -> Vec<(String, Option<String>, Vec<String>)> {
    let store = person.state().store.as_ref().unwrap();
    let clips = store.snapshot.clips.iter();
    clips
        .map(|c| {
            let mut tags = c.tags.clone();
            tags.sort();
            (c.name.clone(), c.subject.clone(), tags)
        })
        .collect()
}

#[test]
fn a_clip_is_renamed_described_and_removed_and_each_is_undone() {
    let (_folder, mut person) = library();
    let before = described(&person);
    person.types("Clip name", "ada walks");
    assert!(person.offers("ada walks") && !person.offers("ada_1"));
    assert!(
        person
            .state()
            .command_line
            .contains("--rename ada_1 'ada walks'")
    );
    person.undo();
    assert_eq!(described(&person), before);
    person.types("Person", "Ada Lovelace");
    assert_eq!(described(&person)[0].1.as_deref(), Some("Ada Lovelace"));
    person.undo();
    assert_eq!(described(&person), before);
    person.types("Tags", "slow, indoors");
    assert_eq!(described(&person)[0].2, ["indoors", "slow"]);
    person.types("Tags", "slow");
    assert_eq!(described(&person)[0].2, ["slow"]);
    person.undo();
    person.undo();
    assert_eq!(described(&person), before);
    let labels = person.labels();
    person.click("Remove this clip");
    person.settle();
    assert!(!person.offers("ada_1") && person.labels().is_empty());
    person.undo();
    assert_eq!(described(&person), before);
    assert_eq!(person.labels(), labels, "its labels come back with it");
}

#[test]
fn several_clips_are_described_and_removed_together() {
    let (_folder, mut person) = library();
    let before = described(&person);
    person.ctrl_click("ben_1");
    person.ctrl_click("cleo_1");
    assert!(person.sees("3 clips are selected"));
    person.types("Person of all", "somebody");
    assert!(
        described(&person)
            .iter()
            .all(|c| c.1.as_deref() == Some("somebody"))
    );
    assert!(person.state().command_line.contains("--clip '*'"));
    person.undo();
    assert_eq!(described(&person), before);
    person.ctrl_click("ada_1");
    person.click("Remove these clips …");
    assert_eq!(described(&person), before);
    // Another selection is asked about anew, also when it is as before again.
    person.ctrl_click("ada_1");
    person.ctrl_click("ada_1");
    person.click("Remove these clips …");
    let snapshot = person.state().store.as_ref().unwrap().snapshot.clone();
    let of = |name: &str| {
        snapshot
            .clips
            .iter()
            .find(|c| c.name == name)
            .unwrap()
            .samples
    };
    let labels = crate::format::count(of("ben_1") + of("cleo_1"), "label");
    person.click(&format!("Remove 2 clips and {labels}"));
    person.settle();
    assert!(person.offers("ada_1") && !person.offers("ben_1") && !person.offers("cleo_1"));
    person.undo();
    assert_eq!(described(&person), before);
}

#[test]
fn a_click_with_shift_selects_all_clips_between() {
    let (_folder, mut person) = library();
    let selected = |person: &Person| person.state().library.selected.len();
    person.shift_click("cleo_1");
    assert!(person.sees("3 clips are selected"));
    person.shift_click("ben_1");
    assert_eq!(selected(&person), 2, "from the first one again");
    person.click("cleo_1");
    person.settle();
    person.shift_click("ada_1");
    assert_eq!(selected(&person), 3, "upwards");
    person.click("ben_1");
    person.settle();
    assert_eq!(selected(&person), 1);
}

#[test]
fn clips_are_sorted_by_a_click_on_a_column_and_the_other_way_round_by_another() {
    let (_folder, mut person) = library();
    let first = |person: &Person| person.state().library.shown()[0];
    person.click("Sort by person");
    let forwards = first(&person);
    person.wait(0.5);
    person.click("Sort by person");
    assert_ne!(first(&person), forwards);
}

#[test]
fn an_import_is_stopped_and_what_is_imported_stays_whole() {
    let (folder, mut person) = library();
    let many = folder.path().join("many");
    std::fs::create_dir(&many).unwrap();
    let take = &super::takes()[0];
    for number in 0..400 {
        // Different clips: the same content would be known already.
        let bytes = super::beginning(take, take.clip.frames - number - 1);
        std::fs::write(many.join(format!("clip_{number:02}.bvh")), bytes).unwrap();
    }
    let studio = person.window.state_mut();
    studio
        .state
        .apply(Command::File(FileCommand::Import(vec![many])));
    person.frames(1);
    // The bar at the bottom names the job, with a button that stops it.
    assert!(person.sees_part("Importing clips"));
    person.click("Stop");
    person.settle();
    assert!(person.sees_part("stopped before the end"));
    let clips = described(&person).len();
    assert!(clips < 403, "{clips}");
    assert!(person.state().jobs.running.is_empty());
}

#[test]
fn with_nothing_named_an_example_is_opened_and_gone_at_the_end() {
    let person = Person::before(&[]);
    let store = person.state().store.as_ref().unwrap();
    assert!(store.temporary);
    let (path, snapshot) = (store.path().to_owned(), store.snapshot.clone());
    assert!(snapshot.clips.len() >= 4 && snapshot.accepted().count() >= 24);
    assert!(person.state().player.motion.is_some());
    assert!(person.sees("example (not saved)"));
    assert_eq!(person.state().command_line, "morec-studio");
    assert!(path.exists());
    drop(person);
    assert!(!path.parent().unwrap().exists(), "its folder is removed");
}
