//! Errors of the database, as sentences that say what to do.

use std::fs::File;
use std::io::{self, ErrorKind};
use std::path::PathBuf;

use rusqlite::ErrorCode;

/// A database operation that was not done, and why. Nothing of it remains in the file.
#[derive(Debug, thiserror::Error)]
pub enum DbError {
    /// A database was to be made where something is.
    #[error("{0}: a file of this name exists already")]
    Exists(PathBuf),
    /// There is no such file.
    #[error("{0}: no such file; create a database with `morec db init`")]
    Missing(PathBuf),
    /// The file is no SQLite database.
    #[error("{}: expected a motion database, found {}", .0.display(), kind_of(.0))]
    NotADatabase(PathBuf),
    /// The file is another program's SQLite database.
    #[error(
        "{path}: expected a motion database, found an SQLite file of another program (application id {found:#x})"
    )]
    Foreign {
        /// Path of the file.
        path: PathBuf,
        /// The application id in its header.
        found: i32,
    },
    /// The file is marked as a motion database, but its tables, triggers or views are not those of one.
    #[error("{}: expected the schema of a motion database, found {found}", path.display())]
    Altered {
        /// Path of the database.
        path: PathBuf,
        /// What is there and should not be, or the other way round.
        found: String,
    },
    /// The file was written by a newer version.
    #[error(
        "{path}: schema {found} is newer than this morec supports ({known}): use a newer morec"
    )]
    Newer {
        /// Path of the database.
        path: PathBuf,
        /// Version of its schema.
        found: i32,
        /// The newest schema known here.
        known: i32,
    },
    /// The file was written by an older version and is open for reading only.
    #[error(
        "{path}: schema {found} must be upgraded to {known}: open the database once for writing"
    )]
    Older {
        /// Path of the database.
        path: PathBuf,
        /// Version of its schema.
        found: i32,
        /// Version of the schema that is needed.
        known: i32,
    },
    /// The file may not be written.
    #[error("the database cannot be written: the file or its folder is read-only")]
    ReadOnly,
    /// The disk may not be written.
    #[error("the database cannot be written: its disk is read-only")]
    ReadOnlyDisk,
    /// Another program writes for longer than was waited.
    #[error(
        "the database is busy because another program is writing to it; try again when that has finished"
    )]
    Busy,
    /// No room is left.
    #[error("the disk is full: the last change was rolled back")]
    Full,
    /// The file is damaged.
    #[error("the database is damaged: {0}")]
    Damaged(String),
    /// Reading or writing the disk failed.
    #[error("the disk cannot be read or written: {0}")]
    Disk(String),
    /// A name that is not there.
    #[error("no {kind} is called {name:?}{hint}")]
    Unknown {
        /// Of what: clip, class, edit.
        kind: &'static str,
        /// The name asked for.
        name: String,
        /// Names that exist, after a semicolon; may be empty.
        hint: String,
    },
    /// A request that makes no sense.
    #[error("{0}")]
    Invalid(String),
    /// The listener said so.
    #[error("cancelled")]
    Cancelled,
    /// Anything else that SQLite reports.
    #[error("database: {0}")]
    Sqlite(rusqlite::Error),
}

impl From<rusqlite::Error> for DbError {
    fn from(error: rusqlite::Error) -> Self {
        let rusqlite::Error::SqliteFailure(code, message) = &error else {
            return Self::Sqlite(error);
        };
        let text = || message.clone().unwrap_or_else(|| code.to_string());
        match code.code {
            ErrorCode::ReadOnly => Self::ReadOnly,
            ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked => Self::Busy,
            ErrorCode::DiskFull => Self::Full,
            ErrorCode::DatabaseCorrupt => Self::Damaged(text()),
            ErrorCode::SystemIoFailure | ErrorCode::CannotOpen => Self::Disk(text()),
            _ => Self::Sqlite(error),
        }
    }
}

impl DbError {
    /// The error of a file that could not be opened for writing, in the terms of the system where SQLite has none: `open` opens
    /// it once more.
    pub(crate) fn with_place(self, open: impl FnOnce() -> io::Result<File>) -> Self {
        if !matches!(self, Self::Disk(_) | Self::ReadOnly) {
            return self;
        }
        match open().map_err(|error| error.kind()) {
            Err(ErrorKind::ReadOnlyFilesystem) => Self::ReadOnlyDisk,
            Err(ErrorKind::PermissionDenied) => Self::ReadOnly,
            _ => self,
        }
    }

    pub(crate) fn unknown(kind: &'static str, name: &str) -> Self {
        Self::Unknown {
            kind,
            name: name.to_owned(),
            hint: String::new(),
        }
    }
}

/// Kind of a path that is no database, in words.
fn kind_of(path: &std::path::Path) -> &'static str {
    match path.is_dir() {
        true => "a folder",
        false => "another kind of file",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_written_is_named() {
        let told = |error: DbError, kind: ErrorKind| {
            let told = error.with_place(|| Err(kind.into()));
            told.to_string()
        };
        let disk = || DbError::Disk("unable to open database file".into());
        let read_only = "its disk is read-only";
        assert!(told(disk(), ErrorKind::ReadOnlyFilesystem).ends_with(read_only));
        assert!(told(DbError::ReadOnly, ErrorKind::ReadOnlyFilesystem).ends_with(read_only));
        assert!(told(disk(), ErrorKind::PermissionDenied).contains("the file or its folder"));
        assert!(told(disk(), ErrorKind::NotFound).contains("unable to open"));
        assert!(told(DbError::Busy, ErrorKind::ReadOnlyFilesystem).contains("busy"));
    }
}
