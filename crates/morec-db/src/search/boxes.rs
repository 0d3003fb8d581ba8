//! Bounding boxes of a clip's rows and windows, used to skip clips in a search: most clips are excluded for most examples before any of their windows is
//! looked at.
//!
//! The mean of a window's rows lies between the least and the greatest row in every coordinate, so the distance of the example's
//! mean pose and travel from that box is no more than their distance from the window's. In the energy of a bone, the sum over
//! the rows of the squared distance from their mean, a window has no less than any window within it and no more than any that
//! holds it: it lies between the least of all windows of a power of two of rows that fits into it and the greatest of all of
//! twice as many. The octaves of a bone in a summary add up to its energy over the rows, so that by the triangle
//! inequality they differ from the example's by no less than their lengths do.

use morec::features::{BODY_BONES, RowLayout, Rows};

use super::layout::ROOT_WEIGHT;
use super::summary::{MEAN, Summary};
use super::windows::{TRAVEL, X};

/// Rows in windows of which energies are kept.
const LEVELS: [usize; 5] = [16, 32, 64, 128, 256];
/// Directions are kept in hundredths, travel in thousandths.
const POSE_UNIT: f32 = 0.01;
const TRAVEL_UNIT: f32 = 0.001;
/// Roots of energies are kept as squares of bytes; this is the greatest.
const MOST: f32 = 16.0;
const ROOT_UNIT: f32 = MOST / (255.0 * 255.0);

/// Bytes of a box: least and greatest directions, least and greatest travel, and for each level least and greatest energies.
pub const BOX_BYTES: usize = 2 * X + 4 * TRAVEL + 2 * BODY_BONES * LEVELS.len();

/// The box of a clip's rows in the layout of all bones; `None` of rows that are beyond what it can hold. O(values).
pub fn boxed(rows: &Rows) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(BOX_BYTES);
    let column = |at: usize| (0..rows.len()).map(move |t| rows.row(t)[at]);
    let least = |at: usize| column(at).fold(f32::INFINITY, f32::min);
    let greatest = |at: usize| column(at).fold(f32::NEG_INFINITY, f32::max);
    let byte = |value: f32| (value.abs() <= 127.0).then(|| (value as i8).cast_unsigned());
    for at in RowLayout::BODY.directions() {
        out.push(byte((least(at) / POSE_UNIT).floor())?);
    }
    for at in RowLayout::BODY.directions() {
        out.push(byte((greatest(at) / POSE_UNIT).ceil())?);
    }
    let travel = |value: f32| (f64::from(value) / ROOT_WEIGHT).asinh() as f32 / TRAVEL_UNIT;
    let short = |value: f32| (value.abs() <= 32_000.0).then(|| (value as i16).to_le_bytes());
    for at in RowLayout::BODY.root() {
        out.extend(short(travel(least(at)).floor() - 1.0)?);
    }
    for at in RowLayout::BODY.root() {
        out.extend(short(travel(greatest(at)).ceil() + 1.0)?);
    }
    let sums = running(rows);
    for level in LEVELS {
        let (least, greatest) = energies(&sums, level);
        // Roundings are in favour of the clip.
        let code = |energy: f64| (energy.sqrt() as f32 / ROOT_UNIT).sqrt();
        out.extend(least.iter().map(|e| (code(*e) - 0.01).max(0.0) as u8));
        for energy in greatest {
            let code = (code(energy) + 0.01).ceil();
            out.push((code <= 255.0).then_some(code as u8)?);
        }
    }
    Some(out)
}

/// Sums over rows, and sums of each bone's squares.
type RowSums = ([f64; X], [f64; BODY_BONES]);

/// Running sums over the rows before each.
fn running(rows: &Rows) -> Vec<RowSums> {
    let mut sum = ([0f64; X], [0f64; BODY_BONES]);
    let mut sums = vec![sum];
    for row in rows.iter() {
        for (lane, value) in row[RowLayout::BODY.directions()].iter().enumerate() {
            let value = f64::from(*value);
            sum.0[lane] += value;
            sum.1[lane / 3] += value * value;
        }
        sums.push(sum);
    }
    sums
}

