//! Feature rows of clips, kept ready in about three bits a value ([`Rows::to_packed`]).
//!
//! Rows are those of [`morec::features`] over every bone a clip shows. They are made of the stored motion, so that
//! making them again gives them again.

use std::time::Duration;

use morec::features::{BoneSet, FeatureParams, RowLayout, Rows, bones_of_clip, rows_of_clip};
use morec::progress::Progress;
use rayon::prelude::*;
use rusqlite::params;

use crate::{ClipId, DbError, MotionDb, StoredClip};

/// Says how rows are made. Rows of another recipe are made again.
pub(crate) fn recipe(params: &FeatureParams) -> String {
    // Counts up when the method changes while its figures do not.
    const METHOD: u32 = 3;
    format!(
        "{METHOD} {}",
        serde_json::to_string(params).unwrap_or_default()
    )
}

/// A clip's rows and the bones they cover.
#[derive(Debug, Clone, PartialEq)]
pub struct ClipRows {
    /// The clip that the rows describe.
    pub clip: ClipId,
    /// Bones of which the rows speak.
    pub bones: BoneSet,
    /// A row for each tick; row `i` ends at `(i + 1) / tick_hz` seconds.
    pub rows: Rows,
}

/// The rows of a clip before they are rounded for keeping.
pub(crate) fn rows_of(stored: &StoredClip, params: &FeatureParams) -> (BoneSet, Rows) {
    let bones = bones_of_clip(&stored.clip, &stored.roles, &stored.rest);
    (
        bones,
        rows_of_clip(&stored.clip, &stored.roles, &stored.rest, bones, params),
    )
}

pub(crate) fn bits(bones: BoneSet) -> i64 {
    bones.indices().fold(0, |bits, bone| bits | 1 << bone)
}

/// The bones of a set kept as a number, a bit each.
pub fn bones_of_bits(bits: i64) -> BoneSet {
    (0..morec::features::BONES)
        .filter(|b| bits >> b & 1 == 1)
        .fold(BoneSet::NONE, BoneSet::with)
}

/// A checksum of kept rows and of all that says how to read them.
fn sum(recipe: &str, bits: i64, bytes: &[u8]) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&(recipe.len() as u64).to_le_bytes());
    hasher.update(recipe.as_bytes());
    hasher.update(&bits.to_le_bytes());
    hasher.update(bytes);
    *hasher.finalize().as_bytes()
}

/// Rows as they lie in the file.
struct Kept {
    clip: ClipId,
    recipe: String,
    bits: i64,
    bytes: Vec<u8>,
    sum: Option<Vec<u8>>,
}

impl Kept {
    fn is_whole(&self) -> bool {
        let sum = sum(&self.recipe, self.bits, &self.bytes);
        self.sum.as_deref() == Some(sum.as_slice())
    }
}

impl MotionDb {
    /// The feature rows of every clip with at least one bone, in the order of clip numbers. Rows that are not stored, are
    /// damaged, or were made with other parameters are computed in parallel and, if the database is writable, stored.
    ///
    /// # Errors
    /// [`DbError::Cancelled`] by `progress`; [`DbError::Damaged`] motion; the database cannot be read.
    pub fn rows(
        &mut self,
        params: &FeatureParams,
        progress: &dyn Progress,
    ) -> Result<Vec<ClipRows>, DbError> {
        let (whole, missing) = self.rows_at_hand(params)?;
        let made = match self.is_read_only()? {
            true => self.make_rows(params, &missing)?,
            false => self.keep_rows(params, &missing, progress)?,
        };
        Ok(in_order(whole, made))
    }

    /// Like [`rows`](Self::rows), for a database opened for reading only: missing rows are stored for the next reader over a
    /// second connection. If that is not possible (a read-only file, another program writing, a full disk), they are
    /// computed and not stored.
    ///
    /// # Errors
    /// [`DbError::Cancelled`] by `progress`; [`DbError::Damaged`] motion; the database cannot be read.
    pub fn rows_kept_if_writable(
        &self,
        params: &FeatureParams,
        progress: &dyn Progress,
    ) -> Result<Vec<ClipRows>, DbError> {
        let (whole, missing) = self.rows_at_hand(params)?;
        let keep = || {
            let mut writer = Self::open(self.path())?;
            // Rows are made sooner than another writer ends.
            writer.conn.busy_timeout(Duration::ZERO)?;
            writer.keep_rows(params, &missing, progress)
        };
        let made = match missing.is_empty() {
            true => Vec::new(),
            false => match keep() {
                Err(DbError::Cancelled) => return Err(DbError::Cancelled),
                kept => kept.or_else(|_| self.make_rows(params, &missing))?,
            },
        };
        Ok(in_order(whole, made))
    }

