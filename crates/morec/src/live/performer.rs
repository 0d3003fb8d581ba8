//! One performer's way from posed skeletons to events.

use std::sync::Arc;

use crate::features::BoneSet;
use crate::templates::TemplateModel;

use super::early::{Early, Hunch};
use super::{Actor, Detection, Event, Frame, Phase, Recognizer, Rig};

/// What is to be said, and how often.
#[derive(Debug, Clone, PartialEq)]
pub struct EventOptions {
    /// Say what seems to be under way, too.
    pub early: bool,
    /// A motion of the same class that ends less than this after the one before it is not told (but counted), seconds.
    /// At 0 the decoder's own rule holds: motions of one performer follow each other and never share more than two
    /// ticks, so one performance is one event.
    pub refractory_secs: f64,
}

impl Default for EventOptions {
    fn default() -> Self {
        Self { early: true, refractory_secs: 0.0 }
    }
}

/// Follows one performer: skeletons and frames in, events out.
///
/// Takes memory when a skeleton is new (a recogniser is made for its bones at its first frame); frames after that
/// take none.
#[derive(Debug)]
pub struct Performer {
    model: Arc<TemplateModel>,
    options: EventOptions,
    actor: Actor,
    rig: Option<Arc<Rig>>,
    recognizer: Option<Recognizer>,
    early: Early,
    motions: u64,
    /// When the last motion ended that was told: of each class, and of all.
    stops: Stops,
    wall_secs: f64,
    suppressed: u64,
    unusable: u64,
}

impl Performer {
    /// Nobody's yet: tell it a rig first.
    pub fn new(model: &Arc<TemplateModel>, actor: Actor, options: &EventOptions) -> Self {
        Self {
            model: model.clone(),
            options: options.clone(),
            actor,
            rig: None,
            recognizer: None,
            early: Early::default(),
            motions: 0,
            stops: Stops::new(model.classes.len()),
            wall_secs: 0.0,
            suppressed: 0,
            unusable: 0,
        }
    }

    /// Begins with a new skeleton; ends what went on with the old one.
    pub fn set_rig(&mut self, rig: &Arc<Rig>, out: &mut impl FnMut(Event)) {
        self.finish(out);
        self.rig = Some(rig.clone());
        self.recognizer = None;
    }

    /// Takes a frame and calls `out` with what it settled. A frame without a rig, or of a skeleton that shows none of
    /// the index's bones, says nothing and is counted.
    ///
    /// `make` gives a recogniser for the bones of a new skeleton, if there can be one.
    pub fn push(
        &mut self,
        frame: &Frame,
        make: &mut impl FnMut(BoneSet) -> Option<Recognizer>,
        out: &mut impl FnMut(Event),
    ) {
        let Some(rig) = &self.rig else {
            self.unusable += 1;
            return;
        };
        let pose = frame.key_pose(rig);
        if self.recognizer.is_none() {
            self.recognizer = make(rig.bones(&pose));
        }
        let Some(recognizer) = &mut self.recognizer else {
            self.unusable += 1;
            return;
        };
        self.wall_secs = frame.wall_secs;
        let mut ended = Ended {
            refractory_secs: self.options.refractory_secs,
            stops: &mut self.stops,
            suppressed: &mut self.suppressed,
        };
        let mut say = Say { actor: self.actor, wall_secs: self.wall_secs, motions: &mut self.motions, out };
        for detection in recognizer.push(frame.time_secs, &pose) {
            ended.tell(detection, &mut self.early, &mut say);
        }
        if self.options.early {
            self.early.look(recognizer.hunch(), self.stops.any_secs, frame.time_secs, &mut say);
        }
    }

    /// The stream ends or breaks off: tells what its last moments hold. It may go on with another frame.
    pub fn finish(&mut self, out: &mut impl FnMut(Event)) {
        let Some(recognizer) = &mut self.recognizer else { return };
        let mut ended = Ended {
            refractory_secs: self.options.refractory_secs,
            stops: &mut self.stops,
            suppressed: &mut self.suppressed,
        };
        let mut say = Say { actor: self.actor, wall_secs: self.wall_secs, motions: &mut self.motions, out };
        for detection in recognizer.finish() {
            ended.tell(detection, &mut self.early, &mut say);
        }
        self.early.cancel(None, &mut say);
        // A clock that begins anew must not find its motions refused for the old one's.
        self.stops.forget();
    }

    /// [`push`](Self::push) that makes recognisers of its own.
    pub fn push_own(&mut self, frame: &Frame, out: &mut impl FnMut(Event)) {
        let model = self.model.clone();
        self.push(frame, &mut |bones| Recognizer::new(&model, bones).ok(), out);
    }

    /// Frames that could not be used: no skeleton was known, or none of its bones are the index's.
    pub fn unusable(&self) -> u64 {
        self.unusable
    }

    /// Motions that were not told because of [`EventOptions::refractory_secs`].
    pub fn suppressed(&self) -> u64 {
        self.suppressed
    }

    /// What seems to be under way.
    pub fn hunch(&self) -> Option<Hunch> {
        self.early.told()
    }
}

/// When motions ended, on the stream's clock.
#[derive(Debug)]
struct Stops {
    any_secs: f64,
    class_secs: Vec<f64>,
}

impl Stops {
    fn new(classes: usize) -> Self {
        Self { any_secs: f64::NEG_INFINITY, class_secs: vec![f64::NEG_INFINITY; classes] }
    }

    fn forget(&mut self) {
        self.any_secs = f64::NEG_INFINITY;
        self.class_secs.fill(f64::NEG_INFINITY);
    }
}

/// Applies the refractory rule to detections.
struct Ended<'a> {
    refractory_secs: f64,
    stops: &'a mut Stops,
    suppressed: &'a mut u64,
}

impl Ended<'_> {
    fn tell(&mut self, d: &Detection, early: &mut Early, say: &mut Say<impl FnMut(Event)>) {
        let before_secs = &mut self.stops.class_secs[d.class.index()];
        if d.stop_secs - *before_secs < self.refractory_secs {
            *self.suppressed += 1;
            early.cancel(Some(d.reported_secs), say);
            return;
        }
        *before_secs = d.stop_secs;
        self.stops.any_secs = d.stop_secs;
        let motion = early.take(d).unwrap_or_else(|| say.new_motion());
        say.event(
            Phase::End,
            motion,
            Hunch {
                class: d.class,
                score: d.score,
                progress: 1.0,
                start_secs: d.start_secs,
                seen_secs: d.stop_secs,
            },
            d.reported_secs,
        );
    }
}

/// Numbers motions and gives events their common parts.
pub(super) struct Say<'a, F: FnMut(Event)> {
    actor: Actor,
    wall_secs: f64,
    motions: &'a mut u64,
    out: &'a mut F,
}

impl<F: FnMut(Event)> Say<'_, F> {
    pub(super) fn new_motion(&mut self) -> u64 {
        *self.motions += 1;
        *self.motions
    }

    pub(super) fn event(&mut self, phase: Phase, motion: u64, what: Hunch, reported_secs: f64) {
        (self.out)(Event {
            phase,
            motion,
            // Whoever carries events out numbers them.
            sequence: 0,
            actor: self.actor,
            class: what.class,
            score: what.score,
            progress: what.progress,
            start_secs: what.start_secs,
            stop_secs: what.seen_secs,
            reported_secs,
            wall_secs: self.wall_secs,
        });
    }
}