/// Least and greatest energy of each bone over windows of `level` rows, or of all if there are less.
fn energies(sums: &[RowSums], level: usize) -> ([f64; BODY_BONES], [f64; BODY_BONES]) {
    let level = level.min(sums.len() - 1);
    let per_row = 1.0 / level as f64;
    let (mut least, mut greatest) = ([f64::INFINITY; BODY_BONES], [0f64; BODY_BONES]);
    for (before, after) in sums.iter().zip(&sums[level..]) {
        for bone in 0..BODY_BONES {
            let mut energy = after.1[bone] - before.1[bone];
            for lane in 3 * bone..3 * bone + 3 {
                let sum = after.0[lane] - before.0[lane];
                energy -= sum * sum * per_row;
            }
            least[bone] = least[bone].min(energy.max(0.0));
            greatest[bone] = greatest[bone].max(energy);
        }
    }
    (least, greatest)
}

/// Lengths of the octaves of each bone, all of them together, as [`BoxView::octaves`] takes them.
pub fn roots(summary: &Summary) -> [f32; 16] {
    let mut roots = [0f32; 16];
    for bone in 0..BODY_BONES {
        let octaves = summary[..MEAN].chunks(X);
        let squares = octaves.flat_map(|o| &o[RowLayout::BODY.direction(bone)]);
        roots[bone] = squares.map(|v| v * v).sum::<f32>().sqrt();
    }
    roots
}

/// Squared distances of an example from what lies within a box, over shared bones.
pub struct BoxView<'a> {
    bytes: &'a [u8; BOX_BYTES],
}

impl<'a> BoxView<'a> {
    pub fn new(bytes: &'a [u8; BOX_BYTES]) -> Self {
        Self { bytes }
    }

    /// Of the mean pose, in coordinates of which `mask` is 1; what follows these is not looked at.
    #[inline(always)]
    pub fn pose(&self, pose: &[f32], mask: &[f32]) -> f32 {
        let (pose, mask) = (&pose[..X], &mask[..X]);
        let (least, greatest) = self.bytes[..2 * X].split_at(X);
        let mut gaps = [0f32; X.next_multiple_of(16)];
        for lane in 0..X {
            let least = f32::from(least[lane].cast_signed()) * POSE_UNIT;
            let greatest = f32::from(greatest[lane].cast_signed()) * POSE_UNIT;
            gaps[lane] = (least - pose[lane]).max(pose[lane] - greatest).max(0.0) * mask[lane];
        }
        let mut squares = [0f32; 16];
        for i in 0..16 {
            squares[i] =
                gaps[i] * gaps[i] + gaps[16 + i] * gaps[16 + i] + gaps[32 + i] * gaps[32 + i];
        }
        total(&squares)
    }

    /// Squared distance of `travel` from the bounds of root motion.
    #[inline(always)]
    pub fn travel(&self, travel: &[f32; TRAVEL]) -> f32 {
        let (values, _) = self.bytes[2 * X..][..4 * TRAVEL].as_chunks::<2>();
        let mut sum = 0f32;
        for i in 0..TRAVEL {
            let least = f32::from(i16::from_le_bytes(values[i])) * TRAVEL_UNIT;
            let greatest = f32::from(i16::from_le_bytes(values[TRAVEL + i])) * TRAVEL_UNIT;
            let gap = (least - travel[i]).max(travel[i] - greatest).max(0.0);
            sum += gap * gap;
        }
        sum
    }

