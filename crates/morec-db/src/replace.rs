//! Replaces the file of a clip. Name, tags and labels stay with the clip; labels and cuts after the new end are removed.

use std::path::Path;

use morec::files::FileReader;
use rusqlite::{Connection, params};

use crate::import::{PreparedFile, insert_file, make, skeleton_of};
use crate::kept::KeptClip;
use crate::labels::{self, DbSample, SampleFilter};
use crate::{ClipId, ClipUpdate, DbError, MotionDb, clips, rows};

/// Result of replacing the file of a clip.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Replaced {
    /// Name of the clip.
    pub clip: String,
    /// Length before, seconds.
    pub before_secs: f64,
    /// Length after, seconds.
    pub after_secs: f64,
    /// Samples that are where they were, in seconds, or the whole clip as before.
    pub kept: usize,
    /// Samples that end behind the new clip's end: removed.
    pub removed: Vec<DbSample>,
    /// Cuts, which were of the old motion: removed.
    pub cuts: usize,
    /// Repairs and doubts from reading the file.
    pub warnings: Vec<String>,
}

impl MotionDb {
    /// Puts the motion of the file at `path` in the place of a clip's, as one step. The clip keeps its number, its name and
    /// what is known about it; its samples stay where they are in time if the new motion is long enough.
    ///
    /// # Errors
    /// There is no such clip; the file cannot be used, holds several clips, or is in the database already.
    pub fn replace_clip(
        &mut self,
        name: &str,
        path: &Path,
        reader: &FileReader,
    ) -> Result<Replaced, DbError> {
        self.find_clip(name)?;
        let refuse = |why: String| Err(DbError::Invalid(format!("{}: {why}", path.display())));
        let known = self.known_hashes()?;
        let clip = match make(path, reader, &ClipUpdate::default(), &known) {
            PreparedFile::Refused(reason) | PreparedFile::TooLarge(reason) => {
                return refuse(reason);
            }
            PreparedFile::Known(file) => {
                let sql =
                    "SELECT coalesce(group_concat(name, ', '), '') FROM clips WHERE file = ?1";
                let names: String = self.conn.query_row(sql, params![file], |row| row.get(0))?;
                return refuse(format!(
                    "the database contains this motion already, as {names}"
                ));
            }
            PreparedFile::New(mut clips) if clips.len() == 1 => clips.remove(0),
            PreparedFile::New(clips) => {
                let count = clips.len();
                return refuse(format!(
                    "expected one clip, found {count}; choose one, as in FILE#2"
                ));
            }
        };
        let after_secs = clip.frames as f64 / clip.rate_hz;
        // Half a frame is no difference.
        let end = after_secs + 0.5 / clip.rate_hz;
        let what = format!("replace the file of clip {name}");
        let (old, kept, removed, cuts) = self.edit(&what, |conn| {
            // Again within the transaction: another program may have removed the clip while the file was read.
            let old = clips::find(conn, name)?;
            let filter = SampleFilter {
                clip: Some(old.id),
                ..SampleFilter::default()
            };
            let samples = labels::list(conn, &filter)?.into_iter();
            let (kept, removed): (Vec<DbSample>, Vec<DbSample>) =
                samples.partition(|sample| sample.whole_clip || sample.stop_secs <= end);
            put(conn, old.id, path, &clip)?;
            for sample in &removed {
                let sql = "DELETE FROM samples WHERE id = ?1";
                conn.prepare_cached(sql)?.execute(params![sample.id.0])?;
            }
            let sql = "UPDATE samples SET stop_secs = ?2 \
                WHERE clip = ?1 AND stop_secs <> ?2 AND (whole_clip OR stop_secs > ?2)";
            conn.execute(sql, params![old.id.0, after_secs])?;
            let sql = "DELETE FROM segments WHERE clip = ?1";
            let cuts = conn.execute(sql, params![old.id.0])?;
            Ok((old, kept, removed, cuts))
        })?;
        Ok(Replaced {
            clip: old.name.clone(),
            before_secs: old.duration_secs(),
            after_secs,
            kept: kept.len(),
            removed,
            cuts,
            warnings: clip.file.warnings,
        })
    }
}

