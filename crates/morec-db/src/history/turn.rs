//! Undo and redo of steps.

use rusqlite::{Connection, OptionalExtension, Transaction, params};

use super::{HistoryStep, measure_bytes, record, step};
use crate::digest;
use crate::tracked::{TRACKED, tracked};
use crate::{DbError, MotionDb};

/// Effect of undoing or redoing a step on a table.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Effect {
    /// The table: clips, samples, classes …
    pub table: String,
    /// Rows that are there again.
    pub back: usize,
    /// Rows that are gone.
    pub gone: usize,
    /// Rows that are there and changed.
    pub changed: usize,
}

/// A step that was taken back or done again, or would be.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct ReplayedStep {
    /// The step as `history` lists it.
    #[serde(flatten)]
    pub step: HistoryStep,
    /// Its effects on the database.
    pub effects: Vec<Effect>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    Undo,
    Redo,
}

impl MotionDb {
    /// Takes a step back: the one of this number, or the last that was not taken back. `None` if there is none.
    ///
    /// # Errors
    /// There is no such step; it has been taken back; later steps changed the same rows or need them. Nothing is changed
    /// then.
    pub fn undo(&mut self, step: Option<i64>) -> Result<Option<ReplayedStep>, DbError> {
        self.turn(Way::Undo, step, true)
    }

    /// Does a step again that was taken back: the one of this number, or the earliest. `None` if there is none.
    ///
    /// # Errors
    /// There is no such step; it has not been taken back; its rows changed since. Nothing is changed then.
    pub fn redo(&mut self, step: Option<i64>) -> Result<Option<ReplayedStep>, DbError> {
        self.turn(Way::Redo, step, true)
    }

    /// Effects that [`MotionDb::undo`] would have.
    ///
    /// # Errors
    /// As there.
    pub fn preview_undo(&mut self, step: Option<i64>) -> Result<Option<ReplayedStep>, DbError> {
        self.turn(Way::Undo, step, false)
    }

    /// Effects that [`MotionDb::redo`] would have.
    ///
    /// # Errors
    /// As there.
    pub fn preview_redo(&mut self, step: Option<i64>) -> Result<Option<ReplayedStep>, DbError> {
        self.turn(Way::Redo, step, false)
    }

    fn turn(
        &mut self,
        way: Way,
        wanted: Option<i64>,
        for_good: bool,
    ) -> Result<Option<ReplayedStep>, DbError> {
        let tx = self.write()?;
        // Rows come back in the reverse of the order in which they went: children before parents.
        tx.pragma_update(None, "defer_foreign_keys", true)?;
        let Some(mut step) = find(&tx, way, wanted)? else {
            return Ok(None);
        };
        let others = in_the_way(&tx, way, step.id)?;
        if !others.is_empty() {
            return Err(refusal(&step, way, "changed the same", &others));
        }
        let effects = swap(&tx, way, &step)?;
        step.undone = way == Way::Undo;
        let sql = "UPDATE edits SET undone = ?2 WHERE id = ?1";
        tx.execute(sql, params![step.id, step.undone])?;
        if for_good {
            tx.commit().map_err(|error| needed(&step, error.into()))?;
        }
        Ok(Some(ReplayedStep { step, effects }))
    }
}

fn find(conn: &Connection, way: Way, wanted: Option<i64>) -> Result<Option<HistoryStep>, DbError> {
    let columns = "SELECT id, what, set_secs, undone, made_by FROM edits";
    let Some(id) = wanted else {
        let sql = match way {
            Way::Undo => format!("{columns} WHERE undone = 0 ORDER BY id DESC LIMIT 1"),
            Way::Redo => format!("{columns} WHERE undone = 1 ORDER BY id LIMIT 1"),
        };
        return Ok(conn.query_row(&sql, [], step).optional()?);
    };
    let sql = format!("{columns} WHERE id = ?1");
    let found = conn.query_row(&sql, params![id], step).optional()?;
    let found = found.ok_or_else(|| DbError::unknown("step", &id.to_string()))?;
    match (way, found.undone) {
        (Way::Undo, true) => Err(DbError::Invalid(format!(
            "step {id} ({}) has been undone already",
            found.what
        ))),
        (Way::Redo, false) => Err(DbError::Invalid(format!(
            "step {id} ({}) has not been undone",
            found.what
        ))),
        _ => Ok(Some(found)),
    }
}

/// Steps whose changes lie over those of a step: later ones; and, to do it again, earlier ones that are taken back.
fn in_the_way(conn: &Connection, way: Way, id: i64) -> Result<Vec<HistoryStep>, DbError> {
    let mut statement = conn.prepare(
        "SELECT e.id, e.what, e.set_secs, e.undone, e.made_by FROM edits e WHERE e.id <> ?1 \
         AND (e.id > ?1 AND e.undone = 0 OR ?2 AND e.id < ?1 AND e.undone = 1) AND EXISTS \
         (SELECT 1 FROM was w JOIN was s ON s.tab = w.tab AND s.c0 = w.c0 WHERE w.edit = e.id AND s.edit = ?1 \
          AND (w.tab NOT IN ('tags', 'file_copies') OR w.c1 = s.c1)) ORDER BY e.id",
    )?;
    let steps = statement.query_map(params![id, way == Way::Redo], step)?;
    Ok(steps.collect::<Result<_, _>>()?)
}

