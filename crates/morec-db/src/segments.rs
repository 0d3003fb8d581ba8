//! Segments that a method of cutting found in clips: motion, stillness and rest poses.

use std::collections::BTreeMap;

use morec::TimeSpan;
use rusqlite::{Connection, params};

use crate::{ClipId, DbError, MotionDb};

/// What happens between two cuts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SegmentKind {
    /// Somebody moves.
    Motion,
    /// A pose is held.
    Still,
    /// A T-pose or another pose of rest.
    Rest,
}

impl SegmentKind {
    fn name(self) -> &'static str {
        match self {
            SegmentKind::Motion => "motion",
            SegmentKind::Still => "still",
            SegmentKind::Rest => "rest",
        }
    }
}

/// A stretch of a clip between two cuts.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Segment {
    /// Number of the clip.
    #[serde(rename = "clip_id")]
    pub clip: ClipId,
    /// Motion, stillness or a pose of rest.
    pub kind: SegmentKind,
    /// Start and stop, seconds.
    #[serde(flatten)]
    pub span: TimeSpan,
}

impl MotionDb {
    /// Stores the segments that `method` found in `clips`, as one step, and replaces all earlier segments of these clips: a
    /// clip has the cuts of one method only.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn set_segments(
        &mut self,
        method: &str,
        clips: &[ClipId],
        segments: &[Segment],
    ) -> Result<(), DbError> {
        let what = format!("cut {} clips by {method}", clips.len());
        self.edit(&what, |conn| put(conn, method, clips, segments))
    }

    /// The method by which each clip was cut; clips without cuts are not included.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn cut_methods(&self) -> Result<BTreeMap<ClipId, String>, DbError> {
        let mut statement = self
            .conn
            .prepare("SELECT clip, max(method) AS method FROM segments GROUP BY clip")?;
        let method = |row: &rusqlite::Row<'_>| Ok((ClipId(row.get("clip")?), row.get("method")?));
        let methods = statement.query_map([], method)?;
        Ok(methods.collect::<Result<_, _>>()?)
    }

    /// The segments of a clip, in order of time.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn segments_of(&self, clip: ClipId) -> Result<Vec<Segment>, DbError> {
        of_clip(&self.conn, clip)
    }

    /// The segments of all clips, sorted by clip and time.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn segments(&self) -> Result<Vec<Segment>, DbError> {
        let mut statement = self.conn.prepare(
            "SELECT clip, kind, start_secs, stop_secs FROM segments ORDER BY clip, start_secs",
        )?;
        let segments = statement.query_map([], segment)?;
        Ok(segments.collect::<Result<_, _>>()?)
    }
}

fn segment(row: &rusqlite::Row<'_>) -> rusqlite::Result<Segment> {
    let kind: String = row.get("kind")?;
    Ok(Segment {
        clip: ClipId(row.get("clip")?),
        kind: match kind.as_str() {
            "still" => SegmentKind::Still,
            "rest" => SegmentKind::Rest,
            _ => SegmentKind::Motion,
        },
        span: TimeSpan::new(row.get("start_secs")?, row.get("stop_secs")?),
    })
}

/// The segments of a clip, by time.
pub(crate) fn of_clip(conn: &Connection, clip: ClipId) -> Result<Vec<Segment>, DbError> {
    let mut statement = conn.prepare_cached(
        "SELECT clip, kind, start_secs, stop_secs FROM segments WHERE clip = ?1 ORDER BY start_secs",
    )?;
    let segments = statement.query_map(params![clip.0], segment)?;
    Ok(segments.collect::<Result<_, _>>()?)
}

/// Puts `segments`, which `method` found, in the place of those of `clips`.
pub(crate) fn put(
    conn: &Connection,
    method: &str,
    clips: &[ClipId],
    segments: &[Segment],
) -> Result<(), DbError> {
    let mut forget = conn.prepare("DELETE FROM segments WHERE clip = ?1")?;
    for clip in clips {
        forget.execute(params![clip.0])?;
    }
    let sql = "INSERT INTO segments (clip, method, kind, start_secs, stop_secs) VALUES (?1, ?2, ?3, ?4, ?5)";
    let mut keep = conn.prepare(sql)?;
    for s in segments {
        keep.execute(params![
            s.clip.0,
            method,
            s.kind.name(),
            s.span.start_secs,
            s.span.stop_secs
        ])?;
    }
    Ok(())
}
