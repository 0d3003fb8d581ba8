//! Trained indexes, kept with what taught them.

use rusqlite::{Connection, OptionalExtension, params};

use crate::history::{digest, record};
use crate::time::now_secs;
use crate::{DbError, MotionDb, names};

/// An index without its bytes.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct IndexInfo {
    /// Its name.
    pub name: String,
    /// Time of training, seconds since 1970.
    pub trained_secs: i64,
    /// Its size.
    pub bytes: usize,
    /// Number of samples it was trained on.
    pub samples: usize,
    /// True if accepted samples or the clips that are background have changed since.
    pub stale: bool,
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

impl MotionDb {
    /// Training data of an index made now: clip, class, start and stop of every accepted sample, then the name alone of every
    /// clip that is background.
    fn taught(&self) -> Result<String, DbError> {
        let filter = crate::labels::SampleFilter {
            state: Some(crate::labels::SampleState::Accepted),
            ..Default::default()
        };
        let samples = self.samples(&filter)?.into_iter();
        let rows =
            samples.map(|s| serde_json::json!((s.clip_name, s.class, s.start_secs, s.stop_secs)));
        let background = self.background(&[])?.clips.into_iter();
        let rows = rows.chain(background.map(|clip| serde_json::json!([clip.name])));
        Ok(serde_json::Value::Array(rows.collect()).to_string())
    }

    /// Keeps an index that the accepted samples of now have taught, in place of one of the same name.
    pub fn store_index(&mut self, name: &str, bytes: &[u8]) -> Result<(), DbError> {
        let taught = self.taught()?;
        self.edit(&format!("keep the index {name}"), |conn| {
            put(conn, name, &taught, bytes)
        })
    }

    /// Keeps the index that was trained last under a name, in place of the one before. It is no step of the history: taking back a
    /// label after training takes back the label.
    pub fn store_last_index(&mut self, name: &str, bytes: &[u8]) -> Result<(), DbError> {
        let taught = self.taught()?;
        let tx = self.write()?;
        let recording = record(&tx, "", None, "")?;
        put(&tx, name, &taught, bytes)?;
        digest::follow(&tx, recording.step, recording.after)?;
        tx.execute("DELETE FROM edits WHERE id = ?1", params![recording.step])?;
        tx.commit()?;
        Ok(())
    }

    /// The bytes of an index.
    pub fn index(&self, name: &str) -> Result<Vec<u8>, DbError> {
        let sql = "SELECT bytes FROM indexes WHERE name = ?1";
        let found = self
            .conn
            .query_row(sql, params![name], |row| row.get(0))
            .optional()?;
        found.ok_or_else(|| names::unknown(&self.conn, "index", name))
    }

    /// Forgets an index.
    ///
    /// # Errors
    /// There is none of this name.
    pub fn remove_index(&mut self, name: &str) -> Result<(), DbError> {
        self.edit(&format!("remove the index {name}"), |conn| {
            let sql = "DELETE FROM indexes WHERE name = ?1";
            match conn.execute(sql, params![name])? {
                0 => Err(names::unknown(conn, "index", name)),
                _ => Ok(()),
            }
        })
    }

    /// All indexes, by name.
    pub fn indexes(&self) -> Result<Vec<IndexInfo>, DbError> {
        let taught = self.taught()?;
        let sql = "SELECT name, trained_secs, length(bytes) AS bytes, samples, (SELECT count(*) FROM json_each(samples) \
                   WHERE json_array_length(value) > 1) AS count FROM indexes ORDER BY name";
        let mut statement = self.conn.prepare(sql)?;
        let indexes = statement.query_map([], |row| {
            Ok(IndexInfo {
                name: row.get("name")?,
                trained_secs: row.get("trained_secs")?,
                bytes: row.get::<_, i64>("bytes")? as usize,
                samples: row.get::<_, i64>("count")? as usize,
                stale: row.get::<_, String>("samples")? != taught,
            })
        })?;
        Ok(indexes.collect::<Result<_, _>>()?)
    }
}
