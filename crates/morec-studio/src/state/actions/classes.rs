//! Classes: labels by their keys, classes added, renamed, merged.

use std::collections::BTreeMap;

use morec::cluster::Dendrogram;
use morec_db::labels::{SampleId, SampleState as Judged, WholeClip};

use crate::state::classes::Held;
use crate::state::{ClassCommand, Panel, State, TimelineCommand};
use crate::store::Edit;

/// A key that is held for less is a tap, seconds on the wall.
const TAP_SECS: f64 = 0.22;
/// Taps further apart than this are no repetitions of one another, seconds of the clip.
const TAPS_SECS: f64 = 6.0;
/// Cuts, ends of stillness nearer than this attract labels made while playing, seconds.
const ATTRACTED_SECS: f64 = 0.2;

impl State {
    pub(in crate::state) fn apply_classes(&mut self, command: ClassCommand) {
        match command {
            ClassCommand::Add(name) => self.add_class(&name, None),
            ClassCommand::GiveKey { class, place } => {
                let new = self.classes.swap(&class, place);
                self.keep_places(new);
            }
            ClassCommand::Rename { from, to } => self.rename_class(&from, to.trim()),
            ClassCommand::Merge { from, into } => self.edit(Edit::MergeClass { from, into }),
            ClassCommand::IsBackground(name) => self.edit(Edit::ClassIsBackground(name)),
            ClassCommand::Remove(name) => match self.classes.added.contains(&name) {
                true => {
                    self.classes.added.retain(|n| *n != name);
                    self.classes.order.retain(|n| *n != name);
                }
                false => self.edit(Edit::RemoveClass(name)),
            },
            ClassCommand::Key { slot, down: true } => self.key_down(slot),
            ClassCommand::Key { slot, down: false } => self.key_up(slot),
            ClassCommand::Propose => self.propose(),
            ClassCommand::Group { cuts, method } => self.group(cuts, method),
            ClassCommand::Depth(groups) => self.classes.cut_into(groups),
            ClassCommand::Divide(node) => self.classes.step(node, Dendrogram::divide),
            ClassCommand::Join(node) => self.classes.step(node, Dendrogram::join),
            ClassCommand::Kwas(kwas) => self.group_by(kwas),
            ClassCommand::CloseGroups => self.classes.groups = None,
            ClassCommand::NameGroup { group, name } => self.name_group(group, &name),
            ClassCommand::Move { id, class } => {
                let other = self
                    .store
                    .as_ref()
                    .and_then(|s| s.snapshot.sample(id))
                    .is_some_and(|s| s.class != class);
                if other {
                    self.edit(Edit::Reclass {
                        ids: vec![id],
                        class,
                    });
                }
            }
            ClassCommand::LabelStretch { of, class } => self.label_stretch(&class, of),
            ClassCommand::Accept(id) => self.judge(id, Judged::Accepted),
            ClassCommand::Reject(id) => self.judge(id, Judged::Rejected),
            ClassCommand::Likely(percent) => self.classes.likely = Some(percent),
            ClassCommand::JudgeAll { accept } => self.judge_all(accept),
            ClassCommand::NextDoubtful => self.next_doubtful(None),
            ClassCommand::Renaming(now) => self.classes.renaming = now,
            ClassCommand::Adding(name) => self.classes.adding = name,
            ClassCommand::Choosing(Some(_)) if self.classes.order.is_empty() => {
                self.say("no class yet: press 1 to create one");
            }
            ClassCommand::Choosing(text) => {
                self.release_keys();
                self.classes.choosing = text;
            }
            ClassCommand::Choose(class) => {
                self.say(format!("Q is {class}"));
                self.classes.choosing = None;
                self.classes.quick = Some(class);
            }
        }
    }

    /// Keeps places of classes in the database.
    pub(in crate::state) fn keep_places(&mut self, places: BTreeMap<String, usize>) {
        if let Some(store) = self.store.as_mut().filter(|_| !places.is_empty()) {
            store.place_classes(places);
        }
    }

    /// A new class, at a place or at the first that is free.
    fn add_class(&mut self, name: &str, place: Option<usize>) {
        let name = name.trim();
        self.classes.adding.clear();
        if name.is_empty() || self.classes.order.iter().any(|n| n == name) {
            return;
        }
        let new = self.classes.add(name, place);
        self.keep_places(new);
    }

