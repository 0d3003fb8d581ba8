//! Feature rows of clips, kept ready in steps of a byte.
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
    const METHOD: u32 = 1;
    format!("{METHOD} {}", serde_json::to_string(params).unwrap_or_default())
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

/// The rows of a clip as they will be read again: rounded to bytes.
pub(crate) fn rows_of(stored: &StoredClip, params: &FeatureParams) -> (BoneSet, Rows) {
    let bones = bones_of_clip(&stored.clip, &stored.roles, &stored.rest);
    (bones, rows_of_clip(&stored.clip, &stored.roles, &stored.rest, bones, params))
}

fn bits(bones: BoneSet) -> i64 {
    bones.indices().fold(0, |bits, bone| bits | 1 << bone)
}

fn bones_of_bits(bits: i64) -> BoneSet {
    (0..morec::features::BONES).filter(|b| bits >> b & 1 == 1).fold(BoneSet::NONE, BoneSet::with)
}

/// A step for each column (little-endian `f32`), then a signed byte for each value, row after row.
pub(crate) fn encode(rows: &Rows) -> Vec<u8> {
    let mut steps = vec![0f32; rows.dim()];
    for row in rows.iter() {
        for (step, value) in steps.iter_mut().zip(row) {
            *step = step.max(value.abs());
        }
    }
    steps.iter_mut().for_each(|step| *step /= 127.0);
    let mut bytes: Vec<u8> = steps.iter().flat_map(|step| step.to_le_bytes()).collect();
    bytes.reserve(rows.values().len());
    for row in rows.iter() {
        bytes.extend(row.iter().zip(&steps).map(|(value, step)| {
            let steps = if *step > 0.0 { (value / step).round() } else { 0.0 };
            steps.clamp(-127.0, 127.0) as i8 as u8
        }));
    }
    bytes
}

/// `None` for bytes of another width.
pub(crate) fn decode(bytes: &[u8], dim: usize) -> Option<Rows> {
    if dim == 0 || bytes.len() < 4 * dim || !(bytes.len() - 4 * dim).is_multiple_of(dim) {
        return None;
    }
    let (steps, values) = bytes.split_at(4 * dim);
    let steps: Vec<f32> =
        steps.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    let values =
        values.chunks_exact(dim).flat_map(|row| row.iter().zip(&steps).map(|(v, s)| f32::from(*v as i8) * s));
    Some(Rows::from_values(dim, values.collect()))
}

impl MotionDb {
    /// The rows of every clip that shows any bone, in the order of clip numbers. What is not kept ready, or by another
    /// recipe, is made in parallel and, if the database may be written, kept.
    pub fn rows(
        &mut self,
        params: &FeatureParams,
        progress: &dyn Progress,
    ) -> Result<Vec<ClipRows>, DbError> {
        self.refresh_rows(params, progress)?;
        let mut statement = self
            .conn
            .prepare("SELECT clip, bones, bytes FROM feature_rows WHERE recipe = ?1 ORDER BY clip")?;
        let kept = statement.query_map(params![recipe(params)], |row| {
            Ok((ClipId(row.get(0)?), row.get::<_, i64>(1)?, row.get::<_, Vec<u8>>(2)?))
        })?;
        let mut all = Vec::new();
        for found in kept {
            let (clip, bits, bytes) = found?;
            let bones = bones_of_bits(bits);
            if let Some(rows) = decode(&bytes, row_dim(bones)).filter(|_| !bones.is_empty()) {
                all.push(ClipRows { clip, bones, rows });
            }
        }
        Ok(all)
    }

    /// Makes the rows that are missing or of another recipe; gives how many.
    pub fn refresh_rows(
        &mut self,
        params: &FeatureParams,
        progress: &dyn Progress,
    ) -> Result<usize, DbError> {
        let recipe = recipe(params);
        let sql = "SELECT id FROM clips WHERE id NOT IN (SELECT clip FROM feature_rows WHERE recipe = ?1)";
        let stale: Vec<ClipId> = {
            let mut statement = self.conn.prepare(sql)?;
            statement.query_map(params![recipe], |row| Ok(ClipId(row.get(0)?)))?.collect::<Result<_, _>>()?
        };
        for (done, batch) in stale.chunks(64).enumerate() {
            if progress.cancelled() {
                return Err(DbError::Cancelled);
            }
            progress.report("feature rows", done * 64, stale.len());
            let clips: Vec<(ClipId, StoredClip)> =
                batch.iter().map(|id| Ok((*id, self.clip(*id)?))).collect::<Result<_, DbError>>()?;
            let made: Vec<(ClipId, BoneSet, Vec<u8>)> = clips
                .par_iter()
                .map(|(id, stored)| {
                    let (bones, rows) = rows_of(stored, params);
                    (*id, bones, encode(&rows))
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
    let sql = "INSERT OR REPLACE INTO feature_rows (clip, recipe, bones, bytes) VALUES (?1, ?2, ?3, ?4)";
    conn.prepare(sql)?.execute(params![clip.0, recipe, bits(bones), bytes])?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn bytes_are_within_half_a_step(values in prop::collection::vec(-9f32..9.0, 0..80)) {
            let rows = Rows::from_values(5, values);
            let again = decode(&encode(&rows), 5).unwrap();
            prop_assert_eq!(again.len(), rows.len());
            for column in 0..5 {
                let most = rows.iter().map(|r| r[column].abs()).fold(0.0, f32::max);
                for (a, b) in rows.iter().zip(again.iter()) {
                    prop_assert!((a[column] - b[column]).abs() <= most / 254.0 + 1e-5);
                }
            }
            // What was read is kept as it is, however often.
            prop_assert_eq!(decode(&encode(&again), 5).map(|r| r.len()), Some(again.len()));
        }

        #[test]
        fn any_bytes_are_rows_or_nothing(bytes in prop::collection::vec(any::<u8>(), 0..200), dim in 0usize..9) {
            let _ = decode(&bytes, dim);
        }
    }

    #[test]
    fn bone_sets_are_bits() {
        for set in [BoneSet::ALL, BoneSet::NONE, BoneSet::NONE.with(0).with(10)] {
            assert_eq!(bones_of_bits(bits(set)), set);
        }
    }
}
