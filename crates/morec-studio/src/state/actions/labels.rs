//! Labels on the timeline: selected, dragged, split, merged, nudged.

use std::collections::BTreeSet;
use std::sync::Arc;

use morec_db::labels::{DbSample, NewSample, SampleState as Judged};
use morec_ops::{CutMethod, CutSettings};

use super::lines::ShownCommand;
use crate::jobs::JobOutcome;
use crate::jobs::cut;
use crate::state::{CutCommand, Drag, Grip, Panel, PlayCommand, State, TimelineCommand};
use crate::store::{Edit, Snapshot};
use crate::stretch::Stretch;

impl State {
    /// Sends an edit to the database, and says which command would do it.
    pub(in crate::state) fn edit(&mut self, edit: Edit) {
        // Another action's command would mislead: an action without a command shows none.
        let line = self.line_of(&edit);
        self.show_line(line);
        let by = self.study.annotator.as_ref();
        let is_new = matches!(edit, Edit::Label(_) | Edit::WholeClips(_));
        if is_new
            && self
                .study
                .shown
                .as_ref()
                .is_some_and(|shown| Some(shown) != by)
        {
            // What is made is seen.
            self.study.shown = None;
        }
        if let Some(store) = &mut self.store {
            store.edit(edit, self.study.annotator.clone());
        }
    }

    /// The labels of the clip that is shown.
    pub fn shown_samples(&self) -> &[Arc<DbSample>] {
        match (&self.store, &self.player.motion) {
            (Some(store), Some(motion)) => store.snapshot.samples_of(motion.id),
            _ => &[],
        }
    }

    /// The labels that are selected, by time.
    pub fn selected(&self) -> Vec<&DbSample> {
        let (Some(store), Some(motion)) = (&self.store, &self.player.motion) else {
            return Vec::new();
        };
        let ids = self.timeline.selected.iter();
        let mut selected: Vec<&DbSample> = ids
            .filter_map(|id| store.snapshot.sample(*id))
            .filter(|s| s.clip == motion.id || self.panel == Panel::Classes)
            .collect();
        selected.sort_by(|a, b| a.start_secs.total_cmp(&b.start_secs));
        selected
    }

    /// Moments that dragged ends snap to: cuts, the ends of other labels, the playhead.
    pub fn marks(&self) -> Vec<f64> {
        let mut marks = vec![self.player.at_secs];
        if let Some(curves) = &self.curves {
            marks.extend(&curves.ppca);
            marks.extend(curves.still.iter().flat_map(|s| [s.0, s.1]));
        }
        marks.extend(self.cuts());
        let held = self.timeline.drag.as_ref().map(|d| d.id);
        let others = self.shown_samples().iter().filter(|s| Some(s.id) != held);
        marks.extend(others.flat_map(|s| [s.start_secs, s.stop_secs]));
        marks
    }

