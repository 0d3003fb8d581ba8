//! Databases as the commands open them: no output of the same run may take their place, and older ones are brought up
//! to date first.

use std::path::Path;

use morec::features::FeatureParams;
use morec_db::{DbError, MotionDb};

use crate::output::mark_database;

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
