//! Samples of a channel, to which its curves are fitted.

use std::borrow::Cow;

use super::bezier::{ChannelKind, ChannelValue};
use crate::clip::Clip;
use crate::math::{Quat, Vec3, same_hemisphere};

/// The samples of a channel, read where the clip has them: copies of all channels would take more than the clip.
#[derive(Clone, Copy)]
pub(super) enum ChannelSamples<'a> {
    /// Column `joint` of a table of `joints` columns; signs are continuous.
    Rotations {
        table: &'a [Quat],
        joints: usize,
        joint: usize,
    },
    /// One position for each frame.
    Positions(&'a [Vec3]),
}

impl ChannelSamples<'_> {
    pub fn kind(&self) -> ChannelKind {
        match self {
            Self::Rotations { .. } => ChannelKind::Rotation,
            Self::Positions(_) => ChannelKind::Position,
        }
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        match self {
            Self::Rotations { table, joints, .. } => table.len() / joints,
            Self::Positions(positions) => positions.len(),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub fn at(&self, frame: usize) -> ChannelValue {
        match self {
            Self::Rotations {
                table,
                joints,
                joint,
            } => table[frame * joints + joint].coords,
            Self::Positions(positions) => positions[frame].push(0.0),
        }
    }

    /// The samples of a range of frames.
    pub fn range(&self, frames: impl Iterator<Item = usize>) -> impl Iterator<Item = ChannelValue> {
        frames.map(|frame| self.at(frame))
    }

    /// All samples.
    pub fn iter(&self) -> impl Iterator<Item = ChannelValue> {
        self.range(0..self.len())
    }
}

/// The clip with continuous signs, which nearly all clips have already.
pub(super) fn with_continuous_signs(clip: &Clip) -> Cow<'_, Clip> {
    let joints = clip.skeleton.len();
    let turned = |at: usize| clip.rotations[at - joints].dot(&clip.rotations[at]) < 0.0;
    if !(joints..clip.rotations.len()).any(turned) {
        return Cow::Borrowed(clip);
    }
    let mut clip = clip.clone();
    for at in joints..clip.rotations.len() {
        clip.rotations[at] = same_hemisphere(&clip.rotations[at - joints], clip.rotations[at]);
    }
    Cow::Owned(clip)
}
