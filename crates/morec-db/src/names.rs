//! Errors for unknown names, with the nearest existing names as suggestions.

use morec::labels::hint;
use rusqlite::Connection;

use crate::{DbError, MotionDb};

/// Bytes in the name of a class or a clip: with what is escaped of it and an ending it is still a file's.
pub(crate) const LONGEST: usize = 200;

fn column(conn: &Connection, sql: &str) -> Result<Vec<String>, DbError> {
    let mut statement = conn.prepare(sql)?;
    Ok(statement
        .query_map([], |row| row.get(0))?
        .collect::<Result<_, _>>()?)
}

/// The error for a name of this kind that is not there.
pub(crate) fn unknown(conn: &Connection, kind: &'static str, name: &str) -> DbError {
    let sql = match kind {
        "clip" => "SELECT name FROM clips ORDER BY name",
        "class" => "SELECT name FROM classes ORDER BY name",
        "index" => "SELECT name FROM indexes ORDER BY name",
        "person" => "SELECT DISTINCT subject FROM clips WHERE subject IS NOT NULL ORDER BY 1",
        "tag" => "SELECT DISTINCT tag FROM tags ORDER BY 1",
        _ => return DbError::unknown(kind, name),
    };
    match column(conn, sql) {
        Err(error) => error,
        Ok(known) => DbError::Unknown {
            kind,
            name: name.to_owned(),
            hint: hint(name, &known),
        },
    }
}

impl MotionDb {
    /// Checks that there is a class of this name.
    ///
    /// # Errors
    /// [`DbError::Unknown`] with the nearest names.
    pub fn need_class(&self, name: &str) -> Result<(), DbError> {
        let sql = "SELECT 1 FROM classes WHERE name = ?1";
        match self.conn.prepare(sql)?.exists([name])? {
            true => Ok(()),
            false => Err(unknown(&self.conn, "class", name)),
        }
    }

    /// Hint for a clip that is not there: the nearest names, after a semicolon.
    pub fn hint_of_clip(&self, name: &str) -> String {
        match unknown(&self.conn, "clip", name) {
            DbError::Unknown { hint, .. } => hint,
            _ => String::new(),
        }
    }
}
