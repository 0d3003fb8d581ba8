//! One history for changes of every kind: each is a step that is done as a whole, taken back as a whole, and done again.
//!
//! Triggers of the schema write down each row as it was before a step touched it. Taking a step back puts these rows in
//! place, in the reverse order, while the same triggers write down what was there: afterwards the step holds what doing
//! it again needs. A removed clip therefore lies in the history once, and an imported one not at all.
//!
//! A step that is not the last can be taken back as long as no later one touched the same rows or depends on them. A new
//! change forgets the steps that were taken back, as editors do.

#[cfg(test)]
mod tests;
mod turn;

use std::collections::BTreeMap;

use rusqlite::{Connection, OptionalExtension, Row, params};

pub use turn::{Effect, ReplayedStep};

use crate::digest;
use crate::time::now_secs;
use crate::{DbError, MotionDb};

/// Number of steps that can be undone.
pub const STEPS_KEPT: usize = 1000;

/// Bytes of motion and indexes kept for undoing, apart from the last step's.
const BYTES_KEPT: i64 = 256 << 20;

/// A change that was done, and can be taken back; or was taken back, and can be done again.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct HistoryStep {
    /// Its number; later steps have greater ones.
    pub id: i64,
    /// Description of the step.
    pub what: String,
    /// Time of the change, seconds since 1970.
    pub set_secs: i64,
    /// True if it has been taken back.
    pub undone: bool,
    /// Name of the program that made it; empty if it is not known.
    pub made_by: String,
    /// Number of rows it touched, by table.
    pub rows: BTreeMap<String, usize>,
}

impl HistoryStep {
    /// The step in a `history`, the last step first, if it was neither taken back nor done again since.
    pub fn unchanged_in<'h>(&self, history: &'h [Self]) -> Option<&'h Self> {
        let at = history.binary_search_by(|old| self.id.cmp(&old.id)).ok()?;
        Some(&history[at]).filter(|old| old.undone == self.undone)
    }
}

/// A number of things in the name of a step: `1 clip`, `2 clips`.
pub(crate) fn counted(n: usize, what: &str) -> String {
    match n {
        1 => format!("1 {what}"),
        n => format!("{n} {what}s"),
    }
}

/// A step while its changes are written down.
pub(crate) struct StepRecorder {
    pub(crate) step: i64,
    /// Rows written down before it have a number up to this.
    pub(crate) after: i64,
}

/// Begins a step of a program, or goes on with one that spans several transactions.
pub(crate) fn record(
    conn: &Connection,
    what: &str,
    step: Option<i64>,
    program: &str,
) -> Result<StepRecorder, DbError> {
    let after = conn.query_row("SELECT coalesce(max(seq), 0) FROM was", [], |row| {
        row.get(0)
    })?;
    let step = match step {
        Some(step) => {
            conn.execute("UPDATE edits SET open = 1 WHERE id = ?1", params![step])?;
            step
        }
        None => {
            let sql = "INSERT INTO edits (what, set_secs, made_by) VALUES (?1, ?2, ?3)";
            conn.execute(sql, params![what, now_secs(), program])?;
            conn.last_insert_rowid()
        }
    };
    Ok(StepRecorder { step, after })
}

/// Ends a step's transaction. A step that touched nothing is forgotten: nothing to undo.
pub(crate) fn recorded(
    conn: &Connection,
    what: &str,
    recording: &StepRecorder,
) -> Result<Option<i64>, DbError> {
    let step = recording.step;
    digest::follow(conn, step, recording.after)?;
    let sql = "SELECT 1 FROM was WHERE edit = ?1 LIMIT 1";
    if !conn.prepare(sql)?.exists(params![step])? {
        conn.execute("DELETE FROM edits WHERE id = ?1", params![step])?;
        return Ok(None);
    }
    conn.execute(
        "UPDATE edits SET open = 0, what = ?2 WHERE id = ?1",
        params![step, what],
    )?;
    measure_bytes(conn, step)?;
    conn.execute(
        "DELETE FROM edits WHERE undone = 1 AND id <> ?1",
        params![step],
    )?;
    prune(conn)?;
    Ok(Some(step))
}

/// Notes how much motion a step keeps.
fn measure_bytes(conn: &Connection, step: i64) -> Result<(), DbError> {
    conn.execute(
        "UPDATE edits SET bytes = (SELECT coalesce(sum(coalesce(length(CASE tab WHEN 'clips' THEN c16 \
         WHEN 'indexes' THEN c4 END), 0)), 0) FROM was WHERE edit = ?1) WHERE id = ?1",
        params![step],
    )?;
    Ok(())
}

