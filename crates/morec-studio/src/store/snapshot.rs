//! The contents of the database without motion, read at once, for drawing.

use std::collections::BTreeMap;
use std::ops::Range;

use morec::roles::RoleMap;
use morec::train::ClassLabels;
use morec_db::labels::{ClassCount, DbSample, SampleFilter, SampleId, SampleState};
use morec_db::{ClipFilter, ClipId, ClipInfo, DbError, HistoryStep, IndexInfo, MotionDb, Segment};

/// The database at one moment, without motion.
#[derive(Debug, Clone, Default)]
pub struct Snapshot {
    /// By name.
    pub clips: Vec<ClipInfo>,
    /// By name.
    pub classes: Vec<ClassCount>,
    /// By clip and time.
    pub samples: Vec<DbSample>,
    pub indexes: Vec<IndexInfo>,
    /// The last first.
    pub history: Vec<HistoryStep>,
    /// By clip and time.
    pub segments: Vec<Segment>,
    /// By which method each clip was cut.
    pub cut_methods: BTreeMap<ClipId, String>,
    /// Roles of the joints of each clip.
    pub roles: BTreeMap<ClipId, RoleMap>,
    /// Places of classes by name.
    pub places: BTreeMap<String, usize>,
    /// What the accepted labels of each class say of its kind.
    pub labels: BTreeMap<String, ClassLabels>,
    /// Name of this program in the history.
    pub program: String,
    place: BTreeMap<ClipId, usize>,
    segments_of: BTreeMap<ClipId, Range<usize>>,
    samples_of: BTreeMap<ClipId, Range<usize>>,
    sample_place: BTreeMap<SampleId, usize>,
}

impl Snapshot {
    pub fn read(db: &MotionDb) -> Result<Self, DbError> {
        let segments = db.segments()?;
        let (mut classes, mut samples) = (db.classes()?, db.samples(&SampleFilter::default())?);
        leave_out_unlikely(&mut classes, &mut samples);
        Ok(Self {
            segments_of: runs(segments.iter().map(|s| s.clip)),
            segments,
            cut_methods: db.cut_methods()?,
            roles: db.roles()?,
            places: db.class_places()?,
            program: db.program().to_owned(),
            ..Self::of(
                db.clips(&ClipFilter::default())?,
                classes,
                samples,
                db.indexes()?,
                db.history()?,
            )
        })
    }

    pub fn of(
        clips: Vec<ClipInfo>,
        classes: Vec<ClassCount>,
        samples: Vec<DbSample>,
        indexes: Vec<IndexInfo>,
        history: Vec<HistoryStep>,
    ) -> Self {
        Self {
            labels: labels_of(&clips, &samples),
            place: clips.iter().enumerate().map(|(i, c)| (c.id, i)).collect(),
            samples_of: runs(samples.iter().map(|s| s.clip)),
            sample_place: samples.iter().enumerate().map(|(i, s)| (s.id, i)).collect(),
            clips,
            classes,
            samples,
            indexes,
            history,
            ..Self::default()
        }
    }

    /// Segments of a clip, by time.
    pub fn segments_of(&self, clip: ClipId) -> &[Segment] {
        let range = self.segments_of.get(&clip).cloned().unwrap_or_default();
        &self.segments[range]
    }

    pub fn clip(&self, id: ClipId) -> Option<&ClipInfo> {
        self.place.get(&id).map(|&at| &self.clips[at])
    }

    /// The samples of a clip, by time.
    pub fn samples_of(&self, clip: ClipId) -> &[DbSample] {
        let range = self.samples_of.get(&clip).cloned().unwrap_or_default();
        &self.samples[range]
    }

    pub fn sample(&self, id: SampleId) -> Option<&DbSample> {
        self.sample_place.get(&id).map(|&at| &self.samples[at])
    }

    /// The step that undo would take back.
    pub fn undo_step(&self) -> Option<&HistoryStep> {
        self.history.iter().find(|s| !s.undone)
    }

    /// True if another program made a step.
    pub fn is_foreign(&self, step: &HistoryStep) -> bool {
        !step.made_by.is_empty() && step.made_by != self.program
    }

    /// The step that undo would take back, if another program made it.
    pub fn foreign_step(&self) -> Option<&HistoryStep> {
        self.undo_step().filter(|step| self.is_foreign(step))
    }

    /// The last step that this program made.
    pub fn my_step(&self) -> Option<&HistoryStep> {
        let mut steps = self.history.iter();
        steps.find(|step| !step.undone && !self.is_foreign(step))
    }

    /// Name of the step that redo would do again: the earliest of those that were taken back.
    pub fn redo_name(&self) -> Option<&str> {
        let step = self.history.iter().rev().find(|s| s.undone)?;
        Some(&step.what)
    }

    pub fn accepted(&self) -> impl Iterator<Item = &DbSample> {
        self.samples
            .iter()
            .filter(|s| s.state == SampleState::Accepted)
    }
}

/// Proposals less likely than this are shown as 0 %, and are not worth an answer.
pub const UNLIKELY: f64 = 0.005;

/// Leaves out the proposals that are not worth an answer.
fn leave_out_unlikely(classes: &mut [ClassCount], samples: &mut Vec<DbSample>) {
    samples.retain(|s| {
        let kept = s.state != SampleState::Proposed || s.score.is_none_or(|p| p >= UNLIKELY);
        if !kept && let Some(class) = classes.iter_mut().find(|c| c.name == s.class) {
            class.proposed = class.proposed.saturating_sub(1);
        }
        kept
    });
}

/// Ranges of equal clips in a list in which they lie together.
fn runs(clips: impl Iterator<Item = ClipId>) -> BTreeMap<ClipId, Range<usize>> {
    let mut runs: BTreeMap<ClipId, Range<usize>> = BTreeMap::new();
    for (at, clip) in clips.enumerate() {
        runs.entry(clip).or_insert(at..at).end = at + 1;
    }
    runs
}

fn labels_of(clips: &[ClipInfo], samples: &[DbSample]) -> BTreeMap<String, ClassLabels> {
    let mut by_clip: BTreeMap<ClipId, Vec<(String, Range<f64>)>> = BTreeMap::new();
    for sample in samples.iter().filter(|s| s.state == SampleState::Accepted) {
        let label = (sample.class.clone(), sample.start_secs..sample.stop_secs);
        by_clip.entry(sample.clip).or_default().push(label);
    }
    let of_clip = |clip: &ClipInfo| Some((clip.duration_secs(), by_clip.remove(&clip.id)?));
    ClassLabels::of_clips(clips.iter().filter_map(of_clip))
}