    /// The rows that are kept ready and whole, and the clips whose rows have to be made.
    fn rows_at_hand(
        &self,
        params: &FeatureParams,
    ) -> Result<(Vec<ClipRows>, Vec<ClipId>), DbError> {
        let recipe = recipe(params);
        let mut missing = self.stale(&recipe)?;
        let kept = self.kept(&recipe)?;
        let (whole, damaged): (Vec<Kept>, Vec<Kept>) =
            kept.into_par_iter().partition(Kept::is_whole);
        missing.extend(damaged.iter().map(|kept| kept.clip));
        let unpacked = whole
            .into_par_iter()
            .filter_map(|kept| unpacked(kept.clip, kept.bits, &kept.bytes, params));
        Ok((unpacked.collect(), missing))
    }

    fn kept(&self, recipe: &str) -> Result<Vec<Kept>, DbError> {
        let mut statement = self.conn.prepare(
            "SELECT clip, recipe, bones, bytes, sum FROM feature_rows WHERE recipe = ?1",
        )?;
        let kept = statement.query_map(params![recipe], |row| {
            Ok(Kept {
                clip: ClipId(row.get("clip")?),
                recipe: row.get("recipe")?,
                bits: row.get("bones")?,
                bytes: row.get("bytes")?,
                sum: row.get("sum")?,
            })
        })?;
        Ok(kept.collect::<Result<_, _>>()?)
    }

    /// Clips whose rows are missing or of another recipe.
    fn stale(&self, recipe: &str) -> Result<Vec<ClipId>, DbError> {
        let sql = "SELECT id FROM clips WHERE id NOT IN (SELECT clip FROM feature_rows WHERE recipe = ?1)";
        let mut statement = self.conn.prepare(sql)?;
        Ok(statement
            .query_map(params![recipe], |row| Ok(ClipId(row.get(0)?)))?
            .collect::<Result<_, _>>()?)
    }

    /// Clips whose kept rows, of whatever recipe, are damaged; and how many rows there are.
    pub(crate) fn damaged_rows(&self) -> Result<(Vec<ClipId>, usize), DbError> {
        let mut recipes = self
            .conn
            .prepare("SELECT DISTINCT recipe FROM feature_rows")?;
        let recipes: Vec<String> = recipes
            .query_map([], |row| row.get(0))?
            .collect::<Result<_, _>>()?;
        let (mut damaged, mut count) = (Vec::new(), 0);
        for recipe in &recipes {
            let kept = self.kept(recipe)?;
            count += kept.len();
            let broken = kept.par_iter().filter(|kept| !kept.is_whole());
            damaged.extend(broken.map(|kept| kept.clip).collect::<Vec<_>>());
        }
        Ok((damaged, count))
    }

    /// Rows made now, as they would be read again.
    fn make_rows(
        &self,
        params: &FeatureParams,
        clips: &[ClipId],
    ) -> Result<Vec<ClipRows>, DbError> {
        let stored: Vec<(ClipId, StoredClip)> = clips
            .iter()
            .map(|id| Ok((*id, self.clip(*id)?)))
            .collect::<Result<_, DbError>>()?;
        let made = stored.par_iter().filter_map(|(clip, stored)| {
            let (bones, rows) = rows_of(stored, params);
            unpacked(*clip, bits(bones), &rows.to_packed(), params)
        });
        Ok(made.collect())
    }

    /// Computes and stores the feature rows that are missing, damaged or made with other parameters. Returns the number of clips.
    ///
    /// # Errors
    /// [`DbError::Cancelled`] by `progress`; the database cannot be written.
    pub fn refresh_rows(
        &mut self,
        params: &FeatureParams,
        progress: &dyn Progress,
    ) -> Result<usize, DbError> {
        let mut missing = self.stale(&recipe(params))?;
        missing.extend(self.damaged_rows()?.0);
        missing.sort();
        missing.dedup();
        self.keep_rows(params, &missing, progress)?;
        Ok(missing.len())
    }

