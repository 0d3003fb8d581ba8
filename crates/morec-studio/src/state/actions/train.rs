//! Training: the classes that are learned, the index, cross-validation.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use morec::index::MotionIndex;
use morec::live::Model;
use morec_db::labels::DbSample;
use morec_ops::{CrossvalSettings, LeftOut, TrainSettings};

use super::lines::{ShownCommand, train_line};
use crate::body::ClipMotion;
use crate::jobs::export::write_whole;
use crate::jobs::{JobOutcome, judge, learning_curve, recognise, train};
use crate::state::{Panel, State, TrainCommand};
use crate::store::{Edit, Snapshot};

/// The name under which an index is kept in the database.
pub const INDEX: &str = "studio";
const TRAINING: &str = "Training";
const JUDGING: &str = "Judging";
const MEASURING_CURVE: &str = "Measuring the learning curve";

impl State {
    pub(in crate::state) fn apply_train(&mut self, command: TrainCommand) {
        match command {
            TrainCommand::Choose { class, on } => {
                match on {
                    true => self.train.without.remove(&class),
                    false => self.train.without.insert(class),
                };
            }
            TrainCommand::Kind { class, kind } => {
                self.train.set_kind(class, kind);
            }
            TrainCommand::Parts(bones) => self.train.settings.bones = bones,
            TrainCommand::Train => self.start_training(),
            TrainCommand::Judge => self.start_judging(self.train_settings()),
            TrainCommand::Curve => self.measure_curve(),
            TrainCommand::CloseCurve => self.close_curve(),
            TrainCommand::Cell(cell) => self.show_cell(cell),
            TrainCommand::Moment(at) => self.go_to_moment(at),
            TrainCommand::StepMoment(by) => self.step_moment(by),
            TrainCommand::Keep(name) => {
                let bytes = self.train.bytes.clone();
                if !bytes.is_empty() {
                    self.edit(Edit::KeepIndex { name, bytes });
                }
            }
            TrainCommand::UseIndex(name) => self.use_index(&name),
            TrainCommand::OpenReport(id) => self.open_report(id),
            TrainCommand::CloseReport => self.close_report(),
            TrainCommand::ThesisParams(params) => self.train.thesis_params = *params,
            TrainCommand::Thesis => self.train_thesis(),
            TrainCommand::JudgeThesis => self.start_judging(self.thesis_settings()),
            TrainCommand::Branch(node) => self.train.branch = node,
            TrainCommand::Sample(at) => self.play_taught(at),
        }
    }

    /// The classes that are learned, which have labels; none means all.
    pub(in crate::state) fn chosen(&self) -> Vec<String> {
        if self.train.without.is_empty() {
            return Vec::new();
        }
        let Some(store) = &self.store else {
            return Vec::new();
        };
        let labelled = store.snapshot.classes.iter().filter(|c| c.accepted > 0);
        labelled
            .map(|class| class.name.clone())
            .filter(|name| !self.train.without.contains(name))
            .collect()
    }

    /// The settings of training as they are chosen, for the classes that are learned.
    pub(super) fn train_settings(&self) -> TrainSettings {
        let snapshot = self.store.as_ref().map(|store| &store.snapshot);
        let classes = snapshot.iter().flat_map(|s| &s.classes);
        let learned = |named: &String| {
            classes.clone().any(|class| class.name == *named) && !self.train.without.contains(named)
        };
        let settings = &self.train.settings;
        let of_learned =
            |named: &[String]| named.iter().filter(|name| learned(name)).cloned().collect();
        TrainSettings {
            classes: self.chosen(),
            activities: of_learned(&settings.activities),
            gestures: of_learned(&settings.gestures),
            ..settings.clone()
        }
    }

    /// Trains with what is labelled now; a training that is under way starts again.
    pub(in crate::state) fn start_training(&mut self) {
        if !self.has_something_to_learn() {
            return;
        }
        let Some(store) = &self.store else { return };
        for job in self.jobs.running.iter().filter(|j| j.name == TRAINING) {
            job.cancel();
        }
        let (db, settings) = (store.path().to_owned(), self.train_settings());
        self.train.taught = self.train.now;
        self.show_line(train_line(&db, &settings, format!("{INDEX}.index")));
        self.jobs.start(
            TRAINING,
            true,
            &self.wake,
            JobOutcome::Trained,
            move |progress| train::run(&db, &settings, progress),
        );
    }

    /// Whether a class that is chosen has labels; if none has, that is said.
    pub(in crate::state) fn has_something_to_learn(&mut self) -> bool {
        let Some(store) = &self.store else {
            return false;
        };
        let labelled = store.snapshot.accepted().next().is_some();
        if labelled && (self.train.without.is_empty() || !self.chosen().is_empty()) {
            return true;
        }
        self.complain(match labelled {
            true => "Nothing to train on: choose a class that has labels",
            false => "Nothing to train on: label a few motions first",
        });
        false
    }

    fn start_judging(&mut self, settings: TrainSettings) {
        if !self.has_something_to_learn() {
            return;
        }
        let Some(store) = &self.store else { return };
        let db = store.path().to_owned();
        let how = folds(&store.snapshot, &settings);
        let by = how.by;
        let line = ShownCommand::new("morec crossval").with("--db", &db);
        self.show_line(line.settings(&how).settings(&settings));
        self.jobs.start(
            JUDGING,
            true,
            &self.wake,
            JobOutcome::Judged,
            move |progress| judge::judge(&db, &settings, by, progress),
        );
    }

