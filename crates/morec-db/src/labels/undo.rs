//! Edits, and taking them back.

use rusqlite::{Connection, OptionalExtension, Row, params};

use crate::time::now_secs;
use crate::{DbError, MotionDb};

/// So many edits can be taken back.
pub const EDITS_KEPT: usize = 1000;

/// An edit that can be taken back.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Edit {
    /// What it did.
    pub what: String,
    /// When, seconds since 1970.
    pub set_secs: i64,
}

impl MotionDb {
    /// Runs `change` as one edit called `what`: all of it or nothing. Triggers write down what it touches.
    pub(crate) fn edit<T>(
        &mut self,
        what: &str,
        change: impl FnOnce(&Connection) -> Result<T, DbError>,
    ) -> Result<T, DbError> {
        let tx = self.write()?;
        tx.execute(
            "INSERT INTO edits (what, set_secs) VALUES (?1, ?2)",
            params![what, now_secs()],
        )?;
        let edit = tx.last_insert_rowid();
        let done = change(&tx)?;
        tx.execute("UPDATE edits SET open = 0 WHERE id = ?1", params![edit])?;
        // An edit that touched nothing is nothing to take back.
        tx.execute(
            "DELETE FROM edits WHERE id = ?1 AND NOT EXISTS (SELECT 1 FROM classes_before WHERE edit = ?1) \
             AND NOT EXISTS (SELECT 1 FROM samples_before WHERE edit = ?1)",
            params![edit],
        )?;
        let oldest = "DELETE FROM edits WHERE id <= (SELECT id FROM edits ORDER BY id DESC LIMIT 1 OFFSET ?1)";
        tx.execute(oldest, params![EDITS_KEPT as i64])?;
        tx.commit()?;
        Ok(done)
    }

    /// The edits that can be taken back, the last one first.
    pub fn edits(&self) -> Result<Vec<Edit>, DbError> {
        let mut statement = self
            .conn
            .prepare("SELECT what, set_secs FROM edits ORDER BY id DESC")?;
        let edits = statement.query_map([], |row| {
            Ok(Edit {
                what: row.get(0)?,
                set_secs: row.get(1)?,
            })
        })?;
        Ok(edits.collect::<Result<_, _>>()?)
    }

    /// Takes back the last edit and says what it was; `None` if there is none. Samples of clips that have been removed
    /// since do not come back.
    pub fn undo(&mut self) -> Result<Option<Edit>, DbError> {
        let tx = self.write()?;
        // Classes come back after their samples.
        tx.pragma_update(None, "defer_foreign_keys", true)?;
        let last = tx
            .query_row(
                "SELECT id, what, set_secs FROM edits ORDER BY id DESC LIMIT 1",
                [],
                |row| {
                    Ok((
                        row.get::<_, i64>(0)?,
                        Edit {
                            what: row.get(1)?,
                            set_secs: row.get(2)?,
                        },
                    ))
                },
            )
            .optional()?;
        let Some((id, edit)) = last else {
            return Ok(None);
        };
        restore_samples(&tx, id)?;
        restore_classes(&tx, id)?;
        tx.execute("DELETE FROM edits WHERE id = ?1", params![id])?;
        tx.commit()?;
        Ok(Some(edit))
    }
}

fn restore_classes(conn: &Connection, edit: i64) -> Result<(), DbError> {
    let mut before =
        conn.prepare("SELECT id, name FROM classes_before WHERE edit = ?1 ORDER BY seq DESC")?;
    let rows: Vec<(i64, Option<String>)> = before
        .query_map(params![edit], |row| Ok((row.get(0)?, row.get(1)?)))?
        .collect::<Result<_, _>>()?;
    for (id, name) in rows {
        match name {
            None => conn.execute("DELETE FROM classes WHERE id = ?1", params![id])?,
            Some(name) => conn.execute(
                "INSERT INTO classes (id, name) VALUES (?1, ?2) ON CONFLICT (id) DO UPDATE SET name = excluded.name",
                params![id, name],
            )?,
        };
    }
    Ok(())
}

/// A row of `samples_before`: the sample's number, and its columns if there was such a sample.
type Before = (i64, Option<[rusqlite::types::Value; 9]>);

fn before(row: &Row<'_>) -> rusqlite::Result<Before> {
    let there = row.get::<_, Option<i64>>(1)?.is_some();
    let column = |i: usize| row.get::<_, rusqlite::types::Value>(i + 1);
    let columns = [0, 1, 2, 3, 4, 5, 6, 7, 8].map(column);
    let mut values = Vec::with_capacity(9);
    for value in columns {
        values.push(value?);
    }
    Ok((row.get(0)?, values.try_into().ok().filter(|_| there)))
}

fn restore_samples(conn: &Connection, edit: i64) -> Result<(), DbError> {
    let mut statement = conn.prepare(
        "SELECT id, clip, class, start_secs, stop_secs, whole_clip, state, score, set_by, set_secs \
         FROM samples_before WHERE edit = ?1 ORDER BY seq DESC",
    )?;
    let rows: Vec<Before> = statement
        .query_map(params![edit], before)?
        .collect::<Result<_, _>>()?;
    for (id, columns) in rows {
        let Some([clip, class, start, stop, whole, state, score, by, at]) = columns else {
            conn.execute("DELETE FROM samples WHERE id = ?1", params![id])?;
            continue;
        };
        conn.execute(
            "INSERT INTO samples (id, clip, class, start_secs, stop_secs, whole_clip, state, score, set_by, set_secs) \
             SELECT ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10 WHERE EXISTS (SELECT 1 FROM clips WHERE id = ?2) \
             ON CONFLICT (id) DO UPDATE SET clip = excluded.clip, class = excluded.class, \
             start_secs = excluded.start_secs, stop_secs = excluded.stop_secs, whole_clip = excluded.whole_clip, \
             state = excluded.state, score = excluded.score, set_by = excluded.set_by, set_secs = excluded.set_secs",
            params![id, clip, class, start, stop, whole, state, score, by, at],
        )?;
    }
    Ok(())
}
