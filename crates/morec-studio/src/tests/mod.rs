//! Tests of the window without a display, through the accessibility tree.

mod access;
mod background;
mod bodies;
mod classes;
mod compare;
mod counted;
mod cuts;
mod dialogs;
mod dropped;
mod edits;
mod faults;
mod framing;
mod keys;
mod label_files;
mod library;
mod lines;
mod lists;
mod live;
mod mistakes;
mod out;
mod person;
mod pictures;
mod places;
mod roles;
mod rooms;
mod selection;
mod several;
mod shelf;
mod study;
mod train;
mod undo;
mod unsaved;
mod unseen;
mod video;
mod view;
mod whole;
mod words;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use morec::formats::bvh;
use morec::synth::{DatabaseSpec, SyntheticTake, database};
use morec_db::labels::NewSample;
use morec_db::{ClipUpdate, MotionDb};

use crate::state::Panel;
use person::Person;

/// Three people, two gestures each twice.
pub fn takes() -> &'static [SyntheticTake] {
    static TAKES: OnceLock<Vec<SyntheticTake>> = OnceLock::new();
    TAKES.get_or_init(|| {
        let spec = DatabaseSpec {
            people: 3,
            repetitions: 2,
            classes: vec!["wave", "clap", "bow"],
            unknown_share: 0.3,
            ..DatabaseSpec::default()
        };
        database(7, &spec)
    })
}

/// These takes as BVH files: names and bytes.
pub fn files_of(takes: &[SyntheticTake]) -> Vec<(String, Vec<u8>)> {
    let written = takes.iter().map(|take| {
        let mut bytes = Vec::new();
        bvh::write(&take.clip, &mut bytes).unwrap();
        (format!("{}.bvh", take.clip.name), bytes)
    });
    written.collect()
}

/// The first frames of a take as a BVH file.
pub fn beginning(take: &SyntheticTake, frames: usize) -> Vec<u8> {
    let mut clip = take.clip.clone();
    clip.frames = frames;
    clip.rotations.truncate(frames * clip.skeleton.len());
    clip.tracks
        .iter_mut()
        .for_each(|t| t.positions.truncate(frames));
    let mut bytes = Vec::new();
    bvh::write(&clip, &mut bytes).unwrap();
    bytes
}

/// Writes files into a folder.
pub fn written(folder: &Path, files: &[(String, Vec<u8>)]) -> Vec<PathBuf> {
    let paths = files.iter().map(|(name, bytes)| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    });
    paths.collect()
}

/// The clips of the takes as files in a folder.
pub fn clips_of(folder: &Path) -> Vec<PathBuf> {
    static FILES: OnceLock<Vec<(String, Vec<u8>)>> = OnceLock::new();
    written(folder, FILES.get_or_init(|| files_of(takes())))
}

/// A database of the takes; those of the first `labelled` people are labelled. Import takes longer than most tests: each
/// database is made once and copied.
pub fn made(folder: &Path, labelled: usize) -> PathBuf {
    static MADE: [OnceLock<Vec<u8>>; 4] = [const { OnceLock::new() }; 4];
    clips_of(folder);
    let path = folder.join("moves.mdb");
    let bytes = MADE[labelled].get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::read(imported(folder.path(), labelled)).unwrap()
    });
    std::fs::write(&path, bytes).unwrap();
    path
}

/// A user at a panel, with such a database in a folder.
pub fn before(panel: Panel, labelled: usize) -> (tempfile::TempDir, Person) {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), labelled)]);
    person.goes_to(panel);
    (folder, person)
}

/// The same before the panel of labels.
pub fn labelling(labelled: usize) -> (tempfile::TempDir, Person) {
    before(Panel::Label, labelled)
}

/// Makes the database by an import of the files.
fn imported(folder: &Path, labelled: usize) -> PathBuf {
    let files = clips_of(folder);
    let path = folder.join("moves.mdb");
    let mut db = MotionDb::create(&path).unwrap();
    let about = ClipUpdate::default();
    db.import(&files, &morec::files::FileReader::default(), &about, &())
        .unwrap();
    for (number, take) in takes().iter().enumerate() {
        let clip = db.find_clip(&take.clip.name).unwrap().id;
        let about = ClipUpdate {
            subject: Some(take.person.clone()),
            ..ClipUpdate::default()
        };
        db.update_clips(&[clip], &about).unwrap();
        if number < labelled {
            let labels = take
                .labels
                .iter()
                .map(|l| NewSample::accepted(clip, l.class, l.span));
            db.add_samples(&labels.collect::<Vec<_>>(), "test").unwrap();
        }
    }
    path
}
