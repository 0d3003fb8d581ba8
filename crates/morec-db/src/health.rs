//! Checks a database for damage, and repairs what can be rebuilt (feature rows, checksums). Used by `morec db check`.

use morec::features::FeatureParams;
use morec::index::MotionIndex;
use morec::progress::Progress;

use crate::digest;
use crate::{ClipFilter, DbError, MotionDb};

/// Result of [`MotionDb::check`].
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Health {
    /// Faults, a sentence each; empty if all is well.
    pub faults: Vec<String>,
    /// Clips whose motion was decoded.
    pub clips: usize,
    /// Clips whose feature rows were compared with their checksums.
    pub rows: usize,
    /// Indexes that were read.
    pub indexes: usize,
}

impl MotionDb {
    /// Reads everything: the file's structure, references between tables, checksums of all tables, feature rows and
    /// indexes, and every clip's motion.
    ///
    /// # Errors
    /// The database cannot be read; what is damaged in it is no error but part of the answer.
    pub fn check(&self) -> Result<Health, DbError> {
        let mut faults = self.lines("PRAGMA integrity_check")?;
        faults.retain(|line| line != "ok");
        faults.extend(self.lines(
            "SELECT 'a row of ' || \"table\" || ' points to nothing' FROM pragma_foreign_key_check",
        )?);
        for table in digest::faults(&self.conn)? {
            faults.push(format!(
                "the table of {table} does not match its checksum: it is damaged or was changed by another program"
            ));
        }
        let clips = self.clips(&ClipFilter::default())?;
        for info in &clips {
            if let Err(error) = self.clip(info.id) {
                faults.push(format!(
                    "clip {}: {error}; import its file again",
                    info.name
                ));
            }
        }
        let (damaged, rows) = self.damaged_rows()?;
        for id in damaged {
            let clip = clips.iter().find(|clip| clip.id == id);
            let name = clip.map_or_else(|| format!("#{}", id.0), |clip| clip.name.clone());
            faults.push(format!(
                "clip {name}: its feature rows are damaged; they can be rebuilt with --repair"
            ));
        }
        let indexes = self.indexes()?;
        for index in &indexes {
            if let Err(error) = MotionIndex::from_bytes(&self.index(&index.name)?) {
                faults.push(format!("index {}: {error}; train it again", index.name));
            }
        }
        Ok(Health {
            faults,
            clips: clips.len(),
            rows,
            indexes: indexes.len(),
        })
    }

    /// Makes again what can be made again (feature rows, the file's search trees), and takes the tables as they are for
    /// right: what [`MotionDb::check`] says afterwards is lost. Gives how many clips' rows were made.
    ///
    /// # Errors
    /// The database cannot be written, or a clip's motion is damaged.
    pub fn repair(&mut self, progress: &dyn Progress) -> Result<usize, DbError> {
        self.conn.execute_batch("REINDEX")?;
        let made = self.refresh_rows(&FeatureParams::default(), progress)?;
        let tx = self.write()?;
        digest::take_all(&tx)?;
        tx.commit()?;
        Ok(made)
    }

    fn lines(&self, sql: &str) -> Result<Vec<String>, DbError> {
        let mut statement = self.conn.prepare(sql)?;
        let lines = statement
            .query_map([], |row| row.get(0))?
            .collect::<Result<_, _>>()?;
        Ok(lines)
    }
}
