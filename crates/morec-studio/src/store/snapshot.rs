//! The contents of the database without motion, for drawing: read at once, then brought up to date by what edits touch.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use morec::roles::RoleMap;
use morec::train::ClassLabels;
use morec_db::labels::{ClassCount, DbSample, SampleFilter, SampleId, SampleState};
use morec_db::{
    ClipFilter, ClipId, ClipInfo, ClipVideo, DbError, HistoryStep, IndexInfo, MotionDb, ReportInfo,
    Segment, training_data,
};

/// The database at one moment, without motion. Snapshots that follow each other share what is the same.
#[derive(Debug, Clone, Default)]
pub struct Snapshot {
    /// By name.
    pub clips: Arc<Vec<ClipInfo>>,
    /// By name.
    pub classes: Vec<ClassCount>,
    /// By the names of their clips and time.
    pub samples: Vec<Arc<DbSample>>,
    /// By name. Whether one is stale by now says [`is_stale`](Self::is_stale).
    pub indexes: Arc<Vec<IndexInfo>>,
    /// Reports that are kept, the last first.
    pub reports: Arc<Vec<ReportInfo>>,
    /// The last first.
    pub history: Arc<Vec<HistoryStep>>,
    /// By clip and time.
    pub segments: Arc<Vec<Segment>>,
    /// By which method each clip was cut.
    pub cut_methods: Arc<BTreeMap<ClipId, String>>,
    /// Roles of the joints of each clip.
    pub roles: Arc<BTreeMap<ClipId, RoleMap>>,
    /// Videos beside clips.
    pub videos: Arc<BTreeMap<ClipId, ClipVideo>>,
    /// Places of classes by name.
    pub places: BTreeMap<String, usize>,
    /// Name of this program in the history.
    pub program: String,
    place: Arc<BTreeMap<ClipId, usize>>,
    sample_place: BTreeMap<SampleId, usize>,
    /// Number of the changes of others that are in it; `None`: nothing was read.
    others: Option<i64>,
    labels: OnceLock<BTreeMap<String, ClassLabels>>,
    taught: OnceLock<String>,
}

impl Snapshot {
    pub fn read(db: &MotionDb) -> Result<Self, DbError> {
        Self::default().follow(db)
    }

    /// The database after the next edit of `db`: what its steps touched is read, all else is as it was. If others changed
    /// something, everything is read.
    pub fn follow(&self, db: &MotionDb) -> Result<Self, DbError> {
        db.at_one_moment(|| {
            let others = Some(db.changes_of_others()?);
            let known = match others == self.others {
                true => &self.history[..],
                false => &[],
            };
            let history = db.history_since(known)?;
            let steps = history.iter().filter(|s| s.unchanged_in(known).is_none());
            let steps: Vec<&HistoryStep> = steps.collect();
            let touched = |tables: &[&str]| {
                let touches = |s: &&HistoryStep| tables.iter().any(|t| s.rows.contains_key(*t));
                others != self.others || steps.iter().any(touches)
            };
            let mut next = Self {
                others,
                places: db.class_places()?,
                // No step of the history says when there is a new one.
                reports: Arc::new(db.reports()?),
                program: db.program().to_owned(),
                labels: OnceLock::new(),
                taught: OnceLock::new(),
                ..self.clone()
            };
            // With a class go its samples, which clips count.
            if touched(&["clips", "files", "tags", "classes"]) {
                next.set_clips(db.clips(&ClipFilter::default())?);
            }
            if touched(&["clips"]) {
                next.roles = Arc::new(db.roles()?);
            }
            if touched(&["clips", "videos"]) {
                next.videos = Arc::new(db.videos()?);
            }
            if touched(&["segments"]) {
                next.segments = Arc::new(db.segments()?);
                next.cut_methods = Arc::new(db.cut_methods()?);
            }
            if touched(&["indexes"]) {
                next.indexes = Arc::new(db.indexes()?);
            }
            if touched(&["classes"]) {
                next.classes = db.classes()?;
            }
            // Samples carry the names of their clips and classes.
            if touched(&["clips", "classes"]) {
                next.set_samples(db.samples(&SampleFilter::default())?);
            } else if touched(&["samples", "annotators"]) {
                let mut ids = BTreeSet::new();
                for step in steps {
                    ids.extend(db.samples_of_step(step.id)?);
                }
                next.change_samples(db, &ids)?;
            }
            next.history = Arc::new(history);
            Ok(next)
        })
    }

    #[cfg(feature = "measure")]
    pub fn of(clips: Vec<ClipInfo>, classes: Vec<ClassCount>, samples: Vec<DbSample>) -> Self {
        let mut snapshot = Self {
            classes,
            ..Self::default()
        };
        snapshot.set_clips(clips);
        snapshot.set_samples(samples);
        snapshot
    }

    fn set_clips(&mut self, clips: Vec<ClipInfo>) {
        let places = clips.iter().enumerate().map(|(i, c)| (c.id, i));
        self.place = Arc::new(places.collect());
        self.clips = Arc::new(clips);
    }

    fn set_samples(&mut self, samples: Vec<DbSample>) {
        self.samples = samples
            .into_iter()
            .filter(is_likely)
            .map(Arc::new)
            .collect();
        self.count_samples();
    }