    /// Cross-validates with ever more samples and people.
    fn measure_curve(&mut self) {
        if !self.has_something_to_learn() {
            return;
        }
        let Some(store) = &self.store else { return };
        let (db, settings) = (store.path().to_owned(), self.train_settings());
        let how = folds(&store.snapshot, &settings);
        let line = ShownCommand::new("morec crossval").with("--db", &db);
        let line = line.settings(&how).settings(&settings);
        self.show_line(line.flag("--curve", true));
        let outcome = JobOutcome::Curve;
        self.jobs.start(
            MEASURING_CURVE,
            true,
            &self.wake,
            outcome,
            move |progress| learning_curve::learn(&db, &settings, &how, progress),
        );
    }

    pub fn is_measuring_curve(&self) -> bool {
        self.jobs.is_running(MEASURING_CURVE)
    }

    /// True while an index is trained.
    pub fn is_training(&self) -> bool {
        self.jobs.is_running(TRAINING)
    }

    pub fn is_judging(&self) -> bool {
        self.jobs.is_running(JUDGING)
    }

    pub(in crate::state) fn trained(&mut self, trained: train::TrainedIndex) {
        let classes = crate::format::count(trained.report.classes.len(), "class");
        self.say(format!("trained on {classes} in {:.1} s", trained.secs));
        self.keep_trained(&trained);
        self.train.secs = trained.secs;
        self.train.index = Some(trained.index);
        self.train.bytes = trained.bytes;
        self.train.report = Some(trained.report);
        // An index of labels that have changed meanwhile would be taken for one of those of now.
        let fresh = !self.train.is_stale();
        if let Some(store) = self.store.as_mut().filter(|_| fresh) {
            store.keep_last_index(self.train.bytes.clone());
        }
        self.live.follow_index(self.train.index.as_ref());
        self.check_silence();
        if self.panel != Panel::Live
            && let Some(motion) = self.player.motion.clone()
        {
            self.want_detections(&motion);
        }
    }

    /// Starts recognition in the clip that is shown.
    pub(in crate::state) fn want_detections(&mut self, motion: &Arc<ClipMotion>) {
        self.detections = None;
        // Of a clip of positions an index of rotations says nothing, as its tracks say.
        let can_look = |index: &Arc<MotionIndex>| {
            motion.clip.has_rotations() || !index.model.needs_rotations()
        };
        let Some(index) = self.train.index.clone().filter(can_look) else {
            return;
        };
        let motion = motion.clone();
        self.jobs.start(
            "Recognising",
            false,
            &self.wake,
            JobOutcome::Recognised,
            move |_| recognise::clip(&index, &motion),
        );
    }

    fn use_index(&mut self, name: &str) {
        let Some(store) = &self.store else { return };
        let line = ShownCommand::new("morec db indexes").word(store.path());
        let line = line
            .with("--write", name)
            .with("-o", format!("{name}.index"));
        if self.load_index(name) {
            self.say(format!("index {name} is in use"));
            self.show_line(line);
            if let Some(motion) = self.player.motion.clone() {
                self.want_detections(&motion);
            }
        }
    }

    /// Uses the index that was kept last, when a database is opened.
    pub(in crate::state) fn use_last_index(&mut self) {
        let Some(store) = &self.store else { return };
        let snapshot = store.snapshot.clone();
        self.train.follow(&snapshot);
        let last = snapshot.indexes.iter().max_by_key(|i| i.trained_secs);
        if let Some(last) = last {
            self.load_index(&last.name);
        }
    }

    /// Reads an index of the database for use; a failure is shown.
    fn load_index(&mut self, name: &str) -> bool {
        let Some(store) = &self.store else {
            return false;
        };
        let indexes = store.snapshot.indexes.iter();
        let stale = indexes
            .filter(|i| i.name == name)
            .any(|i| store.snapshot.is_stale(i));
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
                self.train.taught = match stale {
                    true => !self.train.now,
                    false => self.train.now,
                };
                self.live.follow_index(self.train.index.as_ref());
                true
            }
            Err(why) => {
                self.complain(format!("Index {name}: {why}"));
                false
            }
        }
    }

    pub(in crate::state) fn export_index(&mut self, path: &Path) {
        let name = crate::format::file_name(path);
        if self.train.bytes.is_empty() {
            self.complain("No index yet: train first");
            return;
        }
        match write_whole(path, &self.train.bytes) {
            Ok(()) => self.say(format!("{name} written")),
            Err(why) => self.complain(format!("{name}: not written: {why}")),
        }
        if let Some(store) = &self.store {
            let of_2009 = |index: &Arc<MotionIndex>| matches!(index.model, Model::Svrdm(_));
            let settings = match self.train.index.as_ref().is_some_and(of_2009) {
                true => self.thesis_settings(),
                false => self.train_settings(),
            };
            let line = train_line(store.path(), &settings, path);
            self.show_line(line);
        }
    }
}

/// What a cross-validation leaves out in turn, by the people and clips of the labels that are learned.
fn folds(snapshot: &Snapshot, settings: &TrainSettings) -> CrossvalSettings {
    let classes = &settings.classes;
    let taught: Vec<&DbSample> = (snapshot.accepted())
        .filter(|s| classes.is_empty() || classes.contains(&s.class))
        .collect();
    let people: BTreeSet<_> = taught.iter().filter_map(|s| s.subject.as_ref()).collect();
    let clips: BTreeSet<_> = taught.iter().map(|s| s.clip).collect();
    CrossvalSettings {
        by: LeftOut::usual(people.len(), clips.len()),
        ..CrossvalSettings::default()
    }
}
