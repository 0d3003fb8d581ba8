//! The database file: creating, opening, counting, limiting and shrinking it. All other modules work through [`MotionDb`].

use std::fs::{File, OpenOptions};
use std::path::{Path, PathBuf};
use std::time::Duration;

use rusqlite::{Connection, OpenFlags, Transaction, TransactionBehavior};

use crate::{DbError, SCHEMA, schema};

/// Time a writer waits for another before [`DbError::Busy`].
const WAIT: Duration = Duration::from_secs(5);

/// An open motion database.
#[derive(Debug)]
pub struct MotionDb {
    pub(crate) conn: Connection,
    path: PathBuf,
    /// Name under which steps are written down.
    pub(crate) program: String,
}

/// Contents of a database in numbers.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[allow(missing_docs)] // The names say it.
pub struct DbSummary {
    pub schema: i32,
    pub file_bytes: u64,
    pub files: u64,
    /// Bytes of the files that the clips came from.
    pub source_bytes: u64,
    /// Bytes of compressed motion.
    pub motion_bytes: u64,
    /// Bytes of feature rows kept ready.
    pub row_bytes: u64,
    pub refused: u64,
    pub clips: u64,
    pub skeletons: u64,
    pub secs: f64,
    /// The furthest that any stored joint rotation is from its file's, radians.
    pub max_angle_rad: f64,
    /// The furthest that any stored joint is from where its file has it, metres.
    pub max_position_metres: f64,
    pub segments: u64,
    pub classes: u64,
    pub accepted: u64,
    pub proposed: u64,
    pub rejected: u64,
    pub indexes: u64,
}

impl MotionDb {
    /// Makes a new database.
    ///
    /// # Errors
    /// [`DbError::Exists`]; the folder is not there or cannot be written.
    pub fn create(path: &Path) -> Result<Self, DbError> {
        if path.exists() {
            return Err(DbError::Exists(path.to_owned()));
        }
        let made = Connection::open(path).map_err(DbError::from);
        let made = made.and_then(|mut conn| begin(&mut conn).map(|()| conn));
        let conn = made.map_err(|error| error.with_place(|| File::create_new(path)))?;
        Ok(Self {
            conn,
            path: path.to_owned(),
            program: this_program(),
        })
    }

    /// Opens a database for reading and writing, and brings an older schema to the present one.
    ///
    /// # Errors
    /// No such file, another kind of file, a newer schema, a file that may not be written.
    pub fn open(path: &Path) -> Result<Self, DbError> {
        let opened = Self::open_for_writing(path);
        opened.map_err(|error| error.with_place(|| OpenOptions::new().write(true).open(path)))
    }

    fn open_for_writing(path: &Path) -> Result<Self, DbError> {
        let mut conn = existing(path, OpenFlags::SQLITE_OPEN_READ_WRITE)?;
        let found = schema::check(&conn, path)?;
        match found {
            0 => begin(&mut conn)?,
            found if found < SCHEMA => schema::migrate(&mut conn)?,
            _ => {}
        }
        configure(&conn)?;
        if conn.is_readonly("main")? {
            return Err(DbError::ReadOnly);
        }
        Ok(Self {
            conn,
            path: path.to_owned(),
            program: this_program(),
        })
    }

    /// Opens a database for reading only, beside a writer if there is one.
    ///
    /// # Errors
    /// No such file, another kind of file, another schema.
    pub fn open_read_only(path: &Path) -> Result<Self, DbError> {
        // Opened as a writer would, the last to close leaves one file behind and not its log; and writes nothing.
        let conn = existing(path, OpenFlags::SQLITE_OPEN_READ_WRITE)?;
        let found = match schema::check(&conn, path) {
            // Beside a write-ahead log, readers need a file of their own; where none can be made nobody writes either.
            Err(DbError::Disk(_) | DbError::ReadOnly) => return Self::open_immutable(path),
            other => other?,
        };
        if found < SCHEMA {
            return Err(DbError::Older {
                path: path.to_owned(),
                found,
                known: SCHEMA,
            });
        }
        configure(&conn)?;
        conn.pragma_update(None, "query_only", true)?;
        Ok(Self {
            conn,
            path: path.to_owned(),
            program: this_program(),
        })
    }

    fn open_immutable(path: &Path) -> Result<Self, DbError> {
        let escaped: String = path
            .to_string_lossy()
            .chars()
            .map(|c| match c {
                '%' => "%25".to_owned(),
                '?' => "%3f".to_owned(),
                '#' => "%23".to_owned(),
                c => c.to_string(),
            })
            .collect();
        let flags = OpenFlags::SQLITE_OPEN_READ_ONLY
            | OpenFlags::SQLITE_OPEN_URI
            | OpenFlags::SQLITE_OPEN_NO_MUTEX;
        let conn = Connection::open_with_flags(format!("file:{escaped}?immutable=1"), flags)?;
        schema::check(&conn, path)?;
        Ok(Self {
            conn,
            path: path.to_owned(),
            program: this_program(),
        })
    }

    /// True if it was opened for reading only.
    pub(crate) fn is_read_only(&self) -> Result<bool, DbError> {
        let query_only: bool = self
            .conn
            .pragma_query_value(None, "query_only", |row| row.get(0))?;
        Ok(query_only || self.conn.is_readonly("main")?)
    }

    /// Writes steps down under the name of a program; without it, under that of the file which runs.
    pub fn set_program(&mut self, name: &str) {
        name.clone_into(&mut self.program);
    }

    /// The name under which steps are written down.
    pub fn program(&self) -> &str {
        &self.program
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// A transaction that has the writer's place from its beginning, so that it fails at once or not at all.
    pub(crate) fn write(&mut self) -> Result<Transaction<'_>, DbError> {
        Ok(self
            .conn
            .transaction_with_behavior(TransactionBehavior::Immediate)?)
    }