    pub(in crate::state) fn apply_timeline(&mut self, command: TimelineCommand) {
        let (end, rate) = (self.player.secs(), self.player.rate_hz());
        let timeline = &mut self.timeline;
        match command {
            TimelineCommand::Zoom { factor, about_secs } => timeline.zoom(factor, about_secs, end),
            TimelineCommand::Pan(secs) => timeline.pan(secs, end),
            TimelineCommand::Whole => timeline.whole(end),
            TimelineCommand::Snap(on) => timeline.snap = on,
            TimelineCommand::AllClasses(on) => timeline.all_classes = on,
            TimelineCommand::Width(width) => timeline.width = width,
            TimelineCommand::Range(range) => self.select_range(range),
            TimelineCommand::SelectNothing => {
                self.select_range(None);
                self.timeline.selected.clear();
                self.timeline.cut = None;
            }
            TimelineCommand::SelectSegment(secs) => {
                self.player.apply(&PlayCommand::Seek(secs));
                let segment = self.segment_at(secs);
                self.select_range(Some(segment));
            }
            TimelineCommand::Select { id, add } => {
                timeline.cut = None;
                timeline.just_made = false;
                if !add {
                    timeline.selected.clear();
                }
                if let Some(id) = id
                    && !timeline.selected.remove(&id)
                {
                    timeline.selected.insert(id);
                }
            }
            TimelineCommand::Grab(drag) => {
                timeline.selected = [drag.id].into();
                timeline.drag = Some(drag);
            }
            TimelineCommand::Drag(secs) => {
                let marks = self.marks();
                self.timeline.drag_to(secs, &marks, rate, end);
            }
            TimelineCommand::Drop => self.drop_label(),
            TimelineCommand::Split => self.split(),
            TimelineCommand::Merge => self.merge(),
            TimelineCommand::Remove => {
                // A cut is seen on the timeline alone.
                let cut = self.timeline.cut.filter(|_| self.panel == Panel::Label);
                if let Some(cut) = cut {
                    self.apply_cuts(CutCommand::Remove(cut));
                    return;
                }
                let ids: Vec<_> = self.selected().iter().map(|s| s.id).collect();
                if !ids.is_empty() {
                    self.edit(Edit::Remove(ids));
                }
            }
            TimelineCommand::Nudge(grip, frames) => {
                let by = frames as f64 / rate;
                if let Some(cut) = self.timeline.cut {
                    self.move_cut(cut, cut + by);
                    return;
                }
                self.change_selected(|start, stop| moved(grip, start, stop, by));
            }
            TimelineCommand::ToPlayhead(grip) => {
                let at = self.player.at_secs;
                if let Some(cut) = self.timeline.cut {
                    self.move_cut(cut, at);
                    return;
                }
                self.change_selected(|start, stop| match grip {
                    Grip::Start => (at, stop),
                    Grip::Stop => (start, at),
                    Grip::Whole => (at, at + stop - start),
                });
            }
            TimelineCommand::LabelRange(class) => {
                if let Some((of, _)) = self.selected_stretch() {
                    self.label_stretch(&class, of);
                }
            }
            TimelineCommand::Cut(method) => self.cut(method),
            TimelineCommand::Channel(wanted) => self.want_channel(wanted),
        }
    }

    fn drop_label(&mut self) {
        let Some(drag) = self.timeline.drag.take() else {
            return;
        };
        let moved = self
            .shown_samples()
            .iter()
            .any(|s| s.id == drag.id && !s.span().is_near(drag.span, 1e-6));
        if !moved {
            return;
        }
        self.edit(Edit::Move {
            id: drag.id,
            start_secs: drag.span.start_secs,
            stop_secs: drag.span.stop_secs,
        });
        self.timeline.drag = Some(Drag {
            dropped: true,
            ..drag
        });
    }

    fn change_selected(&mut self, change: impl Fn(f64, f64) -> (f64, f64)) {
        let end = self.player.secs();
        let [sample] = self.selected()[..] else {
            self.say("select one label first");
            return;
        };
        let (id, (start, stop)) = (sample.id, change(sample.start_secs, sample.stop_secs));
        if start < 0.0 || stop > end + 1e-9 || stop <= start {
            self.say("a label stays inside its clip and ends after it begins");
            return;
        }
        self.edit(Edit::Move {
            id,
            start_secs: start,
            stop_secs: stop,
        });
    }

    fn split(&mut self) {
        let at = self.player.at_secs;
        let inside = |s: &&DbSample| s.start_secs < at - 1e-6 && at + 1e-6 < s.stop_secs;
        let selected = self.selected().into_iter();
        let there = self.shown_samples().iter().map(|s| &**s);
        let there = there.filter(|s| self.study.shows(s));
        let found = selected.chain(there).find(inside);
        let Some(sample) = found else {
            self.say("no label lies under the playhead");
            return;
        };
        let part = |start_secs, stop_secs| {
            let part = NewSample {
                start_secs,
                stop_secs,
                whole_clip: false,
                ..NewSample::from(sample)
            };
            (part, sample.annotators.clone())
        };
        let edit = Edit::Replace {
            what: format!("split {} of {}", sample.class, sample.clip_name),
            old: vec![sample.clone()],
            new: vec![part(sample.start_secs, at), part(at, sample.stop_secs)],
        };
        self.edit(edit);
    }

