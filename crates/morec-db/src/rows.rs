//! Feature rows of clips, kept ready in about two bits a value ([`Rows::to_packed`]).
//!
//! Rows are those of [`morec::features`] over every bone a clip shows. They are made of the stored motion, so that
//! making them again gives them again.

use morec::features::{BoneSet, FeatureParams, Rows, bones_of_clip, row_dim, rows_of_clip};
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

/// A clip's rows and the bones they speak of.
#[derive(Debug, Clone, PartialEq)]
pub struct ClipRows {
    /// The clip.
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

fn bits(bones: BoneSet) -> i64 {
    bones.indices().fold(0, |bits, bone| bits | 1 << bone)
}

fn bones_of_bits(bits: i64) -> BoneSet {
    (0..morec::features::BONES)
        .filter(|b| bits >> b & 1 == 1)
        .fold(BoneSet::NONE, BoneSet::with)
}

impl MotionDb {
    /// The rows of every clip that shows any bone, in the order of clip numbers. What is not kept ready, or by another
    /// recipe, is made in parallel and, if the database may be written, kept.
    pub fn rows(
        &mut self,
        params: &FeatureParams,
        progress: &dyn Progress,
    ) -> Result<Vec<ClipRows>, DbError> {
        let stale = if self.is_read_only()? {
            self.make_rows(params, &self.stale(&recipe(params))?)?
        } else {
            Vec::new()
        };
        if stale.is_empty() {
            self.refresh_rows(params, progress)?;
        }
        let mut statement = self.conn.prepare(
            "SELECT clip, bones, bytes FROM feature_rows WHERE recipe = ?1 ORDER BY clip",
        )?;
        let kept = statement.query_map(params![recipe(params)], |row| {
            Ok((
                ClipId(row.get(0)?),
                row.get::<_, i64>(1)?,
                row.get::<_, Vec<u8>>(2)?,
            ))
        })?;
        let kept = kept.collect::<Result<Vec<_>, _>>()?;
        let unpacked = kept.into_par_iter().filter_map(|(clip, bits, bytes)| {
            let bones = bones_of_bits(bits);
            let rows =
                Rows::from_packed(&bytes, row_dim(bones), params).filter(|_| !bones.is_empty())?;
            Some(ClipRows { clip, bones, rows })
        });
        let mut all: Vec<ClipRows> = unpacked.chain(stale).collect();
        all.sort_by_key(|rows| rows.clip);
        Ok(all)
    }

    /// Clips whose rows are missing or of another recipe.
    fn stale(&self, recipe: &str) -> Result<Vec<ClipId>, DbError> {
        let sql = "SELECT id FROM clips WHERE id NOT IN (SELECT clip FROM feature_rows WHERE recipe = ?1)";
        let mut statement = self.conn.prepare(sql)?;
        Ok(statement
            .query_map(params![recipe], |row| Ok(ClipId(row.get(0)?)))?
            .collect::<Result<_, _>>()?)
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
            let rows = Rows::from_packed(&rows.to_packed(params), row_dim(bones), params)
                .filter(|_| !bones.is_empty())?;
            Some(ClipRows {
                clip: *clip,
                bones,
                rows,
            })
        });
        Ok(made.collect())
    }

    /// Makes the rows that are missing or of another recipe; gives how many.
    pub fn refresh_rows(
        &mut self,
        params: &FeatureParams,
        progress: &dyn Progress,
    ) -> Result<usize, DbError> {
        let recipe = recipe(params);
        let stale = self.stale(&recipe)?;
        for (done, batch) in stale.chunks(64).enumerate() {
            if progress.cancelled() {
                return Err(DbError::Cancelled);
            }
            progress.report("feature rows", done * 64, stale.len());
            let clips: Vec<(ClipId, StoredClip)> = batch
                .iter()
                .map(|id| Ok((*id, self.clip(*id)?)))
                .collect::<Result<_, DbError>>()?;
            let made: Vec<(ClipId, BoneSet, Vec<u8>)> = clips
                .par_iter()
                .map(|(id, stored)| {
                    let (bones, rows) = rows_of(stored, params);
                    (*id, bones, rows.to_packed(params))
                })
                .collect();
            let tx = self.write()?;
            for (id, bones, bytes) in &made {
                keep(&tx, *id, &recipe, *bones, bytes)?;
            }
            tx.commit()?;
        }
        Ok(stale.len())
    }
}

pub(crate) fn keep(
    conn: &rusqlite::Connection,
    clip: ClipId,
    recipe: &str,
    bones: BoneSet,
    bytes: &[u8],
) -> Result<(), DbError> {
    let sql =
        "INSERT OR REPLACE INTO feature_rows (clip, recipe, bones, bytes) VALUES (?1, ?2, ?3, ?4)";
    conn.prepare(sql)?
        .execute(params![clip.0, recipe, bits(bones), bytes])?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bone_sets_are_bits() {
        for set in [BoneSet::ALL, BoneSet::NONE, BoneSet::NONE.with(0).with(10)] {
            assert_eq!(bones_of_bits(bits(set)), set);
        }
    }
}