    /// Runs `read` in one transaction, so that all its queries see the same state, even if other programs write meanwhile.
    ///
    /// # Errors
    /// Those of `read`, and a database that cannot be read.
    pub fn at_one_moment<T>(
        &self,
        read: impl FnOnce() -> Result<T, DbError>,
    ) -> Result<T, DbError> {
        let _moment = self.conn.unchecked_transaction()?;
        read()
    }

    /// A number that changes whenever another connection has changed the file, and not after changes of this connection. The
    /// studio polls it to notice changes of the command.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn changes_of_others(&self) -> Result<i64, DbError> {
        let number = |row: &rusqlite::Row<'_>| row.get(0);
        Ok(self.conn.pragma_query_value(None, "data_version", number)?)
    }

    /// Counts of clips, segments, classes, samples and indexes; sizes in bytes; the length of all clips in seconds; and the
    /// largest deviations of stored motion from its files, in radians and metres.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn summary(&self) -> Result<DbSummary, DbError> {
        let count = |sql: &str| -> Result<u64, DbError> {
            Ok(self
                .conn
                .query_row(sql, [], |row| row.get::<_, i64>(0))?
                .max(0) as u64)
        };
        let real = |sql: &str| -> Result<f64, DbError> {
            Ok(self.conn.query_row(sql, [], |row| row.get(0))?)
        };
        Ok(DbSummary {
            schema: SCHEMA,
            file_bytes: count(
                "SELECT page_count * page_size FROM pragma_page_count(), pragma_page_size()",
            )?,
            files: count("SELECT count(*) FROM files")?,
            source_bytes: count("SELECT coalesce(sum(bytes), 0) FROM files")?,
            motion_bytes: count("SELECT coalesce(sum(length(motion)), 0) FROM clips")?,
            row_bytes: count("SELECT coalesce(sum(length(bytes)), 0) FROM feature_rows")?,
            refused: count("SELECT count(*) FROM refused")?,
            clips: count("SELECT count(*) FROM clips")?,
            skeletons: count("SELECT count(DISTINCT skeleton) FROM clips")?,
            secs: real("SELECT coalesce(sum(frames / rate_hz), 0.0) FROM clips")?,
            max_angle_rad: real("SELECT coalesce(max(max_angle_rad), 0.0) FROM clips")?,
            max_position_metres: real("SELECT coalesce(max(max_position_metres), 0.0) FROM clips")?,
            segments: count("SELECT count(*) FROM segments")?,
            classes: count("SELECT count(*) FROM classes")?,
            accepted: count("SELECT count(*) FROM samples WHERE state = 'accepted'")?,
            proposed: count("SELECT count(*) FROM samples WHERE state = 'proposed'")?,
            rejected: count("SELECT count(*) FROM samples WHERE state = 'rejected'")?,
            indexes: count("SELECT count(*) FROM indexes")?,
        })
    }

    /// Limits the size of the file, in bytes, until it is closed. The present content stays, even if it is larger. Changes
    /// that need more space fail as on a full disk, with [`DbError::Full`].
    ///
    /// # Errors
    /// The limit cannot be set.
    pub fn limit_bytes(&mut self, bytes: u64) -> Result<(), DbError> {
        let page: i64 = self
            .conn
            .pragma_query_value(None, "page_size", |row| row.get(0))?;
        // SQLite takes a limit below what is there for what is there.
        let pages = (bytes / page.max(1) as u64).clamp(1, i64::MAX as u64) as i64;
        let set = |row: &rusqlite::Row<'_>| row.get::<_, i64>(0);
        self.conn
            .pragma_update_and_check(None, "max_page_count", pages, set)?;
        Ok(())
    }

    /// Returns unused space of the file to the disk; with `caches`, also drops feature rows, which are rebuilt when needed.
    ///
    /// # Errors
    /// The database cannot be written, for instance because another program is using it.
    pub fn vacuum(&mut self, caches: bool) -> Result<(), DbError> {
        if caches {
            self.conn.execute("DELETE FROM feature_rows", [])?;
        }
        self.conn
            .execute_batch("VACUUM; PRAGMA wal_checkpoint(TRUNCATE);")?;
        Ok(())
    }
}

/// Name of the program that runs: of its file, without the ending.
fn this_program() -> String {
    let path = std::env::current_exe().unwrap_or_default();
    let name = path.file_stem().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

/// Makes an empty file a database.
fn begin(conn: &mut Connection) -> Result<(), DbError> {
    configure(conn)?;
    // A clip's motion is a few kilobytes: in larger pages half of the file would be their unused ends.
    conn.pragma_update(None, "page_size", 1024)?;
    conn.pragma_update(None, "journal_mode", "wal")?;
    schema::migrate(conn)
}

fn existing(path: &Path, mode: OpenFlags) -> Result<Connection, DbError> {
    if !path.exists() {
        return Err(DbError::Missing(path.to_owned()));
    }
    if path.is_dir() {
        return Err(DbError::NotADatabase(path.to_owned()));
    }
    let conn = Connection::open_with_flags(path, mode | OpenFlags::SQLITE_OPEN_NO_MUTEX)?;
    conn.busy_timeout(WAIT)?;
    Ok(conn)
}

/// A crash of the program loses nothing that was committed; a power cut may lose the last commits, never the file.
fn configure(conn: &Connection) -> Result<(), DbError> {
    conn.busy_timeout(WAIT)?;
    conn.pragma_update(None, "synchronous", "normal")?;
    conn.pragma_update(None, "foreign_keys", true)?;
    // What a file says about itself must not make the program run code.
    conn.pragma_update(None, "trusted_schema", false)?;
    Ok(())
}
