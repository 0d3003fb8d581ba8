//! Applies a whole set of labels as one step: adds them to the existing labels, or replaces these.

use std::collections::{BTreeMap, BTreeSet};

use rusqlite::{Connection, params};

use super::read::list;
use super::sample::{Added, DbSample, NewSample, SampleFilter, SampleState};
use super::write::{Change, add, alter, annotate};
use crate::clips::describe;
use crate::history::counted;
use crate::{ClipId, ClipUpdate, DbError, MotionDb};

/// Options of adding labels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LabelOptions {
    /// Author of the labels.
    pub by: String,
    /// The labels are all there are for the clips they name: accepted samples that are not among them are removed.
    pub replace: bool,
    /// Only say what would change.
    pub dry_run: bool,
    /// Who is in clips, as files of labels say.
    pub people: BTreeMap<ClipId, String>,
    /// Who says each label, in their order; empty if nobody is known.
    pub annotators: Vec<Option<String>>,
}

/// Kind of change of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum LabelChange {
    /// It is new.
    Added,
    /// It was there and is judged anew.
    Judged,
    /// It starts or stops elsewhere.
    Moved,
    /// It has another class.
    Renamed,
    /// It is removed.
    Gone,
}

/// A change of a sample, as it is afterwards; a removed sample as it was.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ChangedLabel {
    /// Kind of change.
    pub change: LabelChange,
    /// Number of the clip.
    #[serde(rename = "clip_id")]
    pub clip: crate::ClipId,
    /// Name of the class.
    pub class: String,
    /// Its start, seconds.
    pub start_secs: f64,
    /// Its stop, seconds.
    pub stop_secs: f64,
    /// Class, start and stop before the change, if it is moved or renamed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub was: Option<(String, f64, f64)>,
}

impl ChangedLabel {
    fn of(change: LabelChange, sample: &NewSample) -> Self {
        Self {
            change,
            clip: sample.clip,
            class: sample.class.clone(),
            start_secs: sample.start_secs,
            stop_secs: sample.stop_secs,
            was: None,
        }
    }
}

/// Result of adding labels.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct Labelled {
    /// Counts by kind.
    #[serde(flatten)]
    pub counts: Added,
    /// Every change, in the order of the labels; what goes is last.
    pub changes: Vec<ChangedLabel>,
}

/// Name of the step that adds labels, with their class if they have one class.
fn added(labels: &[NewSample]) -> String {
    let samples = counted(labels.len(), "sample");
    match labels {
        [first, rest @ ..] if rest.iter().all(|l| l.class == first.class) => {
            format!("add {samples} of {}", first.class)
        }
        _ => format!("add {samples}"),
    }
}

impl MotionDb {
    /// Questions about classes of labels that are to be added and are probably misspelled, beside those that are there.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn misspelled(&self, labels: &[NewSample]) -> Result<Vec<String>, DbError> {
        let there = self.classes()?;
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        counts.extend(there.iter().map(|c| (c.name.as_str(), c.accepted)));
        for label in labels {
            *counts.entry(label.class.trim()).or_default() += 1;
        }
        Ok(morec::labels::misspelled(&counts))
    }

    /// Takes labels in, all or none, as one step. A label that is there already (clip, class and extent) is judged anew;
    /// but a proposal changes nothing that was accepted or rejected. A new accepted label rejects what other classes were
    /// proposed for just that stretch; proposals of groups, which claim no class, are withdrawn instead.
    ///
    /// With [`LabelOptions::replace`], accepted samples of the clips named that no label says are moved or renamed where a
    /// label stands for them (the same class overlapping, or the same stretch), and removed otherwise.
    ///
    /// A sample that several annotators say is one sample with all their names.
    ///
    /// # Errors
    /// A label that stops before it starts or lies outside its clip, a class name that cannot be, no such clip.
    pub fn label(
        &mut self,
        labels: &[NewSample],
        options: &LabelOptions,
    ) -> Result<Labelled, DbError> {
        let what = match options.replace {
            true => format!("replace labels by {}", labels.len()),
            false => added(labels),
        };
        let change = |conn: &Connection| {
            let there = match options.replace {
                true => accepted_in(conn, labels)?,
                false => Vec::new(),
            };
            let mut done = Labelled::default();
            let mut left = unsaid(there, labels);
            for (at, label) in labels.iter().enumerate() {
                take_in(conn, label, &mut left, options, &mut done)?;
                if let Some(Some(annotator)) = options.annotators.get(at) {
                    done.counts.annotated += annotate(conn, label, annotator)?;
                }
            }
            for (clip, person) in &options.people {
                let update = ClipUpdate {
                    subject: Some(person.clone()),
                    ..ClipUpdate::default()
                };
                done.counts.people += describe(conn, *clip, &update)?;
            }
            for sample in left {
                conn.prepare_cached("DELETE FROM samples WHERE id = ?1")?
                    .execute(params![sample.id.0])?;
                done.counts.gone += 1;
                done.changes.push(ChangedLabel {
                    change: LabelChange::Gone,
                    clip: sample.clip,
                    class: sample.class,
                    start_secs: sample.start_secs,
                    stop_secs: sample.stop_secs,
                    was: None,
                });
            }
            Ok(done)
        };
        match options.dry_run {
            true => self.dry_run(change),
            false => self.edit(&what, change),
        }
    }
}

