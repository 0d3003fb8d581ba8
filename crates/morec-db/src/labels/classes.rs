//! Classes: created with their first sample, and renamed, merged and split by the user.

use rusqlite::{Connection, OptionalExtension, params};

use super::sample::SampleId;
use crate::history::counted;
use crate::{BACKGROUND, DbError, MotionDb, names};

/// A class and how many samples it has.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ClassCount {
    /// Name of the class.
    pub name: String,
    /// Samples that show it.
    pub accepted: usize,
    /// Samples to be looked at.
    pub proposed: usize,
    /// Samples that do not show it.
    pub rejected: usize,
    /// Length of all accepted samples, seconds.
    pub secs: f64,
}

/// Checks a class name, which must survive tables, track names and terminals.
pub(super) fn check_name(name: &str) -> Result<&str, DbError> {
    let trimmed = name.trim();
    if trimmed.is_empty() || trimmed.len() > names::LONGEST || trimmed.chars().any(char::is_control)
    {
        let expected =
            "a class's name: 1 to 200 bytes without tabs, line ends or other control characters";
        return Err(DbError::Invalid(format!(
            "expected {expected}, found {name:?}"
        )));
    }
    Ok(trimmed)
}

pub(super) fn find(conn: &Connection, name: &str) -> Result<Option<i64>, DbError> {
    let sql = "SELECT id FROM classes WHERE name = ?1";
    Ok(conn
        .prepare_cached(sql)?
        .query_row(params![name], |row| row.get(0))
        .optional()?)
}

fn need(conn: &Connection, name: &str) -> Result<i64, DbError> {
    if let Some(id) = find(conn, name)? {
        return Ok(id);
    }
    Err(names::unknown(conn, "class", name))
}

pub(super) fn find_or_make(conn: &Connection, name: &str) -> Result<i64, DbError> {
    let name = check_name(name)?;
    if let Some(id) = find(conn, name)? {
        return Ok(id);
    }
    conn.prepare_cached("INSERT INTO classes (name) VALUES (?1)")?
        .execute(params![name])?;
    Ok(conn.last_insert_rowid())
}

/// Gives samples another class. One that is there already under that class is dropped instead of kept twice.
fn move_samples(conn: &Connection, which: &str, of: i64, to: i64) -> Result<usize, DbError> {
    let sql = format!("UPDATE OR IGNORE samples SET class = ?2 WHERE {which} = ?1");
    let moved = conn.prepare_cached(&sql)?.execute(params![of, to])?;
    let sql = format!("DELETE FROM samples WHERE {which} = ?1 AND class <> ?2");
    conn.prepare_cached(&sql)?.execute(params![of, to])?;
    Ok(moved)
}

