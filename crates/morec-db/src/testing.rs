//! What the tests share.

use std::path::{Path, PathBuf};

use morec::clip::Clip;
use morec::formats::Limits;
use morec::formats::bvh::{self, BvhOptions};
use morec::synth::{DatabaseSpec, Take, database};
use tempfile::TempDir;

use crate::{ClipReader, ImportSettings, MotionDb, ReadFile};

/// Reads BVH only.
pub struct BvhReader;

impl ClipReader for BvhReader {
    fn read(&self, path: &Path, bytes: &[u8]) -> Result<ReadFile, String> {
        let name = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let loaded = bvh::read(bytes, &name, &BvhOptions::default(), &Limits::default())
            .map_err(|e| e.to_string())?;
        Ok(ReadFile {
            format: "bvh".into(),
            skeleton: None,
            clips: loaded.clips,
            warnings: loaded.warnings,
        })
    }
}

/// Takes of so many people, each waving twice.
pub fn waves(people: usize) -> Vec<Take> {
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

/// A database with a clip for each of so many people, in a folder that lives as long as the first value.
pub fn database_of_waves(people: usize) -> (TempDir, MotionDb) {
    let folder = TempDir::new().unwrap();
    let paths: Vec<PathBuf> = waves(people)
        .iter()
        .map(|take| write_bvh(folder.path(), &take.clip.name, &take.clip))
        .collect();
    let mut db = MotionDb::create(&folder.path().join("test.mdb")).unwrap();
    db.import(&paths, &BvhReader, &ImportSettings::default(), &())
        .unwrap();
    (folder, db)
}