fn refusal(step: &HistoryStep, way: Way, why: &str, others: &[HistoryStep]) -> DbError {
    let named: Vec<String> = others
        .iter()
        .map(|other| format!("{} ({})", other.id, other.what))
        .collect();
    let (done, first) = match way {
        Way::Undo => ("undone", "undo these first"),
        Way::Redo => ("redone", "undo or redo these first"),
    };
    DbError::Invalid(format!(
        "step {} ({}) cannot be {done} alone: {} {why}; {first}",
        step.id,
        step.what,
        named.join(", ")
    ))
}

fn needed(step: &HistoryStep, error: DbError) -> DbError {
    match &error {
        DbError::Sqlite(rusqlite::Error::SqliteFailure(code, _))
            if code.code == rusqlite::ErrorCode::ConstraintViolation =>
        {
            DbError::Invalid(format!(
                "step {} ({}): its rows have changed since or are in use; nothing was undone",
                step.id, step.what
            ))
        }
        _ => error,
    }
}

/// Puts back what a step wrote down, and keeps under its number what was there.
fn swap(tx: &Transaction<'_>, way: Way, step: &HistoryStep) -> Result<Vec<Effect>, DbError> {
    let rows: Vec<(i64, String, bool)> = {
        let sql = "SELECT seq, tab, present FROM was WHERE edit = ?1 ORDER BY seq DESC";
        let mut statement = tx.prepare(sql)?;
        let rows = statement.query_map(params![step.id], |row| {
            Ok((row.get("seq")?, row.get("tab")?, row.get("present")?))
        })?;
        rows.collect::<Result<_, _>>()?
    };
    let recording = record(tx, "", None, "")?;
    for (seq, table, present) in rows {
        let table = tracked(&table)
            .ok_or_else(|| DbError::Damaged(format!("history of a table {table}")))?;
        table
            .restore(tx, seq, present)
            .map_err(|error| needed(step, error))?;
    }
    tx.execute(
        "UPDATE edits SET open = 0 WHERE id = ?1",
        params![recording.step],
    )?;
    let dependents = dependents(tx, step.id, recording.step)?;
    if !dependents.is_empty() {
        return Err(refusal(step, way, "need it", &dependents));
    }
    digest::follow(tx, recording.step, recording.after)?;
    // Kept rows follow from the motion: those of a motion that went would mislead.
    tx.execute(
        "DELETE FROM feature_rows WHERE clip IN (SELECT t.id FROM clips t JOIN was w ON w.c0 = t.id \
         WHERE w.edit = ?1 AND w.tab = 'clips' AND w.present \
         AND (w.c16 IS NOT NULL OR w.c9 IS NOT t.roles OR w.c7 IS NOT t.rest_frames))",
        params![recording.step],
    )?;
    let effects = effects(tx, recording.step)?;
    tx.execute("DELETE FROM was WHERE edit = ?1", params![step.id])?;
    let sql = "UPDATE was SET edit = ?1 WHERE edit = ?2";
    tx.execute(sql, params![step.id, recording.step])?;
    let sql = "DELETE FROM edits WHERE id = ?1";
    tx.execute(sql, params![recording.step])?;
    measure_bytes(tx, step.id)?;
    Ok(effects)
}

/// Steps whose rows went, too, though the step did not touch them.
fn dependents(conn: &Connection, id: i64, recording: i64) -> Result<Vec<HistoryStep>, DbError> {
    let mut statement = conn.prepare(
        "SELECT DISTINCT e.id, e.what, e.set_secs, e.undone, e.made_by FROM was w \
         JOIN was o ON o.tab = w.tab AND o.c0 = w.c0 JOIN edits e ON e.id = o.edit \
         WHERE w.edit = ?2 AND e.id NOT IN (?1, ?2) AND e.undone = 0 \
         AND NOT EXISTS (SELECT 1 FROM was s WHERE s.edit = ?1 AND s.tab = w.tab AND s.c0 = w.c0) ORDER BY e.id",
    )?;
    let steps = statement.query_map(params![id, recording], step)?;
    Ok(steps.collect::<Result<_, _>>()?)
}

fn effects(conn: &Connection, recording: i64) -> Result<Vec<Effect>, DbError> {
    let mut effects = Vec::new();
    for table in &TRACKED {
        let (name, same) = (table.name, table.same_row());
        let keys: Vec<String> = (0..table.keys).map(|at| format!("c{at}")).collect();
        // SQLite takes bare columns beside min() from the row that has the minimum.
        let sql = format!(
            "SELECT coalesce(sum(NOT w.present AND there), 0) AS back, \
             coalesce(sum(w.present AND NOT there), 0) AS gone, \
             coalesce(sum(w.present AND there), 0) AS changed FROM (SELECT w.*, EXISTS (SELECT 1 FROM {name} t WHERE {same}) \
             AS there FROM (SELECT min(seq), * FROM was WHERE edit = ?1 AND tab = ?2 GROUP BY {}) w) w",
            keys.join(", ")
        );
        let counts: [i64; 3] = conn.query_row(&sql, params![recording, name], |row| {
            Ok([row.get("back")?, row.get("gone")?, row.get("changed")?])
        })?;
        let [back, gone, changed] = counts.map(|count| count.max(0) as usize);
        if back + gone + changed > 0 {
            effects.push(Effect {
                table: name.to_owned(),
                back,
                gone,
                changed,
            });
        }
    }
    Ok(effects)
}
