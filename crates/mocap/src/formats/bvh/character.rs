//! The columns of one character in the motion table, converted to rotations and positions row by row.

use super::gaps::{self, Gaps};
use super::half_angles::HalfAngles;
use super::hierarchy::{BvhHierarchy, Channel};
use crate::clip::{Joint, Span};
use crate::formats::ParseError;
use crate::formats::loaded::room;
use crate::math::{Axis, Quat, Vec3, same_hemisphere};

/// Motion of a character, read so far. Only the row at hand is ever held as numbers.
#[derive(Debug)]
pub(super) struct Character {
    /// Its joints, parents counted from its root.
    pub joints: Vec<Joint>,
    turns: Vec<Vec<(usize, Axis)>>,
    half_angles: HalfAngles,
    /// Rotations of all frames, as in [`Clip::rotations`](crate::clip::Clip::rotations).
    pub rotations: Vec<Quat>,
    rotation_gaps: Vec<Gaps>,
    /// Values of the position channels, for each joint that has any.
    pub positions: Vec<JointPositions>,
    /// Number of frames.
    pub frames: usize,
}

/// The position channels of one joint.
#[derive(Debug)]
pub(super) struct JointPositions {
    /// Number of the joint in the character.
    pub joint: usize,
    /// For each axis its column, if the joint has one.
    pub columns: [Option<usize>; 3],
    /// Values, frame by frame; 0 on axes without a channel.
    pub values: Vec<Vec3>,
    gaps: Gaps,
}

impl Character {
    /// The `k`th root of `hierarchy`.
    pub fn new(hierarchy: &BvhHierarchy, k: usize) -> Self {
        let range = hierarchy.character(k);
        let mut character = Self {
            joints: hierarchy.joints[range.clone()].to_vec(),
            turns: Vec::with_capacity(range.len()),
            half_angles: HalfAngles::default(),
            rotations: Vec::new(),
            rotation_gaps: vec![Gaps::default(); range.len()],
            positions: Vec::new(),
            frames: 0,
        };
        for (j, global) in range.clone().enumerate() {
            let parent = &mut character.joints[j].parent;
            *parent = parent.map(|p| p - range.start);
            let columns = hierarchy.columns[global].clone();
            character.add_columns(j, columns.map(|c| (c, hierarchy.channels[c])));
        }
        character
    }

    fn add_columns(&mut self, joint: usize, columns: impl Iterator<Item = (usize, Channel)>) {
        let (mut turns, mut places) = (Vec::new(), [None; 3]);
        for (column, channel) in columns {
            match channel {
                Channel::Rotation(axis) => turns.push((column, axis)),
                Channel::Position(axis) => places[axis.index()] = Some(column),
            }
        }
        self.turns.push(turns);
        if places.iter().any(Option::is_some) {
            let positions = JointPositions {
                joint,
                columns: places,
                values: Vec::new(),
                gaps: Gaps::default(),
            };
            self.positions.push(positions);
        }
    }

    /// Makes room for this many frames.
    ///
    /// # Errors
    /// The system has no memory for them.
    pub fn reserve(&mut self, frames: usize) -> Result<(), ParseError> {
        self.rotations = room(frames * self.turns.len())?;
        for positions in &mut self.positions {
            positions.values = room(frames)?;
        }
        Ok(())
    }

    /// Adds one frame from a whole row of the motion table. O(joints).
    pub fn push(&mut self, row: &[f64]) {
        let joints = self.turns.len();
        self.half_angles.set(row);
        for j in 0..joints {
            let previous = match self.rotations.len().checked_sub(joints) {
                Some(before) => self.rotations[before],
                None => Quat::identity(),
            };
            let mut rotation = rotation(&self.turns[j], &self.half_angles);
            if rotation.w.is_nan() {
                self.rotation_gaps[j].add(self.frames);
                rotation = previous;
            }
            self.rotations.push(same_hemisphere(&previous, rotation));
        }
        for track in &mut self.positions {
            let mut value = Vec3::from(track.columns.map(|c| c.map_or(0.0, |c| row[c])));
            if !value.iter().all(|v| v.is_finite()) {
                track.gaps.add(self.frames);
                value = track.values.last().copied().unwrap_or_else(Vec3::zeros);
            }
            track.values.push(value);
        }
        self.frames += 1;
    }

    /// Forgets every frame.
    pub fn clear(&mut self) {
        self.rotations.clear();
        self.rotation_gaps.iter_mut().for_each(Gaps::clear);
        for track in &mut self.positions {
            track.values.clear();
            track.gaps.clear();
        }
        self.frames = 0;
    }

    /// Makes room for whole frames that the file spoilt, at the increasing frame numbers `lost` (of the clip with
    /// them), and fills all gaps. Returns the frames that were filled.
    pub fn repair(&mut self, lost: &[usize]) -> Vec<Span> {
        let joints = self.turns.len();
        gaps::spread(&mut self.rotations, joints, lost);
        self.frames += lost.len();
        let mut repaired = Gaps::default();
        for (j, gaps) in self.rotation_gaps.iter_mut().enumerate() {
            gaps.shift(lost);
            for span in gaps.spans() {
                gaps::fill_rotations(&mut self.rotations[j..], joints, self.frames, span);
            }
            repaired.merge(gaps);
        }
        for track in &mut self.positions {
            gaps::spread(&mut track.values, 1, lost);
            track.gaps.shift(lost);
            for span in track.gaps.spans() {
                gaps::fill_positions(&mut track.values, span);
            }
            repaired.merge(&track.gaps);
        }
        repaired.merge(&Gaps::from_frames(lost));
        repaired.spans()
    }
}

impl JointPositions {
    /// True if no frame holds a position.
    pub fn are_missing(&self) -> bool {
        self.gaps.len() == self.values.len()
    }
}

/// The intrinsic product in listed order, R = R1·R2·R3; NaN if an angle is.
fn rotation(turns: &[(usize, Axis)], halves: &HalfAngles) -> Quat {
    let mut product = nalgebra::Quaternion::identity();
    for &(column, axis) in turns {
        let (sin, cos) = (halves.sines[column], halves.cosines[column]);
        let [w, x, y, z] = [product.w, product.i, product.j, product.k];
        // The product with (cos, sin·axis), written out: three quarters of a general one would be zeros.
        let [w, x, y, z] = match axis {
            Axis::X => [
                w * cos - x * sin,
                x * cos + w * sin,
                y * cos + z * sin,
                z * cos - y * sin,
            ],
            Axis::Y => [
                w * cos - y * sin,
                x * cos - z * sin,
                y * cos + w * sin,
                z * cos + x * sin,
            ],
            Axis::Z => [
                w * cos - z * sin,
                x * cos + y * sin,
                y * cos - x * sin,
                z * cos + w * sin,
            ],
        };
        product = nalgebra::Quaternion::new(w, x, y, z);
    }
    Quat::new_unchecked(product)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn any_sequence_is_the_product_in_listed_order(turns in proptest::collection::vec((0usize..3, -720.0f64..720.0), 0..5)) {
            let listed: Vec<_> = turns.iter().enumerate().map(|(c, t)| (c, Axis::ALL[t.0])).collect();
            let row: Vec<_> = turns.iter().map(|t| t.1).collect();
            let product = turns.iter().fold(Quat::identity(), |q, t| q * Axis::ALL[t.0].rotation(t.1.to_radians()));
            let mut halves = HalfAngles::default();
            halves.set(&row);
            prop_assert!((rotation(&listed, &halves).coords - product.coords).norm() < 1e-12);
        }
    }
}
