//! Videos beside clips: a file, and the time of it at which the clip begins.

use std::collections::BTreeMap;

use rusqlite::params;

use crate::{ClipId, DbError, MotionDb, clips};

/// A video of the motion of a clip.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ClipVideo {
    /// Path of its file.
    pub path: String,
    /// Time of the video at which the clip begins, seconds; negative if the clip begins first.
    pub offset_secs: f64,
}

impl MotionDb {
    /// The videos of clips.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn videos(&self) -> Result<BTreeMap<ClipId, ClipVideo>, DbError> {
        let sql = "SELECT clip, path, offset_secs FROM videos";
        let mut statement = self.conn.prepare_cached(sql)?;
        let videos = statement.query_map([], |row| {
            let video = ClipVideo {
                path: row.get("path")?,
                offset_secs: row.get("offset_secs")?,
            };
            Ok((ClipId(row.get("clip")?), video))
        })?;
        Ok(videos.collect::<Result<_, _>>()?)
    }

    /// Sets the video of a clip, replacing an earlier one; `None` removes it. One step of the history.
    ///
    /// # Errors
    /// No such clip; no path, one with control characters, or an offset that is not a number.
    pub fn set_video(&mut self, clip: &str, video: Option<&ClipVideo>) -> Result<(), DbError> {
        let is_good = |video: &ClipVideo| {
            let ClipVideo { path, offset_secs } = video;
            !path.is_empty() && !path.chars().any(char::is_control) && offset_secs.is_finite()
        };
        if let Some(video) = video.filter(|video| !is_good(video)) {
            let expected = "a path without control characters and an offset in seconds";
            let (path, offset) = (&video.path, video.offset_secs);
            return Err(DbError::Invalid(format!(
                "expected {expected}, found {path:?} and {offset}"
            )));
        }
        let what = match video {
            Some(_) => format!("video of {clip}"),
            None => format!("no video of {clip}"),
        };
        self.edit(&what, |conn| {
            let id = clips::find(conn, clip)?.id.0;
            match video {
                Some(ClipVideo { path, offset_secs }) => {
                    let sql = "INSERT INTO videos (clip, path, offset_secs) VALUES (?1, ?2, ?3) \
                         ON CONFLICT (clip) DO UPDATE SET path = ?2, offset_secs = ?3";
                    conn.execute(sql, params![id, path, offset_secs])?;
                }
                None => {
                    conn.execute("DELETE FROM videos WHERE clip = ?1", params![id])?;
                }
            }
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::database_of_waves;

    #[test]
    fn a_video_is_set_moved_and_taken_away_and_each_is_undone() {
        let (_folder, mut db) = database_of_waves(2);
        let clips = db.clips(&Default::default()).unwrap();
        let (name, id) = (clips[0].name.clone(), clips[0].id);
        let video = |offset_secs| ClipVideo {
            path: "films/take 1.mp4".to_owned(),
            offset_secs,
        };
        db.set_video(&name, Some(&video(1.5))).unwrap();
        db.set_video(&name, Some(&video(-0.25))).unwrap();
        let of = |db: &MotionDb| db.videos().unwrap().get(&id).cloned();
        assert_eq!(of(&db), Some(video(-0.25)));
        db.set_video(&name, None).unwrap();
        assert_eq!(of(&db), None);
        for expected in [Some(-0.25), Some(1.5), None] {
            db.undo(None).unwrap();
            assert_eq!(of(&db), expected.map(video));
        }
        db.redo(None).unwrap();
        // A clip that goes comes back with its video.
        db.remove_clips(&[id]).unwrap();
        assert!(db.videos().unwrap().is_empty());
        db.undo(None).unwrap();
        assert_eq!(of(&db), Some(video(1.5)));
        for bad in [
            video(f64::NAN),
            ClipVideo {
                path: String::new(),
                offset_secs: 0.0,
            },
        ] {
            assert!(db.set_video(&name, Some(&bad)).is_err());
        }
        assert!(db.set_video("nobody", Some(&video(0.0))).is_err());
    }
}
