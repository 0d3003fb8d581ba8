//! Writes rows of samples. Called only inside a step of the history.

use rusqlite::{Connection, OptionalExtension, params};

use super::classes;
use super::sample::{GROUPED_BY, NewSample, SampleId, SampleState};
use crate::DbError;
use crate::time::now_secs;

pub(super) enum Change {
    New,
    Judged,
    None,
}

/// Effects of an accepted sample on proposals of other classes.
#[derive(Default)]
pub(super) struct Others {
    pub rejected: usize,
    pub withdrawn: usize,
}

pub(super) fn add(
    conn: &Connection,
    sample: &NewSample,
    by: &str,
) -> Result<(Change, Others), DbError> {
    check_extent(conn, sample)?;
    // A class is made with its first sample, in the same step of the history, and goes with it when that is taken back.
    let class = classes::find_or_make(conn, &sample.class)?;
    let extent = params![sample.clip.0, class, sample.start_secs, sample.stop_secs];
    let there: Option<(i64, String)> = conn
        .prepare_cached(
            "SELECT id, state FROM samples WHERE clip = ?1 AND class = ?2 AND start_secs = ?3 AND stop_secs = ?4",
        )?
        .query_row(extent, |row| Ok((row.get("id")?, row.get("state")?)))
        .optional()?;
    let Some((id, state)) = there else {
        conn.prepare_cached(
            "INSERT INTO samples (clip, class, start_secs, stop_secs, whole_clip, state, score, set_by, set_secs) \
             VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)",
        )?
        .execute(params![
            sample.clip.0,
            class,
            sample.start_secs,
            sample.stop_secs,
            sample.whole_clip,
            sample.state.name(),
            sample.score,
            by,
            now_secs()
        ])?;
        let others = match sample.state {
            SampleState::Accepted => reject_instead(conn, sample, class, by)?,
            _ => Others::default(),
        };
        return Ok((Change::New, others));
    };
    // What a person has judged is not proposed again.
    if state == sample.state.name() || sample.state == SampleState::Proposed {
        return Ok((Change::None, Others::default()));
    }
    conn.prepare_cached("UPDATE samples SET state = ?2, set_by = ?3, set_secs = ?4 WHERE id = ?1")?
        .execute(params![id, sample.state.name(), by, now_secs()])?;
    Ok((Change::Judged, Others::default()))
}

/// Proposals of other classes for the very stretch that is now known to be of `class` were wrong. Those of groups say
/// that stretches are alike, not what they are: they are withdrawn, and with the last of them the group's class.
fn reject_instead(
    conn: &Connection,
    sample: &NewSample,
    class: i64,
    by: &str,
) -> Result<Others, DbError> {
    let stretch =
        "clip = ?1 AND start_secs = ?2 AND stop_secs = ?3 AND class <> ?4 AND state = 'proposed'";
    let given = params![
        sample.clip.0,
        sample.start_secs,
        sample.stop_secs,
        class,
        GROUPED_BY
    ];
    // Before they are deleted: the classes that may be empty afterwards.
    let sql = format!("SELECT class FROM samples WHERE {stretch} AND set_by = ?5");
    let groups: Vec<i64> = conn
        .prepare_cached(&sql)?
        .query_map(given, |row| row.get(0))?
        .collect::<Result<_, _>>()?;
    let sql = format!("DELETE FROM samples WHERE {stretch} AND set_by = ?5");
    let withdrawn = conn.prepare_cached(&sql)?.execute(given)?;
    for group in groups {
        conn.prepare_cached(
            "DELETE FROM classes WHERE id = ?1 AND NOT EXISTS (SELECT 1 FROM samples WHERE class = ?1)",
        )?
        .execute(params![group])?;
    }
    let sql = format!(
        "UPDATE samples SET state = 'rejected', set_by = ?5, set_secs = ?6 WHERE {stretch}"
    );
    let rejected = conn.prepare_cached(&sql)?.execute(params![
        sample.clip.0,
        sample.start_secs,
        sample.stop_secs,
        class,
        by,
        now_secs()
    ])?;
    Ok(Others {
        rejected,
        withdrawn,
    })
}

/// Notes who says a label that is there; the number of samples of which that is news.
pub(super) fn annotate(
    conn: &Connection,
    label: &NewSample,
    annotator: &str,
) -> Result<usize, DbError> {
    let sql = "SELECT s.id FROM samples s JOIN classes n ON n.id = s.class \
         WHERE s.clip = ?1 AND n.name = ?2 AND s.start_secs = ?3 AND s.stop_secs = ?4";
    let said = params![
        label.clip.0,
        label.class.trim(),
        label.start_secs,
        label.stop_secs
    ];
    let there = conn.prepare_cached(sql)?.query_row(said, |row| row.get(0));
    match there.optional()? {
        Some(id) => annotate_sample(conn, SampleId(id), annotator),
        None => Ok(0),
    }
}

/// Notes who says a sample; the number of samples of which that is news.
pub(super) fn annotate_sample(
    conn: &Connection,
    sample: SampleId,
    annotator: &str,
) -> Result<usize, DbError> {
    let annotator = annotator.trim();
    if annotator.is_empty() || annotator.chars().any(char::is_control) {
        let expected = "a name of an annotator without control characters";
        return Err(DbError::Invalid(format!(
            "expected {expected}, found {annotator:?}"
        )));
    }
    let sql = "INSERT OR IGNORE INTO annotators (sample, annotator) SELECT id, ?2 FROM samples WHERE id = ?1";
    let said = params![sample.0, annotator];
    Ok(conn.prepare_cached(sql)?.execute(said)?)
}

fn check_extent(conn: &Connection, sample: &NewSample) -> Result<(), DbError> {
    let sql = "SELECT name, frames / rate_hz AS secs, rate_hz FROM clips WHERE id = ?1";
    let clip: Option<(String, f64, f64)> = conn
        .prepare_cached(sql)?
        .query_row(params![sample.clip.0], |row| {
            Ok((row.get("name")?, row.get("secs")?, row.get("rate_hz")?))
        })
        .optional()?;
    let (name, secs, rate_hz) =
        clip.ok_or_else(|| DbError::unknown("clip", &format!("#{}", sample.clip.0)))?;
    let (start, stop) = (sample.start_secs, sample.stop_secs);
    // A frame counts for its whole period; half a frame is rounding.
    if !(start >= 0.0 && stop > start && stop <= secs + 0.5 / rate_hz) {
        let class = &sample.class;
        return Err(DbError::Invalid(format!(
            "{name}: expected a sample of {class} within 0 to {secs:.3} s, found {start:.3} to {stop:.3} s"
        )));
    }
    Ok(())
}

/// Gives a sample the class and extent of a label; its number stays.
pub(super) fn alter(
    conn: &Connection,
    id: SampleId,
    label: &NewSample,
    by: &str,
) -> Result<(), DbError> {
    check_extent(conn, label)?;
    let class = classes::find_or_make(conn, &label.class)?;
    conn.prepare_cached(
        "UPDATE samples SET class = ?2, start_secs = ?3, stop_secs = ?4, whole_clip = ?5, set_by = ?6, set_secs = ?7 \
         WHERE id = ?1",
    )?
    .execute(params![
            id.0,
            class,
            label.start_secs,
            label.stop_secs,
            label.whole_clip,
            by,
            now_secs()
        ])?;
    Ok(())
}
