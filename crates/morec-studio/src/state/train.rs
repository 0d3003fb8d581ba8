//! Training, what it reports, and how good the index is.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use morec::index::MotionIndex;
use morec::train::TrainingReport;

use super::files::quoted;
use super::{Panel, State, TrainCommand};
use crate::jobs::load::ClipMotion;
use crate::jobs::thesis::{self, Map, Thesis};
use crate::jobs::{judge, recognise, train};
use crate::store::{Edit, Snapshot};

/// The name under which an index is kept in the database.
pub const INDEX: &str = "studio";
const TRAINING: &str = "Training";
const JUDGING: &str = "Judging";
const THESIS: &str = "Training the method of 2009";
/// Name of the job that maps confidences.
pub(super) const MAPPING: &str = "Mapping confidences";

/// The training panel's own state.
#[derive(Default)]
pub struct Train {
    /// Classes that are left out.
    pub without: BTreeSet<String>,
    pub index: Option<Arc<MotionIndex>>,
    pub bytes: Vec<u8>,
    pub report: Option<TrainingReport>,
    /// How long training took.
    pub secs: f64,
    /// The labels that taught the index, to know whether they have changed.
    taught: u64,
    now: u64,
    pub judged: Option<CrossvalView>,
    /// The cell of the confusion matrix that is shown.
    pub cell: Option<(usize, usize)>,
    /// The method of 2009, once it is trained; the branch that is shown; its map of the clip that is shown.
    pub thesis: Option<Arc<Thesis>>,
    pub branch: usize,
    pub map: Option<Map>,
}

/// A cross-validation, ready to be shown.
pub struct CrossvalView {
    pub evaluation: morec::eval::Evaluation,
    pub moments: Vec<judge::Moment>,
    pub by: &'static str,
}

impl From<judge::CrossvalResult> for CrossvalView {
    fn from(judged: judge::CrossvalResult) -> Self {
        Self {
            moments: judged.moments(),
            evaluation: judged.evaluation,
            by: judged.by,
        }
    }
}

impl CrossvalView {
    /// The moments of a cell; the row after the last class is what nobody labelled, the column after it nothing found.
    pub fn of_cell(&self, row: usize, column: usize) -> Vec<&judge::Moment> {
        let confusion = &self.evaluation.confusion;
        let (truth, found) = (confusion.rows.get(row), confusion.columns.get(column));
        let wanted = |m: &&judge::Moment| m.truth.as_ref() == truth && m.found.as_ref() == found;
        self.moments.iter().filter(wanted).collect()
    }
}

impl Train {
    /// Whether labels have changed since the index was trained.
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
        self.now = hasher.finish();
    }
}

impl State {
    pub(super) fn apply_train(&mut self, command: TrainCommand) {
        match command {
            TrainCommand::Choose { class, on } => {
                match on {
                    true => self.train.without.remove(&class),
                    false => self.train.without.insert(class),
                };
            }
            TrainCommand::Train => self.start_training(),
            TrainCommand::Judge => self.start_judging(),
            TrainCommand::Cell(cell) => self.train.cell = cell,
            TrainCommand::Keep(name) => {
                let bytes = self.train.bytes.clone();
                if !bytes.is_empty() {
                    self.edit(Edit::KeepIndex { name, bytes });
                }
            }
            TrainCommand::UseIndex(name) => self.use_index(&name),
            TrainCommand::Thesis => self.train_thesis(),
            TrainCommand::Branch(node) => self.train.branch = node,
        }
    }

    /// The classes that are learned; none means all.
    fn chosen(&self) -> Vec<String> {
        if self.train.without.is_empty() {
            return Vec::new();
        }
        let Some(store) = &self.store else {
            return Vec::new();
        };
        let names = store.snapshot.classes.iter().map(|c| &c.name);
        names
            .filter(|name| !self.train.without.contains(*name))
            .cloned()
            .collect()
    }

    /// Trains with what is labelled now; a training that is under way starts again.
    pub(super) fn start_training(&mut self) {
        let Some(store) = &self.store else { return };
        if store.snapshot.accepted().next().is_none() {
            self.complain("Nothing to learn from: label a few motions first");
            return;
        }
        for job in self.jobs.running.iter().filter(|j| j.name == TRAINING) {
            job.cancel();
        }
        let (db, classes) = (store.path().to_owned(), self.chosen());
        self.train.taught = self.train.now;
        let chosen = match classes.is_empty() {
            true => String::new(),
            false => format!(" --classes {}", classes.join(",")),
        };
        self.command_line = format!("morec train --db {}{chosen} -o {INDEX}.index", quoted(&db));
        self.jobs
            .start(TRAINING, true, &self.wake, move |progress| {
                train::run(&db, &classes, progress)
            });
    }