    /// Makes rows of clips and keeps them, as caches: no step of the history.
    fn keep_rows(
        &mut self,
        params: &FeatureParams,
        clips: &[ClipId],
        progress: &dyn Progress,
    ) -> Result<Vec<ClipRows>, DbError> {
        let recipe = recipe(params);
        let mut all = Vec::with_capacity(clips.len());
        for (done, batch) in clips.chunks(64).enumerate() {
            if progress.cancelled() {
                return Err(DbError::Cancelled);
            }
            progress.report("feature rows", done * 64, clips.len());
            let stored: Vec<(ClipId, StoredClip)> = batch
                .iter()
                .map(|id| Ok((*id, self.clip(*id)?)))
                .collect::<Result<_, DbError>>()?;
            let made: Vec<(ClipId, BoneSet, Vec<u8>)> = stored
                .par_iter()
                .map(|(id, stored)| {
                    let (bones, rows) = rows_of(stored, params);
                    (*id, bones, rows.to_packed())
                })
                .collect();
            let tx = self.write()?;
            for (id, bones, bytes) in &made {
                keep(&tx, *id, &recipe, bits(*bones), bytes)?;
                all.extend(unpacked(*id, bits(*bones), bytes, params));
            }
            tx.commit()?;
        }
        Ok(all)
    }
}

/// Rows of all clips, by their numbers.
fn in_order(mut some: Vec<ClipRows>, others: Vec<ClipRows>) -> Vec<ClipRows> {
    some.extend(others);
    some.sort_by_key(|rows| rows.clip);
    some
}

/// Rows as they are read; none of a clip that shows no bone.
pub(crate) fn unpacked(
    clip: ClipId,
    bits: i64,
    bytes: &[u8],
    params: &FeatureParams,
) -> Option<ClipRows> {
    let bones = bones_of_bits(bits);
    let rows = Rows::from_packed(bytes, RowLayout::of(bones).dim(), params)
        .filter(|_| !bones.is_empty())?;
    Some(ClipRows { clip, bones, rows })
}

pub(crate) fn keep(
    conn: &rusqlite::Connection,
    clip: ClipId,
    recipe: &str,
    bones: i64,
    bytes: &[u8],
) -> Result<(), DbError> {
    let sql = "INSERT OR REPLACE INTO feature_rows (clip, recipe, bones, bytes, sum) VALUES (?1, ?2, ?3, ?4, ?5)";
    let sum = sum(recipe, bones, bytes);
    conn.prepare_cached(sql)?
        .execute(params![clip.0, recipe, bones, bytes, sum])?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bone_sets_are_bits() {
        for set in [BoneSet::BODY, BoneSet::NONE, BoneSet::NONE.with(0).with(10)] {
            assert_eq!(bones_of_bits(bits(set)), set);
        }
    }

    /// A database whose kept rows are damaged, and what they were.
    fn damaged() -> (tempfile::TempDir, MotionDb, Vec<ClipRows>) {
        let (folder, mut db) = crate::testing::database_of_waves(2);
        let whole = db.rows(&FeatureParams::default(), &()).unwrap();
        let sql = "UPDATE feature_rows SET bytes = zeroblob(length(bytes))";
        db.conn.execute(sql, []).unwrap();
        assert_eq!(db.check().unwrap().faults.len(), 2);
        (folder, db, whole)
    }

    #[test]
    fn a_reader_keeps_the_rows_it_had_to_make() {
        let (_folder, db, whole) = damaged();
        let reader = MotionDb::open_read_only(db.path()).unwrap();
        let params = FeatureParams::default();
        assert_eq!(reader.rows_kept_if_writable(&params, &()).unwrap(), whole);
        assert_eq!(db.check().unwrap().faults, [""; 0]);
        assert_eq!(reader.rows_at_hand(&params).unwrap(), (whole, Vec::new()));
    }

    #[test]
    fn a_reader_beside_a_writer_makes_rows_and_keeps_none() {
        let (_folder, mut db, whole) = damaged();
        let reader = MotionDb::open_read_only(db.path()).unwrap();
        let params = FeatureParams::default();
        let writing = db.write().unwrap();
        assert_eq!(reader.rows_kept_if_writable(&params, &()).unwrap(), whole);
        drop(writing);
        assert_eq!(db.check().unwrap().faults.len(), 2);
    }
}
