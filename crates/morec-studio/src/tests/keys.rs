//! No key acts on what is not seen: behind a field, a menu or a window, or on another panel.

use egui::{Key, Modifiers};

use super::{Person, made};
use crate::state::{Command, Panel, TimelineCommand};

fn library(labelled: usize) -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    let person = Person::before(&[made(folder.path(), labelled)]);
    (folder, person)
}

/// Clip, class, start and stop of a label.
pub type WrittenLabel = (i64, String, i64, i64);

impl Person {
    /// Names and tags of clips, and all labels: what keys must leave alone.
    pub fn written(&self) -> (Vec<(String, Vec<String>)>, Vec<WrittenLabel>) {
        let store = self.state().store.as_ref().unwrap();
        let clips = store.snapshot.clips.iter();
        let clips = clips.map(|c| (c.name.clone(), c.tags.clone()));
        (clips.collect(), self.labels())
    }

    /// Presses a key that is a letter or a digit, as a keyboard does: the key and its text.
    pub fn presses(&mut self, key: Key) {
        let text = key.symbol_or_name().to_lowercase();
        if text.len() == 1 {
            self.window.event(egui::Event::Text(text));
        }
        self.key(key);
    }
}

#[test]
fn after_a_search_no_key_acts_on_a_hidden_clip() {
    let (_folder, mut person) = library(0);
    person.click("ada_1");
    person.settle();
    let before = person.written();
    person.click("Search clips");
    person.window.event(egui::Event::Text("ben".to_owned()));
    person.frames(3);
    person.key(Key::Enter);
    person.frames(2);
    for key in [Key::B, Key::Num1, Key::Delete] {
        person.presses(key);
    }
    person.settle();
    assert_eq!(person.written(), before, "Enter keeps the field");
    // Escape empties and leaves the field. The clip that the search hid is no longer selected.
    person.key(Key::Escape);
    person.frames(2);
    person.presses(Key::B);
    person.presses(Key::Num1);
    person.settle();
    assert_eq!(person.written(), before);
}

#[test]
fn a_clip_that_nobody_selected_is_labelled_by_no_key() {
    let (_folder, mut person) = library(0);
    let before = person.written();
    person.presses(Key::Num1);
    person.presses(Key::B);
    person.settle();
    assert_eq!(person.written(), before);
    assert!(person.sees_part("select clips in the list, then press"));
    person.click("ben_1");
    person.settle();
    person.presses(Key::Num1);
    person.settle();
    assert_eq!(person.labels().len(), 1);
}

#[test]
fn what_is_typed_after_a_refused_path_is_text() {
    let (folder, mut person) = library(1);
    person.has_no_dialogs();
    person.key_with(Key::A, Modifiers::COMMAND);
    person.key_with(Key::S, Modifiers::COMMAND);
    person.settle();
    let before = person.written();
    let nowhere = folder.path().join("nowhere/copy.mdb");
    person.types("Path", &nowhere.to_string_lossy());
    for key in [Key::B, Key::Num1, Key::S, Key::Space, Key::Delete] {
        person.presses(key);
    }
    person.settle();
    assert_eq!(person.written(), before);
    assert!(!person.state().player.playing);
    assert!(person.state().typed.as_ref().unwrap().text.ends_with("b1s"));
    // Not even with the keyboard elsewhere.
    person
        .window
        .ctx
        .memory_mut(|memory| memory.stop_text_input());
    person.frames(2);
    person.presses(Key::B);
    person.presses(Key::Num2);
    person.settle();
    assert_eq!(person.written(), before);
}

#[test]
fn keys_do_nothing_behind_an_open_menu_or_window() {
    let (folder, mut person) = library(1);
    person.key_with(Key::A, Modifiers::COMMAND);
    person.frames(2);
    let before = person.written();
    let keys = |person: &mut Person| {
        for key in [Key::B, Key::Num2, Key::Space, Key::S, Key::Delete] {
            person.presses(key);
        }
        person.settle();
    };
    person.click("Whole clips are …");
    person.frames(3);
    assert!(person.sees("A new class"));
    keys(&mut person);
    assert_eq!(person.written(), before);
    assert!(!person.state().player.playing, "Space plays nothing either");
    person.key(Key::Escape);
    person.frames(3);
    person.right_click("ben_1");
    person.frames(3);
    keys(&mut person);
    assert_eq!(person.written(), before);
    person.key(Key::Escape);
    person.frames(3);
    person.key(Key::F1);
    person.frames(3);
    keys(&mut person);
    assert_eq!(person.written(), before);
    person.key(Key::Escape);
    person.frames(3);
    // A look at labels of files.
    let table = folder.path().join("more.csv");
    std::fs::write(
        &table,
        "clip,class,start_secs,stop_secs\nben_1,jump,0.5,1.5\n",
    )
    .unwrap();
    person.will_choose(&[&table]);
    person.command(Command::File(crate::state::FileCommand::AskImportLabels));
    assert!(person.sees("Apply"));
    keys(&mut person);
    assert_eq!(person.written(), before);
}

