//! Whole clips are labelled: by a key, by a menu, by their names.

use std::path::{Path, PathBuf};

use egui::{Key, Modifiers};
use morec::formats::bvh;

use super::{Person, made, takes};
use crate::state::Panel;

/// A clip of each label of the takes, called after person, class and number.
fn one_gesture_clips(folder: &Path) -> Vec<PathBuf> {
    let mut paths = Vec::new();
    for take in takes() {
        for (number, label) in take.labels.iter().enumerate() {
            let clip = &take.clip;
            let frame = |secs: f64| (secs * clip.rate_hz) as usize;
            let frames = frame(label.span.start_secs)..frame(label.span.stop_secs).min(clip.frames);
            let joints = clip.skeleton.len();
            let mut cut = clip.clone();
            cut.frames = frames.len();
            cut.rotations = clip.rotations[frames.start * joints..frames.end * joints].to_vec();
            for track in &mut cut.tracks {
                track.positions = track.positions[frames.clone()].to_vec();
            }
            let name = format!("{}_{}_{number}", take.person, label.class);
            let path = folder.join(format!("{name}.bvh"));
            let mut bytes = Vec::new();
            bvh::write(&cut, &mut bytes).unwrap();
            std::fs::write(&path, bytes).unwrap();
            paths.push(path);
        }
    }
    paths
}

impl Person {
    /// Class of the one label of each clip, by the clip's name; whole clips only.
    fn whole(&self) -> Vec<(String, String)> {
        let store = self.state().store.as_ref().unwrap();
        let whole = store.snapshot.accepted().filter(|s| s.whole_clip);
        let mut all: Vec<_> = whole
            .map(|s| (s.clip_name.clone(), s.class.clone()))
            .collect();
        all.sort();
        all
    }

    fn people(&self) -> Vec<String> {
        let store = self.state().store.as_ref().unwrap();
        let people = store.snapshot.clips.iter();
        let mut people: Vec<String> = people.filter_map(|c| c.subject.clone()).collect();
        people.sort();
        people.dedup();
        people
    }
}

/// From a folder of clips of one gesture each to an index: no more clicks and keys than this.
const AT_MOST: usize = 10;

#[test]
fn a_folder_of_clips_of_one_gesture_becomes_an_index_after_few_clicks_and_keys() {
    let folder = tempfile::tempdir().unwrap();
    let count = one_gesture_clips(folder.path()).len();
    let mut person = Person::before(&[]);
    person.will_choose(&[folder.path()]);
    person.click("Folder …");
    person.settle();
    person.key_with(Key::A, Modifiers::COMMAND);
    person.settle();
    assert!(person.sees(&format!("{count} clips are selected")));
    // What the names say is seen before it is believed.
    let (clip, class) = {
        let take = &takes()[0];
        let class = take.labels[0].class;
        (format!("{}_{class}_0", take.person), class)
    };
    assert!(person.sees(&format!("{clip}: {class}, by {}", takes()[0].person)));
    person.click(&format!("Label {count} whole clips"));
    person.settle();
    assert_eq!(person.whole().len(), count);
    assert!(person.whole().contains(&(clip, class.to_owned())));
    assert_eq!(person.people().len(), 3);
    person.key_with(Key::T, Modifiers::COMMAND);
    person.settle();
    assert_eq!(
        person
            .state()
            .train
            .index
            .as_ref()
            .unwrap()
            .model
            .classes()
            .len(),
        3
    );
    eprintln!("{} clicks and keys from a folder of clips", person.actions);
    assert!(person.actions <= AT_MOST, "{}", person.actions);
    person.undo();
    assert!(
        person.whole().is_empty() && person.people().is_empty(),
        "one step"
    );
}

#[test]
fn a_key_labels_the_selected_clips_and_another_says_otherwise() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    person.ctrl_click("ben_1");
    person.key(Key::Num1);
    person.settle();
    let first = |clip: &str| (clip.to_owned(), "gesture 1".to_owned());
    assert_eq!(person.whole(), [first("ada_1"), first("ben_1")]);
    assert!(
        person
            .state()
            .command_line
            .contains("--clip ada_1 --class 'gesture 1'")
    );
    person.click("ben_1");
    person.settle();
    person.key(Key::Num2);
    person.settle();
    let second = ("ben_1".to_owned(), "gesture 2".to_owned());
    assert_eq!(person.whole(), [first("ada_1"), second]);
    person.undo();
    assert_eq!(person.whole(), [first("ada_1"), first("ben_1")]);
    // On other panels keys do what they did.
    person.goes_to(Panel::Label);
    person.key(Key::Num2);
    person.settle();
    assert_eq!(person.whole(), [first("ada_1"), first("ben_1")]);
}

#[test]
fn a_menu_labels_whole_clips_with_a_class_that_is_there_or_new() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    person.key_with(Key::A, Modifiers::COMMAND);
    person.frames(2);
    person.types("New class of whole clips", "jump");
    assert_eq!(person.whole().len(), 3);
    assert!(person.whole().iter().all(|(_, class)| class == "jump"));
    person.click("ben_1");
    person.settle();
    person.wait(0.5);
    person.click("Whole clips are …");
    person.frames(3);
    person.click("A new class");
    person.settle();
    let other = ("ben_1".to_owned(), "gesture 1".to_owned());
    assert!(person.whole().contains(&other));
    person.wait(0.5);
    person.click("Whole clips are …");
    person.frames(3);
    person.click("jump");
    person.settle();
    assert!(person.whole().iter().all(|(_, class)| class == "jump"));
}

#[test]
fn names_that_do_not_fit_are_told_and_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    person.key_with(Key::A, Modifiers::COMMAND);
    person.frames(2);
    person.types("Pattern of names", "ada_{class}");
    assert!(person.sees_part("2 names do not fit, such as ben_1"));
    person.click("Label 1 whole clip");
    person.settle();
    assert_eq!(person.whole(), [("ada_1".to_owned(), "1".to_owned())]);
    person.key_with(Key::A, Modifiers::COMMAND);
    person.frames(2);
    person.types("Pattern of names", "{who}");
    assert!(person.sees_part("{who}: expected {class}, {person} or {}"));
}

#[test]
fn several_clips_get_tags() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    person.key_with(Key::A, Modifiers::COMMAND);
    person.frames(2);
    person.types("Tags of all", "slow, indoors");
    let store = person.state().store.as_ref().unwrap();
    assert!(store.snapshot.clips.iter().all(|c| c.tags.len() == 2));
}