/// The accepted samples of the clips that labels name.
fn accepted_in(conn: &Connection, labels: &[NewSample]) -> Result<Vec<DbSample>, DbError> {
    let clips: BTreeSet<_> = labels.iter().map(|label| label.clip).collect();
    let mut samples = Vec::new();
    for clip in clips {
        let filter = SampleFilter {
            clip: Some(clip),
            state: Some(SampleState::Accepted),
            ..SampleFilter::default()
        };
        samples.extend(list(conn, &filter)?);
    }
    Ok(samples)
}

fn says(label: &NewSample, sample: &DbSample) -> bool {
    label.clip == sample.clip
        && label.class == sample.class
        && (label.start_secs, label.stop_secs) == (sample.start_secs, sample.stop_secs)
}

/// Samples that no label says just so.
fn unsaid(there: Vec<DbSample>, labels: &[NewSample]) -> Vec<DbSample> {
    there
        .into_iter()
        .filter(|sample| !labels.iter().any(|label| says(label, sample)))
        .collect()
}

fn take_in(
    conn: &Connection,
    label: &NewSample,
    left: &mut Vec<DbSample>,
    options: &LabelOptions,
    done: &mut Labelled,
) -> Result<(), DbError> {
    let stands_for = match label.state {
        SampleState::Accepted if !is_there(conn, label)? => counterpart(label, left),
        _ => None,
    };
    let Some(at) = stands_for else {
        let (change, others) = add(conn, label, &options.by)?;
        done.counts.rejected += others.rejected;
        done.counts.withdrawn += others.withdrawn;
        match change {
            Change::None => done.counts.unchanged += 1,
            Change::New => {
                done.counts.added += 1;
                done.changes
                    .push(ChangedLabel::of(LabelChange::Added, label));
            }
            Change::Judged => {
                done.counts.changed += 1;
                done.changes
                    .push(ChangedLabel::of(LabelChange::Judged, label));
            }
        }
        return Ok(());
    };
    let old = left.swap_remove(at);
    alter(conn, old.id, label, &options.by)?;
    let change = match old.class == label.class {
        true => LabelChange::Moved,
        false => LabelChange::Renamed,
    };
    match change {
        LabelChange::Moved => done.counts.moved += 1,
        _ => done.counts.renamed += 1,
    }
    let mut changed = ChangedLabel::of(change, label);
    changed.was = Some((old.class, old.start_secs, old.stop_secs));
    done.changes.push(changed);
    Ok(())
}

fn is_there(conn: &Connection, label: &NewSample) -> Result<bool, DbError> {
    let sql = "SELECT 1 FROM samples s JOIN classes n ON n.id = s.class WHERE s.clip = ?1 AND n.name = ?2 \
        AND s.start_secs = ?3 AND s.stop_secs = ?4";
    let given = params![
        label.clip.0,
        label.class.trim(),
        label.start_secs,
        label.stop_secs
    ];
    Ok(conn.prepare_cached(sql)?.exists(given)?)
}

/// The sample that a label stands for: of the same stretch, or the one of its class that overlaps it most.
fn counterpart(label: &NewSample, left: &[DbSample]) -> Option<usize> {
    let of_clip = || {
        let all = left.iter().enumerate();
        all.filter(|(_, sample)| sample.clip == label.clip)
    };
    let same = of_clip().find(|(_, sample)| {
        (sample.start_secs, sample.stop_secs) == (label.start_secs, label.stop_secs)
    });
    let overlap = |sample: &DbSample| {
        sample.stop_secs.min(label.stop_secs) - sample.start_secs.max(label.start_secs)
    };
    let overlapping = of_clip().filter(|(_, s)| s.class == label.class && overlap(s) > 0.0);
    let most = overlapping.max_by(|(_, a), (_, b)| overlap(a).total_cmp(&overlap(b)));
    same.or(most).map(|(at, _)| at)
}
