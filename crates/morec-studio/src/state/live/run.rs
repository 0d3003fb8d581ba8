//! One run of a live source: its poses, the minutes before, what was recognised.

use std::collections::VecDeque;
use std::sync::Arc;

use morec::classes::ClassId;
use morec::diagnosis::{Diagnosis, Severity};
use morec::features::KeyPose;
use morec::kinematics::WorldPose;
use morec::live::{
    EarlyDetection, Event, EventOptions, Frame, Model, Performer, PerformerId, Phase, Recording,
    Rig,
};
use morec::math::Vec3;

use super::feed::{Feed, SourceItem};
use super::moved;
use crate::body::Body;

/// So much of the stream is kept for looking back.
pub const KEPT_SECS: f64 = 300.0;
/// A stream that says nothing for so long has been lost, seconds on the wall.
const LOST_SECS: f64 = 1.5;

/// Something that was recognised.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveDetection {
    pub class: String,
    pub start_secs: f64,
    pub stop_secs: f64,
    pub reported_secs: f64,
    pub score: f64,
}

/// A source that runs.
pub struct Run {
    feed: Feed,
    pub name: String,
    pub rig: Option<Arc<Rig>>,
    pub body: Body,
    pub pose: WorldPose,
    pub now_secs: f64,
    /// The last minutes, of the first performer.
    pub frames: VecDeque<Frame>,
    /// How fast hands and feet move against the hips, for each of them: metres a second.
    pub speeds: VecDeque<f32>,
    pub seen: Vec<LiveDetection>,
    /// Classes of motions that ended since they were asked for.
    pub news: Vec<ClassId>,
    performer: Option<Performer>,
    model: Option<Model>,
    actor: Option<PerformerId>,
    /// How long nothing has come, seconds on the wall.
    pub silent_secs: f64,
    pub ended: bool,
    /// What the source finds wrong with what it is sent, and what it has said so far.
    pub notices: Option<morec_live::Notices>,
    noticed: Vec<String>,
}

impl Run {
    pub fn new(feed: Feed, name: String) -> Self {
        Self {
            feed,
            name,
            rig: None,
            body: Body::default(),
            pose: WorldPose::default(),
            now_secs: 0.0,
            frames: VecDeque::new(),
            speeds: VecDeque::new(),
            seen: Vec::new(),
            news: Vec::new(),
            performer: None,
            model: None,
            actor: None,
            silent_secs: 0.0,
            ended: false,
            notices: None,
            noticed: Vec::new(),
        }
    }

    /// Recognises with this model from the next frame on. What went on with the last one is told before.
    pub fn recognise_with(&mut self, model: &Model) {
        let mut events = Vec::new();
        if let Some(performer) = &mut self.performer {
            performer.finish(&mut |event| events.push(event));
        }
        self.take_events(&events);
        self.model = Some(model.clone());
        let mut performer = Performer::new(model, PerformerId(0), &EventOptions::default());
        if let Some(rig) = &self.rig {
            performer.set_rig(rig, &mut |_| {});
        }
        self.performer = Some(performer);
    }

    /// Takes what has come while `dt` seconds passed; gives the frames of the performer who is watched.
    pub fn tick(&mut self, dt: f64) -> Vec<Frame> {
        let (mut items, mut frames, mut events) = (Vec::new(), Vec::new(), Vec::new());
        self.feed.poll(dt, &mut items);
        self.silent_secs += dt;
        if let Some(notices) = &self.notices {
            self.noticed.extend(notices.take());
        }
        for item in items {
            match item {
                SourceItem::Rig(actor, rig) => {
                    if *self.actor.get_or_insert(actor) == actor {
                        self.set_rig(rig, &mut events);
                    }
                }
                SourceItem::Frame(frame) if self.actor == Some(frame.actor) => {
                    self.silent_secs = 0.0;
                    self.push(&frame, &mut events);
                    frames.push(*frame);
                }
                SourceItem::Gone(actor) if self.actor == Some(actor) => {
                    if let Some(performer) = &mut self.performer {
                        performer.finish(&mut |event| events.push(event));
                    }
                }
                SourceItem::Ended => self.ended = true,
                SourceItem::Frame(_) | SourceItem::Gone(_) => {}
            }
        }
        self.take_events(&events);
        frames
    }

    fn set_rig(&mut self, rig: Arc<Rig>, events: &mut Vec<Event>) {
        if let Some(performer) = &mut self.performer {
            performer.set_rig(&rig, &mut |event| events.push(event));
        }
        // Frames of another skeleton cannot stand beside these.
        let other = self
            .rig
            .as_ref()
            .is_some_and(|old| old.skeleton.len() != rig.skeleton.len());
        if other {
            self.frames.clear();
            self.speeds.clear();
        }
        self.body = Body::default();
        self.rig = Some(rig);
    }

