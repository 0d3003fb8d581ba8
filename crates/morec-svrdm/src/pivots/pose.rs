//! Input of pose rows from one frame.

use mocap::math::Quat;

/// Most pivots in a set.
pub const MAX_PIVOTS: usize = 32;

/// World orientations of the pivots at one instant, Y up. Pivots have the numbers of their
/// [`PivotSet`](super::PivotSet); [`PivotMap::pose`](super::PivotMap::pose) makes one of a posed skeleton.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PivotPose {
    rotations: [Quat; MAX_PIVOTS],
    present: u32,
}

impl Default for PivotPose {
    fn default() -> Self {
        Self {
            rotations: [Quat::identity(); MAX_PIVOTS],
            present: 0,
        }
    }
}

impl PivotPose {
    /// `world_from_pivot` of pivot `index`, if the source knows.
    #[inline]
    pub fn get(&self, index: usize) -> Option<&Quat> {
        (index < MAX_PIVOTS && self.present >> index & 1 == 1).then(|| &self.rotations[index])
    }

    /// Orients pivot `index`; a rotation that is not finite counts as unknown, an index past the last is ignored.
    #[inline]
    pub fn set(&mut self, index: usize, world_from_pivot: Quat) {
        if index >= MAX_PIVOTS {
            return;
        }
        if world_from_pivot.coords.iter().all(|c| c.is_finite()) {
            self.rotations[index] = world_from_pivot;
            self.present |= 1 << index;
        } else {
            self.present &= !(1 << index);
        }
    }
}
