//! The schema, in numbered steps.

use std::path::Path;

use rusqlite::{Connection, TransactionBehavior};

use crate::DbError;
use crate::history::digest;

/// Marks an SQLite file as a motion database: "mrec".
pub const APPLICATION_ID: i32 = 0x6d72_6563;

/// Step `i` brings schema `i` to schema `i + 1`. Steps are only ever added.
const MIGRATIONS: [&str; 3] = [
    include_str!("migrations/0001.sql"),
    include_str!("migrations/0002.sql"),
    include_str!("migrations/0003.sql"),
];

/// The newest schema that this version knows.
pub const SCHEMA: i32 = MIGRATIONS.len() as i32;

/// Schema version of a file.
///
/// # Errors
/// It is no motion database, or a newer one.
pub(crate) fn check(conn: &Connection, path: &Path) -> Result<i32, DbError> {
    let id: i32 = pragma(conn, path, "application_id")?;
    let version: i32 = pragma(conn, path, "user_version")?;
    // A program that was killed while it made the database leaves an empty one: that is ours to finish.
    let empty = || {
        conn.query_row("SELECT count(*) = 0 FROM sqlite_schema", [], |row| {
            row.get::<_, bool>(0)
        })
    };
    if id == 0 && version == 0 && empty()? {
        return Ok(0);
    }
    if id != APPLICATION_ID {
        return Err(DbError::Foreign {
            path: path.to_owned(),
            found: id,
        });
    }
    if version > SCHEMA {
        return Err(DbError::Newer {
            path: path.to_owned(),
            found: version,
            known: SCHEMA,
        });
    }
    Ok(version)
}

fn pragma(conn: &Connection, path: &Path, name: &str) -> Result<i32, DbError> {
    conn.pragma_query_value(None, name, |row| row.get(0))
        .map_err(|error| match error {
            rusqlite::Error::SqliteFailure(code, _)
                if code.code == rusqlite::ErrorCode::NotADatabase =>
            {
                DbError::NotADatabase(path.to_owned())
            }
            other => other.into(),
        })
}

/// Brings a file to the newest schema, all steps in one transaction.
pub(crate) fn migrate(conn: &mut Connection) -> Result<(), DbError> {
    let tx = conn.transaction_with_behavior(TransactionBehavior::Immediate)?;
    // Read under the lock: another program may have been faster.
    let from: i32 = tx.pragma_query_value(None, "user_version", |row| row.get(0))?;
    for step in MIGRATIONS.iter().skip(from.max(0) as usize) {
        tx.execute_batch(step)?;
    }
    if from < SCHEMA {
        digest::take_all(&tx)?;
    }
    tx.pragma_update(None, "application_id", APPLICATION_ID)?;
    tx.pragma_update(None, "user_version", SCHEMA)?;
    tx.commit()?;
    Ok(())
}
