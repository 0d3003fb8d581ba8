//! Samples curves frame by frame in constant memory, however long the clip is.

use super::bezier::{ChannelKind, ChannelValue, CurveSegment, rotation};
use crate::clip::{Clip, JointTrack, Skeleton};
use crate::kinematics::WorldPose;
use crate::math::{Quat, Vec3};

/// A channel to be played: its curves in order, and the value that a channel without curves keeps.
pub(super) trait PlayedChannel {
    fn kind(&self) -> ChannelKind;
    fn start(&self) -> ChannelValue;
    fn segments(&self) -> &[CurveSegment];
}

/// The frame of some channels at which they were last asked, rotations joint by joint and then tracks.
pub(super) struct Playhead {
    /// One frame long, to pose the skeleton.
    frame: Clip,
    pose: WorldPose,
    /// Of each channel, the curve that the last frame lay on.
    current: Vec<usize>,
}

impl Playhead {
    /// For channels that have the joints and tracks of `clip`.
    pub fn new(clip: &Clip) -> Self {
        let tracks = clip.tracks.iter().map(|track| track.joint);
        Self::of(clip.skeleton.clone(), tracks)
    }

    fn of(skeleton: Skeleton, tracks: impl Iterator<Item = usize>) -> Self {
        let tracks: Vec<JointTrack> = tracks
            .map(|joint| JointTrack {
                joint,
                positions: vec![Vec3::zeros()],
            })
            .collect();
        Self {
            current: vec![0; skeleton.len() + tracks.len()],
            frame: Clip {
                name: String::new(),
                rotations: vec![Quat::identity(); skeleton.len()],
                skeleton,
                rate_hz: 1.0,
                tracks,
                frames: 1,
                repaired: Vec::new(),
                points: None,
            },
            pose: WorldPose::default(),
        }
    }

    /// Goes back to the first frame; needed before a frame that lies before the last one, and when curves have changed.
    pub fn rewind(&mut self) {
        self.current.fill(0);
    }

    /// Moves on to `frame`. O(channels), and O(log curves) for each channel that comes to another curve.
    pub fn set<'a, C: PlayedChannel + 'a>(
        &mut self,
        channels: impl Iterator<Item = &'a C>,
        frame: usize,
    ) {
        let joints = self.frame.skeleton.len();
        for (c, channel) in channels.enumerate() {
            let value = self.value(c, channel, frame);
            match channel.kind() {
                ChannelKind::Rotation => self.frame.rotations[c] = rotation(&value),
                ChannelKind::Position => self.frame.tracks[c - joints].positions[0] = value.xyz(),
            }
        }
        self.pose.set(&self.frame, 0);
    }

    fn value(&mut self, c: usize, channel: &impl PlayedChannel, frame: usize) -> ChannelValue {
        let (segments, current) = (channel.segments(), &mut self.current[c]);
        let begun = |segment: &CurveSegment| segment.start as usize <= frame;
        if segments.get(*current + 1).is_some_and(begun) {
            *current += segments[*current + 1..].partition_point(begun);
        }
        segments.get(*current).map_or_else(
            || channel.start(),
            |segment| segment.at(channel.kind(), frame as f64),
        )
    }

    /// Rotations in the parents' frames, one for each joint.
    pub fn rotations(&self) -> &[Quat] {
        &self.frame.rotations
    }

    /// The position of track `track` in its parent's frame.
    pub fn position(&self, track: usize) -> Vec3 {
        self.frame.tracks[track].positions[0]
    }

    /// Positions in the world, one for each joint.
    pub fn world(&self) -> &[Vec3] {
        &self.pose.positions
    }
}
