//! Training material of a database: labelled clips, background and persons.

use std::collections::{BTreeMap, BTreeSet};

use morec::diagnosis::errors_of_clip;
use morec::labels::{Extent, Label, Labels, some_of};
use morec::train::{StreamKind, TrainClip, TrainingData, TrainingMaterial};
use morec_db::labels::{DbSample, SampleFilter, SampleState};
use morec_db::{BACKGROUND, ClipFilter, ClipId, ClipInfo, DbError, MotionDb, StoredClip};

use crate::OperationError;

/// The accepted samples of a database as a table of labels.
///
/// # Errors
/// The database cannot be read.
pub fn accepted_labels(db: &MotionDb) -> Result<Labels, DbError> {
    let filter = SampleFilter {
        state: Some(SampleState::Accepted),
        ..SampleFilter::default()
    };
    let label = |(s, line): (DbSample, u64)| Label {
        extent: match s.whole_clip {
            true => Extent::WholeClip,
            false => Extent::Secs(s.span()),
        },
        clip: s.clip_name,
        class: s.class,
        person: s.subject,
        annotator: None,
        line,
    };
    let samples = db.samples(&filter)?.into_iter();
    Ok(Labels {
        rows: samples.zip(1..).map(label).collect(),
        warnings: Vec::new(),
    })
}

/// What is used of a database, and with it, besides accepted samples and the clips that are marked as background.
#[derive(Debug, Clone, Default)]
pub struct MaterialBeside {
    /// Names of clips that are background, of the database or of `clips`.
    pub background: BTreeSet<String>,
    /// Names of clips that hold none of the classes and are only tested.
    pub unknown: BTreeSet<String>,
    /// Names of clips that are left out.
    pub exclude: BTreeSet<String>,
    /// Clips that are not in the database.
    pub clips: Vec<TrainClip>,
}

/// The accepted samples of `classes` (all, if none are named), the clips they lie in, those that are marked as background,
/// and what is named beside.
///
/// # Errors
/// The database cannot be read, or holds no sample of one of the classes.
pub fn training_data(
    db: &MotionDb,
    classes: &[String],
    beside: MaterialBeside,
) -> Result<TrainingData, OperationError> {
    let MaterialBeside {
        mut background,
        unknown,
        exclude,
        clips: mut all,
    } = beside;
    let marked = db.background(classes)?;
    background.extend(marked.clips.into_iter().map(|info| info.name));
    let labels = accepted_labels(db)?;
    let taught = labels.rows.iter();
    let taught = taught.filter(|row| classes.is_empty() || classes.contains(&row.class));
    let mut names: BTreeSet<&str> = taught.map(|row| row.clip.as_str()).collect();
    names.extend(background.iter().chain(&unknown).map(String::as_str));
    let mut infos = db.clips(&ClipFilter::default())?;
    infos.retain(|info| names.contains(info.name.as_str()) && !exclude.contains(&info.name));
    all.splice(..0, clips_of(db, infos)?);
    for clip in &mut all {
        if background.contains(&clip.name) {
            clip.source = StreamKind::Background;
        }
    }
    let material = TrainingMaterial {
        labels: &labels,
        people: None,
        classes,
        unknown: &unknown,
    };
    let mut data = material.sort_out(all)?;
    data.notes.extend(errors_of(&data.clips));
    if !marked.labelled.is_empty() {
        data.notes.push(format!(
            "{} clips with the tag {BACKGROUND} have samples of the classes and are used as labelled clips: {}",
            marked.labelled.len(),
            some_of(marked.labelled.iter().map(|info| &info.name))
        ));
    }
    Ok(data)
}

/// What [`errors_of_clip`] says of clips that teach, each sentence once.
fn errors_of(clips: &[TrainClip]) -> Vec<String> {
    let mut said: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for clip in clips {
        for error in errors_of_clip(&clip.clip, &clip.roles, &clip.rest) {
            said.entry(error).or_default().push(&clip.name);
        }
    }
    let sentence = |(error, clips): (String, Vec<&str>)| format!("{}: {error}", some_of(clips));
    said.into_iter().map(sentence).collect()
}

/// Clips of a database, as labelled ones.
fn clips_of(db: &MotionDb, infos: Vec<ClipInfo>) -> Result<Vec<TrainClip>, DbError> {
    let ids: Vec<ClipId> = infos.iter().map(|info| info.id).collect();
    let clip = |(info, stored): (ClipInfo, StoredClip)| TrainClip {
        name: info.name,
        clip: stored.clip,
        roles: stored.roles,
        rest: stored.rest,
        source: StreamKind::Labelled,
        person: info.subject,
    };
    let stored = db.stored_clips(&ids)?;
    Ok(infos.into_iter().zip(stored).map(clip).collect())
}
