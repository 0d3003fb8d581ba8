//! The timeline: the part of the clip in view, the selection, the label that is dragged.

use std::collections::BTreeSet;

use morec::TimeSpan;
use morec_db::labels::{DbSample, NewSample, SampleId};

use super::cuts::HeldCut;

/// No view is shorter than this, seconds.
const SHORTEST: f64 = 0.05;
/// Distance within which a moment snaps to a mark, points of the screen.
const SNAP_POINTS: f64 = 7.0;

/// Part of a label that is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grip {
    Start,
    Stop,
    Whole,
}

/// A label that is being dragged, as it is now.
#[derive(Debug, Clone, PartialEq)]
pub struct Drag {
    pub id: SampleId,
    pub grip: Grip,
    /// Place at which it was held, seconds from its start.
    pub held_secs: f64,
    pub span: TimeSpan,
    /// Dropped, and on its way to the database: drawn here until it arrives there.
    pub dropped: bool,
}

/// The timeline's own state.
#[derive(Debug, Clone)]
pub struct TimelineState {
    pub from_secs: f64,
    pub to_secs: f64,
    pub selected: BTreeSet<SampleId>,
    /// The label that is selected was just made here, and not selected by hand.
    pub just_made: bool,
    /// A label that is on its way to the database, and selected once it is there.
    pub(super) awaited: Option<NewSample>,
    /// A stretch of time that is selected.
    pub range: Option<(f64, f64)>,
    pub drag: Option<Drag>,
    /// The cut that is selected, seconds.
    pub cut: Option<f64>,
    pub held_cut: Option<HeldCut>,
    pub snap: bool,
    /// A track for each class, though there are many; else for those that the clip shows.
    pub all_classes: bool,
    /// Width of the tracks, points; known once it was drawn.
    pub width: f32,
    /// True if the view follows the playhead.
    pub follow: bool,
}

impl Default for TimelineState {
    fn default() -> Self {
        Self {
            from_secs: 0.0,
            to_secs: 10.0,
            selected: BTreeSet::new(),
            just_made: false,
            awaited: None,
            range: None,
            drag: None,
            cut: None,
            held_cut: None,
            snap: true,
            all_classes: false,
            width: 800.0,
            follow: true,
        }
    }
}

impl TimelineState {
    /// Shows all of a clip.
    pub fn whole(&mut self, secs: f64) {
        (self.from_secs, self.to_secs) = (0.0, secs.max(SHORTEST));
    }

    pub fn span(&self) -> f64 {
        (self.to_secs - self.from_secs).max(SHORTEST)
    }

    /// Zooms about a moment; factors above 1 show less time. The view stays within the clip.
    pub fn zoom(&mut self, factor: f64, about_secs: f64, clip_secs: f64) {
        let span = (self.span() / factor).clamp(SHORTEST, clip_secs.max(SHORTEST));
        let share = ((about_secs - self.from_secs) / self.span()).clamp(0.0, 1.0);
        self.from_secs = about_secs - share * span;
        self.to_secs = self.from_secs + span;
        self.keep_inside(clip_secs);
    }

    /// Moves the view.
    pub fn pan(&mut self, secs: f64, clip_secs: f64) {
        self.from_secs += secs;
        self.to_secs += secs;
        self.keep_inside(clip_secs);
    }

    /// Goes on by a page when the playhead leaves the view.
    pub fn follow(&mut self, secs: f64, clip_secs: f64) {
        if self.follow && (secs > self.to_secs - 0.02 * self.span() || secs < self.from_secs) {
            self.pan(secs - self.from_secs - 0.1 * self.span(), clip_secs);
        }
    }

    fn keep_inside(&mut self, clip_secs: f64) {
        let span = self.span();
        self.from_secs = self.from_secs.clamp(0.0, (clip_secs - span).max(0.0));
        self.to_secs = self.from_secs + span;
    }

    /// Seconds in a point of the screen.
    pub fn secs_per_point(&self) -> f64 {
        self.span() / f64::from(self.width.max(1.0))
    }

