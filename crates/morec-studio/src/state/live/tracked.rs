//! One performer of a live source: skeleton, poses of the last minutes, recognition.

use std::collections::VecDeque;
use std::sync::Arc;

use morec::diagnosis::Diagnosis;
use morec::features::KeyPose;
use morec::kinematics::WorldPose;
use morec::live::{
    EarlyDetection, Event, EventOptions, Frame, Model, Performer, PerformerId, Recording, Rig,
};
use morec::math::Vec3;

use super::moved;
use crate::body::Body;
use crate::body::extent;

/// Length of the stream that is kept for looking back, seconds.
pub const KEPT_SECS: f64 = 300.0;
/// A clock that goes back by more began anew, seconds.
const CLOCK_BACK_SECS: f64 = 1.0;

/// A performer of the source, with the last minutes of the stream.
pub struct LivePerformer {
    pub actor: PerformerId,
    pub rig: Option<Arc<Rig>>,
    pub body: Body,
    pub pose: WorldPose,
    /// Time of the last frame, on the stream's clock.
    pub now_secs: f64,
    /// The last minutes.
    pub frames: VecDeque<Frame>,
    /// Speed of hands and feet against the hips for each frame, metres a second.
    pub speeds: VecDeque<f32>,
    /// True once the source has said that the performer left.
    pub gone: bool,
    performer: Option<Performer>,
}

impl LivePerformer {
    pub fn new(actor: PerformerId, model: Option<&Model>) -> Self {
        Self {
            actor,
            rig: None,
            body: Body::default(),
            pose: WorldPose::default(),
            now_secs: 0.0,
            frames: VecDeque::new(),
            speeds: VecDeque::new(),
            gone: false,
            performer: model.map(|m| recogniser(m, actor)),
        }
    }

    /// Recognises with this model from the next frame on. What went on with the last one is reported before.
    pub fn recognise_with(&mut self, model: &Model, events: &mut Vec<Event>) {
        self.finish(events);
        let mut performer = recogniser(model, self.actor);
        if let Some(rig) = &self.rig {
            performer.set_rig(rig);
        }
        self.performer = Some(performer);
    }

    /// Ends the motions that are under way.
    pub fn finish(&mut self, events: &mut Vec<Event>) {
        if let Some(performer) = &mut self.performer {
            events.extend_from_slice(performer.finish());
        }
    }

    /// Goes on with this skeleton. True if the frames that were kept are dropped, being of another one.
    pub fn set_rig(&mut self, rig: Arc<Rig>, events: &mut Vec<Event>) -> bool {
        if let Some(performer) = &mut self.performer {
            events.extend_from_slice(performer.set_rig(&rig));
        }
        // Frames of another skeleton cannot stand beside these.
        let other = self
            .rig
            .as_ref()
            .is_some_and(|old| old.skeleton.len() != rig.skeleton.len());
        let dropped = other && self.drop_frames();
        self.body = Body::default();
        self.gone = false;
        self.rig = Some(rig);
        dropped
    }

    /// Takes a frame. True if the frames that were kept are dropped, as the sender's clock went back.
    pub fn push(&mut self, frame: &Frame, events: &mut Vec<Event>) -> bool {
        if self.body.limbs.is_empty()
            && let Some(rig) = &self.rig
        {
            let joints = rig.skeleton.joints().iter();
            let parents: Vec<Option<usize>> = joints.map(|j| j.parent).collect();
            self.body = Body::new(&parents, &rig.roles, &frame.pose);
        }
        if let Some(performer) = &mut self.performer {
            events.extend_from_slice(performer.push(frame));
        }
        let went_back = frame.time_secs < self.now_secs - CLOCK_BACK_SECS;
        let dropped = went_back && self.drop_frames();
        self.gone = false;
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
        dropped
    }

    fn drop_frames(&mut self) -> bool {
        let some = !self.frames.is_empty();
        self.frames.clear();
        self.speeds.clear();
        some
    }

    pub fn centre(&self) -> Option<Vec3> {
        if self.body.is_hand {
            return Some(extent(&self.pose.positions)?.0);
        }
        let at = self.body.centre(&self.pose)?;
        Some(Vec3::new(
            at.x,
            self.floor() + 0.52 * self.body.height,
            at.z,
        ))
    }

    /// The lowest joint of the present pose, which is about where the floor is.
    pub fn floor(&self) -> f64 {
        let heights = self.pose.positions.iter().map(|p| p.y);
        let lowest = heights.filter(|y| y.is_finite()).fold(f64::MAX, f64::min);
        // A jump leaves the floor where it is.
        if lowest < f64::MAX && self.body.is_hand {
            lowest
        } else if lowest < f64::MAX {
            lowest.min(0.05)
        } else {
            0.0
        }
    }

    pub fn early_detection(&self) -> Option<EarlyDetection> {
        self.performer.as_ref()?.early_detection()
    }

    pub fn diagnosis(&self) -> Option<Diagnosis> {
        self.performer.as_ref()?.diagnosis()
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

/// The window shows what seems to be under way, and how well each motion and repetition was performed.
fn recogniser(model: &Model, actor: PerformerId) -> Performer {
    let options = EventOptions {
        tentative: true,
        each_repetition: true,
        deviation: true,
        ..EventOptions::default()
    };
    Performer::new(model, actor, &options)
}