/// Makes `clip` the motion of the clip numbered `id`; forgets the file it had, if no other clip is from it.
fn put(conn: &Connection, id: ClipId, path: &Path, clip: &KeptClip) -> Result<(), DbError> {
    let file = insert_file(conn, path, &clip.file)?;
    let skeleton = skeleton_of(conn, clip)?;
    conn.execute(
        "UPDATE clips SET file = ?2, character = ?3, skeleton = ?4, frames = ?5, rate_hz = ?6, rest_frames = ?7, \
         repaired_frames = ?8, roles = ?9, facts = ?10, max_angle_rad = ?11, max_position_metres = ?12, motion = ?13 \
         WHERE id = ?1",
        params![
            id.0,
            file,
            clip.character as i64,
            skeleton,
            clip.frames as i64,
            clip.rate_hz,
            clip.rest_frames as i64,
            clip.repaired_frames as i64,
            clip.roles,
            clip.facts,
            clip.max_angle_rad,
            clip.max_position_metres,
            clip.motion,
        ],
    )?;
    rows::keep(conn, id, &clip.recipe, clip.bones, &clip.rows)?;
    conn.execute(
        "DELETE FROM files WHERE NOT EXISTS (SELECT 1 FROM clips c WHERE c.file = files.id)",
        [],
    )?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labels::{NewSample, SampleState};
    use crate::testing::{database_of_waves, waves, write_bvh};

    fn sample(clip: ClipId, class: &str, extent: (f64, f64), whole_clip: bool) -> NewSample {
        NewSample {
            clip,
            class: class.to_owned(),
            start_secs: extent.0,
            stop_secs: extent.1,
            whole_clip,
            state: SampleState::Accepted,
            score: None,
        }
    }

    /// Labels follow or are named, and undo brings back motion, rows, labels and file.
    #[test]
    fn labels_follow_a_replaced_file() {
        let (folder, mut db) = database_of_waves(1);
        let take = waves(1).remove(0);
        let name = take.clip.name.clone();
        let info = db.find_clip(&name).unwrap();
        let length = info.duration_secs();
        let given = [
            sample(info.id, "near", (0.1, 0.5), false),
            sample(info.id, "late", (length - 0.5, length), false),
            sample(info.id, "all", (0.0, length), true),
        ];
        db.add_samples(&given, "user").unwrap();
        let before = (
            db.clip(info.id).unwrap(),
            db.samples(&SampleFilter::default()).unwrap(),
            db.rows(&Default::default(), &()).unwrap(),
        );

        let mut shorter = take.clip.clone();
        let joints = shorter.skeleton.len();
        shorter.frames -= (shorter.rate_hz * 1.0) as usize;
        shorter.rotations.truncate(shorter.frames * joints);
        for track in &mut shorter.tracks {
            track.positions.truncate(shorter.frames);
        }
        let path = write_bvh(folder.path(), "shorter", &shorter);
        let replaced = db.replace_clip(&name, &path, &FileReader::default());
        let replaced = replaced.unwrap();
        let classes: Vec<&str> = replaced.removed.iter().map(|s| s.class.as_str()).collect();
        assert_eq!((replaced.kept, classes), (2, vec!["late"]));
        let now = db.find_clip(&name).unwrap();
        assert_eq!((now.id, now.frames), (info.id, shorter.frames));
        let samples = db.samples(&SampleFilter::default()).unwrap();
        let all = samples.iter().find(|s| s.class == "all").unwrap();
        assert!(all.whole_clip && (all.stop_secs - now.duration_secs()).abs() < 1e-9);
        assert_ne!(db.rows(&Default::default(), &()).unwrap(), before.2);
        assert!(db.check().unwrap().faults.is_empty());

        db.undo(None).unwrap();
        assert_eq!(db.clip(info.id).unwrap(), before.0);
        assert_eq!(db.samples(&SampleFilter::default()).unwrap(), before.1);
        assert_eq!(db.rows(&Default::default(), &()).unwrap(), before.2);
        assert!(db.check().unwrap().faults.is_empty());
        db.redo(None).unwrap();
        assert_eq!(db.find_clip(&name).unwrap().frames, shorter.frames);
        assert_ne!(db.rows(&Default::default(), &()).unwrap(), before.2);
    }

    #[test]
    fn what_is_there_already_replaces_nothing() {
        let (folder, mut db) = database_of_waves(2);
        let takes = waves(2);
        let path = write_bvh(folder.path(), "again", &takes[1].clip);
        let error = db
            .replace_clip(&takes[0].clip.name, &path, &FileReader::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains(&takes[1].clip.name), "{error}");
        std::fs::write(&path, "no motion").unwrap();
        let reader = FileReader::default();
        assert!(
            db.replace_clip(&takes[0].clip.name, &path, &reader)
                .is_err()
        );
        assert_eq!(db.history().unwrap().len(), 1);
    }
}
