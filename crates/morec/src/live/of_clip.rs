//! Plays a stored clip through the live recogniser, as `morec recognize` does.

use std::sync::Arc;
use std::thread;
use std::time::Duration;

use crate::clip::{Clip, Joint, Span};
use crate::features::{BoneSet, KeyPose, all_bones_of_clip};
use crate::kinematics::for_each_world_pose;
use crate::math::Quat;
use crate::pivots::NoPivots;
use crate::roles::RoleMap;

use super::start::check_shown;
use super::{
    Detection, Event, EventReader, Frame, Model, PerformerId, Phase, PoseExtractor, Recognizer,
    RecognizerCache, Rig, Session, SessionError, SessionOptions, StartError, wall_now_secs,
};

/// Everything that the recogniser reports of a clip, pose by pose as it would be live; times from the clip's
/// beginning. `rest` are the frames that a conversion left at the start; the first pose after them stands in for them.
///
/// # Errors
/// The clip lacks joints or rotations that the model asks for, or the model's parts do not fit together.
pub fn recognize_clip<M: Clone + Into<Model>>(
    model: &M,
    clip: &Clip,
    roles: &RoleMap,
    rest: &Span,
) -> Result<Vec<Detection>, StartError> {
    RecognizerCache::new(model).recognize_clip(clip, roles, rest)
}

impl RecognizerCache {
    /// [`recognize_clip`] with a recogniser of this cache: for many clips.
    ///
    /// # Errors
    /// As [`recognize_clip`].
    pub fn recognize_clip(
        &self,
        clip: &Clip,
        roles: &RoleMap,
        rest: &Span,
    ) -> Result<Vec<Detection>, StartError> {
        let roles = &self.model().roles_of(&clip.skeleton, roles);
        let recognizer = self.recognizer(all_bones_of_clip(clip, roles, rest))?;
        recognize_with(recognizer, self.model(), clip, roles, rest)
    }

    /// [`recognize_poses`] with a recogniser of this cache.
    ///
    /// # Errors
    /// As [`recognize_poses`].
    pub fn recognize_poses(&self, poses: &[(f64, KeyPose)]) -> Result<Vec<Detection>, StartError> {
        let bones = poses
            .first()
            .map_or(BoneSet::NONE, |p| BoneSet::of_pose(&p.1));
        let mut recognizer = self.recognizer(bones)?;
        let mut found = Vec::new();
        recognizer.push_all(poses, &mut found);
        found.extend_from_slice(recognizer.finish());
        Ok(found)
    }
}

/// Detections of `recognizer`, which is a new one for `model`, in a clip.
pub(super) fn recognize_with(
    mut recognizer: Recognizer,
    model: &Model,
    clip: &Clip,
    roles: &RoleMap,
    rest: &Span,
) -> Result<Vec<Detection>, StartError> {
    let mut found = Vec::new();
    if clip.frames == 0 {
        return Ok(found);
    }
    let mut reader = reader(model, clip, roles)?;
    recognizer.push_each(&mut found, |push| {
        reader
            .part_of(clip)
            .for_each_world_pose(rest, |time_secs, world| push(time_secs, reader.read(world)));
    });
    found.extend_from_slice(recognizer.finish());
    Ok(found)
}

/// Everything that the recogniser reports of `poses` with their times in seconds. The bones are those of the first
/// pose.
///
/// # Errors
/// A model that needs joint rotations, or no bone in common with it.
pub fn recognize_poses<M: Clone + Into<Model>>(
    model: &M,
    poses: &[(f64, KeyPose)],
) -> Result<Vec<Detection>, StartError> {
    RecognizerCache::new(model).recognize_poses(poses)
}

/// A reader of the poses of `clip` for `model`; an error if that asks for rotations and the clip has none.
fn reader(model: &Model, clip: &Clip, roles: &RoleMap) -> Result<PoseExtractor, StartError> {
    if model.needs_rotations() && has_positions_alone(clip) {
        return Err(NoPivots::Rotations.into());
    }
    PoseExtractor::new(model, &clip.skeleton, roles)
}

/// True of a clip of points, and of one whose joints move against their parents and never turn. O(frames × joints).
fn has_positions_alone(clip: &Clip) -> bool {
    let mut joints = clip.skeleton.joints().iter().enumerate();
    let moves = |(at, joint): (usize, &Joint)| joint.parent.is_some() && clip.track(at).is_some();
    let mut frames = (0..clip.frames).map(|frame| clip.frame_rotations(frame));
    !clip.has_rotations()
        || (joints.any(moves) && frames.all(|f| f.iter().all(|q| *q == Quat::identity())))
}

/// The same through a [`Session`], and on as many threads as its layout has. The session waits for room, whatever
/// `options` say of that.
///
/// # Errors
/// As [`recognize_clip`]; or the system refuses a thread.
pub fn recognize_clip_in_session<M: Clone + Into<Model>>(
    model: &M,
    clip: &Clip,
    roles: &RoleMap,
    rest: &Span,
    options: &SessionOptions,
) -> Result<Vec<Detection>, SessionError> {
    let model = model.clone().into();
    let roles = &model.roles_of(&clip.skeleton, roles);
    // What keeps a clip from being recognised is said as it is without a session.
    reader(&model, clip, roles)?;
    if let (Model::Templates(model), true) = (&model, clip.frames > 0) {
        check_shown(model.bones, all_bones_of_clip(clip, roles, rest))?;
    }
    let options = SessionOptions {
        overload: super::OverflowPolicy::Wait,
        readers: 1,
        ..options.clone()
    };
    let (session, mut feed, readers) = Session::open(&model, &options)?;
    let rig = Arc::new(Rig {
        skeleton: clip.skeleton.clone(),
        roles: RoleMap::clone(roles),
    });
    let found = thread::scope(|scope| {
        let found = scope.spawn(|| readers.into_iter().flat_map(ended).collect());
        feed.set_rig(PerformerId(0), &rig);
        let mut frame: Box<Frame> = Box::default();
        for_each_world_pose(clip, rest, |time_secs, world| {
            (frame.time_secs, frame.wall_secs) = (time_secs, wall_now_secs());
            frame.pose.clone_from(world);
            feed.send(&mut frame);
        });
        drop(feed);
        found.join().unwrap_or_default()
    });
    session.join();
    Ok(found)
}

/// The motions that end among everything a reader gives, until its stream ends.
fn ended(mut reader: EventReader) -> Vec<Detection> {
    let mut found = Vec::new();
    while !reader.is_ended() {
        let event = reader
            .wait(Duration::from_millis(200))
            .filter(|event| event.phase == Phase::End);
        found.extend(event.map(|event: Event| event.detection()));
    }
    found
}
