//! Time budgets, annotators, and decisions where two of them differ.

use std::path::Path;

use morec_db::labels::{DbSample, NewSample};
use morec_ops::{ComparedAnnotators, FORMAT_VERSION, time_budget};
use serde_json::json;

use super::lines::ShownCommand;
use crate::format;
use crate::jobs::export::write_whole;
use crate::jobs::{JobError, JobOutcome};
use crate::state::study::{AGREED, LabelDecision, StudyCommand, StudyView, UNIT_SECS, samples_of};
use crate::state::{LibraryCommand, Panel, State};
use crate::store::Edit;
use crate::stretch::Stretch;

/// A loop around a difference begins so long before it and ends so long after it, seconds.
const AROUND_SECS: f64 = 0.5;

impl State {
    pub(in crate::state) fn apply_study(&mut self, command: StudyCommand) {
        match command {
            StudyCommand::Show(view) => self.show_study(view),
            StudyCommand::ShowLabelsOf(name) => self.show_labels_of(name),
            StudyCommand::Annotator(name) => {
                let name = name.map(|name| name.trim().to_owned());
                self.study.annotator = name.filter(|name| !name.is_empty());
                self.say(match &self.study.annotator {
                    Some(name) => format!("new labels are by {name}"),
                    None => "new labels name no annotator".to_owned(),
                });
            }
            StudyCommand::Compare(pair) => {
                self.study.pair = Some(pair);
                self.study.chosen = None;
                self.show_study(Some(StudyView::Annotators));
            }
            StudyCommand::GoTo(at) => self.go_to_difference(at),
            StudyCommand::Decide(at, decision) => {
                let at = at.or(self.study.chosen);
                match at.filter(|at| self.study.undecided().contains(at)) {
                    Some(at) => self.decide(at, decision),
                    None => self.say("choose a difference of the list first"),
                }
            }
        }
        self.refresh_study();
    }

    /// The view that is shown in place of the classes; `None` while hits, groups or sets cover it.
    pub fn study_view(&self) -> Option<StudyView> {
        let classes = &self.classes;
        let is_covered = classes.similar.is_some() || classes.groups.is_some() || self.shelf.open;
        self.study.view.filter(|_| !is_covered)
    }

    fn show_study(&mut self, view: Option<StudyView>) {
        self.study.view = view;
        if view.is_none() {
            return;
        }
        self.panel = Panel::Classes;
        self.classes.similar = None;
        self.classes.groups = None;
        self.shelf.open = false;
        let Some(store) = &self.store else { return };
        let line = match (view, &self.study.pair) {
            (Some(StudyView::Annotators), Some(pair)) => {
                let line = ShownCommand::new("morec agree").word(store.path());
                Some(line.list("--annotators", pair))
            }
            (Some(StudyView::Annotators), None) => None,
            _ => Some(ShownCommand::new("morec budget").word(store.path())),
        };
        self.show_line(line);
    }

    fn show_labels_of(&mut self, name: Option<String>) {
        self.study.shown = name;
        // What is not seen is not selected.
        let hidden = self.selected().into_iter();
        let hidden = hidden.filter(|s| !self.study.shows(s)).map(|s| s.id);
        for id in hidden.collect::<Vec<_>>() {
            self.timeline.selected.remove(&id);
        }
    }

    /// Brings what is shown up to date with the database.
    pub(super) fn refresh_study(&mut self) {
        let Some(store) = &self.store else { return };
        let version = store.version;
        match self.study.view {
            Some(StudyView::Budget) => {
                let is_fresh = |(of, _): &(u64, _)| *of == version;
                if !self.study.budget.as_ref().is_some_and(is_fresh) {
                    let budget = time_budget(store.snapshot.accepted(), &store.snapshot.clips);
                    self.study.budget = Some((version, budget));
                }
            }
            Some(StudyView::Annotators) => {
                let wanted = self.study.pair.clone().map(|pair| (version, pair));
                if wanted != self.study.asked {
                    self.study.asked.clone_from(&wanted);
                    if let Some((_, pair)) = wanted {
                        self.compare_annotators(pair);
                    }
                }
            }
            None => {}
        }
    }

    fn compare_annotators(&mut self, pair: [String; 2]) {
        let Some(store) = &self.store else { return };
        let snapshot = store.snapshot.clone();
        self.jobs.start(
            "Comparing annotators",
            true,
            &self.wake,
            JobOutcome::ComparedAnnotators,
            move |_| {
                let samples = snapshot.samples.iter().map(|s| &**s);
                let compared = ComparedAnnotators::of(pair, samples, &snapshot.clips, UNIT_SECS);
                let compared = compared.map(Box::new);
                compared.map_err(|why| JobError::Failed(format!("Not compared: {why}")))
            },
        );
    }

