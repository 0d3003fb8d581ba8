//! Keeps joints near their positions in the world: thresholds by reach first, then closer fits if that is not enough.

use super::measure::angle_between;
use super::params::{SmoothError, SmoothParams};
use super::playhead::Playhead;
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

/// Initial tolerance of each channel.
pub(super) struct Thresholds {
    angle_rad: f64,
    position: f64,
    bound: Option<f64>,
    /// Largest distance of a joint that hangs on each, in the clip's unit.
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
pub(super) fn tighten<'c>(
    clip: &'c Clip,
    channels: &mut [ChannelFit<'c>],
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

struct Tightening<'w, 'c> {
    clip: &'c Clip,
    channels: &'w mut [ChannelFit<'c>],
    /// Frames at which curves have changed since they were looked at.
    changed: Vec<bool>,
    /// Of each joint, its track's channel.
    tracks: Vec<Option<usize>>,
    bound: f64,
    worst: f64,
    pose: WorldPose,
    /// The local pose of the fitted curves at the present frame.
    fitted: Playhead,
}

impl<'w, 'c> Tightening<'w, 'c> {
    fn new(clip: &'c Clip, channels: &'w mut [ChannelFit<'c>], bound: f64) -> Self {
        let joints = clip.skeleton.len();
        let mut tracks = vec![None; joints];
        for (i, track) in clip.tracks.iter().enumerate() {
            tracks[track.joint] = Some(joints + i);
        }
        Self {
            clip,
            channels,
            changed: vec![true; clip.frames],
            tracks,
            bound,
            worst: 0.0,
            pose: WorldPose::default(),
            fitted: Playhead::new(clip),
        }
    }

    /// Looks at the frames that have changed, and names who is to blame for joints that are too far away.
    fn blame(&mut self) -> Vec<Blame> {
        let mut blamed = Vec::new();
        self.worst = 0.0;
        self.fitted.rewind();
        for frame in 0..self.clip.frames {
            if !std::mem::take(&mut self.changed[frame]) {
                continue;
            }
            self.pose.set(self.clip, frame);
            self.fitted.set(self.channels.iter(), frame);
            let off = |j: usize| (self.pose.positions[j] - self.fitted.world()[j]).norm();
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
                let position = self.clip.tracks[track].positions[frame];
                let off = (position - self.fitted.position(track)).norm();
                parts.push((off, channel, off));
            }
            if j != joint {
                let rotation = &self.clip.rotations[frame * joints + j];
                let angle = angle_between(rotation, &self.fitted.rotations()[j]);
                let arm = (self.pose.positions[joint] - self.pose.positions[j]).norm();
                parts.push((angle * arm, j, chord(angle)));
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
                    .for_each(|range| self.changed[range].fill(true)),
                Err(_) => {
                    channel.lattice = channel.lattice.finer();
                    channel.fit().map_err(|coarse| (index, coarse))?;
                    self.changed.fill(true);
                }
            }
        }
        Ok(())
    }
}

/// Distance between the quaternions of two rotations that differ by an angle.
pub(super) fn chord(angle_rad: f64) -> f64 {
    2.0 * (angle_rad / 4.0).sin()
}

/// Values beyond what steps can reach.
pub(super) fn too_coarse(
    clip: &Clip,
    channel: usize,
    TooCoarse { frame, limit }: TooCoarse,
) -> SmoothError {
    let joints = clip.skeleton.len();
    let joint = if channel < joints {
        channel
    } else {
        clip.tracks[channel - joints].joint
    };
    let name = clip.skeleton.joints()[joint].name.clone();
    SmoothError::Value {
        joint,
        name,
        frame,
        most: limit,
    }
}
