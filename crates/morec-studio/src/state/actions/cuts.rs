//! Cuts of the clip that is shown: dragged into place, added, removed. Cuts by hand are kept apart from automatic ones.

use morec_db::{ClipId, Segment, SegmentKind};

use crate::state::cuts::HeldCut;
use crate::state::{CutCommand, State};
use crate::store::Edit;

/// Cuts nearer than this are one, seconds.
const SAME_SECS: f64 = 0.02;

impl State {
    /// The cuts of the clip that is shown: those that are kept, else those that kernel change points give.
    pub fn cuts(&self) -> Vec<f64> {
        let Some(clip) = self.player.motion.as_ref().map(|m| m.id) else {
            return Vec::new();
        };
        match self.kept_cuts(clip) {
            Some(cuts) => cuts,
            None => self
                .curves
                .as_ref()
                .map_or_else(Vec::new, |c| c.kernel.clone()),
        }
    }

    /// The cuts of a clip that are in the database; `None` if it was not cut.
    fn kept_cuts(&self, clip: ClipId) -> Option<Vec<f64>> {
        let snapshot = &self.store.as_ref()?.snapshot;
        let motions = |s: &&Segment| s.kind == SegmentKind::Motion;
        let starts: Vec<f64> = snapshot
            .segments_of(clip)
            .iter()
            .filter(motions)
            .map(|s| s.span.start_secs)
            .collect();
        // The first begins with the clip, which is no cut.
        (!starts.is_empty()).then(|| starts[1..].to_vec())
    }

    /// The stretch between the cuts around the playhead.
    pub fn segment(&self) -> (f64, f64) {
        self.segment_at(self.player.at_secs)
    }

    /// The stretch between the cuts around a moment.
    pub(super) fn segment_at(&self, at: f64) -> (f64, f64) {
        let cuts = self.cuts();
        let start = cuts.iter().copied().filter(|cut| *cut <= at + 1e-9);
        let stop = cuts.iter().copied().filter(|cut| *cut > at + 1e-9);
        (
            start.fold(0.0, f64::max),
            stop.fold(self.player.secs(), f64::min),
        )
    }

    /// By which method the clip that is shown was cut, if its cuts are kept.
    pub fn cut_method(&self) -> Option<&str> {
        let clip = self.player.motion.as_ref()?.id;
        let methods = &self.store.as_ref()?.snapshot.cut_methods;
        methods.get(&clip).map(String::as_str)
    }

    pub(in crate::state) fn apply_cuts(&mut self, command: CutCommand) {
        let (rate, end) = (self.player.rate_hz(), self.player.secs());
        match command {
            CutCommand::Grab(from_secs) => {
                self.timeline.cut = Some(from_secs);
                self.timeline.held_cut = Some(HeldCut {
                    from_secs,
                    at_secs: from_secs,
                    dropped: false,
                });
            }
            CutCommand::Drag(secs) => {
                let marks = self.cut_marks();
                let at = self.timeline.snapped(secs, marks.into_iter(), rate);
                let frame = 1.0 / rate;
                if let Some(held) = self.timeline.held_cut.as_mut().filter(|h| !h.dropped) {
                    held.at_secs = at.clamp(frame, (end - frame).max(frame));
                }
            }
            CutCommand::Drop => self.drop_cut(),
            CutCommand::Select(cut) => {
                self.timeline.cut = cut;
                if cut.is_some() {
                    self.timeline.selected.clear();
                }
            }
            CutCommand::Add(secs) => {
                self.timeline.range = None;
                let at = (secs * rate).round() / rate;
                let mut cuts = self.cuts();
                if at > SAME_SECS && at < end - SAME_SECS && !cuts.iter().any(near(at)) {
                    cuts.push(at);
                    self.keep_cuts(cuts, format!("cut at {at:.2} s"));
                    self.timeline.cut = Some(at);
                }
            }
            CutCommand::Remove(secs) => {
                let mut cuts = self.cuts();
                let before = cuts.len();
                cuts.retain(|cut| !near(secs)(cut));
                if cuts.len() < before {
                    self.keep_cuts(cuts, format!("remove the cut at {secs:.2} s"));
                }
                self.timeline.cut = None;
            }
            CutCommand::Reset => {
                let clip = self.player.motion.as_ref().map(|m| m.id);
                if let Some(clip) = clip.filter(|_| self.cut_method().is_some()) {
                    self.edit(Edit::ForgetCuts(clip));
                }
            }
        }
    }

    /// Moments that a dragged cut snaps to: the ends of labels and of stillness, the other method's cuts, the playhead.
    fn cut_marks(&self) -> Vec<f64> {
        let mut marks = vec![self.player.at_secs];
        if let Some(curves) = &self.curves {
            marks.extend(&curves.ppca);
            marks.extend(curves.still.iter().flat_map(|s| [s.0, s.1]));
        }
        let labels = self.shown_samples().iter();
        marks.extend(labels.flat_map(|s| [s.start_secs, s.stop_secs]));
        marks
    }

    fn drop_cut(&mut self) {
        if let Some(held) = self.timeline.held_cut.take() {
            self.move_cut(held.from_secs, held.at_secs);
        }
    }

    /// Moves a cut to a moment inside the clip. Nothing happens while the move before is on its way to the database.
    pub(in crate::state) fn move_cut(&mut self, from_secs: f64, to_secs: f64) {
        if self.timeline.held_cut.is_some() {
            return;
        }
        let (rate, end) = (self.player.rate_hz(), self.player.secs());
        let frame = 1.0 / rate;
        let at_secs = to_secs.clamp(frame, (end - frame).max(frame));
        if (at_secs - from_secs).abs() < 1e-6 {
            return;
        }
        let mut cuts = self.cuts();
        cuts.retain(|cut| !near(from_secs)(cut) && !near(at_secs)(cut));
        cuts.push(at_secs);
        self.keep_cuts(cuts, format!("move a cut to {at_secs:.2} s"));
        self.timeline.cut = Some(at_secs);
        self.timeline.held_cut = Some(HeldCut {
            from_secs,
            at_secs,
            dropped: true,
        });
    }

    /// Keeps cuts of the clip that is shown.
    fn keep_cuts(&mut self, cuts: Vec<f64>, what: String) {
        if let Some(clip) = self.shown_clip().cloned() {
            let clip = Box::new(clip);
            self.edit(Edit::Cuts { what, clip, cuts });
        }
    }
}

fn near(secs: f64) -> impl Fn(&f64) -> bool {
    move |cut| (cut - secs).abs() < SAME_SECS
}