    /// Of the octaves of all bones of windows of this many rows: `roots` are the lengths of the example's, 0 in `mask` what is not
    /// shared.
    #[inline(always)]
    pub fn octaves(&self, rows: usize, roots: &[f32; 16], mask: &[f32; 16]) -> f32 {
        let per_row = ROOT_UNIT / (rows as f32).sqrt();
        let energies = &self.bytes[2 * X + 4 * TRAVEL..];
        let (mut least, mut greatest) = ([0f32; 16], [f32::INFINITY; 16]);
        for (number, level) in LEVELS.iter().enumerate() {
            let of_level = &energies[2 * BODY_BONES * number..][..2 * BODY_BONES];
            if rows >= *level {
                for bone in 0..BODY_BONES {
                    let code = f32::from(of_level[bone]);
                    least[bone] = code * code * per_row;
                }
            } else {
                for bone in 0..BODY_BONES {
                    let code = f32::from(of_level[BODY_BONES + bone]);
                    greatest[bone] = code * code * per_row;
                }
                break;
            }
        }
        let mut squares = [0f32; 16];
        for bone in 0..16 {
            let gap = (least[bone] - roots[bone])
                .max(roots[bone] - greatest[bone])
                .max(0.0)
                * mask[bone];
            squares[bone] = gap * gap;
        }
        total(&squares)
    }
}

/// The sum, by halves. Their widths are constants: a loop over them is not unrolled into vectors.
#[inline(always)]
pub fn total(sixteen: &[f32; 16]) -> f32 {
    let (mut eight, mut four) = ([0f32; 8], [0f32; 4]);
    for i in 0..8 {
        eight[i] = sixteen[i] + sixteen[8 + i];
    }
    for i in 0..4 {
        four[i] = eight[i] + eight[4 + i];
    }
    (four[0] + four[2]) + (four[1] + four[3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::layout::DIM;
    use crate::search::summary::ROOT;
    use crate::search::windows::Sums;
    use proptest::prelude::*;

    /// Rows that move by little from one to the next, so that boxes are tight.
    fn walked(steps: &[f32]) -> Rows {
        let mut row = [0f32; DIM];
        let mut rows = Rows::new(DIM);
        for step in steps.chunks_exact(DIM) {
            for (value, step) in row.iter_mut().zip(step) {
                *value = (*value + 0.2 * step).clamp(-1.0, 1.0);
            }
            rows.push(&row);
        }
        rows
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn windows_lie_within(
            steps in prop::collection::vec(-1f32..1.0, 1..70 * DIM),
            of_example in prop::collection::vec(-1f32..1.0, 20 * DIM),
        ) {
            let rows = walked(&steps);
            prop_assume!(!rows.is_empty());
            let bytes = boxed(&rows).unwrap();
            let within = BoxView::new(bytes.as_slice().try_into().unwrap());
            let example = Sums::of(&walked(&of_example)).octaves(&(0..20));
            let sums = Sums::of(&rows);
            let pose = &example[MEAN..ROOT];
            let travel: [f32; TRAVEL] = example[ROOT..].try_into().unwrap();
            let roots = roots(&example);
            for start in 0..rows.len() {
                for stop in start + 1..=rows.len() {
                    let window = sums.octaves(&(start..stop));
                    let squares = |from: usize, to: usize| -> f32 {
                        (from..to).map(|i| (window[i] - example[i]).powi(2)).sum()
                    };
                    let lengths = within.octaves(stop - start, &roots, &[1.0; 16]);
                    for (bound, exact) in [
                        (within.pose(pose, &[1.0; X]), squares(MEAN, ROOT)),
                        (within.travel(&travel), squares(ROOT, ROOT + TRAVEL)),
                        (lengths, squares(0, MEAN)),
                    ] {
                        prop_assert!(bound.sqrt() <= exact.sqrt() + 1e-4, "{bound} {exact}");
                    }
                }
            }
        }
    }

    #[test]
    fn rows_beyond_a_box_have_none() {
        for (at, value) in [(0, 1.4), (0, f32::NAN), (DIM - 1, f32::INFINITY)] {
            let mut row = [0f32; DIM];
            row[at] = value;
            assert!(boxed(&Rows::from_values(DIM, row.to_vec())).is_none());
        }
    }
}
