//! Keeping joints where they were in the world: thresholds by reach, then closer fits where that is not enough.

use super::bezier::ChannelKind;
use super::compress::too_coarse;
use super::measure::angle_between;
use super::params::{SmoothError, SmoothParams};
use super::sample::rotation;
use super::split::{ChannelFit, TooCoarse};
use crate::clip::Clip;
use crate::kinematics::WorldPose;
use crate::progress::Progress;

/// Share of the bound that one joint alone may use up at the end of its reach. Errors of a chain rarely add up in
/// one direction; where they do, [`tighten`] sees to it.
const SHARE_OF_JOINT: f64 = 0.7;
/// The same for a position, which moves all that hangs on it.
const SHARE_OF_POSITION: f64 = 0.5;
/// An ancestor with so much of the largest part in an error is fitted more closely,
const PART: f64 = 0.7;
/// to so much of the error it has.
const TIGHTER: f64 = 0.5;
/// Rounds of looking and fitting; ten or twenty are usual.
const ROUNDS: usize = 400;

/// What each channel may be off by, to begin with.
pub(super) struct Thresholds {
    angle_rad: f64,
    position: f64,
    bound: Option<f64>,
    /// How far the furthest joint that hangs on each is from it at most, in the clip's unit.
    reach: Vec<f64>,
}

impl Thresholds {
    pub fn new(clip: &Clip, params: &SmoothParams) -> Self {
        let bound = params
            .joint_position_metres
            .map(|metres| metres / params.metres_per_unit);
        let position = params.position_metres / params.metres_per_unit;
        let position = bound.map_or(position, |bound| position.min(SHARE_OF_POSITION * bound));
        Self {
            angle_rad: params.angle_rad,
            position,
            bound,
            reach: reach(clip),
        }
    }

    /// Of joint `j`'s rotation.
    pub fn angle_rad(&self, j: usize) -> f64 {
        match self.bound {
            Some(bound) if self.reach[j] > 0.0 => self
                .angle_rad
                .min((SHARE_OF_JOINT * bound / self.reach[j]).max(1e-6)),
            _ => self.angle_rad,
        }
    }

    /// Of positions, in the clip's unit.
    pub fn position(&self) -> f64 {
        self.position
    }
}

/// Length of the longest chain below each joint, as the first frame has it.
fn reach(clip: &Clip) -> Vec<f64> {
    let joints = clip.skeleton.joints();
    let mut reach = vec![0.0f64; joints.len()];
    for j in (0..joints.len()).rev() {
        if let Some(parent) = joints[j].parent {
            let bone = if clip.frames > 0 {
                clip.local_position(0, j)
            } else {
                joints[j].offset
            };
            reach[parent] = reach[parent].max(bone.norm() + reach[j]);
        }
    }
    reach
}

/// Fits channels again, more closely, until every joint lies within `metres` of where it was, at every frame.
pub(super) fn tighten(
    clip: &Clip,
    channels: &mut [ChannelFit],
    metres: f64,
    metres_per_unit: f64,
    progress: &dyn Progress,
) -> Result<(), SmoothError> {
    let mut work = Tightening::new(clip, channels, metres / metres_per_unit);
    for _ in 0..ROUNDS {
        if progress.cancelled() {
            return Err(SmoothError::Cancelled);
        }
        let blamed = work.blame();
        if blamed.is_empty() {
            return Ok(());
        }
        work.refit(blamed)
            .map_err(|(channel, coarse)| too_coarse(clip, channel, coarse))?;
    }
    let reached_metres = work.worst * metres_per_unit;
    Err(SmoothError::Bound {
        bound_metres: metres,
        reached_metres,
    })
}

/// A channel to be fitted to a share of its tolerance at a frame.
struct Blame {
    channel: usize,
    frame: usize,
    share: f32,
}

struct Tightening<'a> {
    clip: &'a Clip,
    channels: &'a mut [ChannelFit],
    /// What the curves give at the clip's frames.
    fitted: Clip,
    /// Frames at which `fitted` has changed since they were looked at.
    changed: Vec<bool>,
    /// Of each joint, its track's channel.
    tracks: Vec<Option<usize>>,
    bound: f64,
    worst: f64,
    pose: WorldPose,
    fitted_pose: WorldPose,
}

impl<'a> Tightening<'a> {
    fn new(clip: &'a Clip, channels: &'a mut [ChannelFit], bound: f64) -> Self {
        let joints = clip.skeleton.len();
        let mut tracks = vec![None; joints];
        for (i, track) in clip.tracks.iter().enumerate() {
            tracks[track.joint] = Some(joints + i);
        }
        let (pose, fitted_pose) = (WorldPose::default(), WorldPose::default());
        let changed = vec![true; clip.frames];
        let fitted = clip.clone();
        let mut work = Self {
            clip,
            channels,
            fitted,
            changed,
            tracks,
            bound,
            worst: 0.0,
            pose,
            fitted_pose,
        };
        for channel in 0..work.channels.len() {
            work.play(channel, 0, clip.frames);
        }
        work
    }