/// Forgets the oldest steps: there is no end to them.
fn prune(conn: &Connection) -> Result<(), DbError> {
    conn.execute(
        "DELETE FROM edits WHERE id <= (SELECT id FROM edits ORDER BY id DESC LIMIT 1 OFFSET ?1)",
        params![STEPS_KEPT as i64],
    )?;
    conn.execute(
        "DELETE FROM edits WHERE id <= (SELECT max(id) FROM (SELECT id, sum(bytes) OVER (ORDER BY id DESC) AS total \
         FROM edits) WHERE total > ?1) AND id < (SELECT max(id) FROM edits)",
        params![BYTES_KEPT],
    )?;
    Ok(())
}

fn step(row: &Row<'_>) -> rusqlite::Result<HistoryStep> {
    Ok(HistoryStep {
        id: row.get("id")?,
        what: row.get("what")?,
        set_secs: row.get("set_secs")?,
        undone: row.get("undone")?,
        made_by: row.get("made_by")?,
        rows: BTreeMap::new(),
    })
}

/// Number of rows that a step touched, by table.
fn touched(conn: &Connection, step: i64) -> Result<BTreeMap<String, usize>, DbError> {
    let sql = "SELECT tab, count(*) AS rows FROM (SELECT DISTINCT tab, c0, \
         CASE WHEN tab IN ('tags', 'file_copies') THEN c1 END FROM was WHERE edit = ?1) GROUP BY tab";
    let mut statement = conn.prepare_cached(sql)?;
    let rows = statement.query_map(params![step], |row| {
        let count: i64 = row.get("rows")?;
        Ok((row.get("tab")?, count.max(0) as usize))
    })?;
    Ok(rows.collect::<Result<_, _>>()?)
}

impl MotionDb {
    /// Runs `change` as one step called `what`: all of it or nothing.
    pub(crate) fn edit<T>(
        &mut self,
        what: &str,
        change: impl FnOnce(&Connection) -> Result<T, DbError>,
    ) -> Result<T, DbError> {
        self.edit_named(|conn| Ok((change(conn)?, what.to_owned())))
    }

    /// The same where only `change` knows what the step is called.
    pub(crate) fn edit_named<T>(
        &mut self,
        change: impl FnOnce(&Connection) -> Result<(T, String), DbError>,
    ) -> Result<T, DbError> {
        let program = self.program.clone();
        let tx = self.write()?;
        let recording = record(&tx, "", None, &program)?;
        let (done, what) = change(&tx)?;
        recorded(&tx, &what, &recording)?;
        tx.commit()?;
        Ok(done)
    }

    /// Runs `change` and leaves everything as it was.
    pub(crate) fn dry_run<T>(
        &mut self,
        change: impl FnOnce(&Connection) -> Result<T, DbError>,
    ) -> Result<T, DbError> {
        let tx = self.write()?;
        change(&tx)
    }

    /// All steps of the history, the newest first, each with the number of rows that it changed in each table.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn history(&self) -> Result<Vec<HistoryStep>, DbError> {
        self.history_since(&[])
    }

    /// The history like [`history`](Self::history), but with counts taken from `before`, an earlier result, for all steps
    /// that have not changed since; only the other steps are counted again. O(rows of these).
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn history_since(&self, before: &[HistoryStep]) -> Result<Vec<HistoryStep>, DbError> {
        let sql = "SELECT id, what, set_secs, undone, made_by FROM edits ORDER BY id DESC";
        let mut statement = self.conn.prepare_cached(sql)?;
        let steps = statement.query_map([], step)?;
        let mut steps: Vec<HistoryStep> = steps.collect::<Result<_, _>>()?;
        for step in &mut steps {
            step.rows = match step.unchanged_in(before) {
                Some(old) => old.rows.clone(),
                None => touched(&self.conn, step.id)?,
            };
        }
        Ok(steps)
    }

    /// The newest step that is not undone, without its counts of rows; `None` if the history has no such step.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn last_step(&self) -> Result<Option<HistoryStep>, DbError> {
        let sql = "SELECT id, what, set_secs, undone, made_by FROM edits WHERE undone = 0 ORDER BY id DESC LIMIT 1";
        Ok(self.conn.query_row(sql, [], step).optional()?)
    }

    /// Removes the history, so that earlier changes cannot be undone any more. Returns the number of steps removed.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn forget_history(&mut self) -> Result<usize, DbError> {
        let tx = self.write()?;
        let steps = tx.execute("DELETE FROM edits", [])?;
        tx.commit()?;
        Ok(steps)
    }
}
