//! The schema of the file, upgraded in numbered steps. A released step must never be changed; a change of the schema is a new
//! step.

use std::collections::BTreeMap;
use std::path::Path;

use rusqlite::{Connection, TransactionBehavior};

use crate::DbError;
use crate::digest;

/// Marks an SQLite file as a motion database: "mrec".
pub const APPLICATION_ID: i32 = 0x6d72_6563;

/// Step `i` brings schema `i` to schema `i + 1`. Steps are only ever added.
const MIGRATIONS: [&str; 6] = [
    include_str!("migrations/0001.sql"),
    include_str!("migrations/0002.sql"),
    include_str!("migrations/0003.sql"),
    include_str!("migrations/0004.sql"),
    include_str!("migrations/0005.sql"),
    include_str!("migrations/0006.sql"),
];

/// The newest schema that this version knows.
pub const SCHEMA: i32 = MIGRATIONS.len() as i32;

/// Schema version of a file.
///
/// # Errors
/// It is no motion database, a newer one, or one with other tables, views or triggers than its version has.
pub(crate) fn check(conn: &Connection, path: &Path) -> Result<i32, DbError> {
    // Version and schema of the same moment: another program may bring the file to a newer one.
    let conn = conn.unchecked_transaction()?;
    let version = version(&conn, path)?;
    let expected = Connection::open_in_memory()?;
    for step in MIGRATIONS.iter().take(version.max(0) as usize) {
        expected.execute_batch(step)?;
    }
    match difference(&objects(&expected)?, &objects(&conn)?) {
        Some(found) => Err(DbError::Altered {
            path: path.to_owned(),
            found,
        }),
        None => Ok(version),
    }
}

/// Parts of a schema by kind and name, each with what it is made of: columns, or the text of what runs.
type SchemaParts = BTreeMap<(String, String), String>;

fn objects(conn: &Connection) -> Result<SchemaParts, DbError> {
    // Statistics and indexes of constraints are SQLite's own.
    let sql = "SELECT type, name, CASE type WHEN 'table' THEN \
         (SELECT group_concat(name || ' ' || type || ' ' || hidden) FROM pragma_table_xinfo(s.name)) ELSE sql END \
         FROM sqlite_schema s WHERE name NOT LIKE 'sqlite\\_%' ESCAPE '\\'";
    let mut statement = conn.prepare(sql)?;
    let rows = statement.query_map([], |row| {
        let text: Option<String> = row.get(2)?;
        Ok(((row.get(0)?, row.get(1)?), plain(&text.unwrap_or_default())))
    })?;
    Ok(rows.collect::<Result<_, _>>()?)
}

/// SQL without comments, and with one blank in place of several.
fn plain(sql: &str) -> String {
    let lines = sql
        .lines()
        .map(|line| line.split("--").next().unwrap_or(line));
    let words = lines.flat_map(str::split_whitespace);
    words.collect::<Vec<&str>>().join(" ")
}

/// The first part that only one of the schemas has, or that differs.
fn difference(expected: &SchemaParts, found: &SchemaParts) -> Option<String> {
    let other = found
        .iter()
        .find_map(|(part @ (kind, name), text)| match expected.get(part) {
            None => Some(format!("unexpected {kind} {name:?}: not created by morec")),
            Some(own) if own != text => Some(format!("another {kind} {name:?}")),
            Some(_) => None,
        });
    let missing = || expected.keys().find(|part| !found.contains_key(part));
    other.or_else(|| missing().map(|(kind, name)| format!("no {kind} {name:?}")))
}

fn version(conn: &Connection, path: &Path) -> Result<i32, DbError> {
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
