//! Lists, adds, changes, judges and removes samples.

use rusqlite::{Connection, OptionalExtension, params};

use super::plan::LabelOptions;
use super::read::{find, list};
use super::sample::{
    Added, DbSample, JudgedCounts, NewSample, SampleFilter, SampleId, SampleState,
};
use super::write::{add, alter, annotate, annotate_sample};
use crate::history::counted;
use crate::time::now_secs;
use crate::{DbError, MotionDb};

/// Refuses samples that are not as somebody saw them who now takes them away: what another program made of them would be lost.
fn need_unchanged(conn: &Connection, seen: &[DbSample]) -> Result<(), DbError> {
    for old in seen {
        if NewSample::from(&find(conn, old.id)?) != NewSample::from(old) {
            return Err(DbError::Invalid(format!(
                "another program has changed sample {}: nothing was changed",
                old.id.0
            )));
        }
    }
    Ok(())
}

impl MotionDb {
    /// The sample with this number.
    ///
    /// # Errors
    /// [`DbError::Unknown`] if it does not exist.
    pub fn sample(&self, id: SampleId) -> Result<DbSample, DbError> {
        find(&self.conn, id)
    }

    /// The samples that match a filter, sorted by clip and start; empty if there is none.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn samples(&self, filter: &SampleFilter) -> Result<Vec<DbSample>, DbError> {
        list(&self.conn, filter)
    }

    /// Numbers of the samples that a step of the history changed, whether they still exist or not.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn samples_of_step(&self, step: i64) -> Result<Vec<SampleId>, DbError> {
        let sql =
            "SELECT DISTINCT c0 FROM was WHERE edit = ?1 AND tab IN ('samples', 'annotators')";
        let mut statement = self.conn.prepare_cached(sql)?;
        let samples = statement.query_map(params![step], |row| Ok(SampleId(row.get(0)?)))?;
        Ok(samples.collect::<Result<_, _>>()?)
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
        self.edit(
            &format!("propose {}", counted(new.len(), "sample")),
            |conn| {
                for id in old {
                    conn.prepare_cached("DELETE FROM samples WHERE id = ?1")?
                        .execute(params![id.0])?;
                }
                new.iter()
                    .try_for_each(|sample| add(conn, sample, by).map(drop))
            },
        )
    }

    /// Puts samples in place of others, as one step called `what`: how a label is split, several become one, and one of two
    /// annotators' labels is taken. New samples are as in [`MotionDb::label`], each with its annotators.
    ///
    /// # Errors
    /// As [`MotionDb::label`]; an old sample that is not there, or of another clip, class, extent or state than was seen.
    pub fn change_samples(
        &mut self,
        what: &str,
        old: &[DbSample],
        new: &[(NewSample, Vec<String>)],
        by: &str,
    ) -> Result<(), DbError> {
        self.edit(what, |conn| {
            need_unchanged(conn, old)?;
            for sample in old {
                conn.prepare_cached("DELETE FROM samples WHERE id = ?1")?
                    .execute(params![sample.id.0])?;
            }
            for (sample, annotators) in new {
                add(conn, sample, by)?;
                for annotator in annotators {
                    annotate(conn, sample, annotator)?;
                }
            }
            Ok(())
        })
    }

    /// Sets the state of samples (accepted, proposed, rejected) as one step; `by` is the author. Returns the number of samples
    /// changed.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn judge(
        &mut self,
        samples: &[SampleId],
        state: SampleState,
        by: &str,
    ) -> Result<usize, DbError> {
        let what = format!("{} {}", state.name(), counted(samples.len(), "sample"));
        self.edit(&what, |conn| judge(conn, samples, state, by))
    }

    /// Accepts samples and notes `annotator` as their annotator, as one step. Returns the number of samples accepted.
    ///
    /// # Errors
    /// No annotator's name; the database cannot be written.
    pub fn accept_as(
        &mut self,
        samples: &[SampleId],
        annotator: &str,
        by: &str,
    ) -> Result<usize, DbError> {
        let accepted = SampleState::Accepted;
        let what = format!("{} {}", accepted.name(), counted(samples.len(), "sample"));
        self.edit(&what, |conn| {
            for id in samples {
                annotate_sample(conn, *id, annotator)?;
            }
            judge(conn, samples, accepted, by)
        })
    }

    /// Accepts the proposals of `classes` (of all, if none is named) with at least the score `accept`, and rejects the others below
    /// `reject`, as one step. A proposal without a score has 0.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn judge_by_score(
        &mut self,
        classes: &[String],
        (accept, reject): (Option<f64>, Option<f64>),
        by: &str,
    ) -> Result<JudgedCounts, DbError> {
        self.edit_named(|conn| {
            let proposed = SampleFilter {
                state: Some(SampleState::Proposed),
                ..SampleFilter::default()
            };
            let all = list(conn, &proposed)?;
            let (mut accepted, mut rejected) = (Vec::new(), Vec::new());
            let wanted = |s: &&DbSample| classes.is_empty() || classes.contains(&s.class);
            for sample in all.iter().filter(wanted) {
                let score = sample.score.unwrap_or(0.0);
                if accept.is_some_and(|least| score >= least) {
                    accepted.push(sample.id);
                } else if reject.is_some_and(|least| score < least) {
                    rejected.push(sample.id);
                }
            }
            judge(conn, &accepted, SampleState::Accepted, by)?;
            judge(conn, &rejected, SampleState::Rejected, by)?;
            let what = format!(
                "accept {} and reject {}",
                accepted.len(),
                counted(rejected.len(), "sample")
            );
            let counts = JudgedCounts {
                accepted: accepted.len(),
                rejected: rejected.len(),
                left: all.len() - accepted.len() - rejected.len(),
            };
            Ok((counts, what))
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
        self.edit(&format!("move sample {}", id.0), |conn| {
            // Read within the transaction: changes of the sample by another program stay.
            let old = find(conn, id)?;
            let sql = "SELECT o.id FROM samples s JOIN samples o ON o.clip = s.clip AND o.class = s.class \
                 WHERE s.id = ?1 AND o.id <> s.id AND o.start_secs = ?2 AND o.stop_secs = ?3";
            let mut there = conn.prepare_cached(sql)?;
            let there = there.query_row(params![id.0, start_secs, stop_secs], |row| row.get(0));
            let there: Option<i64> = there.optional()?;
            if let Some(other) = there {
                return Err(DbError::Invalid(format!(
                    "sample {} of {} exists already, as number {other}",
                    old.class, old.clip_name
                )));
            }
            let moved = NewSample {
                start_secs,
                stop_secs,
                whole_clip: false,
                ..NewSample::from(&old)
            };
            alter(conn, id, &moved, by)
        })
    }

    /// Removes samples, as one step. Returns how many existed.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn remove_samples(&mut self, samples: &[SampleId]) -> Result<usize, DbError> {
        self.edit(
            &format!("remove {}", counted(samples.len(), "sample")),
            |conn| {
                let mut statement = conn.prepare_cached("DELETE FROM samples WHERE id = ?1")?;
                let mut removed = 0;
                for id in samples {
                    removed += statement.execute(params![id.0])?;
                }
                Ok(removed)
            },
        )
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