#[test]
fn labels_are_split_merged_and_removed_only_where_they_are_seen() {
    let (_folder, mut person) = library(1);
    person.goes_to(Panel::Label);
    let sample = person.state().shown_samples()[0].clone();
    let select = TimelineCommand::Select {
        id: Some(sample.id),
        add: false,
    };
    person.command(Command::Timeline(select));
    let middle = 0.5 * (sample.start_secs + sample.stop_secs);
    person.command(Command::Play(crate::state::PlayCommand::Seek(middle)));
    let before = person.written();
    for panel in [Panel::Library, Panel::Train, Panel::Live] {
        person.goes_to(panel);
        for key in [Key::S, Key::M, Key::Delete, Key::OpenBracket, Key::X] {
            person.presses(key);
        }
        person.key_with(Key::ArrowRight, Modifiers::COMMAND);
        person.key_with(Key::ArrowRight, Modifiers::ALT);
        person.settle();
        assert_eq!(person.written(), before, "{panel:?}");
    }
    person.goes_to(Panel::Label);
    person.presses(Key::S);
    person.settle();
    assert_eq!(
        person.labels().len(),
        before.1.len() + 1,
        "seen, it is split"
    );
}

#[test]
fn escape_gives_up_what_was_typed() {
    let (_folder, mut person) = library(1);
    person.click("ada_1");
    person.settle();
    let before = person.written();
    person.click("Clip name");
    person.window.event(egui::Event::Text("xyz".to_owned()));
    person.frames(2);
    person.key(Key::Escape);
    person.settle();
    assert_eq!(person.written(), before);
    person.goes_to(Panel::Label);
    let class = person.state().classes.order[0].clone();
    let now = Some((class.clone(), class));
    person.command(Command::Classes(crate::state::ClassCommand::Renaming(now)));
    person.window.event(egui::Event::Text("xyz".to_owned()));
    person.frames(2);
    person.key(Key::Escape);
    person.settle();
    assert_eq!(person.written(), before);
    assert!(person.state().classes.renaming.is_none());
}

#[test]
fn clips_are_looked_through_searched_and_labelled_by_keys_alone() {
    let (_folder, mut person) = library(0);
    person.key(Key::ArrowDown);
    person.settle();
    person.key(Key::ArrowDown);
    person.settle();
    person.presses(Key::Num1);
    person.settle();
    let shown = person.state().player.motion.as_ref().unwrap().id.0;
    assert_eq!(person.labels().len(), 1);
    assert_eq!(person.labels()[0].0, shown);
    person.key(Key::ArrowUp);
    person.settle();
    assert_ne!(person.state().player.motion.as_ref().unwrap().id.0, shown);
    // In the list of labelling, too, where a key without a selection labels no clip as a whole.
    person.key_with(Key::Num2, Modifiers::COMMAND);
    person.settle();
    person.key(Key::ArrowDown);
    person.settle();
    assert_eq!(person.state().player.motion.as_ref().unwrap().id.0, shown);
    person.presses(Key::Num2);
    person.settle();
    assert_eq!(person.labels().len(), 1);
    // Into the search of the same list.
    person.key_with(Key::F, Modifiers::COMMAND);
    person.frames(3);
    person.window.event(egui::Event::Text("ben".to_owned()));
    person.frames(3);
    assert!(person.offers("Show ben_1") && !person.offers("Show ada_1"));
    // Down goes to what was found.
    person.key(Key::ArrowDown);
    person.settle();
    let shown = person.state().player.motion.as_ref().unwrap();
    assert_eq!(shown.clip.name, "ben_1");
    person.key_with(Key::F, Modifiers::COMMAND);
    person.frames(3);
    // From elsewhere into that of the library, which is the same.
    person.key(Key::Enter);
    person.key_with(Key::Num4, Modifiers::COMMAND);
    person.frames(3);
    person.key_with(Key::F, Modifiers::COMMAND);
    person.frames(3);
    assert!(person.offers("ben_1") && !person.offers("ada_1"));
}
