//! What a database has to train from.

use std::collections::BTreeSet;

use morec::labels::{Extent, Label, Labels};
use morec::train::{StreamKind, TrainClip, TrainingData};
use morec_db::labels::{DbSample, SampleFilter, SampleState};
use morec_db::{ClipFilter, ClipId, ClipInfo, DbError, MotionDb, StoredClip};

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
        line,
    };
    let samples = db.samples(&filter)?.into_iter();
    Ok(Labels {
        rows: samples.zip(1..).map(label).collect(),
        warnings: Vec::new(),
    })
}

/// Clips of a database, as labelled ones.
///
/// # Errors
/// The database cannot be read.
pub fn clips_to_train(
    db: &MotionDb,
    infos: Vec<ClipInfo>,
) -> Result<Vec<(ClipInfo, TrainClip)>, DbError> {
    let ids: Vec<ClipId> = infos.iter().map(|info| info.id).collect();
    let clip = |(info, stored): (ClipInfo, StoredClip)| {
        let clip = TrainClip {
            name: info.name.clone(),
            clip: stored.clip,
            roles: stored.roles,
            rest: stored.rest,
            source: StreamKind::Labelled,
            person: info.subject.clone(),
        };
        (info, clip)
    };
    let stored = db.stored_clips(&ids)?;
    Ok(infos.into_iter().zip(stored).map(clip).collect())
}

/// The accepted samples of `classes` (all, if none are named), the clips they lie in, and those that are marked as background.
/// Classes without an accepted sample are left out.
///
/// # Errors
/// The database cannot be read, or holds no sample of the classes.
pub fn training_data(db: &MotionDb, classes: &[String]) -> Result<TrainingData, OperationError> {
    let mut labels = accepted_labels(db)?;
    let shown = |class: &String| labels.rows.iter().any(|row| row.class == *class);
    let shown: Vec<String> = classes.iter().filter(|c| shown(c)).cloned().collect();
    if !classes.is_empty() {
        labels.rows.retain(|row| classes.contains(&row.class));
    }
    let background = db.background(classes)?.clips;
    let background: BTreeSet<ClipId> = background.iter().map(|info| info.id).collect();
    let taught: BTreeSet<&str> = labels.rows.iter().map(|row| row.clip.as_str()).collect();
    let mut infos = db.clips(&ClipFilter::default())?;
    infos.retain(|info| background.contains(&info.id) || taught.contains(info.name.as_str()));
    let clips = clips_to_train(db, infos)?.into_iter();
    let clips = clips.map(|(info, clip)| TrainClip {
        source: match background.contains(&info.id) {
            true => StreamKind::Background,
            false => StreamKind::Labelled,
        },
        ..clip
    });
    Ok(TrainingData::new(clips.collect(), &labels, &shown)?)
}
