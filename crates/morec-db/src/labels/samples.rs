//! Samples: added, judged, listed.

use rusqlite::{Connection, OptionalExtension, Row, params};

use super::{GROUPED_BY, LabelOptions, SampleState, classes};
use crate::time::now_secs;
use crate::{ClipId, DbError, MotionDb};

/// A sample's number in its database.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
pub struct SampleId(pub i64);

/// A sample as it is kept.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct DbSample {
    /// Its number.
    pub id: SampleId,
    /// Its clip.
    pub clip: ClipId,
    /// Its clip's name.
    pub clip_name: String,
    /// Who is seen in the clip.
    pub subject: Option<String>,
    /// What it shows.
    pub class: String,
    /// Where it starts, seconds from the clip's beginning.
    pub start_secs: f64,
    /// Where it stops.
    pub stop_secs: f64,
    /// Whether the clip as a whole was labelled, still ends and all.
    pub whole_clip: bool,
    /// What is thought of it.
    pub state: SampleState,
    /// How sure a program was of it.
    pub score: Option<f64>,
    /// Who said so.
    pub set_by: String,
    /// When, seconds since 1970.
    pub set_secs: i64,
    /// Frames a second of its clip.
    pub rate_hz: f64,
}

impl DbSample {
    /// Its frames in the clip's file, rounded to whole ones.
    pub fn frames(&self) -> std::ops::Range<usize> {
        let frame = |secs: f64| (secs * self.rate_hz).round().max(0.0) as usize;
        frame(self.start_secs)..frame(self.stop_secs)
    }
}

/// A sample to add.
#[derive(Debug, Clone, PartialEq)]
pub struct NewSample {
    /// Its clip.
    pub clip: ClipId,
    /// What it shows.
    pub class: String,
    /// Where it starts, seconds.
    pub start_secs: f64,
    /// Where it stops.
    pub stop_secs: f64,
    /// Whether the clip as a whole is meant.
    pub whole_clip: bool,
    /// What is thought of it.
    pub state: SampleState,
    /// How sure a program is of it.
    pub score: Option<f64>,
}

/// What became of samples that were added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct Added {
    /// They are new.
    pub added: usize,
    /// They were there and are judged anew.
    pub changed: usize,
    /// They were there just so; or a proposal of what had been judged.
    pub unchanged: usize,
    /// Samples that start or stop elsewhere now.
    pub moved: usize,
    /// Samples that have another class now.
    pub renamed: usize,
    /// Samples that were removed, as no label says them.
    pub gone: usize,
    /// Proposals of other classes for the same stretch that are rejected now.
    pub rejected: usize,
    /// Proposals of groups for the same stretch that are there no more.
    pub withdrawn: usize,
}

/// Which samples; all conditions must hold.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SampleFilter {
    /// In this clip.
    pub clip: Option<ClipId>,
    /// Of this class.
    pub class: Option<String>,
    /// In this state.
    pub state: Option<SampleState>,
}

fn sample(row: &Row<'_>) -> rusqlite::Result<DbSample> {
    let state: String = row.get("state")?;
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
        set_by: row.get("set_by")?,
        set_secs: row.get("set_secs")?,
        rate_hz: row.get("rate_hz")?,
    })
}

impl MotionDb {
    /// The samples of a filter, by clip and time.
    pub fn samples(&self, filter: &SampleFilter) -> Result<Vec<DbSample>, DbError> {
        let mut statement = self.conn.prepare_cached(
            "SELECT s.id, s.clip, c.name AS clip_name, c.subject, n.name AS class, s.start_secs, s.stop_secs, s.whole_clip, \
             s.state, s.score, s.set_by, s.set_secs, c.rate_hz FROM samples s JOIN clips c ON c.id = s.clip JOIN classes n ON n.id = s.class \
             WHERE (?1 IS NULL OR s.clip = ?1) AND (?2 IS NULL OR n.name = ?2) AND (?3 IS NULL OR s.state = ?3) \
             ORDER BY c.name, s.start_secs, s.stop_secs, n.name",
        )?;
        let given = params![
            filter.clip.map(|c| c.0),
            filter.class,
            filter.state.map(SampleState::name)
        ];
        let samples = statement
            .query_map(given, sample)?
            .collect::<Result<_, _>>()?;
        Ok(samples)
    }

    /// Adds samples, all or none, as one step: [`MotionDb::label`] without replacing.
    ///
    /// # Errors
    /// A sample that stops before it starts or lies outside its clip, a class name that cannot be, no such clip.
    pub fn add_samples(&mut self, samples: &[NewSample], by: &str) -> Result<Added, DbError> {
        let options = LabelOptions {
            by: by.to_owned(),
            ..LabelOptions::default()
        };
        Ok(self.label(samples, &options)?.counts)
    }

    /// Puts proposals in place of others, as one step.
    ///
    /// # Errors
    /// As [`MotionDb::label`].
    pub fn replace_proposals(
        &mut self,
        old: &[SampleId],
        new: &[NewSample],
        by: &str,
    ) -> Result<(), DbError> {
        self.edit(&format!("propose {} samples", new.len()), |conn| {
            for id in old {
                conn.execute("DELETE FROM samples WHERE id = ?1", params![id.0])?;
            }
            new.iter()
                .try_for_each(|sample| add(conn, sample, by).map(drop))
        })
    }

