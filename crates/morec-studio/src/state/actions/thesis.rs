//! The method of 2009: training, the samples of its tree, its map of the clip that is shown.

use std::sync::Arc;

use morec_ops::TrainSettings;

use super::lines::train_line;
use crate::body::ClipMotion;
use crate::jobs::JobOutcome;
use crate::jobs::thesis::{self, Thesis};
use crate::state::{LibraryCommand, State};
use crate::stretch::Stretch;

const THESIS: &str = "Training the method of 2009";
/// Name of the job that maps confidences.
pub(in crate::state) const MAPPING: &str = "Mapping confidences";

impl State {
    pub(in crate::state) fn train_thesis(&mut self) {
        if !self.has_something_to_learn() {
            return;
        }
        let Some(store) = &self.store else { return };
        let (db, settings) = (store.path().to_owned(), self.thesis_settings());
        self.train.taught = self.train.now;
        self.show_line(train_line(&db, &settings, "2009.index"));
        let params = self.train.thesis_params.clone();
        self.jobs.start(
            THESIS,
            true,
            &self.wake,
            JobOutcome::Thesis,
            move |progress| thesis::run(&db, &settings, params, progress),
        );
    }

    /// The settings that train the method of 2009 with the figures that are chosen.
    pub(super) fn thesis_settings(&self) -> TrainSettings {
        TrainSettings {
            classes: self.chosen(),
            ..TrainSettings::of_svrdm(&self.train.thesis_params)
        }
    }

    pub(in crate::state) fn thesis_trained(&mut self, thesis: Arc<Thesis>) {
        let samples = crate::format::count(thesis.samples.len(), "sample");
        self.say(format!("the method of 2009 is trained on {samples}"));
        let first = (0..thesis.nodes.len()).find(|&at| thesis.branch(at).is_some());
        self.train.branch = first.unwrap_or(0);
        self.train.sample = None;
        self.train.thesis = Some(thesis);
        if let Some(motion) = self.player.motion.clone() {
            self.want_map(&motion);
        }
    }

    /// The confidences of the method of 2009 over the clip that is shown.
    pub(in crate::state) fn want_map(&mut self, motion: &Arc<ClipMotion>) {
        self.train.map = None;
        let Some(thesis) = self
            .train
            .thesis
            .clone()
            .filter(|_| motion.clip.has_rotations())
        else {
            return;
        };
        for job in self.jobs.running.iter().filter(|j| j.name == MAPPING) {
            job.cancel();
        }
        let motion = motion.clone();
        self.jobs.start(
            MAPPING,
            false,
            &self.wake,
            JobOutcome::Map,
            move |progress| thesis::map(&thesis.model, &motion, progress),
        );
    }

    pub fn is_training_thesis(&self) -> bool {
        self.jobs.is_running(THESIS)
    }

    /// Plays a sample that taught the tree, in a loop.
    pub(in crate::state) fn play_taught(&mut self, at: usize) {
        let thesis = self.train.thesis.clone();
        let Some(sample) = thesis.as_ref().and_then(|t| t.samples.get(at)) else {
            return;
        };
        self.train.sample = Some(at);
        let clips = self.store.iter().flat_map(|s| s.snapshot.clips.iter());
        let clip = clips
            .filter(|clip| clip.name == sample.clip)
            .map(|clip| clip.id)
            .next();
        match clip {
            Some(clip) => self.apply_library(LibraryCommand::GoTo(Stretch::new(clip, sample.span))),
            None => self.say(format!("{} is no longer in the database", sample.clip)),
        }
    }
}
