//! A checksum of each table, which follows every change in time proportional to the change.
//!
//! It is the exclusive or of the BLAKE3 hashes of the rows: a row that goes is taken out by the same operation that took
//! it in. It finds damage and changes by other programs; it is no defence against somebody who forges it.

use rusqlite::types::ValueRef;
use rusqlite::{Connection, OptionalExtension, Row, params};

use crate::DbError;
use crate::tracked::{TRACKED, Tracked};

type Sum = [u8; 32];

fn add(sum: &mut Sum, row: &Row<'_>, columns: usize) -> rusqlite::Result<()> {
    let mut hasher = blake3::Hasher::new();
    for at in 0..columns {
        let (kind, bytes): (u8, &[u8]) = match row.get_ref(at)? {
            ValueRef::Null => (0, &[]),
            ValueRef::Integer(value) => (1, &value.to_le_bytes()),
            ValueRef::Real(value) => (2, &value.to_le_bytes()),
            ValueRef::Text(text) => (3, text),
            ValueRef::Blob(bytes) => (4, bytes),
        };
        hasher.update(&[kind]);
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    }
    for (sum, byte) in sum.iter_mut().zip(hasher.finalize().as_bytes()) {
        *sum ^= byte;
    }
    Ok(())
}

fn add_all(
    sum: &mut Sum,
    conn: &Connection,
    sql: &str,
    given: impl rusqlite::Params,
    columns: usize,
) -> Result<(), DbError> {
    let mut statement = conn.prepare_cached(sql)?;
    let mut rows = statement.query(given)?;
    while let Some(row) = rows.next()? {
        add(sum, row, columns)?;
    }
    Ok(())
}

/// The checksum of a table as it is.
fn of(conn: &Connection, table: &Tracked) -> Result<Sum, DbError> {
    let columns: Vec<&str> = table.small().map(|(_, name)| name).collect();
    let sql = format!("SELECT {} FROM {}", columns.join(", "), table.name);
    let mut sum = Sum::default();
    add_all(&mut sum, conn, &sql, [], columns.len())?;
    Ok(sum)
}

fn kept(conn: &Connection, table: &Tracked) -> Result<Option<Vec<u8>>, DbError> {
    let sql = "SELECT sum FROM digests WHERE tab = ?1";
    let mut statement = conn.prepare_cached(sql)?;
    Ok(statement
        .query_row(params![table.name], |row| row.get(0))
        .optional()?)
}

fn keep(conn: &Connection, table: &Tracked, sum: &Sum) -> Result<(), DbError> {
    let sql = "INSERT OR REPLACE INTO digests (tab, sum) VALUES (?1, ?2)";
    conn.prepare_cached(sql)?
        .execute(params![table.name, sum])?;
    Ok(())
}

/// Writes new checksums of all tables, accepting their present content. Used when a database is created or repaired.
pub fn take_all(conn: &Connection) -> Result<(), DbError> {
    TRACKED
        .iter()
        .try_for_each(|table| keep(conn, table, &of(conn, table)?))
}

/// Updates the checksums with the rows that step `step` has recorded after row `after` of its record.
pub fn follow(conn: &Connection, step: i64, after: i64) -> Result<(), DbError> {
    for table in &TRACKED {
        let sql = "SELECT 1 FROM was WHERE edit = ?1 AND tab = ?2 AND seq > ?3 LIMIT 1";
        let given = params![step, table.name, after];
        if !conn.prepare_cached(sql)?.exists(given)? {
            continue;
        }
        let mut sum = Sum::default();
        if let Some(kept) = kept(conn, table)?.and_then(|sum| sum.try_into().ok()) {
            sum = kept;
        }
        let columns: Vec<(usize, &str)> = table.small().collect();
        let keys: Vec<String> = (0..table.keys).map(|at| format!("c{at}")).collect();
        let keys = keys.join(", ");
        let were: Vec<String> = columns.iter().map(|(at, _)| format!("c{at}")).collect();
        let were = were.join(", ");
        // SQLite takes bare columns beside min() from the row that has the minimum: what was there first.
        let before = format!(
            "SELECT {were} FROM (SELECT min(seq), * FROM was WHERE edit = ?1 AND tab = ?2 AND seq > ?3 \
             GROUP BY {keys}) WHERE present"
        );
        add_all(&mut sum, conn, &before, given, columns.len())?;
        let are: Vec<String> = columns
            .iter()
            .map(|(_, name)| format!("t.{name}"))
            .collect();
        let now = format!(
            "SELECT {} FROM {} t JOIN (SELECT DISTINCT {keys} FROM was WHERE edit = ?1 AND tab = ?2 AND seq > ?3) w \
             ON {}",
            are.join(", "),
            table.name,
            table.same_row()
        );
        add_all(&mut sum, conn, &now, given, columns.len())?;
        keep(conn, table, &sum)?;
    }
    Ok(())
}

/// The tables whose content does not match their checksum: damaged, or changed by a program that does not write the history.
pub fn faults(conn: &Connection) -> Result<Vec<&'static str>, DbError> {
    let mut faults = Vec::new();
    for table in &TRACKED {
        if kept(conn, table)?.is_some_and(|sum| !matches!(of(conn, table), Ok(now) if now == *sum))
        {
            faults.push(table.name);
        }
    }
    Ok(faults)
}
