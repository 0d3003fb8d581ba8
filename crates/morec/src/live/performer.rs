//! One performer of a source: from posed skeletons through diagnosis and recognition to events.

use std::borrow::Cow;
use std::sync::Arc;

use super::early::EarlyTracker;
use super::event_buffer::EventBuffer;
use super::event_tracker::EventTracker;
use super::{
    EarlyDetection, Event, EventOptions, Frame, Model, PerformerId, Phase, PoseExtractor,
    Recognizer, RecognizerCache, RecognizerInput, Rig, ShownBones, StartError,
};
use crate::diagnosis::{Diagnoser, Diagnosis};
use crate::features::{BoneSet, KeyPose};
use crate::kinematics::WorldPose;

/// Follows one performer: skeletons and frames in, events out. [`PerformerStream`](super::PerformerStream) is the same for a performer
/// whose skeleton or points are known from the beginning, with all options.
///
/// Takes memory when a skeleton is new (a recogniser is made for its bones at its first frame), and when a second shows that the
/// stream has other bones than that was made for ([`ShownBones`]); other frames take none.
#[derive(Debug)]
pub struct Performer {
    recognizers: Arc<RecognizerCache>,
    rig: Option<Arc<Rig>>,
    /// Made with the first pose, as `reader` is with the first skeleton: a performer that never comes takes little memory.
    recognizer: Option<Box<Recognizer>>,
    shown: ShownBones,
    /// Reads what a model asks for beyond places of joints.
    reader: Option<Box<PoseExtractor>>,
    early: EarlyTracker,
    /// See [`EventOptions::deviation`].
    compares: bool,
    /// See [`EventOptions::progress`].
    follows: bool,
    tracker: EventTracker,
    out: EventBuffer,
    unusable: u64,
    dropped: u64,
    problem: Option<StartError>,
    /// Made with the first skeleton: a performer that never comes needs none.
    diagnoser: Option<Box<Diagnoser>>,
}

impl Performer {
    /// Has no rig yet; call [`set_rig`](Self::set_rig) first.
    pub fn new<M: Clone + Into<Model>>(
        model: &M,
        actor: PerformerId,
        options: &EventOptions,
    ) -> Self {
        Self::sharing(&Arc::new(RecognizerCache::new(model)), actor, options)
    }

    /// The same, with recognisers that others share.
    pub fn sharing(
        recognizers: &Arc<RecognizerCache>,
        actor: PerformerId,
        options: &EventOptions,
    ) -> Self {
        let model = recognizers.model();
        Self {
            tracker: EventTracker::new(model.classes().len(), options.refractory_secs),
            shown: ShownBones::new(model.bones()),
            recognizers: recognizers.clone(),
            reader: None,
            rig: None,
            recognizer: None,
            early: EarlyTracker::new(options),
            compares: options.deviation,
            follows: options.progress,
            out: EventBuffer::new(actor),
            unusable: 0,
            dropped: 0,
            problem: Some(StartError::NoSkeleton),
            diagnoser: None,
        }
    }

    /// Begins with a new skeleton; the events of the end of what went on with the old one.
    pub fn set_rig(&mut self, rig: &Arc<Rig>) -> &[Event] {
        self.finish();
        let classes = self.recognizers.model().classes().len();
        self.out.reserve(if self.follows { classes } else { 0 });
        let rig = match self.recognizers.model().roles_of(&rig.skeleton, &rig.roles) {
            Cow::Borrowed(_) => rig.clone(),
            Cow::Owned(roles) => Arc::new(Rig {
                roles,
                skeleton: rig.skeleton.clone(),
            }),
        };
        self.dropped = self.dropped();
        (self.recognizer, self.problem) = (None, None);
        self.shown.reset();
        self.diagnoser = Some(Box::new(Diagnoser::live()));
        let reader = PoseExtractor::new(self.recognizers.model(), &rig.skeleton, &rig.roles);
        self.reader = reader.ok().map(Box::new);
        self.rig = Some(rig);
        self.out.events()
    }

    /// Makes a recogniser for `bones` now and not at the first frame, so that what does not fit is said now, and no bone is given up
    /// because the first frame happens not to show it. Call it after [`set_rig`](Self::set_rig), which forgets it.
    ///
    /// # Errors
    /// As [`Recognizer::new`].
    pub fn announce(&mut self, bones: BoneSet) -> Result<(), StartError> {
        self.recognizer = Some(self.made(bones)?);
        Ok(())
    }

    fn made(&self, bones: BoneSet) -> Result<Box<Recognizer>, StartError> {
        let mut made = Box::new(self.recognizers.recognizer(bones)?);
        if self.compares {
            made.measure_deviations();
        }
        if self.follows {
            made.follow_progress();
        }
        Ok(made)
    }

    /// Takes a frame; the events that it settled. A frame without a rig, or of a skeleton that shows none of the index's bones, gives
    /// none and is counted as [unusable](Self::unusable); [`problem`](Self::problem) is then why.
    pub fn push(&mut self, frame: &Frame) -> &[Event] {
        let key = match &self.rig {
            Some(rig) => frame.key_pose(rig),
            None => KeyPose::default(),
        };
        self.take(frame.time_secs, frame.wall_secs, &key, &frame.pose)
    }