    fn start_judging(&mut self) {
        let Some(store) = &self.store else { return };
        let (db, classes) = (store.path().to_owned(), self.chosen());
        self.command_line = format!("morec crossval --db {}", quoted(&db));
        self.jobs.start(JUDGING, true, &self.wake, move |progress| {
            judge::judge(&db, &classes, progress)
        });
    }

    fn train_thesis(&mut self) {
        let Some(store) = &self.store else { return };
        if store.snapshot.accepted().next().is_none() {
            self.complain("Nothing to learn from: label a few motions first");
            return;
        }
        let (db, classes) = (store.path().to_owned(), self.chosen());
        self.command_line = format!(
            "morec train --db {} --method svrdm -o 2009.index",
            quoted(&db)
        );
        self.jobs.start(THESIS, true, &self.wake, move |progress| {
            thesis::run(&db, &classes, progress)
        });
    }

    pub(super) fn thesis_trained(&mut self, thesis: Arc<Thesis>) {
        let samples = crate::format::count(thesis.samples.len(), "sample");
        self.say(format!("the method of 2009 is trained on {samples}"));
        let mut branches = thesis.nodes.iter();
        let first = branches.position(|n| matches!(n, thesis::Shown::Branch(_)));
        self.train.branch = first.unwrap_or(0);
        self.train.thesis = Some(thesis);
        if let Some(motion) = self.player.motion.clone() {
            self.want_map(&motion);
        }
    }

    /// The confidences of the method of 2009 over the clip that is shown.
    pub(super) fn want_map(&mut self, motion: &Arc<ClipMotion>) {
        self.train.map = None;
        let Some(thesis) = self.train.thesis.clone() else {
            return;
        };
        for job in self.jobs.running.iter().filter(|j| j.name == MAPPING) {
            job.cancel();
        }
        let motion = motion.clone();
        self.jobs
            .start(MAPPING, false, &self.wake, move |progress| {
                thesis::map(&thesis.model, &motion, progress)
            });
    }

    pub fn is_training_thesis(&self) -> bool {
        self.jobs.is_running(THESIS)
    }

    /// Whether an index is being trained.
    pub fn is_training(&self) -> bool {
        self.jobs.is_running(TRAINING)
    }

    pub fn is_judging(&self) -> bool {
        self.jobs.is_running(JUDGING)
    }

    pub(super) fn trained(&mut self, trained: train::TrainedIndex) {
        let classes = crate::format::count(trained.report.classes.len(), "class");
        self.say(format!("trained on {classes} in {:.1} s", trained.secs));
        self.train.secs = trained.secs;
        self.train.index = Some(trained.index);
        self.train.bytes = trained.bytes;
        self.train.report = Some(trained.report);
        self.live.follow_index(self.train.index.as_ref());
        if self.panel != Panel::Live
            && let Some(motion) = self.player.motion.clone()
        {
            self.want_detections(&motion);
        }
    }

    /// What the index recognises in a clip that is shown.
    pub(super) fn want_detections(&mut self, motion: &Arc<ClipMotion>) {
        self.detections = None;
        let Some(index) = self.train.index.clone() else {
            return;
        };
        let motion = motion.clone();
        self.jobs
            .start("Recognising", false, &self.wake, move |progress| {
                recognise::clip(&index, &motion, progress)
            });
    }

    fn use_index(&mut self, name: &str) {
        let Some(store) = &self.store else { return };
        let read = morec_db::MotionDb::open_read_only(store.path())
            .and_then(|db| db.index(name))
            .map_err(|e| e.to_string())
            .and_then(|bytes| {
                let index = MotionIndex::from_bytes(&bytes).map_err(|e| e.to_string())?;
                Ok((index, bytes))
            });
        match read {
            Ok((index, bytes)) => {
                self.train.index = Some(Arc::new(index));
                self.train.bytes = bytes;
                self.train.report = None;
                self.train.taught = self.train.now;
                self.say(format!("index {name} is in use"));
                self.live.follow_index(self.train.index.as_ref());
                if let Some(motion) = self.player.motion.clone() {
                    self.want_detections(&motion);
                }
            }
            Err(why) => self.complain(format!("Index {name}: {why}")),
        }
    }

    pub(super) fn export_index(&mut self, path: &Path) {
        if self.train.bytes.is_empty() {
            self.complain("There is no index yet: train first");
            return;
        }
        match std::fs::write(path, &self.train.bytes) {
            Ok(()) => self.say(format!("{} written", crate::format::file_name(path))),
            Err(error) => self.complain(format!(
                "{}: not written: {error}",
                crate::format::file_name(path)
            )),
        }
    }
}