    /// Reads the samples of these numbers, which may be gone or new.
    fn change_samples(&mut self, db: &MotionDb, ids: &BTreeSet<SampleId>) -> Result<(), DbError> {
        let (gone, mut samples): (Vec<_>, Vec<_>) =
            self.samples.drain(..).partition(|s| ids.contains(&s.id));
        let mut clips: BTreeSet<ClipId> = gone.iter().map(|s| s.clip).collect();
        for id in ids {
            let sample = match db.sample(*id) {
                Ok(sample) if is_likely(&sample) => sample,
                Ok(_) | Err(DbError::Unknown { .. }) => continue,
                Err(error) => return Err(error),
            };
            clips.insert(sample.clip);
            let at = samples.partition_point(|s: &Arc<DbSample>| is_before(s, &sample));
            samples.insert(at, Arc::new(sample));
        }
        self.samples = samples;
        self.count_samples();
        for clip in clips {
            let accepted = |s: &&Arc<DbSample>| s.state == SampleState::Accepted;
            let count = self.samples_of(clip).iter().filter(accepted).count();
            if let Some(&at) = self.place.get(&clip)
                && self.clips[at].samples != count
            {
                Arc::make_mut(&mut self.clips)[at].samples = count;
            }
        }
        Ok(())
    }

    /// Counts the samples of classes, without those that are not shown.
    fn count_samples(&mut self) {
        let places = self.samples.iter().enumerate().map(|(i, s)| (s.id, i));
        self.sample_place = places.collect();
        for class in &mut self.classes {
            (class.accepted, class.proposed, class.rejected) = (0, 0, 0);
            class.secs = 0.0;
        }
        for sample in &self.samples {
            let Ok(at) = self
                .classes
                .binary_search_by(|c| c.name.as_str().cmp(&sample.class))
            else {
                continue;
            };
            let class = &mut self.classes[at];
            match sample.state {
                SampleState::Accepted => {
                    class.accepted += 1;
                    class.secs += sample.stop_secs - sample.start_secs;
                }
                SampleState::Proposed => class.proposed += 1,
                SampleState::Rejected => class.rejected += 1,
            }
        }
    }

    /// What the accepted labels of each class say of its kind; made when it is first asked for.
    pub fn labels(&self) -> &BTreeMap<String, ClassLabels> {
        let labels = || labels_of(&self.clips, self.accepted());
        self.labels.get_or_init(labels)
    }

    /// True if accepted samples or the clips that are background have changed since an index was trained.
    pub fn is_stale(&self, index: &IndexInfo) -> bool {
        let background = self.clips.iter();
        let background = background.filter(|clip| clip.is_background() && clip.samples == 0);
        let now = || training_data(self.accepted(), background);
        *self.taught.get_or_init(now) != index.taught
    }

    /// Segments of a clip, by time.
    pub fn segments_of(&self, clip: ClipId) -> &[Segment] {
        let start = self.segments.partition_point(|s| s.clip < clip);
        let stop = self.segments.partition_point(|s| s.clip <= clip);
        &self.segments[start..stop]
    }

    pub fn clip(&self, id: ClipId) -> Option<&ClipInfo> {
        self.place.get(&id).map(|&at| &self.clips[at])
    }

    /// The samples of a clip, by time.
    pub fn samples_of(&self, clip: ClipId) -> &[Arc<DbSample>] {
        let name = self.clip(clip).map_or("", |clip| &clip.name);
        let start = self.samples.partition_point(|s| *s.clip_name < *name);
        let stop = self.samples.partition_point(|s| *s.clip_name <= *name);
        &self.samples[start..stop]
    }

    pub fn sample(&self, id: SampleId) -> Option<&DbSample> {
        self.sample_place.get(&id).map(|&at| &*self.samples[at])
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
        let samples = self.samples.iter().map(|s| &**s);
        samples.filter(|s| s.state == SampleState::Accepted)
    }
}

/// Proposals less likely than this are shown as 0 %, and are not worth an answer.
pub const UNLIKELY: f64 = 0.005;

/// False for a proposal that is not worth an answer.
fn is_likely(sample: &DbSample) -> bool {
    sample.state != SampleState::Proposed || sample.score.is_none_or(|p| p >= UNLIKELY)
}

/// The order of samples in a snapshot, which is that of the database.
fn is_before(a: &DbSample, b: &DbSample) -> bool {
    let secs = |s: &DbSample| (s.start_secs, s.stop_secs);
    let order = a.clip_name.cmp(&b.clip_name);
    let order = order.then(secs(a).partial_cmp(&secs(b)).unwrap_or(Ordering::Equal));
    order.then_with(|| a.class.cmp(&b.class)).is_lt()
}

fn labels_of<'a>(
    clips: &[ClipInfo],
    accepted: impl Iterator<Item = &'a DbSample>,
) -> BTreeMap<String, ClassLabels> {
    let mut by_clip: BTreeMap<ClipId, Vec<(String, Range<f64>)>> = BTreeMap::new();
    for sample in accepted {
        let label = (sample.class.clone(), sample.start_secs..sample.stop_secs);
        by_clip.entry(sample.clip).or_default().push(label);
    }
    let of_clip = |clip: &ClipInfo| Some((clip.duration_secs(), by_clip.remove(&clip.id)?));
    ClassLabels::of_clips(clips.iter().filter_map(of_clip))
}