    /// A moment put onto the nearest of `marks` if that is near, else onto a frame.
    pub fn snapped(&self, secs: f64, marks: impl Iterator<Item = f64>, rate_hz: f64) -> f64 {
        let on_frame = (secs * rate_hz).round() / rate_hz;
        if !self.snap {
            return on_frame;
        }
        let nearest = marks.min_by(|a, b| (a - secs).abs().total_cmp(&(b - secs).abs()));
        nearest
            .filter(|mark| (mark - secs).abs() <= SNAP_POINTS * self.secs_per_point())
            .unwrap_or(on_frame)
    }

    /// Start and stop at which a label is drawn: while it is dragged, those of the drag.
    pub fn extent(&self, sample: &DbSample) -> (f64, f64) {
        match &self.drag {
            Some(drag) if drag.id == sample.id => (drag.span.start_secs, drag.span.stop_secs),
            _ => (sample.start_secs, sample.stop_secs),
        }
    }

    /// Goes on with a drag whose pointer is at a moment. `marks` are moments to snap to.
    pub fn drag_to(&mut self, secs: f64, marks: &[f64], rate_hz: f64, clip_secs: f64) {
        let Some(mut drag) = self.drag.take() else {
            return;
        };
        let frame = 1.0 / rate_hz;
        let snap = |secs: f64| self.snapped(secs, marks.iter().copied(), rate_hz);
        match drag.grip {
            Grip::Start => {
                drag.span.start_secs = snap(secs).clamp(0.0, drag.span.stop_secs - frame)
            }
            Grip::Stop => {
                drag.span.stop_secs = snap(secs).clamp(drag.span.start_secs + frame, clip_secs)
            }
            Grip::Whole => {
                let length = drag.span.duration_secs();
                let start = snap(secs - drag.held_secs).clamp(0.0, (clip_secs - length).max(0.0));
                drag.span = TimeSpan::new(start, start + length);
            }
        }
        self.drag = Some(drag);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zooming_keeps_the_moment_under_the_pointer_and_the_view_in_the_clip() {
        let mut timeline = TimelineState::default();
        timeline.whole(100.0);
        timeline.zoom(4.0, 30.0, 100.0);
        assert!((timeline.span() - 25.0).abs() < 1e-9);
        let share = (30.0 - timeline.from_secs) / timeline.span();
        assert!((share - 0.3).abs() < 1e-9);
        timeline.zoom(1e-9, 30.0, 100.0);
        assert_eq!((timeline.from_secs, timeline.to_secs), (0.0, 100.0));
    }

    #[test]
    fn what_is_near_a_mark_is_put_there_and_everything_else_on_a_frame() {
        let mut timeline = TimelineState {
            width: 1000.0,
            ..TimelineState::default()
        };
        timeline.whole(100.0);
        let marks = || [20.0, 50.03].into_iter();
        assert_eq!(timeline.snapped(49.6, marks(), 30.0), 50.03);
        assert!((timeline.snapped(48.01, marks(), 30.0) - 48.0).abs() < 1e-9);
        timeline.snap = false;
        assert!((timeline.snapped(49.99, marks(), 30.0) - 50.0).abs() < 1e-9);
    }

    #[test]
    fn a_dragged_label_stays_in_its_clip_and_at_least_a_frame_long() {
        let mut timeline = TimelineState::default();
        timeline.whole(10.0);
        let drag = |grip| Drag {
            id: SampleId(1),
            grip,
            held_secs: 0.5,
            span: TimeSpan::new(2.0, 3.0),
            dropped: false,
        };
        timeline.drag = Some(drag(Grip::Whole));
        timeline.drag_to(99.0, &[], 60.0, 10.0);
        let now = timeline.drag.clone().unwrap();
        assert_eq!(now.span, TimeSpan::new(9.0, 10.0));
        timeline.drag = Some(drag(Grip::Start));
        timeline.drag_to(99.0, &[], 60.0, 10.0);
        let now = timeline.drag.clone().unwrap();
        assert!((now.span.duration_secs() - 1.0 / 60.0).abs() < 1e-9);
    }
}
