//! Each action behind a file dialog, with the dialog's answer given by the test.

use egui::{Key, Modifiers};
use morec_db::exchange::LabelFormat;

use super::{Person, made, takes};
use crate::state::{Command, DialogKind, Panel, PlayCommand};

fn with_labels(labelled: usize) -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    let person = Person::before(&[made(folder.path(), labelled)]);
    (folder, person)
}

impl Person {
    /// Opens the menu File and clicks an entry.
    fn file(&mut self, entry: &str) {
        // Soon after another click it would be a double click.
        self.wait(0.5);
        self.click("File");
        self.click(entry);
        self.settle();
    }

    fn database(&self) -> String {
        let store = self.state().store.as_ref().unwrap();
        crate::format::file_name(store.path())
    }
}

#[test]
fn a_database_is_opened_made_and_copied() {
    let (folder, mut person) = with_labels(1);
    let other = tempfile::tempdir().unwrap();
    let second = made(other.path(), 2);
    person.will_choose(&[&second]);
    person.file("Open … Ctrl O");
    assert_eq!(person.asked().choice, DialogKind::File);
    assert_eq!(person.asked().filter.unwrap().1, "mdb");
    assert_eq!(person.state().store.as_ref().unwrap().path(), second);
    let copy = folder.path().join("copy.mdb");
    person.will_choose(&[&copy]);
    person.click("ben_1");
    person.settle();
    person.command(Command::Play(PlayCommand::Seek(1.5)));
    person.file("Save a copy as … Ctrl S");
    assert_eq!(person.asked().choice, DialogKind::Save);
    let player = &person.state().player;
    let shown = player.motion.as_ref().map(|m| m.clip.name.as_str());
    assert_eq!((shown, player.at_secs), (Some("ben_1"), 1.5), "as before");
    assert_eq!(person.database(), "copy.mdb");
    assert_eq!(person.labels().len(), 12, "with all that was in it");
    let new = folder.path().join("new.mdb");
    person.will_choose(&[&new]);
    person.file("New database …");
    assert_eq!(person.asked().file_name, "motions.mdb");
    assert_eq!(person.database(), "new.mdb");
    assert!(person.sees("No clips yet"));
    // An existing file is not overwritten by a new one.
    person.will_choose(&[&copy]);
    person.file("New database …");
    assert!(person.sees_part("copy.mdb: this file exists already"));
    assert_eq!(person.database(), "new.mdb");
}

#[test]
fn clips_are_imported_from_files_and_folders() {
    let (folder, mut person) = with_labels(0);
    let new = folder.path().join("new.mdb");
    person.will_choose(&[&new]);
    person.file("New database …");
    let file = |name: &str| folder.path().join(format!("{name}.bvh"));
    person.will_choose(&[&file("ada_1"), &file("ben_1")]);
    person.click("Import clips");
    person.settle();
    assert_eq!(person.asked().choice, DialogKind::Files);
    assert!(person.offers("ada_1") && person.offers("ben_1") && !person.offers("cleo_1"));
    person.undo();
    assert!(!person.offers("ada_1"));
    person.will_choose(&[folder.path()]);
    person.file("Import a folder …");
    assert_eq!(person.asked().choice, DialogKind::Folders);
    assert!(takes().iter().all(|take| person.offers(&take.clip.name)));
    person.undo();
    assert!(!person.offers("cleo_1"));
}

