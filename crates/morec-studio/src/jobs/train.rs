//! Training in the background.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use morec::index::{MotionIndex, Provenance};
use morec::labels::Sample;
use morec::roles::{Role, RoleMap};
use morec::synth;
use morec::train::{
    EVERYDAY_SEED, Everyday, Labelling, Recipe, Source, TrainClip, TrainError, TrainOptions,
    TrainingReport, train_model,
};
use morec_db::labels::{SampleFilter, State};
use morec_db::{ClipFilter, DbError, MotionDb};

use super::{JobProgress, Outcome};

/// What training made.
pub struct Trained {
    pub index: Arc<MotionIndex>,
    pub bytes: Vec<u8>,
    pub report: TrainingReport,
    pub secs: f64,
}

/// Clips and samples to learn from.
pub struct Material {
    pub clips: Vec<TrainClip>,
    pub samples: Vec<Sample>,
    pub classes: Vec<String>,
}

/// The accepted samples of `classes` (all, if none are named) and the clips they lie in.
pub fn material(path: &Path, classes: &[String]) -> Result<Material, DbError> {
    let db = MotionDb::open_read_only(path)?;
    let filter = SampleFilter {
        state: Some(State::Accepted),
        ..SampleFilter::default()
    };
    let wanted = |class: &String| classes.is_empty() || classes.contains(class);
    let accepted = db.samples(&filter)?;
    let samples: Vec<Sample> = accepted
        .into_iter()
        .filter(|s| wanted(&s.class))
        .zip(1..)
        .map(|(s, line)| Sample {
            clip: s.clip_name,
            class: s.class,
            start_secs: s.start_secs,
            stop_secs: s.stop_secs,
            whole_clip: s.whole_clip,
            person: s.subject,
            line,
        })
        .collect();
    let mut names: Vec<&str> = samples.iter().map(|s| s.clip.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let mut clips = Vec::new();
    for info in db.clips(&ClipFilter::default())? {
        if names.binary_search(&info.name.as_str()).is_ok() {
            let stored = db.clip(info.id)?;
            clips.push(TrainClip {
                name: info.name,
                clip: stored.clip,
                roles: stored.roles,
                rest: stored.rest,
                source: Source::Labelled,
                person: info.subject,
            });
        }
    }
    let mut classes: Vec<String> = samples.iter().map(|s| s.class.clone()).collect();
    classes.sort();
    classes.dedup();
    Ok(Material {
        clips,
        samples,
        classes,
    })
}

/// Everyday motion, made once: it is the same for every index.
pub fn everyday() -> &'static [TrainClip] {
    static CLIPS: OnceLock<Vec<TrainClip>> = OnceLock::new();
    CLIPS.get_or_init(|| {
        let clip = |clip: morec::clip::Clip| TrainClip {
            name: clip.name.clone(),
            roles: RoleMap::find(&clip.skeleton),
            rest: 0..0,
            source: Source::Everyday,
            person: None,
            clip,
        };
        synth::everyday(EVERYDAY_SEED)
            .into_iter()
            .map(clip)
            .collect()
    })
}

/// How the studio trains: as `morec train` does, with everyday motion that is among the clips already.
pub fn recipe() -> Recipe {
    let everyday = Everyday::Never;
    TrainOptions {
        everyday,
        ..TrainOptions::default()
    }
    .into()
}

/// Trains an index of the database at `path`.
pub fn train(path: &Path, classes: &[String], progress: &JobProgress) -> Outcome {
    let begun = std::time::Instant::now();
    match trained(path, classes, progress) {
        Ok(mut trained) => {
            trained.secs = begun.elapsed().as_secs_f64();
            Outcome::Trained(Box::new(trained))
        }
        Err(None) => Outcome::Cancelled,
        Err(Some(why)) => Outcome::Failed(why),
    }
}

/// Why there is nothing; `None` if it was cancelled.
type Why = Option<String>;

fn trained(path: &Path, classes: &[String], progress: &JobProgress) -> Result<Trained, Why> {
    use morec::progress::Progress;
    let material = material(path, classes).map_err(|e| Some(e.to_string()))?;
    if material.samples.is_empty() {
        return Err(Some(
            "Nothing to learn from: label a few motions first".to_owned(),
        ));
    }
    progress.report("everyday motion", 0, 0);
    let mut clips = material.clips;
    clips.extend_from_slice(everyday());
    if progress.cancelled() {
        return Err(None);
    }
    let labelling = Labelling {
        samples: &material.samples,
        held_back: &[],
        classes: &material.classes,
        unlabelled_is_background: true,
    };
    let (model, report) =
        train_model(&clips, &labelling, &recipe(), progress).map_err(|e| match e {
            TrainError::Cancelled => None,
            other => Some(format!("Training stopped: {other}")),
        })?;
    let labelled = || clips.iter().filter(|c| c.source == Source::Labelled);
    let index = MotionIndex {
        roles: labelled().next().map(roles_of).unwrap_or_default(),
        provenance: Provenance {
            created: created(),
            morec_version: env!("CARGO_PKG_VERSION").to_owned(),
            clips: labelled().map(|c| c.name.clone()).collect(),
            samples: material.samples.len(),
            background_secs: report.background_secs.clone(),
        },
        model,
    };
    let bytes = index.to_bytes().map_err(|e| Some(e.to_string()))?;
    Ok(Trained {
        index: Arc::new(index),
        bytes,
        report,
        secs: 0.0,
    })
}

fn roles_of(clip: &TrainClip) -> std::collections::BTreeMap<Role, String> {
    let joints = clip.clip.skeleton.joints();
    let name = |role: Role| Some((role, joints[clip.roles.joint(role)?].name.clone()));
    Role::ALL.into_iter().filter_map(name).collect()
}

/// Now, as dates in indexes are written: `2026-11-22T06:30:00Z`.
fn created() -> String {
    let secs = std::time::SystemTime::now()
        .duration_since(std::time::UNIX_EPOCH)
        .map_or(0, |d| d.as_secs() as i64);
    crate::format::utc(secs)
}