    /// Puts samples in place of others, as one step called `what`: how a label is split or several become one. New
    /// samples are as in [`MotionDb::label`].
    ///
    /// # Errors
    /// As [`MotionDb::label`]; an old sample that is not there.
    pub fn change_samples(
        &mut self,
        what: &str,
        old: &[SampleId],
        new: &[NewSample],
        by: &str,
    ) -> Result<(), DbError> {
        self.edit(what, |conn| {
            for id in old {
                let sql = "DELETE FROM samples WHERE id = ?1";
                if conn.execute(sql, params![id.0])? == 0 {
                    return Err(DbError::unknown("sample", &format!("#{}", id.0)));
                }
            }
            new.iter()
                .try_for_each(|sample| add(conn, sample, by).map(drop))
        })
    }

    /// Says what is thought of samples. Gives how many changed.
    pub fn judge(
        &mut self,
        samples: &[SampleId],
        state: SampleState,
        by: &str,
    ) -> Result<usize, DbError> {
        let what = format!("{} {} samples", state.name(), samples.len());
        self.edit(&what, |conn| judge(conn, samples, state, by))
    }

    /// Accepts samples and rejects others, as one step.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn judge_both(
        &mut self,
        accepted: &[SampleId],
        rejected: &[SampleId],
        by: &str,
    ) -> Result<(), DbError> {
        let what = format!(
            "accept {} and reject {} samples",
            accepted.len(),
            rejected.len()
        );
        self.edit(&what, |conn| {
            judge(conn, accepted, SampleState::Accepted, by)?;
            judge(conn, rejected, SampleState::Rejected, by)?;
            Ok(())
        })
    }

    /// Gives a sample another extent, in seconds. Its number, class and state stay.
    ///
    /// # Errors
    /// There is no such sample; it would lie outside its clip, or where its class has a sample already.
    pub fn move_sample(
        &mut self,
        id: SampleId,
        start_secs: f64,
        stop_secs: f64,
        by: &str,
    ) -> Result<(), DbError> {
        let unknown = || DbError::unknown("sample", &format!("#{}", id.0));
        let all = self.samples(&SampleFilter::default())?;
        let old = all.iter().find(|s| s.id == id).ok_or_else(unknown)?;
        let there = all.iter().find(|s| {
            s.id != id
                && (s.clip, &s.class) == (old.clip, &old.class)
                && (s.start_secs, s.stop_secs) == (start_secs, stop_secs)
        });
        if let Some(other) = there {
            return Err(DbError::Invalid(format!(
                "sample {} of {} is there already: number {}",
                old.class, old.clip_name, other.id.0
            )));
        }
        let moved = NewSample {
            clip: old.clip,
            class: old.class.clone(),
            start_secs,
            stop_secs,
            whole_clip: false,
            state: old.state,
            score: old.score,
        };
        self.edit(&format!("move sample {}", id.0), |conn| {
            super::plan::alter(conn, id, &moved, by)
        })
    }

    /// Forgets samples. Gives how many there were.
    pub fn remove_samples(&mut self, samples: &[SampleId]) -> Result<usize, DbError> {
        self.edit(&format!("remove {} samples", samples.len()), |conn| {
            let mut statement = conn.prepare_cached("DELETE FROM samples WHERE id = ?1")?;
            let mut removed = 0;
            for id in samples {
                removed += statement.execute(params![id.0])?;
            }
            Ok(removed)
        })
    }
}

fn judge(
    conn: &Connection,
    samples: &[SampleId],
    state: SampleState,
    by: &str,
) -> Result<usize, DbError> {
    let sql =
        "UPDATE samples SET state = ?2, set_by = ?3, set_secs = ?4 WHERE id = ?1 AND state <> ?2";
    let mut statement = conn.prepare_cached(sql)?;
    let mut changed = 0;
    for id in samples {
        changed += statement.execute(params![id.0, state.name(), by, now_secs()])?;
    }
    Ok(changed)
}

pub(super) enum Change {
    New,
    Judged,
    None,
}

/// What an accepted sample does to proposals of other classes.
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
    let class = classes::find_or_make(conn, &sample.class)?;
    let extent = params![sample.clip.0, class, sample.start_secs, sample.stop_secs];
    let there: Option<(i64, String)> = conn
        .prepare_cached(
            "SELECT id, state FROM samples WHERE clip = ?1 AND class = ?2 AND start_secs = ?3 AND stop_secs = ?4",
        )?
        .query_row(extent, |row| Ok((row.get(0)?, row.get(1)?)))
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
    let sql = format!("SELECT class FROM samples WHERE {stretch} AND set_by = ?5");
    let groups: Vec<i64> = conn
        .prepare_cached(&sql)?
        .query_map(given, |row| row.get(0))?
        .collect::<Result<_, _>>()?;
    let sql = format!("DELETE FROM samples WHERE {stretch} AND set_by = ?5");
    let withdrawn = conn.execute(&sql, given)?;
    for group in groups {
        conn.execute(
            "DELETE FROM classes WHERE id = ?1 AND NOT EXISTS (SELECT 1 FROM samples WHERE class = ?1)",
            params![group],
        )?;
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

pub(super) fn check_extent(conn: &Connection, sample: &NewSample) -> Result<(), DbError> {
    let sql = "SELECT name, frames / rate_hz, rate_hz FROM clips WHERE id = ?1";
    let clip: Option<(String, f64, f64)> = conn
        .prepare_cached(sql)?
        .query_row(params![sample.clip.0], |row| {
            Ok((row.get(0)?, row.get(1)?, row.get(2)?))
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