    /// Brings `fitted` up to date with a channel in `from..to`.
    fn play(&mut self, channel: usize, from: usize, to: usize) {
        let joints = self.clip.skeleton.len();
        let c = &self.channels[channel];
        let (kind, start) = (c.lattice.kind, c.start());
        let mut current = c
            .segments
            .partition_point(|s| (s.start as usize) < from)
            .saturating_sub(1);
        for frame in from..to {
            while c
                .segments
                .get(current + 1)
                .is_some_and(|next| next.start as usize <= frame)
            {
                current += 1;
            }
            let value = c
                .segments
                .get(current)
                .map_or(start, |s| s.at(kind, frame as f64));
            match kind {
                ChannelKind::Rotation => {
                    self.fitted.rotations[frame * joints + channel] = rotation(&value)
                }
                ChannelKind::Position => {
                    self.fitted.tracks[channel - joints].positions[frame] = value.xyz()
                }
            }
            self.changed[frame] = true;
        }
    }

    /// Looks at the frames that have changed, and names who is to blame for joints that are too far away.
    fn blame(&mut self) -> Vec<Blame> {
        let mut blamed = Vec::new();
        self.worst = 0.0;
        for frame in 0..self.clip.frames {
            if !std::mem::take(&mut self.changed[frame]) {
                continue;
            }
            self.pose.set(self.clip, frame);
            self.fitted_pose.set(&self.fitted, frame);
            let off = |j: usize| (self.pose.positions[j] - self.fitted_pose.positions[j]).norm();
            let furthest = (0..self.clip.skeleton.len())
                .map(|j| (off(j), j))
                .max_by(|a, b| a.0.total_cmp(&b.0));
            let Some((distance, joint)) = furthest.filter(|(distance, _)| *distance > self.bound)
            else {
                continue;
            };
            self.worst = self.worst.max(distance);
            self.blame_chain(frame, joint, &mut blamed);
        }
        blamed
    }

    /// Of the channels that move `joint`, those with the largest parts in its error.
    fn blame_chain(&self, frame: usize, joint: usize, blamed: &mut Vec<Blame>) {
        let joints = self.clip.skeleton.len();
        let mut parts: Vec<(f64, usize, f64)> = Vec::new();
        let mut at = Some(joint);
        while let Some(j) = at {
            if let Some(channel) = self.tracks[j] {
                let track = channel - joints;
                let positions = |clip: &Clip| clip.tracks[track].positions[frame];
                let off = (positions(self.clip) - positions(&self.fitted)).norm();
                parts.push((off, channel, off));
            }
            if j != joint {
                let i = frame * joints + j;
                let angle = angle_between(&self.clip.rotations[i], &self.fitted.rotations[i]);
                let arm = (self.pose.positions[joint] - self.pose.positions[j]).norm();
                parts.push((angle * arm, j, super::compress::chord(angle)));
            }
            at = self.clip.skeleton.joints()[j].parent;
        }
        let most = parts.iter().map(|part| part.0).fold(0.0, f64::max);
        for (part, channel, off) in parts {
            if part >= PART * most {
                let share = (TIGHTER * off / self.channels[channel].tolerance).min(1.0) as f32;
                blamed.push(Blame {
                    channel,
                    frame,
                    share: share.max(f32::MIN_POSITIVE),
                });
            }
        }
    }

    /// Fits the blamed channels again. On failure: which channel, and at which frame.
    fn refit(&mut self, mut blamed: Vec<Blame>) -> Result<(), (usize, TooCoarse)> {
        blamed.sort_by_key(|b| (b.channel, b.frame));
        for group in blamed.chunk_by(|a, b| a.channel == b.channel) {
            let index = group[0].channel;
            let channel = &mut self.channels[index];
            let shares = channel
                .shares
                .get_or_insert_with(|| vec![1.0; self.clip.frames]);
            for b in group {
                shares[b.frame] = shares[b.frame].min(b.share);
            }
            let frames: Vec<usize> = group.iter().map(|b| b.frame).collect();
            match channel.refine(&frames) {
                Ok(ranges) => ranges
                    .into_iter()
                    .for_each(|range| self.play(index, range.start, range.end)),
                Err(_) => {
                    channel.lattice = channel.lattice.finer();
                    channel.fit().map_err(|coarse| (index, coarse))?;
                    self.play(index, 0, self.clip.frames);
                }
            }
        }
        Ok(())
    }
}
