//! Labels of whole clips: the class of a clip and its person.

use rusqlite::{Connection, params};

use super::classes;
use super::sample::{Added, NewSample, SampleState};
use super::write::{Change, add, annotate};
use crate::clips::describe;
use crate::history::counted;
use crate::{ClipId, ClipUpdate, DbError, MotionDb};

/// What a clip as a whole is said to show; `None` leaves it as it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WholeClip {
    /// The clip that is labelled or described.
    pub clip: ClipId,
    /// The class that all of it shows.
    pub class: Option<String>,
    /// The person in it.
    pub subject: Option<String>,
}

/// What the history calls it: the number of clips and their class.
fn step_name(clips: &[WholeClip]) -> String {
    let number = counted(clips.len(), "whole clip");
    let mut classes: Vec<&str> = clips.iter().filter_map(|c| c.class.as_deref()).collect();
    classes.sort_unstable();
    classes.dedup();
    match classes[..] {
        [] => format!("describe {number}"),
        [class] => format!("label {number} {class}"),
        _ => format!("label {number}, {} classes", classes.len()),
    }
}

impl MotionDb {
    /// Says of whole clips which class each shows and who is in it, all as one step. A sample of a whole clip takes the place of one
    /// of another class; samples of parts of the clip stay.
    ///
    /// # Errors
    /// A class name, a person's or an annotator's that cannot be, no such clip.
    pub fn label_clips(
        &mut self,
        clips: &[WholeClip],
        by: &str,
        annotator: Option<&str>,
    ) -> Result<Added, DbError> {
        let mut subjects = clips.iter().filter_map(|c| c.subject.as_ref());
        if let Some(text) = subjects.find(|text| text.chars().any(char::is_control)) {
            return Err(DbError::Invalid(format!(
                "expected a person's name without control characters, found {text:?}"
            )));
        }
        self.edit(&step_name(clips), |conn| {
            let mut counts = Added::default();
            for clip in clips {
                if let Some(class) = &clip.class {
                    label(conn, clip.clip, class, (by, annotator), &mut counts)?;
                }
                let subject = clip.subject.clone();
                let update = ClipUpdate {
                    subject,
                    ..ClipUpdate::default()
                };
                describe(conn, clip.clip, &update)?;
            }
            Ok(counts)
        })
    }
}

fn label(
    conn: &Connection,
    clip: ClipId,
    class: &str,
    (by, annotator): (&str, Option<&str>),
    counts: &mut Added,
) -> Result<(), DbError> {
    let sql = "SELECT frames / rate_hz FROM clips WHERE id = ?1";
    let stop_secs = conn
        .prepare_cached(sql)?
        .query_row(params![clip.0], |row| row.get(0))
        .map_err(|_| DbError::unknown("clip", &format!("#{}", clip.0)))?;
    let sample = NewSample {
        clip,
        class: class.to_owned(),
        start_secs: 0.0,
        stop_secs,
        whole_clip: true,
        state: SampleState::Accepted,
        score: None,
    };
    let class = classes::find_or_make(conn, class)?;
    let sql =
        "DELETE FROM samples WHERE clip = ?1 AND whole_clip AND state = 'accepted' AND class <> ?2";
    let others = conn.prepare_cached(sql)?.execute(params![clip.0, class])?;
    let (change, rejected) = add(conn, &sample, by)?;
    if let Some(annotator) = annotator {
        counts.annotated += annotate(conn, &sample, annotator)?;
    }
    counts.rejected += rejected.rejected;
    counts.withdrawn += rejected.withdrawn;
    match change {
        Change::New if others > 0 => counts.renamed += 1,
        Change::New => counts.added += 1,
        Change::Judged => counts.changed += 1,
        Change::None => counts.unchanged += 1,
    }
    Ok(())
}