#[test]
fn labels_of_each_form_a_clip_and_a_page_are_exported() {
    let (folder, mut person) = with_labels(2);
    let names = [
        ("Table (TSV) …", LabelFormat::Tsv, DialogKind::Save),
        ("Table (CSV) …", LabelFormat::Csv, DialogKind::Save),
        ("JSON …", LabelFormat::Json, DialogKind::Save),
        (
            "ELAN, a file for each clip …",
            LabelFormat::Eaf,
            DialogKind::Folder,
        ),
        (
            "Audacity, a file for each clip …",
            LabelFormat::Audacity,
            DialogKind::Folder,
        ),
        ("BABEL …", LabelFormat::Babel, DialogKind::Save),
        ("Label Studio …", LabelFormat::LabelStudio, DialogKind::Save),
        ("BORIS project …", LabelFormat::Boris, DialogKind::Save),
        (
            "BIDS events, a file for each clip …",
            LabelFormat::Bids,
            DialogKind::Folder,
        ),
    ];
    assert_eq!(names.len(), LabelFormat::ALL.len());
    for (entry, form, choice) in names {
        let path = folder.path().join(format!("out-{}", form.name()));
        person.will_choose(&[&path]);
        person.wait(0.5);
        person.click("File");
        person.click("Export labels ⏵");
        person.click(entry);
        person.settle();
        assert_eq!(person.asked().choice, choice, "{entry}");
        assert!(path.exists(), "{entry}");
        let line = &person.state().command_line;
        assert!(line.ends_with(&format!("--form {}", form.name())), "{line}");
    }
    let clip = folder.path().join("out.bvh");
    person.will_choose(&[&clip]);
    person.file("Export this clip …");
    assert_eq!(person.asked().file_name, "ada_1.bvh");
    assert!(morec::files::open(&clip).is_ok());
    let page = folder.path().join("out.html");
    person.will_choose(&[&page]);
    person.file("A page of it to send …");
    assert_eq!(person.asked().file_name, "ada_1.html");
    assert!(std::fs::read_to_string(&page).unwrap().contains("<canvas"));
}

#[test]
fn an_index_is_exported_and_can_be_loaded() {
    let (folder, mut person) = with_labels(2);
    person.goes_to(Panel::Train);
    person.click("Start training");
    person.settle();
    let path = folder.path().join("mine.index");
    for entry in [true, false] {
        let _ = std::fs::remove_file(&path);
        person.will_choose(&[&path]);
        match entry {
            true => person.file("Export the index …"),
            false => {
                person.click("Export …");
                person.settle();
            }
        }
        assert_eq!(person.asked().filter.unwrap().1, "index");
        let index = morec::MotionIndex::load(&path).unwrap();
        assert_eq!(index.model.classes().len(), 3);
    }
    let line = &person.state().command_line;
    assert!(line.ends_with("mine.index"), "{line}");
}

#[test]
fn keys_open_dialogs_and_a_dialog_that_is_cancelled_changes_nothing() {
    let (_folder, mut person) = with_labels(1);
    let (before, database) = (person.labels(), person.database());
    for (key, choice) in [
        (Key::O, DialogKind::File),
        (Key::I, DialogKind::Files),
        (Key::S, DialogKind::Save),
    ] {
        person.key_with(key, Modifiers::COMMAND);
        person.settle();
        assert_eq!(person.asked().choice, choice);
    }
    assert_eq!(person.labels(), before);
    assert_eq!(person.database(), database);
    assert!(person.state().notices.is_empty());
}

#[test]
fn where_no_dialog_can_be_opened_a_path_is_typed() {
    let (folder, mut person) = with_labels(1);
    person.has_no_dialogs();
    person.key_with(Key::S, Modifiers::COMMAND);
    person.settle();
    assert!(person.sees_part("No file dialog can be opened"));
    // What cannot be is said before it is tried.
    let copy = folder.path().join("copy.mdb");
    let nowhere = folder.path().join("nowhere/copy.mdb");
    person.types("Path", &nowhere.to_string_lossy());
    assert!(person.sees("There is no such folder."));
    assert_eq!(person.database(), "moves.mdb");
    person.key(Key::Escape);
    person.settle();
    // The name that is proposed is selected: what is typed replaces it.
    person.key_with(Key::S, Modifiers::COMMAND);
    person.settle();
    person
        .window
        .event(egui::Event::Text(copy.to_string_lossy().into_owned()));
    person.frames(2);
    person.key(Key::Enter);
    person.settle();
    assert_eq!(person.database(), "copy.mdb");
    assert!(!person.sees_part("No file dialog can be opened"));
    // A file that is there is written over by a click only.
    person.key_with(Key::S, Modifiers::COMMAND);
    person.settle();
    let first = folder.path().join("moves.mdb");
    person.types("Path", &first.to_string_lossy());
    assert!(person.sees_part("This file exists and will be replaced"));
    assert_eq!(person.database(), "copy.mdb");
    person.click("Cancel");
    person.settle();
    let clips = tempfile::tempdir().unwrap();
    std::fs::write(clips.path().join("x.txt"), "no clip").unwrap();
    super::clips_of(clips.path());
    person.click("Folder …");
    person.settle();
    person.types("Path", &clips.path().to_string_lossy());
    assert!(
        person.state().said.contains("3 known already"),
        "{}",
        person.state().said
    );
}