    /// Shows two annotators compared, unless others are compared by now.
    pub(super) fn annotators_compared(&mut self, compared: ComparedAnnotators) {
        if self.study.pair.as_ref() != Some(&compared.names) {
            return;
        }
        // Decided ones come and go: the one that was gone to is known by its labels.
        let labels = |of: &ComparedAnnotators, at| samples_of(of, at).map(|s| s.map(|s| s.id));
        let chosen = self.study.compared.as_ref().zip(self.study.chosen);
        let chosen = chosen.map(|(of, at)| labels(of, at));
        let is_same = |at: &usize| Some(labels(&compared, *at)) == chosen;
        self.study.chosen = (0..compared.differences.len()).find(is_same);
        self.study.compared = Some(compared);
    }

    /// Plays a difference in a loop.
    fn go_to_difference(&mut self, at: usize) {
        let Some(compared) = &self.study.compared else {
            return;
        };
        let samples = samples_of(compared, at);
        let of_both: Vec<&DbSample> = samples.into_iter().flatten().collect();
        let Some(clip) = of_both.first().map(|s| s.clip) else {
            return;
        };
        let start = of_both.iter().map(|s| s.start_secs);
        let stop = of_both.iter().map(|s| s.stop_secs);
        let from = start.fold(f64::INFINITY, f64::min) - AROUND_SECS;
        let to = stop.fold(0.0, f64::max) + AROUND_SECS;
        let store = self.store.as_ref();
        let known = store.and_then(|store| store.snapshot.clip(clip));
        let end = known.map_or(to, |clip| clip.duration_secs());
        self.study.chosen = Some(at);
        let stretch = Stretch::new(clip, from.max(0.0)..to.min(end));
        self.apply_library(LibraryCommand::GoTo(stretch));
    }

    /// Takes the label of A or of B, or keeps both; a label that is kept is by [`AGREED`], too.
    fn decide(&mut self, at: usize, decision: LabelDecision) {
        let Some(compared) = &mut self.study.compared else {
            return;
        };
        let samples = samples_of(compared, at).map(Option::<&DbSample>::cloned);
        let [a, b] = &compared.names;
        let (what, keeps) = match decision {
            LabelDecision::A => (format!("take the label of {a}"), [true, false]),
            LabelDecision::B => (format!("take the label of {b}"), [false, true]),
            LabelDecision::Both => ("keep both labels".to_owned(), [true, true]),
        };
        let kept = samples.iter().zip(keeps).filter(|(_, keep)| *keep);
        let new = kept.filter_map(|(sample, _)| {
            let sample = sample.as_ref()?;
            let mut annotators = sample.annotators.clone();
            annotators.push(AGREED.to_owned());
            Some((NewSample::from(sample), annotators))
        });
        let old: Vec<DbSample> = samples.iter().flatten().cloned().collect();
        let clip = old.first().map_or("", |s| s.clip_name.as_str());
        let edit = Edit::Replace {
            what: format!("{what} in {clip}"),
            new: new.collect(),
            old,
        };
        // Decided once: the comparison of what the database then holds is under way.
        compared.differences.remove(at);
        self.study.chosen = None;
        self.edit(edit);
        let next = self.study.undecided().into_iter().find(|next| *next >= at);
        if let Some(next) = next {
            self.go_to_difference(next);
        }
    }

    /// Writes the time budget as a table, or as JSON.
    pub(super) fn export_budget(&mut self, path: &Path) {
        let Some(store) = &self.store else { return };
        let name = format::file_name(path);
        let line = ShownCommand::new("morec budget").word(store.path());
        let line = line.with("-o", path);
        let Some((_, budget)) = &self.study.budget else {
            return;
        };
        let text = match path.extension().is_some_and(|ending| ending == "json") {
            true => {
                let mut json = json!(budget);
                json["format_version"] = FORMAT_VERSION.into();
                format!("{json:#}\n")
            }
            false => budget.tsv(),
        };
        match write_whole(path, text.as_bytes()) {
            Ok(()) => self.say(format!("{name} written")),
            Err(why) => self.complain(format!("{name}: not written: {why}")),
        }
        self.show_line(line);
    }
}