    fn merge(&mut self) {
        let selected = self.selected();
        let (Some(first), true) = (selected.first(), selected.len() >= 2) else {
            self.say("select two labels or more to merge them");
            return;
        };
        if selected.iter().any(|s| s.class != first.class) {
            self.say("labels of different classes are not merged");
            return;
        }
        let stop_secs = selected.iter().map(|s| s.stop_secs).fold(0.0, f64::max);
        let annotators: BTreeSet<&String> = selected.iter().flat_map(|s| &s.annotators).collect();
        let whole = NewSample {
            stop_secs,
            whole_clip: false,
            ..NewSample::from(*first)
        };
        let edit = Edit::Replace {
            what: format!("merge {} labels of {}", selected.len(), first.class),
            old: selected.iter().map(|s| (*s).clone()).collect(),
            new: vec![(whole, annotators.into_iter().cloned().collect())],
        };
        self.edit(edit);
    }

    /// Selects a stretch in place of what was selected; `None` if there is none any more.
    pub(in crate::state) fn select_range(&mut self, range: Option<(f64, f64)>) {
        self.timeline.range = range.filter(|r| r.1 - r.0 > 1e-3);
        if self.timeline.range.is_some() {
            self.timeline.selected.clear();
            self.timeline.cut = None;
        }
    }

    /// Labels a stretch of the clip that is shown.
    pub(in crate::state) fn label(&mut self, class: &str, start_secs: f64, stop_secs: f64) {
        let Some(clip) = self.player.motion.as_ref().map(|m| m.id) else {
            return;
        };
        let of = Stretch::new(clip, start_secs..stop_secs);
        if let Some(sample) = self.new_label(class, &of) {
            self.edit(Edit::Label(vec![sample]));
        }
    }

    /// Labels a stretch of a clip, and selects the label once it is there.
    pub(in crate::state) fn label_stretch(&mut self, class: &str, of: Stretch) {
        self.timeline.range = None;
        if let Some(sample) = self.new_label(class, &of) {
            self.timeline.awaited = Some(sample.clone());
            self.edit(Edit::Label(vec![sample]));
        }
    }

    /// A label of a stretch, from frame to frame; `None` if it has no length.
    fn new_label(&self, class: &str, of: &Stretch) -> Option<NewSample> {
        let clip = self.store.as_ref()?.snapshot.clip(of.clip)?;
        let frame = |secs: f64| (secs * clip.rate_hz).round() / clip.rate_hz;
        let (start, stop) = (
            of.span.start_secs.min(of.span.stop_secs),
            of.span.start_secs.max(of.span.stop_secs),
        );
        let sample = NewSample {
            clip: of.clip,
            class: class.to_owned(),
            start_secs: frame(start.max(0.0)),
            stop_secs: frame(stop.min(clip.duration_secs())),
            whole_clip: false,
            state: Judged::Accepted,
            score: None,
        };
        (sample.stop_secs > sample.start_secs).then_some(sample)
    }

    /// Selects the label that was on its way to the database.
    pub(in crate::state) fn select_awaited(&mut self, snapshot: &Snapshot) {
        let Some(wanted) = &self.timeline.awaited else {
            return;
        };
        let near = |a: f64, b: f64| (a - b).abs() < 1e-3;
        let there = snapshot.samples_of(wanted.clip).iter().find(|s| {
            s.class == wanted.class
                && near(s.start_secs, wanted.start_secs)
                && near(s.stop_secs, wanted.stop_secs)
        });
        if let Some(sample) = there {
            self.timeline.selected = [sample.id].into();
            self.timeline.just_made = true;
            self.timeline.awaited = None;
        }
    }

    fn cut(&mut self, method: CutMethod) {
        let Some(store) = &self.store else { return };
        let db = store.place();
        let line = ShownCommand::new("morec cut").word(&db.path);
        self.show_line(line.settings(&CutSettings::from(method)));
        self.jobs.start(
            "Cutting clips",
            true,
            &self.wake,
            JobOutcome::Cut,
            move |progress| cut::cut(&db, method, &[], progress),
        );
    }
}

fn moved(grip: Grip, start: f64, stop: f64, by: f64) -> (f64, f64) {
    match grip {
        Grip::Start => (start + by, stop),
        Grip::Stop => (start, stop + by),
        Grip::Whole => (start + by, stop + by),
    }
}
