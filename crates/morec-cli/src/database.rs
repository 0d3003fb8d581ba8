//! Opens databases for commands: upgrades older ones first, and registers them so that no output of the same run overwrites them.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use morec::features::FeatureParams;
use morec_db::exchange::{self, ClipLengths};
use morec_db::{ClipFilter, DbError, MotionDb};

use crate::output::mark_database;

/// The database, where a command was given one in place of clips.
///
/// # Errors
/// A database beside something else.
pub fn only(inputs: &[PathBuf]) -> Result<Option<&Path>> {
    match inputs {
        [one] if is_database(one) => Ok(Some(one)),
        _ => match inputs.iter().find(|path| is_database(path)) {
            Some(path) => bail!(
                "{}: clips and a database cannot be combined: give either clips or one database",
                path.display()
            ),
            None => Ok(None),
        },
    }
}

/// True if a file begins as SQLite's do.
fn is_database(path: &Path) -> bool {
    let mut head = [0; 16];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut head));
    read.is_ok() && &head == b"SQLite format 3\0"
}

/// Opens a database for reading and writing.
pub fn open(path: &Path) -> Result<MotionDb, DbError> {
    mark_database(path);
    MotionDb::open(path)
}

/// Opens a database for reading only. One of an older version is brought to the present one, if it may be written.
pub fn open_read_only(path: &Path) -> Result<MotionDb, DbError> {
    mark_database(path);
    match MotionDb::open_read_only(path) {
        Err(DbError::Older { .. }) => {
            // What is only kept ready is made now, once, as readers cannot keep it.
            MotionDb::open(path)?.refresh_rows(&FeatureParams::default(), &())?;
            MotionDb::open_read_only(path)
        }
        other => other,
    }
}

/// Says that a report is not kept: it is printed all the same.
pub fn note_unkept<T, E: std::fmt::Display>(db: &Path, kept: Result<T, E>) {
    if let Err(error) = kept {
        eprintln!("note: the report is not kept in {}: {error}", db.display());
    }
}

/// The lengths of all clips by name.
pub fn lengths(db: &MotionDb) -> Result<ClipLengths> {
    Ok(exchange::clip_lengths(&db.clips(&ClipFilter::default())?))
}
