//! Reads samples from the rows of the table.

use rusqlite::{Connection, OptionalExtension, Row, ToSql};

use super::sample::{DbSample, SampleFilter, SampleId, SampleState};
use crate::{ClipId, DbError};

fn sample(row: &Row<'_>) -> rusqlite::Result<DbSample> {
    let state: String = row.get("state")?;
    let annotators: Option<String> = row.get("annotators")?;
    Ok(DbSample {
        id: SampleId(row.get("id")?),
        clip: ClipId(row.get("clip")?),
        clip_name: row.get("clip_name")?,
        subject: row.get("subject")?,
        class: row.get("class")?,
        start_secs: row.get("start_secs")?,
        stop_secs: row.get("stop_secs")?,
        whole_clip: row.get("whole_clip")?,
        // The table allows no other.
        state: SampleState::from_name(&state).unwrap_or(SampleState::Proposed),
        score: row.get("score")?,
        annotators: annotators
            .map_or_else(Vec::new, |all| all.split('\n').map(str::to_owned).collect()),
        set_by: row.get("set_by")?,
        set_secs: row.get("set_secs")?,
        rate_hz: row.get("rate_hz")?,
    })
}

/// Everything of samples; a condition follows.
const SELECT: &str = "SELECT s.id, s.clip, c.name AS clip_name, c.subject, n.name AS class, s.start_secs, s.stop_secs, s.whole_clip, \
     s.state, s.score, s.set_by, s.set_secs, c.rate_hz, \
     (SELECT group_concat(a.annotator, char(10) ORDER BY a.annotator) FROM annotators a WHERE a.sample = s.id) AS annotators \
     FROM samples s JOIN clips c ON c.id = s.clip JOIN classes n ON n.id = s.class";

/// The sample of a number; an error if it does not exist.
pub(super) fn find(conn: &Connection, id: SampleId) -> Result<DbSample, DbError> {
    let sql = format!("{SELECT} WHERE s.id = ?1");
    let found = conn.prepare_cached(&sql)?.query_row([id.0], sample);
    let found = found.optional()?;
    found.ok_or_else(|| DbError::unknown("sample", &format!("#{}", id.0)))
}

/// The samples of a filter, by clip and time.
pub(crate) fn list(conn: &Connection, filter: &SampleFilter) -> Result<Vec<DbSample>, DbError> {
    let (clip, state) = (
        filter.clip.map(|c| c.0),
        filter.state.map(SampleState::name),
    );
    // Only the conditions that there are: one that may be left out would keep SQLite from its indexes.
    let mut sql = format!("{SELECT} WHERE 1");
    let mut given: Vec<&dyn ToSql> = Vec::new();
    let mut need = |column, value| {
        given.push(value);
        sql.push_str(&format!(" AND {column} = ?{}", given.len()));
    };
    if let Some(clip) = &clip {
        need("s.clip", clip);
    }
    if let Some(class) = &filter.class {
        need("n.name", class);
    }
    if let Some(state) = &state {
        need("s.state", state);
    }
    if let Some(annotator) = &filter.annotator {
        given.push(annotator);
        let of_annotator = "SELECT 1 FROM annotators a WHERE a.sample = s.id AND a.annotator";
        sql.push_str(&format!(" AND EXISTS ({of_annotator} = ?{})", given.len()));
    }
    sql.push_str(" ORDER BY c.name, s.start_secs, s.stop_secs, n.name");
    let mut statement = conn.prepare_cached(&sql)?;
    let samples = statement.query_map(&given[..], sample)?;
    Ok(samples.collect::<Result<_, _>>()?)
}