    fn push(&mut self, frame: &Frame, events: &mut Vec<Event>) {
        if self.body.limbs.is_empty()
            && let Some(rig) = &self.rig
        {
            let joints = rig.skeleton.joints().iter();
            let parents: Vec<Option<usize>> = joints.map(|j| j.parent).collect();
            self.body = Body::new(&parents, &rig.roles, &frame.pose);
        }
        if let Some(performer) = &mut self.performer {
            performer.push_own(frame, &mut |event| events.push(event));
        }
        self.now_secs = frame.time_secs;
        self.pose.clone_from(&frame.pose);
        let speed = match &self.rig {
            Some(rig) => moved::speed(&self.frames, frame, rig),
            None => 0.0,
        };
        self.speeds.push_back(speed);
        self.frames.push_back(frame.clone());
        let old = self.now_secs - KEPT_SECS;
        while self.frames.front().is_some_and(|f| f.time_secs < old) {
            self.frames.pop_front();
            self.speeds.pop_front();
        }
    }

    fn take_events(&mut self, events: &[Event]) {
        let Some(model) = &self.model else { return };
        for event in events.iter().filter(|e| e.phase == Phase::End) {
            self.news.push(event.class);
            self.seen.push(LiveDetection {
                class: model.class_name(event.class).to_owned(),
                start_secs: event.start_secs,
                stop_secs: event.stop_secs,
                reported_secs: event.reported_secs,
                score: event.score,
            });
        }
    }

    pub fn centre(&self) -> Option<Vec3> {
        let at = self.body.centre(&self.pose)?;
        let height = self.body.height;
        Some(Vec3::new(at.x, self.floor() + 0.52 * height, at.z))
    }

    /// The lowest joint of the present pose, which is about where the floor is.
    pub fn floor(&self) -> f64 {
        let heights = self.pose.positions.iter().map(|p| p.y);
        let lowest = heights.filter(|y| y.is_finite()).fold(f64::MAX, f64::min);
        // A jump leaves the floor where it is.
        if lowest < f64::MAX {
            lowest.min(0.05)
        } else {
            0.0
        }
    }

    /// What seems to be under way: class and progress.
    pub fn hunch(&self) -> Option<(String, EarlyDetection)> {
        let hunch = self.performer.as_ref()?.hunch()?;
        let model = self.model.as_ref()?;
        Some((model.class_name(hunch.class).to_owned(), hunch))
    }

    pub fn diagnosis(&self) -> Option<Diagnosis> {
        self.performer.as_ref()?.diagnosis()
    }

    /// How the stream is, in sentences, each with whether it is a fault.
    pub fn health(&self) -> Vec<(String, bool)> {
        let mut said = Vec::new();
        if self.ended {
            said.push(("The source has ended".to_owned(), true));
        } else if self.frames.is_empty() {
            said.push((
                "Nothing has come yet: is the sender on, and does it send here?".to_owned(),
                true,
            ));
        } else if self.silent_secs > LOST_SECS {
            let secs = self.silent_secs;
            said.push((
                format!("Nothing has come for {secs:.0} s: the sender has stopped"),
                true,
            ));
        }
        let counts = self.feed.counts();
        if counts.malformed > 0 {
            said.push((
                format!("{} packets could not be understood", counts.malformed),
                true,
            ));
        }
        said.extend(self.noticed.iter().rev().map(|text| (text.clone(), true)));
        if let Some(diagnosis) = self.diagnosis() {
            for finding in diagnosis.findings().iter() {
                said.push((
                    crate::store::sentence(&finding.to_string()),
                    finding.severity() != Severity::Info,
                ));
            }
        }
        said
    }

    /// The last stretch in which somebody moved.
    pub fn last_motion(&self) -> Option<(f64, f64)> {
        moved::last_motion(&self.frames, &self.speeds)
    }

    /// The frames of a stretch as a recording, and the time at which it begins.
    pub fn cut_out(&self, start_secs: f64, stop_secs: f64) -> Option<(Recording, f64)> {
        let mut recording = Recording::new(self.rig.as_ref()?);
        let inside = |f: &&Frame| f.time_secs >= start_secs && f.time_secs <= stop_secs;
        let frames: Vec<&Frame> = self.frames.iter().filter(inside).collect();
        let origin = frames.first()?.time_secs;
        frames.iter().for_each(|frame| recording.push(frame));
        Some((recording, origin))
    }

    /// The kept poses, for trying another sensitivity.
    pub fn key_poses(&self) -> Vec<(f64, KeyPose)> {
        let Some(rig) = &self.rig else {
            return Vec::new();
        };
        let pose = |f: &Frame| (f.time_secs, f.key_pose(rig));
        self.frames.iter().map(pose).collect()
    }
}