    fn rename_class(&mut self, from: &str, to: &str) {
        self.classes.renaming = None;
        if to.is_empty() || from == to {
            return;
        }
        if self.classes.order.iter().any(|n| n == to) {
            self.complain(format!(
                "A class called {to} exists already: to merge the two, right click {from} and choose Merge into"
            ));
            return;
        }
        // It keeps its place, its key and its colour.
        self.classes.rename(from, to);
        for name in self.classes.quick.iter_mut().filter(|n| *n == from) {
            to.clone_into(name);
        }
        match self.classes.added.iter_mut().find(|n| *n == from) {
            Some(added) => {
                to.clone_into(added);
                if let Some(place) = self.classes.place(to) {
                    self.keep_places([(to.to_owned(), place)].into());
                }
            }
            None => self.edit(Edit::RenameClass {
                from: from.to_owned(),
                to: to.to_owned(),
            }),
        }
    }

    /// The class of a key; a key without a class makes one.
    pub(in crate::state) fn class_of_key(&mut self, slot: usize) -> String {
        if let Some(class) = self.classes.at(slot) {
            return class.to_owned();
        }
        let name = self.classes.free_name();
        self.add_class(&name, Some(slot));
        name
    }

    fn key_down(&mut self, slot: usize) {
        if self.panel == Panel::Library {
            return self.label_whole(slot);
        }
        if self.player.motion.is_none() || self.classes.held.is_some() {
            return;
        }
        // With a selection a key says what the selection is, playing or not.
        if self.timeline.range.is_some() {
            let class = self.class_of_key(slot);
            self.apply_timeline(TimelineCommand::LabelRange(class));
            return;
        }
        let ids: Vec<SampleId> = self.selected().iter().map(|s| s.id).collect();
        if !ids.is_empty() {
            let class = self.class_of_key(slot);
            self.edit(Edit::Reclass { ids, class });
            return;
        }
        // What passes is labelled where the timeline shows it.
        if self.panel != Panel::Label {
            return self.say("select a label or a stretch, then press the key of a class");
        }
        if !self.player.playing {
            self.say("play (Space) and hold the key while the motion passes, or select a stretch");
            return;
        }
        self.class_of_key(slot);
        self.classes.held = Some(Held {
            slot,
            since_secs: self.player.at_secs,
            wall_secs: 0.0,
        });
    }

    /// The selected clips of the library, as a whole, show the class of a key.
    fn label_whole(&mut self, slot: usize) {
        let clips = self.library.chosen().to_vec();
        if clips.is_empty() {
            return self.say("select clips in the list, then press the key of a class");
        }
        let class = self.class_of_key(slot);
        let whole = |clip| WholeClip {
            clip,
            class: Some(class.clone()),
            subject: None,
        };
        self.edit(Edit::WholeClips(clips.into_iter().map(whole).collect()));
    }

    fn key_up(&mut self, slot: usize) {
        let Some(held) = self.classes.held.take_if(|h| h.slot == slot) else {
            return;
        };
        let class = self.class_of_key(slot);
        let (start, stop) = (held.since_secs, self.player.at_secs);
        if held.wall_secs >= TAP_SECS {
            self.classes.tapped = None;
            // Hands are slow: an end near a cut or near stillness is meant to be there.
            let (start, stop) = (self.attracted(start), self.attracted(stop));
            self.label(&class, start, stop);
            return;
        }
        // Each tap begins a repetition and ends the one before.
        let at = start;
        match self.classes.tapped {
            Some((same, last)) if same == slot && at > last && at - last <= TAPS_SECS => {
                self.label(&class, last, at);
            }
            _ => self.say(format!(
                "{class}: tap again where the next repetition begins"
            )),
        }
        self.classes.tapped = Some((slot, at));
    }

    fn attracted(&self, secs: f64) -> f64 {
        let Some(curves) = self.curves.as_ref().filter(|_| self.timeline.snap) else {
            return secs;
        };
        let still = curves.still.iter().flat_map(|s| [s.0, s.1]);
        let marks = self.cuts().into_iter().chain(still);
        marks
            .filter(|m| (m - secs).abs() <= ATTRACTED_SECS)
            .min_by(|a, b| (a - secs).abs().total_cmp(&(b - secs).abs()))
            .unwrap_or(secs)
    }

    /// A key that is down when another clip or panel is shown labels nothing.
    pub(in crate::state) fn release_keys(&mut self) {
        self.classes.held = None;
        self.classes.tapped = None;
    }

    /// Counts how long a key has been down.
    pub fn tick_keys(&mut self, dt: f64) {
        if let Some(held) = &mut self.classes.held {
            held.wall_secs += dt;
        }
    }
}