impl MotionDb {
    /// All classes, sorted by name, with their numbers of samples by state and the seconds of accepted samples.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn classes(&self) -> Result<Vec<ClassCount>, DbError> {
        let mut statement = self.conn.prepare(
            "SELECT n.name, coalesce(sum(s.state = 'accepted'), 0) AS accepted, \
             coalesce(sum(s.state = 'proposed'), 0) AS proposed, coalesce(sum(s.state = 'rejected'), 0) AS rejected, \
             coalesce(sum((s.stop_secs - s.start_secs) * (s.state = 'accepted')), 0.0) AS secs \
             FROM classes n LEFT JOIN samples s ON s.class = n.id GROUP BY n.id ORDER BY n.name",
        )?;
        let classes = statement.query_map([], |row| {
            let count = |column: &str| -> rusqlite::Result<usize> {
                Ok(row.get::<_, i64>(column)?.max(0) as usize)
            };
            Ok(ClassCount {
                name: row.get("name")?,
                accepted: count("accepted")?,
                proposed: count("proposed")?,
                rejected: count("rejected")?,
                secs: row.get("secs")?,
            })
        })?;
        Ok(classes.collect::<Result<_, _>>()?)
    }

    /// Gives a class another name.
    ///
    /// # Errors
    /// There is no such class, or another one of the new name (merge them instead).
    pub fn rename_class(&mut self, from: &str, to: &str) -> Result<(), DbError> {
        let to = check_name(to)?;
        self.edit(&format!("rename {from} to {to}"), |conn| {
            let id = need(conn, from)?;
            if find(conn, to)?.is_some_and(|other| other != id) {
                return Err(DbError::Invalid(format!(
                    "a class called {to} exists already: merge the two instead"
                )));
            }
            conn.execute(
                "UPDATE classes SET name = ?2 WHERE id = ?1",
                params![id, to],
            )?;
            // Its place goes with it; the old name keeps it too, for undoing.
            let sql = "INSERT OR REPLACE INTO class_places (name, place) \
                SELECT ?2, place FROM class_places WHERE name = ?1";
            conn.execute(sql, params![from, to])?;
            Ok(())
        })
    }

    /// Moves all samples of the classes `from` to the class `into`, which is created if it does not exist, and removes the
    /// emptied classes, as one step. Returns the number of samples moved.
    ///
    /// # Errors
    /// [`DbError::Unknown`] if a class of `from` does not exist; [`DbError::Invalid`] if `into` is not a valid name.
    pub fn merge_classes(&mut self, from: &[String], into: &str) -> Result<usize, DbError> {
        self.edit(&format!("merge {} into {into}", from.join(", ")), |conn| {
            let olds = from
                .iter()
                .map(|name| need(conn, name))
                .collect::<Result<Vec<_>, _>>()?;
            let target = find_or_make(conn, into)?;
            let mut moved = 0;
            for old in olds.into_iter().filter(|old| *old != target) {
                moved += move_samples(conn, "class", old, target)?;
                conn.prepare_cached("DELETE FROM classes WHERE id = ?1")?
                    .execute(params![old])?;
            }
            Ok(moved)
        })
    }

    /// Moves samples, of any class, to the class `into`, which is created if it does not exist, as one step. Returns the
    /// number of samples moved.
    ///
    /// # Errors
    /// [`DbError::Unknown`] if a sample does not exist; [`DbError::Invalid`] if `into` is not a valid name.
    pub fn split_class(&mut self, samples: &[SampleId], into: &str) -> Result<usize, DbError> {
        let count = counted(samples.len(), "sample");
        self.edit(&format!("move {count} to {into}"), |conn| {
            let mut known = conn.prepare_cached("SELECT 1 FROM samples WHERE id = ?1")?;
            for id in samples {
                if !known.exists(params![id.0])? {
                    return Err(DbError::unknown("sample", &format!("#{}", id.0)));
                }
            }
            let target = find_or_make(conn, into)?;
            samples.iter().try_fold(0, |moved, id| {
                Ok(moved + move_samples(conn, "id", id.0, target)?)
            })
        })
    }

    /// Forgets a class and its samples.
    ///
    /// # Errors
    /// There is no such class.
    pub fn remove_class(&mut self, name: &str) -> Result<(), DbError> {
        self.edit(&format!("remove {name}"), |conn| {
            let id = need(conn, name)?;
            conn.execute("DELETE FROM classes WHERE id = ?1", params![id])?;
            Ok(())
        })
    }

    /// Turns a class into background: removes the class with its samples, and tags as [background](BACKGROUND) the clips whose accepted
    /// samples are all of it. Returns the number of tagged clips.
    ///
    /// # Errors
    /// There is no such class.
    pub fn class_is_background(&mut self, name: &str) -> Result<usize, DbError> {
        self.edit(&format!("{name} is background"), |conn| {
            let id = need(conn, name)?;
            let tagged = conn.execute(
                "INSERT OR IGNORE INTO tags (clip, tag) SELECT clip, ?2 FROM samples WHERE state = 'accepted' \
                 GROUP BY clip HAVING min(class = ?1) = 1",
                params![id, BACKGROUND],
            )?;
            conn.execute("DELETE FROM classes WHERE id = ?1", params![id])?;
            Ok(tagged)
        })
    }

    /// Forgets every class whose name matches a pattern (`*` any text, `?` one character), and their samples, as one
    /// step. Gives how many classes and samples there were.
    ///
    /// # Errors
    /// No class's name matches.
    pub fn remove_classes(&mut self, pattern: &str) -> Result<(usize, usize), DbError> {
        self.edit(&format!("remove {pattern}"), |conn| {
            let samples: i64 = conn.query_row(
                "SELECT count(*) FROM samples s JOIN classes n ON n.id = s.class WHERE n.name GLOB ?1 OR n.name = ?1",
                params![pattern],
                |row| row.get(0),
            )?;
            let sql = "DELETE FROM classes WHERE name GLOB ?1 OR name = ?1";
            match conn.execute(sql, params![pattern])? {
                0 => Err(names::unknown(conn, "class", pattern)),
                classes => Ok((classes, samples.max(0) as usize)),
            }
        })
    }
}
