//! Search by example, and labels from its hits.

use morec_db::labels::NewSample;
use morec_db::labels::SampleState;
use morec_db::search::Hit;

use super::lines::ShownCommand;
use crate::jobs::JobOutcome;
use crate::jobs::similar::{self, Similar};
use crate::state::classes::LIKELY;
use crate::state::{Panel, SimilarCommand, State};
use crate::store::Edit;
use crate::stretch::Stretch;

/// Name of the job that searches.
pub(in crate::state) const SEARCHING: &str = "Searching";

impl State {
    pub(in crate::state) fn apply_similar(&mut self, command: SimilarCommand) {
        match command {
            SimilarCommand::OfSelection => match self.selected_stretch() {
                Some((of, class)) => self.search(of, class),
                None => self.say("select a label or a stretch first"),
            },
            SimilarCommand::Of(of, class) => self.search(of, class),
            SimilarCommand::Mirror(on) => {
                self.classes.mirror = on;
                if let Some(similar) = &self.classes.similar {
                    let (of, class) = (similar.of, similar.class.clone());
                    self.search(of, class);
                }
            }
            SimilarCommand::Label(at, class) => self.label_hit(at, class),
            SimilarCommand::Alike(percent) => self.classes.alike = Some(percent),
            SimilarCommand::LabelAll(class) => self.label_hits(&class),
            SimilarCommand::Close => self.classes.similar = None,
        }
    }

    /// The selected stretch of the clip that is shown, or the selected label with its class.
    pub fn selected_stretch(&self) -> Option<(Stretch, Option<String>)> {
        let clip = self.player.motion.as_ref()?.id;
        if let Some((start_secs, stop_secs)) = self.timeline.range {
            let stretch = Stretch::new(clip, start_secs..stop_secs);
            return Some((stretch, None));
        }
        let selected = self.selected();
        let sample = selected.first()?;
        let stretch = Stretch::new(clip, sample.span());
        Some((stretch, Some(sample.class.clone())))
    }

    pub fn is_selected_stretch(&self, of: Stretch) -> bool {
        self.selected_stretch().is_some_and(|(now, _)| now == of)
    }

    fn search(&mut self, of: Stretch, class: Option<String>) {
        let Some(store) = &self.store else { return };
        let (db, mirror) = (store.path().to_owned(), self.classes.mirror);
        let line = self.search_line(&of);
        self.show_line(line.map(|line| line.settings(&similar::settings(mirror))));
        for job in self.jobs.running.iter().filter(|j| j.name == SEARCHING) {
            job.cancel();
        }
        self.jobs.start(
            SEARCHING,
            true,
            &self.wake,
            JobOutcome::Similar,
            move |progress| similar::find(&db, of, class, mirror, progress),
        );
    }

    /// The command that searches for what is like a stretch.
    pub(in crate::state) fn search_line(&self, of: &Stretch) -> Option<ShownCommand> {
        let store = self.store.as_ref()?;
        let clip = store.snapshot.clip(of.clip)?;
        let line = ShownCommand::new("morec db search")
            .word(store.path())
            .word(&clip.name);
        Some(
            line.secs("--start", of.span.start_secs)
                .secs("--stop", of.span.stop_secs),
        )
    }

    /// Shows what was found.
    pub(in crate::state) fn found_similar(&mut self, mut similar: Similar) {
        if let Some(class) = &similar.class {
            similar.hits.retain(|hit| !self.is_labelled(hit, class));
        }
        self.say(format!(
            "{} like it",
            crate::format::count(similar.hits.len(), "stretch")
        ));
        self.classes.similar = Some(similar);
        self.classes.groups = None;
        self.panel = Panel::Classes;
    }

    /// Places of the hits that are labelled at once.
    pub fn alike_at_once(&self) -> Vec<usize> {
        let least = f64::from(self.classes.alike.unwrap_or(LIKELY)) / 100.0;
        let similar = self.classes.similar.iter();
        let hits = similar.flat_map(|similar| similar.hits.iter().enumerate());
        hits.filter(|(_, hit)| f64::from(hit.score) >= least)
            .map(|(at, _)| at)
            .collect()
    }

    /// True if a label of the class lies where the hit does: another one would be double.
    fn is_labelled(&self, hit: &Hit, class: &str) -> bool {
        let store = self.store.iter();
        let mut samples = store.flat_map(|store| store.snapshot.samples_of(hit.clip));
        samples.any(|sample| {
            sample.state == SampleState::Accepted
                && sample.class == class
                && sample.span().matches(hit.span)
        })
    }

    fn label_hits(&mut self, class: &str) {
        let mut places = self.alike_at_once();
        if let Some(similar) = &self.classes.similar {
            places.retain(|at| !self.is_labelled(&similar.hits[*at], class));
        }
        let Some(similar) = &mut self.classes.similar else {
            return;
        };
        let new = places.iter().map(|at| labelled(&similar.hits[*at], class));
        let new: Vec<NewSample> = new.collect();
        for at in places.into_iter().rev() {
            similar.hits.remove(at);
        }
        if !new.is_empty() {
            self.edit(Edit::Label(new));
        }
    }

    fn label_hit(&mut self, at: usize, class: String) {
        let Some(similar) = &mut self.classes.similar else {
            return;
        };
        if at >= similar.hits.len() {
            return;
        }
        let hit: Hit = similar.hits.remove(at);
        self.edit(Edit::Label(vec![labelled(&hit, &class)]));
    }
}

/// A hit as a label.
fn labelled(hit: &Hit, class: &str) -> NewSample {
    NewSample::accepted(hit.clip, class, hit.span)
}
