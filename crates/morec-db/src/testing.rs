//! Clips and databases for the tests of this crate.

use std::path::{Path, PathBuf};

use morec::clip::Clip;
use morec::files::FileReader;
use morec::formats::bvh;
use morec::synth::{DatabaseSpec, SyntheticTake, database};
use tempfile::TempDir;

use crate::{ClipUpdate, MotionDb};

/// Takes of this many people, each waving twice.
pub fn waves(people: usize) -> Vec<SyntheticTake> {
    let spec = DatabaseSpec {
        people,
        repetitions: 2,
        classes: vec!["wave", "bow"],
        ..Default::default()
    };
    database(7, &spec)
}

pub fn write_bvh(folder: &Path, name: &str, clip: &Clip) -> PathBuf {
    let path = folder.join(format!("{name}.bvh"));
    let mut bytes = Vec::new();
    bvh::write(clip, &mut bytes).unwrap();
    std::fs::write(&path, bytes).unwrap();
    path
}

/// A database with a clip for each of this many people, in a folder that lives as long as the first value.
pub fn database_of_waves(people: usize) -> (TempDir, MotionDb) {
    let folder = TempDir::new().unwrap();
    let paths: Vec<PathBuf> = waves(people)
        .iter()
        .map(|take| write_bvh(folder.path(), &take.clip.name, &take.clip))
        .collect();
    let mut db = MotionDb::create(&folder.path().join("test.mdb")).unwrap();
    db.import(&paths, &FileReader::default(), &ClipUpdate::default(), &())
        .unwrap();
    (folder, db)
}
