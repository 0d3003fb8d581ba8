//! Places of the values in a feature row.

use std::ops::Range;

use crate::{ALL_BONES, BODY_BONES, BONES, BoneSet};

/// Layout of a feature row over `b` bones: a direction for each (3 b values), a velocity for each (3 b), then root motion (4).
///
/// Bones stand in the order of [`ALL_BONES`]; the place of a bone among those of the row is its slot. Directions and velocities
/// are (lateral, up, forward) or (lateral, normal, forward) of a palm, root motion is that of a velocity and the rate of turning.
///
/// ```
/// use morec_features::{BoneSet, RowLayout};
///
/// let layout = RowLayout::of(BoneSet::BODY);
/// assert_eq!(layout.dim(), 70);
/// assert_eq!((layout.velocity(0), layout.root()), (33..36, 66..70));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowLayout {
    bones: usize,
}

impl RowLayout {
    /// Of rows over the bones of the body.
    pub const BODY: RowLayout = RowLayout { bones: BODY_BONES };

    /// Values of root motion.
    pub const ROOT: usize = 4;

    /// Of rows over `bones`.
    pub fn of(bones: BoneSet) -> Self {
        Self { bones: bones.len() }
    }

    /// Of rows of `dim` values; `None` if no set of bones has such rows.
    pub fn from_dim(dim: usize) -> Option<Self> {
        let of_bones = dim.checked_sub(Self::ROOT)?;
        let bones = of_bones / 6;
        (of_bones.is_multiple_of(6) && bones <= BONES).then_some(Self { bones })
    }

    /// Number of bones, `b`.
    #[inline]
    pub const fn bones(self) -> usize {
        self.bones
    }

    /// Values in a row, `6 b + 4`.
    #[inline]
    pub const fn dim(self) -> usize {
        6 * self.bones + Self::ROOT
    }

    /// Columns of all directions.
    #[inline]
    pub const fn directions(self) -> Range<usize> {
        0..3 * self.bones
    }

    /// Columns of all velocities.
    #[inline]
    pub const fn velocities(self) -> Range<usize> {
        3 * self.bones..6 * self.bones
    }

    /// Columns of root motion.
    #[inline]
    pub const fn root(self) -> Range<usize> {
        6 * self.bones..self.dim()
    }

    /// Columns of the direction of the bone in `slot`.
    #[inline]
    pub const fn direction(self, slot: usize) -> Range<usize> {
        3 * slot..3 * slot + 3
    }

    /// Columns of the velocity of the bone in `slot`.
    #[inline]
    pub const fn velocity(self, slot: usize) -> Range<usize> {
        let first = 3 * (self.bones + slot);
        first..first + 3
    }

    /// Columns of a row over `bones` that belong to bones of `kept`, and to the root, in their order: a row over what both
    /// have in common.
    pub fn kept_columns(bones: BoneSet, kept: BoneSet) -> Vec<usize> {
        let layout = Self::of(bones);
        let slots = || {
            let all = bones.indices().enumerate();
            all.filter(|(_, bone)| kept.contains(*bone))
                .map(|(slot, _)| slot)
        };
        let directions = slots().flat_map(|slot| layout.direction(slot));
        let velocities = slots().flat_map(|slot| layout.velocity(slot));
        directions.chain(velocities).chain(layout.root()).collect()
    }

    /// Names of the columns of rows over `bones`, in their order: `left_arm.direction.up`, `root.turning`.
    pub fn column_names(bones: BoneSet) -> Vec<String> {
        let mut names = Vec::with_capacity(Self::of(bones).dim());
        for what in ["direction", "velocity"] {
            for bone in bones.indices() {
                let bone = ALL_BONES[bone].name;
                names.extend(
                    ["lateral", "up", "forward"].map(|axis| format!("{bone}.{what}.{axis}")),
                );
            }
        }
        names.extend(["lateral", "up", "forward", "turning"].map(|axis| format!("root.{axis}")));
        names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_belongs_to_one_part() {
        for count in 0..=BONES {
            let bones = (0..count).fold(BoneSet::NONE, BoneSet::with);
            let layout = RowLayout::of(bones);
            assert_eq!(RowLayout::from_dim(layout.dim()), Some(layout));
            let parts = (0..count)
                .flat_map(|slot| layout.direction(slot))
                .chain((0..count).flat_map(|slot| layout.velocity(slot)))
                .chain(layout.root());
            assert!(parts.eq(0..layout.dim()));
            assert_eq!(layout.directions().end, layout.velocities().start);
            assert_eq!(layout.velocities().end, layout.root().start);
            assert_eq!(RowLayout::column_names(bones).len(), layout.dim());
        }
        for dim in [0, 3, 5, 9, 11, 6 * BONES + 10] {
            assert_eq!(RowLayout::from_dim(dim), None, "{dim}");
        }
    }

    #[test]
    fn kept_columns_have_the_names_of_the_kept_bones() {
        let (all, kept) = (BoneSet::BODY, BoneSet::NONE.with(1).with(4).with(10));
        let names = RowLayout::column_names(all);
        let columns = RowLayout::kept_columns(all, kept);
        let picked: Vec<_> = columns.iter().map(|c| names[*c].clone()).collect();
        assert_eq!(picked, RowLayout::column_names(kept));
        // Bones that a row lacks cannot be kept.
        assert_eq!(
            RowLayout::kept_columns(kept, all).len(),
            RowLayout::of(kept).dim()
        );
    }
}
