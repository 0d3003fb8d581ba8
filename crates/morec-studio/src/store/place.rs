//! Where a database lies, and who writes.

use std::path::PathBuf;

use morec_db::{DbError, MotionDb};

/// A database, and the name under which this window's steps are written down in it.
#[derive(Debug, Clone)]
pub struct DbPlace {
    pub path: PathBuf,
    pub signature: String,
}

impl DbPlace {
    /// Opens the database for steps of this window.
    pub fn open(&self) -> Result<MotionDb, DbError> {
        let mut db = MotionDb::open(&self.path)?;
        db.set_program(&self.signature);
        Ok(db)
    }
}
