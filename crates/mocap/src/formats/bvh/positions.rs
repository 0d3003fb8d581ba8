//! Meaning of position channels: they replace OFFSET, or are added to it.

use std::fmt;

use super::character::{Character, JointPositions};
use crate::clip::{Joint, JointTrack};
use crate::math::Vec3;

/// Meaning of the position channels of joints below the root. Producers differ, and no file says which it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PositionChannels {
    /// They are the joint's position in its parent's frame; OFFSET is not used.
    Replace,
    /// They are added to OFFSET.
    Add,
}

/// Number of joints in favour of each meaning.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Votes {
    pub replace: usize,
    pub add: usize,
}

impl Votes {
    /// Each joint below a root votes by whether the medians of its channels lie nearer to OFFSET or to 0;
    /// joints whose OFFSET is nearly 0 do not vote, as both meanings agree there. O(frames × joints).
    pub fn of(characters: &[Character]) -> Self {
        let mut votes = Self::default();
        for (joint, positions) in characters.iter().flat_map(Character::positions_below_root) {
            if positions.are_missing() {
                continue;
            }
            let driven = Vec3::from(positions.columns.map(|c| f64::from(u8::from(c.is_some()))));
            let median = median(&positions.values).component_mul(&driven);
            match vote(&joint.offset.component_mul(&driven), &median) {
                Some(PositionChannels::Replace) => votes.replace += 1,
                Some(PositionChannels::Add) => votes.add += 1,
                None => {}
            }
        }
        votes
    }

    /// Meaning that most joints favour; replacing, if they are divided.
    pub fn decide(self) -> PositionChannels {
        if self.add > self.replace {
            PositionChannels::Add
        } else {
            PositionChannels::Replace
        }
    }
}

impl fmt::Display for PositionChannels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            PositionChannels::Replace => "in place of OFFSET",
            PositionChannels::Add => "added to OFFSET",
        })
    }
}

/// Vote of a joint whose positions have this `median`; none if its OFFSET is 0.
pub(super) fn vote(offset: &Vec3, median: &Vec3) -> Option<PositionChannels> {
    if offset.amax() <= 1e-6 {
        return None;
    }
    let replaces = (median - offset).norm_squared() < median.norm_squared();
    Some(if replaces {
        PositionChannels::Replace
    } else {
        PositionChannels::Add
    })
}

/// The median of each coordinate; 0 of nothing. O(positions).
pub(super) fn median(positions: &[Vec3]) -> Vec3 {
    Vec3::from_fn(|axis, _| {
        let mut values: Vec<f64> = positions.iter().map(|p| p[axis]).collect();
        if values.is_empty() {
            return 0.0;
        }
        let middle = values.len() / 2;
        *values.select_nth_unstable_by(middle, f64::total_cmp).1
    })
}

impl Character {
    fn positions_below_root(&self) -> impl Iterator<Item = (&Joint, &JointPositions)> {
        self.positions
            .iter()
            .map(|p| (&self.joints[p.joint], p))
            .filter(|(joint, _)| joint.parent.is_some())
    }

    /// The joints' positions over time. A joint below the root that stays at its OFFSET, but for printed digits,
    /// gets none.
    pub fn take_tracks(&mut self, below_root: PositionChannels) -> Vec<JointTrack> {
        let mut tracks = Vec::new();
        for mut positions in std::mem::take(&mut self.positions) {
            let joint = &self.joints[positions.joint];
            if positions.are_missing() && self.frames > 0 {
                continue;
            }
            let is_root = joint.parent.is_none();
            let adds = match is_root {
                true => positions.is_zero_beside(&joint.offset),
                false => below_root == PositionChannels::Add,
            };
            positions.place(&joint.offset, adds);
            if is_root || !positions.stays_at(&joint.offset) {
                tracks.push(JointTrack {
                    joint: positions.joint,
                    positions: positions.values,
                });
            }
        }
        tracks
    }
}

impl JointPositions {
    /// True if a root's channels say nothing, so that its OFFSET is where it stands.
    fn is_zero_beside(&self, offset: &Vec3) -> bool {
        let largest = self.values.iter().map(Vec3::amax).fold(0.0, f64::max);
        largest <= 1e-3 * offset.amax()
    }

    /// Makes the values positions in the parent's frame.
    fn place(&mut self, offset: &Vec3, adds: bool) {
        for axis in 0..3 {
            if adds || self.columns[axis].is_none() {
                self.values.iter_mut().for_each(|p| p[axis] += offset[axis]);
            }
        }
    }

    fn stays_at(&self, offset: &Vec3) -> bool {
        // OFFSETs are often printed with six significant digits, positions with six decimals.
        let tolerance = 1e-6 + 1e-5 * offset.amax();
        self.values.iter().all(|p| (p - offset).amax() <= tolerance)
    }
}