    /// [`push`](Self::push) of a pose whose roles are known, as of a rig [of roles](Rig::of_roles).
    pub fn push_pose(&mut self, time_secs: f64, wall_secs: f64, pose: &KeyPose) -> &[Event] {
        self.take(time_secs, wall_secs, pose, &WorldPose::default())
    }

    fn take(
        &mut self,
        time_secs: f64,
        wall_secs: f64,
        pose: &KeyPose,
        world: &WorldPose,
    ) -> &[Event] {
        self.out.clear();
        if self.rig.is_none() {
            self.unusable += 1;
            return self.out.events();
        }
        if let Some(diagnoser) = &mut self.diagnoser {
            diagnoser.push(time_secs, wall_secs, pose);
            diagnoser.see_turns(&world.rotations);
        }
        let bones = match &self.recognizer {
            Some(recognizer) => {
                let used = recognizer.model().bones();
                self.shown.take(used, time_secs, pose)
            }
            None => Some(BoneSet::of_pose(pose)),
        };
        if let Some(bones) = bones {
            self.look_at(bones);
        }
        let Some(recognizer) = &mut self.recognizer else {
            self.unusable += 1;
            return self.out.events();
        };
        self.out.arrive(wall_secs);
        let reader = self.reader.as_mut();
        let pivots = reader.and_then(|reader| reader.pivots(world));
        for detection in recognizer.push(time_secs, RecognizerInput { key: pose, pivots }) {
            self.tracker.emit(detection, &mut self.early, &mut self.out);
        }
        if self.early.is_wanted() {
            let (early, after_secs) = (recognizer.early_detection(), self.tracker.last_stop_secs());
            self.early.look(early, after_secs, time_secs, &mut self.out);
        }
        if self.follows {
            let out = &mut self.out;
            recognizer.progress(|of, pace| out.add_progress(of, pace, time_secs));
        }
        self.compare();
        self.out.events()
    }

    /// Goes on with a recogniser for other bones, if there can be one.
    fn look_at(&mut self, bones: BoneSet) {
        let new = self.made(bones);
        self.problem = new.as_ref().err().cloned();
        if let Ok(new) = new {
            self.end();
            self.dropped = self.dropped();
            self.recognizer = Some(new);
        }
    }

    /// The stream ends or breaks off: the events that its last moments hold. It may go on with another frame.
    pub fn finish(&mut self) -> &[Event] {
        self.out.clear();
        self.end();
        self.tracker.forget();
        self.shown.reset();
        self.out.events()
    }

    /// Adds the events that the recogniser still holds.
    fn end(&mut self) {
        let Some(recognizer) = &mut self.recognizer else {
            return;
        };
        for detection in recognizer.finish() {
            self.tracker.emit(detection, &mut self.early, &mut self.out);
        }
        self.early.cancel(None, &mut self.out);
        self.compare();
    }

    /// Compares what ended with samples, if that is asked for.
    fn compare(&mut self) {
        if let Some(recognizer) = self.recognizer.as_mut().filter(|_| self.compares) {
            self.out.compare(|event| {
                let repetition = event.phase == Phase::Repetition;
                recognizer.deviation(event.class, event.span, repetition)
            });
        }
    }

    /// Frames that could not be used: no skeleton was known, or none of its bones are the index's.
    pub fn unusable(&self) -> u64 {
        self.unusable
    }

    /// Detections that were lost because one frame settled more than a recogniser keeps.
    pub fn dropped(&self) -> u64 {
        self.dropped + self.recognizer.as_ref().map_or(0, |r| r.dropped())
    }

    /// Motions that were not reported because of [`EventOptions::refractory_secs`].
    pub fn suppressed(&self) -> u64 {
        self.tracker.suppressed()
    }

    /// Findings about the stream since its present skeleton was set; `None` before there is one.
    pub fn diagnosis(&self) -> Option<Diagnosis> {
        self.diagnoser
            .as_ref()
            .map(|diagnoser| diagnoser.diagnosis())
    }

    /// Why what the stream shows cannot be recognised: nothing of it is the index's, or [no rig](Self::set_rig) was set.
    pub fn problem(&self) -> Option<&StartError> {
        self.problem.as_ref()
    }

    /// See [`Recognizer::latency_secs`]; `None` before there is a recogniser.
    pub fn latency_secs(&self) -> Option<f64> {
        let recognizer = self.recognizer.as_ref();
        recognizer.map(|recognizer| recognizer.latency_secs())
    }

    /// The bones that are looked at; `None` before there is a recogniser.
    pub fn bones(&self) -> Option<BoneSet> {
        let recognizer = self.recognizer.as_ref();
        recognizer.map(|recognizer| recognizer.model().bones())
    }

    /// True if the last second showed nothing that the index can use, and something else: a performer of another kind.
    pub fn shows_another(&self) -> bool {
        self.shown.is_other()
    }

    /// See [`Recognizer::admits_strangers`].
    pub fn admits_strangers(&self) -> bool {
        let recognizer = self.recognizer.as_ref();
        recognizer.is_some_and(|recognizer| recognizer.admits_strangers())
    }

    /// The motion that seems to be under way.
    pub fn early_detection(&self) -> Option<EarlyDetection> {
        self.early.last_reported()
    }
}
