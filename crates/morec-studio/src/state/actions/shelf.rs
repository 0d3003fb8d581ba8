//! Sets are looked for, shown, and named: their instances become proposals.

use morec_db::ClipId;
use morec_db::labels::{NewSample, SampleState as Judged};
use morec_ops::{DiscoverSettings, DiscoveredSets};

use super::lines::ShownCommand;
use crate::jobs::{JobOutcome, discover};
use crate::state::shelf::{Shelf, ShelfCommand};
use crate::state::{Panel, State};
use crate::store::Edit;
use crate::stretch::Stretch;

/// Share of right samples among those of sets that are named without a look inside, as measured on six people's sessions.
const RIGHT: f64 = 0.85;

impl State {
    pub(in crate::state) fn apply_shelf(&mut self, command: ShelfCommand) {
        match command {
            ShelfCommand::Discover => self.discover(),
            ShelfCommand::Name { set, name } => self.name_set(set, name.trim()),
            other => self.shelf.apply(other),
        }
    }

    fn discover(&mut self) {
        let Some(store) = &self.store else { return };
        let db = store.path().to_owned();
        let settings = DiscoverSettings::default();
        let line = ShownCommand::new("morec discover").word(&db);
        self.show_line(line.settings(&settings));
        self.jobs.start(
            "Finding repeated motions",
            true,
            &self.wake,
            JobOutcome::Discovered,
            move |progress| discover::discover(&db, &settings, progress),
        );
    }

    /// Shows what was found.
    pub(in crate::state) fn found_sets(&mut self, found: DiscoveredSets) {
        self.say(found.summary());
        self.shelf = Shelf::of(found);
        self.classes.groups = None;
        self.classes.similar = None;
        self.panel = Panel::Classes;
    }

    /// The instances of a set on the shelf as they will be proposed, the outermost first.
    pub fn set_instances(&self, set: usize) -> Vec<Stretch> {
        let secs_of = |id: ClipId| {
            let clip = self
                .store
                .as_ref()
                .and_then(|store| store.snapshot.clip(id));
            clip.map_or(0.0, morec_db::ClipInfo::duration_secs)
        };
        self.shelf.instances(set, secs_of)
    }

    fn name_set(&mut self, set: usize, name: &str) {
        if name.is_empty() {
            return;
        }
        let sample = |of: Stretch| NewSample {
            clip: of.clip,
            class: name.to_owned(),
            start_secs: of.span.start_secs,
            stop_secs: of.span.stop_secs,
            whole_clip: false,
            state: Judged::Proposed,
            score: Some(RIGHT),
        };
        let samples: Vec<NewSample> = self.set_instances(set).into_iter().map(sample).collect();
        if samples.is_empty() {
            return;
        }
        self.edit(Edit::Label(samples));
        if let Some(of) = self.shelf.sets.get_mut(set) {
            of.named = Some(name.to_owned());
        }
    }
}
