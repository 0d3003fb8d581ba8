//! Files that are dropped on the window, and what becomes of those that are refused.

use std::path::{Path, PathBuf};

use super::{Person, clips_of, made};
use crate::state::Panel;

impl Person {
    /// Drops files on the window.
    pub fn drops(&mut self, paths: &[&Path]) {
        self.actions += 1;
        let files = paths.iter().map(|path| egui::DroppedFile {
            path: Some(path.to_path_buf()),
            ..egui::DroppedFile::default()
        });
        self.window.input_mut().dropped_files = files.collect();
        self.frames(1);
        self.window.input_mut().dropped_files.clear();
        self.settle();
    }

    /// Holds files over the window, or takes them away.
    fn hovers(&mut self, paths: &[&Path]) {
        let files = paths.iter().map(|path| egui::HoveredFile {
            path: Some(path.to_path_buf()),
            ..egui::HoveredFile::default()
        });
        self.window.input_mut().hovered_files = files.collect();
        self.frames(2);
        self.window.input_mut().hovered_files.clear();
    }

    fn clips(&self) -> Vec<String> {
        let store = self.state().store.as_ref().unwrap();
        store
            .snapshot
            .clips
            .iter()
            .map(|c| c.name.clone())
            .collect()
    }
}

#[test]
fn a_drop_onto_the_untouched_example_makes_a_new_database() {
    let folder = tempfile::tempdir().unwrap();
    let clips = clips_of(folder.path());
    let mut person = Person::before(&[]);
    person.hovers(&[&clips[0]]);
    assert!(person.sees("Drop here: a new database is created"));
    person.drops(&[&clips[0], &clips[1]]);
    assert_eq!(person.clips(), ["ada_1", "ben_1"]);
    assert!(person.state().store.as_ref().unwrap().temporary);
    // What was begun is added to.
    person.hovers(&[&clips[2]]);
    assert!(person.sees_part("Drop here: into clips_1"));
    person.drops(&[&clips[2]]);
    assert_eq!(person.clips(), ["ada_1", "ben_1", "cleo_1"]);
    let other = made(&tempfile::tempdir().unwrap().keep(), 0);
    person.hovers(&[&other]);
    assert!(person.sees("Drop here: moves.mdb is opened"));
}

#[test]
fn a_drop_onto_an_example_that_was_changed_goes_into_it() {
    let folder = tempfile::tempdir().unwrap();
    let clips = clips_of(folder.path());
    let mut person = Person::before(&[]);
    let before = person.clips().len();
    person.types("Tags", "mine");
    person.drops(&[&clips[0]]);
    assert_eq!(person.clips().len(), before + 1);
}

/// Two clips and two files that are no clips.
fn with_refused(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = clips_of(folder).into_iter().take(2).collect();
    for name in ["broken.bvh", "empty.bvh"] {
        files.push(folder.join(name));
    }
    std::fs::write(&files[2], "HIERARCHY\nROOT x\n{\n").unwrap();
    std::fs::write(&files[3], "").unwrap();
    files
}

#[test]
fn refused_files_are_listed_however_they_came() {
    let folder = tempfile::tempdir().unwrap();
    let files = with_refused(folder.path());
    let lists = |person: &Person| {
        person.sees_part("broken.bvh: refused") && person.sees_part("empty.bvh: refused")
    };
    // On the command line.
    let mut person = Person::before(&files);
    assert_eq!(person.clips(), ["ada_1", "ben_1"]);
    assert!(lists(&person));
    person.click("Close");
    person.frames(2);
    assert!(!lists(&person));
    // Dropped.
    let all: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    person.drops(&all);
    assert!(lists(&person));
    // Where no clip can be read at all.
    let person = Person::before(&files[2..]);
    assert!(person.state().store.is_none());
    assert!(lists(&person));
}

#[test]
fn files_that_are_refused_for_one_reason_share_a_line() {
    let folder = tempfile::tempdir().unwrap();
    let files = ["one.bvh", "two.bvh"].map(|name| folder.path().join(name));
    for file in &files {
        std::fs::write(file, "").unwrap();
    }
    let person = Person::before(&files);
    assert!(person.sees_part("one.bvh, two.bvh: refused"));
}

#[test]
fn refused_files_are_told_on_other_panels() {
    let folder = tempfile::tempdir().unwrap();
    let files = with_refused(folder.path());
    let mut person = Person::before(&files[..1]);
    person.goes_to(Panel::Label);
    person.drops(&[&files[2]]);
    assert!(person.sees_part("1 file refused: the library says why"));
}
