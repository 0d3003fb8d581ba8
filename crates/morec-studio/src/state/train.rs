//! Training: the classes that are learned, the index, cross-validation, the method of 2009.

use std::collections::BTreeSet;
use std::sync::Arc;

use morec::index::MotionIndex;
use morec::train::thesis::SvrdmTrainParams;
use morec::train::{ClassKind, TrainingReport};
use morec_db::ReportInfo;
use morec_ops::{KeptTraining, LearningCurve, TrainSettings};

use super::crossval::CrossvalView;
use crate::jobs::thesis::{Map, Thesis};
use crate::store::Snapshot;

/// The training panel's own state.
#[derive(Default)]
pub struct Train {
    /// Classes that are left out.
    pub without: BTreeSet<String>,
    /// How an index is trained; its classes are those of the labels that are not left out.
    pub settings: TrainSettings,
    pub index: Option<Arc<MotionIndex>>,
    pub bytes: Vec<u8>,
    pub report: Option<TrainingReport>,
    /// Duration of training.
    pub secs: f64,
    /// The labels and background that taught the index, to know whether they have changed.
    pub(super) taught: u64,
    pub(super) now: u64,
    pub judged: Option<CrossvalView>,
    pub curve: Option<LearningCurve>,
    /// The kept report that is open: of the cross-validation shown, of the learning curve shown, or of a training.
    pub opened: Option<OpenedReport>,
    /// The cell of the confusion matrix whose moments are listed; `None` lists the mistakes.
    pub cell: Option<(usize, usize)>,
    /// The moment of the list that was chosen, by its place in `CrossvalView::moments`.
    pub moment: Option<usize>,
    /// The figures with which the method of 2009 is trained.
    pub thesis_params: SvrdmTrainParams,
    /// The method of 2009, once it is trained; the branch that is shown; its map of the clip that is shown.
    pub thesis: Option<Arc<Thesis>>,
    pub branch: usize,
    /// The sample that was chosen by its point.
    pub sample: Option<usize>,
    pub map: Option<Map>,
}

/// A report of the database.
pub struct OpenedReport {
    pub info: ReportInfo,
    /// Text of a training; `None` of a cross-validation (see `Train::judged`) or a learning curve (see `Train::curve`).
    pub training: Option<KeptTraining>,
}

impl Train {
    /// The kind that was chosen for a class.
    pub fn kind(&self, class: &String) -> Option<ClassKind> {
        let TrainSettings {
            activities,
            gestures,
            ..
        } = &self.settings;
        match (activities.contains(class), gestures.contains(class)) {
            (true, _) => Some(ClassKind::Activity),
            (_, true) => Some(ClassKind::Gesture),
            _ => None,
        }
    }

    pub(super) fn set_kind(&mut self, class: String, kind: Option<ClassKind>) {
        let TrainSettings {
            activities,
            gestures,
            ..
        } = &mut self.settings;
        activities.retain(|other| *other != class);
        gestures.retain(|other| *other != class);
        match kind {
            Some(ClassKind::Activity) => activities.push(class),
            Some(ClassKind::Gesture) => gestures.push(class),
            None => {}
        }
    }

    /// True if labels or background have changed since the index was trained.
    pub fn is_stale(&self) -> bool {
        self.index.is_some() && self.taught != self.now
    }

    pub(super) fn follow(&mut self, snapshot: &Snapshot) {
        use std::hash::{Hash, Hasher};
        let mut hasher = std::hash::DefaultHasher::new();
        for s in snapshot.accepted() {
            let extent = (s.start_secs.to_bits(), s.stop_secs.to_bits());
            (s.clip, &s.class, extent).hash(&mut hasher);
        }
        for clip in snapshot.clips.iter().filter(|clip| clip.is_background()) {
            clip.id.hash(&mut hasher);
        }
        self.now = hasher.finish();
    }
}
