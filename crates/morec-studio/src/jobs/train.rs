//! Training in the background.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use morec::features::{BoneSet, HeadingLine};
use morec::index::{MotionIndex, Provenance};
use morec::labels::Sample;
use morec::progress::Progress;
use morec::train::{
    EVERYDAY_SEED, Everyday, LabelSet, Prepared, StreamKind, TrainClip, TrainError, TrainOptions,
    TrainParams, TrainStream, TrainingData, TrainingReport, add_mirrored, build_train_set,
    everyday_clips, train,
};
use morec_db::labels::{SampleFilter, SampleState};
use morec_db::{ClipFilter, ClipId, ClipInfo, DbError, MotionDb, StoredClip};

use super::progress::{JobError, JobProgress};

/// Result of training.
pub struct TrainedIndex {
    pub index: Arc<MotionIndex>,
    pub bytes: Vec<u8>,
    pub report: TrainingReport,
    pub secs: f64,
}

/// The accepted samples of `classes` (all, if none are named), the clips they lie in, and those that are marked as background.
pub fn material(path: &Path, classes: &[String]) -> Result<TrainingData, DbError> {
    let db = MotionDb::open_read_only(path)?;
    let filter = SampleFilter {
        state: Some(SampleState::Accepted),
        ..SampleFilter::default()
    };
    let wanted = |class: &String| classes.is_empty() || classes.contains(class);
    let accepted = db.samples(&filter)?;
    let samples: Vec<Sample> = accepted
        .into_iter()
        .filter(|s| wanted(&s.class))
        .zip(1..)
        .map(|(s, line)| Sample {
            span: s.span(),
            clip: s.clip_name,
            class: s.class,
            whole_clip: s.whole_clip,
            person: s.subject,
            line,
        })
        .collect();
    let labelled: BTreeSet<&str> = samples.iter().map(|s| s.clip.as_str()).collect();
    let background = db.background(classes)?.clips;
    let background: BTreeSet<ClipId> = background.iter().map(|info| info.id).collect();
    let mut infos = db.clips(&ClipFilter::default())?;
    infos.retain(|info| labelled.contains(info.name.as_str()) || background.contains(&info.id));
    let ids: Vec<ClipId> = infos.iter().map(|info| info.id).collect();
    let stored = db.stored_clips(&ids)?;
    let clip = |(info, stored): (ClipInfo, StoredClip)| TrainClip {
        source: match background.contains(&info.id) {
            true => StreamKind::Background,
            false => StreamKind::Labelled,
        },
        name: info.name,
        clip: stored.clip,
        roles: stored.roles,
        rest: stored.rest,
        person: info.subject,
    };
    let clips = infos.into_iter().zip(stored).map(clip).collect();
    let mut classes: Vec<String> = samples.iter().map(|s| s.class.clone()).collect();
    classes.sort();
    classes.dedup();
    Ok(TrainingData {
        clips,
        samples,
        classes,
        ..TrainingData::default()
    })
}

/// Everyday motion, once it is made: it is the same for every index.
pub static EVERYDAY: OnceLock<Vec<TrainClip>> = OnceLock::new();

/// The same, made when first asked for.
pub fn everyday() -> &'static [TrainClip] {
    EVERYDAY.get_or_init(|| everyday_clips(EVERYDAY_SEED))
}

/// Options of training: those of `morec train`, with everyday motion that is among the clips already.
pub fn options(bones: BoneSet) -> TrainOptions {
    TrainOptions {
        bones,
        everyday: Everyday::Never,
        ..TrainOptions::default()
    }
}

/// Trains an index of the database at `path`.
pub fn run(
    path: &Path,
    classes: &[String],
    options: TrainOptions,
    progress: &JobProgress,
) -> Result<Box<TrainedIndex>, JobError> {
    let begun = std::time::Instant::now();
    let mut trained = trained(path, classes, options, progress)?;
    trained.secs = begun.elapsed().as_secs_f64();
    Ok(Box::new(trained))
}

fn trained(
    path: &Path,
    classes: &[String],
    options: TrainOptions,
    progress: &JobProgress,
) -> Result<TrainedIndex, JobError> {
    let data = material(path, classes).map_err(|e| JobError::Failed(e.to_string()))?;
    if data.samples.is_empty() {
        return Err(JobError::Failed(
            "Nothing to learn from: label a few motions first".to_owned(),
        ));
    }
    let TrainOptions {
        params,
        mirror,
        one_sided,
        bones: wanted,
        ..
    } = options;
    let mut prepared = prepared(&data, wanted, &params, progress);
    if progress.cancelled() {
        return Err(JobError::Cancelled);
    }
    if prepared.bones == BoneSet::NONE {
        let why = prepared.no_bone(wanted);
        return Err(JobError::Failed(format!("Training stopped: {why}")));
    }
    let bones = prepared.bones;
    add_mirrored(&mut prepared.set, bones, mirror, &one_sided);
    let params = prepared.params(&params);
    let done = train(&prepared.set, prepared.bones, &params, progress).map_err(|e| match e {
        TrainError::Cancelled => JobError::Cancelled,
        other => JobError::Failed(format!("Training stopped: {other}")),
    })?;
    let report = TrainingReport::of(&prepared, &done, &params);
    let index = MotionIndex {
        roles: data.role_names(),
        provenance: Provenance {
            created: created(),
            morec_version: env!("CARGO_PKG_VERSION").to_owned(),
            clips: data.labelled().map(|c| c.name.clone()).collect(),
            samples: data.samples.len(),
            background_secs: report.background_secs.clone(),
        },
        model: done.model.into(),
    };
    let bytes = index
        .to_bytes()
        .map_err(|e| JobError::Failed(e.to_string()))?;
    Ok(TrainedIndex {
        index: Arc::new(index),
        bytes,
        report,
        secs: 0.0,
    })
}

/// Streams to train from. Everyday motion is the same for every index of the same bones and heading: its rows are made once.
fn prepared(
    data: &TrainingData,
    wanted: BoneSet,
    params: &TrainParams,
    progress: &JobProgress,
) -> Prepared {
    static EVERYDAY: Mutex<BTreeMap<(BoneSet, HeadingLine), Vec<TrainStream>>> =
        Mutex::new(BTreeMap::new());
    let labelling = LabelSet {
        samples: &data.samples,
        held_back: &[],
        classes: &data.classes,
        unlabelled_is_background: true,
    };
    let mut prepared = build_train_set(&data.clips, &labelling, wanted, &params.features);
    let mut known = EVERYDAY.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(streams) = known.get(&(prepared.bones, prepared.features.heading)) {
        prepared.set.streams.extend_from_slice(streams);
        return prepared;
    }
    progress.report("everyday motion", 0, 0);
    let mut clips = data.clips.clone();
    clips.extend_from_slice(everyday());
    let prepared = build_train_set(&clips, &labelling, wanted, &params.features);
    let streams = prepared.set.streams.iter();
    let made = streams
        .filter(|s| s.source == StreamKind::Everyday)
        .cloned();
    known.insert((prepared.bones, prepared.features.heading), made.collect());
    prepared
}

/// Now, as dates in indexes are written: `2026-11-22T06:30:00Z`.
fn created() -> String {
    let secs = std::time::SystemTime::now()
        .duration_since(std::time::UNIX_EPOCH)
        .map_or(0, |d| d.as_secs() as i64);
    crate::format::utc(secs)
}
