//! Trained indexes stored in the database, with the samples and background that they were trained on, so that changes since
//! training are noticed.

use rusqlite::{Connection, OptionalExtension, params};

use serde_json::json;

use crate::digest;
use crate::history::record;
use crate::labels::{self, DbSample, SampleFilter, SampleState};
use crate::time::now_secs;
use crate::{ClipInfo, DbError, MotionDb, background, names};

/// An index without its bytes.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct IndexInfo {
    /// Name of the index.
    pub name: String,
    /// Time of training, seconds since 1970.
    pub trained_secs: i64,
    /// Size in bytes.
    pub bytes: usize,
    /// Number of samples it was trained on.
    pub samples: usize,
    /// True if accepted samples or the clips that are background have changed since.
    pub stale: bool,
    /// What taught it: [`training_data`] of then.
    #[serde(skip)]
    pub taught: String,
}

/// Keeps an index with what taught it.
fn put(conn: &Connection, name: &str, taught: &str, bytes: &[u8]) -> Result<(), DbError> {
    conn.execute(
        "INSERT INTO indexes (name, trained_secs, samples, bytes) VALUES (?1, ?2, ?3, ?4) \
         ON CONFLICT (name) DO UPDATE SET trained_secs = excluded.trained_secs, \
         samples = excluded.samples, bytes = excluded.bytes",
        params![name, now_secs(), taught, bytes],
    )?;
    Ok(())
}

/// Training data of an index, as it is kept with the index: clip, class, start and stop of every accepted sample, by clip and
/// time, then the name alone of every clip that is background and has none, by name.
pub fn training_data<'a>(
    accepted: impl IntoIterator<Item = &'a DbSample>,
    background: impl IntoIterator<Item = &'a ClipInfo>,
) -> String {
    let row = |s: &DbSample| json!((&s.clip_name, &s.class, s.start_secs, s.stop_secs));
    let rows = accepted.into_iter().map(row);
    let rows = rows.chain(background.into_iter().map(|clip| json!([clip.name])));
    serde_json::Value::Array(rows.collect()).to_string()
}

/// Training data of an index made now.
fn taught(conn: &Connection) -> Result<String, DbError> {
    let filter = SampleFilter {
        state: Some(SampleState::Accepted),
        ..SampleFilter::default()
    };
    let accepted = labels::list(conn, &filter)?;
    Ok(training_data(
        &accepted,
        &background::find(conn, &[])?.clips,
    ))
}

impl MotionDb {
    /// Stores an index file, as trained on the present accepted samples, under a name, and replaces an index of that name.
    /// One step of the history.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn store_index(&mut self, name: &str, bytes: &[u8]) -> Result<(), DbError> {
        self.edit(&format!("keep the index {name}"), |conn| {
            put(conn, name, &taught(conn)?, bytes)
        })
    }

    /// Stores the latest index under a name, without a step of the history, so that undo after training undoes the last
    /// label and not the training.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn store_last_index(&mut self, name: &str, bytes: &[u8]) -> Result<(), DbError> {
        let tx = self.write()?;
        let recording = record(&tx, "", None, "")?;
        put(&tx, name, &taught(&tx)?, bytes)?;
        digest::follow(&tx, recording.step, recording.after)?;
        tx.execute("DELETE FROM edits WHERE id = ?1", params![recording.step])?;
        tx.commit()?;
        Ok(())
    }

    /// The bytes of the index file with this name.
    ///
    /// # Errors
    /// [`DbError::Unknown`], with the nearest names, if no index is called so.
    pub fn index(&self, name: &str) -> Result<Vec<u8>, DbError> {
        let sql = "SELECT bytes FROM indexes WHERE name = ?1";
        let found = self
            .conn
            .query_row(sql, params![name], |row| row.get(0))
            .optional()?;
        found.ok_or_else(|| names::unknown(&self.conn, "index", name))
    }

    /// Removes an index, as one step.
    ///
    /// # Errors
    /// [`DbError::Unknown`], with the nearest names, if no index is called so.
    pub fn remove_index(&mut self, name: &str) -> Result<(), DbError> {
        self.edit(&format!("remove the index {name}"), |conn| {
            let sql = "DELETE FROM indexes WHERE name = ?1";
            match conn.execute(sql, params![name])? {
                0 => Err(names::unknown(conn, "index", name)),
                _ => Ok(()),
            }
        })
    }

    /// All stored indexes, sorted by name, with their size and whether labels or background have changed since training.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn indexes(&self) -> Result<Vec<IndexInfo>, DbError> {
        let taught = taught(&self.conn)?;
        let sql = "SELECT name, trained_secs, length(bytes) AS bytes, samples, (SELECT count(*) FROM json_each(samples) \
                   WHERE json_array_length(value) > 1) AS count FROM indexes ORDER BY name";
        let mut statement = self.conn.prepare(sql)?;
        let indexes = statement.query_map([], |row| {
            let by: String = row.get("samples")?;
            Ok(IndexInfo {
                name: row.get("name")?,
                trained_secs: row.get("trained_secs")?,
                bytes: row.get::<_, i64>("bytes")? as usize,
                samples: row.get::<_, i64>("count")? as usize,
                stale: by != taught,
                taught: by,
            })
        })?;
        Ok(indexes.collect::<Result<_, _>>()?)
    }
}
