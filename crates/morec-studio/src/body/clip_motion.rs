//! A clip's motion, decoded for looking at.

use morec::clip::Clip;
use morec::diagnosis::errors_of_clip;
use morec::features::{FeatureParams, RowLayout, bones_of_clip, rows_of_clip};
use morec::kinematics::WorldPose;
use morec::math::Vec3;
use morec::roles::{self, Role, RoleMap};
use morec_db::{ClipId, StoredClip};

use super::Body;

/// A clip as the view and the timeline need it.
#[derive(Debug)]
pub struct ClipMotion {
    pub id: ClipId,
    pub clip: Clip,
    pub roles: RoleMap,
    pub rest: std::ops::Range<usize>,
    pub body: Body,
    /// Speed at which the bones turn, at every tick: root mean square, saturated, for the track under the timeline.
    pub speed: Vec<f32>,
    pub tick_hz: f64,
    /// Height of the lowest joint over the whole clip, metres.
    pub floor: f64,
    /// What no person's body has, each in a sentence, as `morec inspect` reports it.
    pub doubts: Vec<String>,
    /// False of an animal, a thing, and points of which nothing is known.
    pub is_person: bool,
}

impl ClipMotion {
    pub fn of(id: ClipId, stored: StoredClip) -> Self {
        let StoredClip { clip, roles, rest } = stored;
        let params = FeatureParams::default();
        let bones = bones_of_clip(&clip, &roles, &rest);
        let speed = match bones.is_empty() {
            true => Vec::new(),
            false => speeds(
                &rows_of_clip(&clip, &roles, &rest, bones, &params),
                RowLayout::of(bones),
            ),
        };
        let doubts = doubts(&clip, &roles, &rest);
        let first = rest.end.min(clip.frames.saturating_sub(1));
        // Whoever is no person is drawn without a person's limbs.
        let is_person = !doubts.iter().any(|doubt| doubt.starts_with(NOT_HUMAN));
        let body = match is_person {
            false => Body::of(&clip, &RoleMap::default(), first),
            true => Body::of(&clip, &roles, first),
        };
        let is_person = is_person && roles.joint(Role::Hips).is_some();
        let floor = floor(&clip, &rest);
        Self {
            id,
            body,
            speed,
            tick_hz: params.tick_hz(),
            floor,
            doubts,
            is_person,
            clip,
            roles,
            rest,
        }
    }

    /// True if the clip holds points that do not hang together, as markers do.
    pub fn is_points(&self) -> bool {
        let joints = self.clip.skeleton.joints();
        joints.iter().all(|joint| joint.parent.is_none())
    }

    pub fn secs(&self) -> f64 {
        self.clip.duration_secs()
    }

    /// The frame shown at a moment: T-poses that a conversion left at the start show what follows.
    pub fn frame_at(&self, secs: f64) -> usize {
        let last = self.clip.frames.saturating_sub(1);
        let frame = ((secs * self.clip.rate_hz).floor().max(0.0) as usize).min(last);
        match self.rest.contains(&frame) {
            true => self.rest.end.min(last),
            false => frame,
        }
    }

    pub fn pose(&self, secs: f64) -> WorldPose {
        match self.clip.frames {
            0 => WorldPose::default(),
            _ => WorldPose::of(&self.clip, self.frame_at(secs)),
        }
    }

    /// Where a camera looks that follows: the middle of what is seen; of a person at the height of a waist, so that the picture does
    /// not bob.
    pub fn centre(&self, pose: &WorldPose) -> Option<Vec3> {
        if !self.is_person {
            return Some(extent(&pose.positions)?.0);
        }
        let at = self.body.centre(pose)?;
        Some(Vec3::new(at.x, self.floor + 0.52 * self.body.height, at.z))
    }

    /// So many poses at most, evenly spread over the clip.
    pub fn poses(&self, most: usize) -> impl Iterator<Item = WorldPose> {
        let step = self.clip.frames.div_ceil(most).max(1);
        let frames = (0..self.clip.frames).step_by(step);
        frames.map(|frame| self.pose((frame as f64 + 0.5) / self.clip.rate_hz))
    }
}

/// Root mean square of the bones' speeds: rows hold them saturated, which is well for a picture.
fn speeds(rows: &morec::features::Rows, layout: RowLayout) -> Vec<f32> {
    let speed = |row: &[f32]| {
        let velocities = &row[layout.velocities()];
        (velocities.iter().map(|v| v * v).sum::<f32>() / layout.bones().max(1) as f32).sqrt()
    };
    rows.iter().map(speed).collect()
}

/// How [`roles::check`] begins what it says of an animal or a thing.
const NOT_HUMAN: &str = "this is probably not a human body";

/// What no person's body has, in some frames; nothing of points of which none is known.
fn doubts(clip: &Clip, roles: &RoleMap, rest: &std::ops::Range<usize>) -> Vec<String> {
    const FRAMES: usize = 12;
    if clip.frames == 0 || (!clip.has_rotations() && *roles == RoleMap::default()) {
        return Vec::new();
    }
    let first = rest.end.min(clip.frames.saturating_sub(1));
    let step = (clip.frames - first).div_ceil(FRAMES).max(1);
    let frames = (first..clip.frames).step_by(step);
    let poses: Vec<Vec<Vec3>> = frames.map(|at| WorldPose::of(clip, at).positions).collect();
    let mut doubts = roles::check(&clip.skeleton, roles, &poses);
    doubts.extend(errors_of_clip(clip, roles, rest));
    // The command's remedy is a file; here it is a click.
    let here = |doubt: String| {
        doubt.replace(
            "with --roles FILE",
            "under Parts of the body in the library",
        )
    };
    doubts.into_iter().map(here).collect()
}

/// Where joints are that are seen: the middle, and half of the greatest extent, metres.
pub fn extent(positions: &[Vec3]) -> Option<(Vec3, f64)> {
    let seen = || positions.iter().filter(|p| p.iter().all(|v| v.is_finite()));
    let first = seen().next()?;
    let (low, high) = seen().fold((*first, *first), |(low, high), p| (low.inf(p), high.sup(p)));
    Some(((low + high) / 2.0, (high - low).max() / 2.0))
}

/// The lowest joint of some fifty frames.
fn floor(clip: &Clip, rest: &std::ops::Range<usize>) -> f64 {
    let first = rest.end.min(clip.frames.saturating_sub(1));
    let step = ((clip.frames - first.min(clip.frames)) / 50).max(1);
    let lowest = (first..clip.frames)
        .step_by(step)
        .flat_map(|frame| WorldPose::of(clip, frame).positions)
        .map(|p| p.y)
        .filter(|y| y.is_finite())
        .fold(f64::INFINITY, f64::min);
    if lowest.is_finite() { lowest } else { 0.0 }
}
