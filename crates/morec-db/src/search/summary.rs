//! Summary of a stretch in a few numbers, from prefix sums: variance at each pace, the mean pose, the travel.
//!
//! How much: the variance of every coordinate, split by octaves of a Haar transform over the stretch (Mallat, *A theory
//! for multiresolution signal decomposition*, 1989): between its halves, quarters, eighths, sixteenths, and within these.
//! Raising an arm once and waving with it vary as much, but not at the same pace. Paces are relative to the stretch, so
//! slow and fast performances agree; phases are left out, so it does not matter where in its cycle a motion begins.

use std::ops::Range;

use morec::features::{BODY_BONES, BoneSet, RowLayout, opposite_bone, reflected_direction};

use super::layout::ROOT_WEIGHT;
use super::windows::{Sums, TRAVEL, X};

/// Parts that a stretch is divided into.
const PARTS: usize = 16;
/// Octaves: between halves, quarters, eighths and sixteenths; within sixteenths.
const OCTAVES: usize = 5;
/// First value of the mean pose.
pub const MEAN: usize = OCTAVES * X;
/// First value of the travel.
pub const ROOT: usize = MEAN + X;
/// Values in a summary.
pub const SUMMARY: usize = ROOT + TRAVEL;

/// `[standard deviation by octave and coordinate (5 × 33); mean pose (33); asinh of the mean root motion (4)]`.
pub type Summary = [f32; SUMMARY];

/// Weight of each part's distance: about one over its median among windows of everyday motion, except that the mean
/// pose, which tells people and styles apart better than motions, counts a sixth of that.
pub const WEIGHTS: Weights = Weights {
    motion: 0.9,
    pose: 0.1,
    travel: 1.6,
};

/// Weights of the parts of a summary in a distance.
pub struct Weights {
    pub motion: f32,
    pub pose: f32,
    pub travel: f32,
}

impl Sums {
    /// The summary of the rows of `span`. O(columns), however long it is; zeros for none.
    pub fn octaves(&self, span: &Range<usize>) -> Summary {
        let mut out = [0f32; SUMMARY];
        if span.is_empty() {
            return out;
        }
        let n = span.len() as f64;
        let mut parts = self.parts(span);
        let (means, variances, root) = self.moments(span);
        let mut within = [0f32; X];
        for (within, variance) in within.iter_mut().zip(&variances) {
            *within = *variance as f32;
        }
        // From sixteenths up: what two neighbours differ by belongs to their octave, their mean goes on to the next.
        let mut count = PARTS;
        for octave in (0..OCTAVES - 1).rev() {
            count /= 2;
            let mut energy = [0f32; X];
            for k in 0..count {
                for i in 0..X {
                    let (a, b) = (parts[2 * k][i], parts[2 * k + 1][i]);
                    energy[i] += (0.5 * (a - b)).powi(2);
                    parts[k][i] = 0.5 * (a + b);
                }
            }
            for i in 0..X {
                let energy = energy[i] / count as f32;
                within[i] -= energy;
                out[octave * X + i] = energy.sqrt();
            }
        }
        for i in 0..X {
            out[(OCTAVES - 1) * X + i] = within[i].max(0.0).sqrt();
            out[MEAN + i] = means[i] as f32;
        }
        for (i, sum) in root.iter().enumerate() {
            // Rows hold root motion weighted; leg lengths a second and radians a second are meant. Twice as fast is as
            // much for a slow walk as for a run.
            out[ROOT + i] = (sum / n / ROOT_WEIGHT).asinh() as f32;
        }
        out
    }

    /// Means of the coordinates over sixteenths of `span`, whose ends lie between rows as they fall.
    fn parts(&self, span: &Range<usize>) -> [[f32; X]; PARTS] {
        let mut parts = [[0f32; X]; PARTS];
        let length = span.len() as f64 / PARTS as f64;
        let mut before = [0f64; X];
        self.until(span.start as f64, &mut before);
        let mut after = [0f64; X];
        for (k, part) in parts.iter_mut().enumerate() {
            self.until(span.start as f64 + length * (k + 1) as f64, &mut after);
            for i in 0..X {
                part[i] = ((after[i] - before[i]) / length) as f32;
            }
            before = after;
        }
        parts
    }
}

/// `[standard deviation by coordinate (33); mean pose (33); asinh of the mean root motion (4)]`: a summary without paces.
pub type MomentVector = [f32; 2 * X + TRAVEL];

/// Those that a summary holds: its octaves add up to the variance.
pub fn moments_in(summary: &Summary) -> MomentVector {
    let mut out = [0f32; 2 * X + TRAVEL];
    for i in 0..X {
        out[i] = (0..OCTAVES)
            .map(|octave| summary[octave * X + i].powi(2))
            .sum::<f32>()
            .sqrt();
    }
    out[X..].copy_from_slice(&summary[MEAN..]);
    out
}

impl Sums {
    /// The moments of the rows of `span`, which is not empty.
    pub fn moments_of(&self, span: &Range<usize>) -> MomentVector {
        let (means, variances, root) = self.moments(span);
        let mut out = [0f32; 2 * X + TRAVEL];
        for i in 0..X {
            out[i] = variances[i].sqrt() as f32;
            out[X + i] = means[i] as f32;
        }
        for (out, sum) in out[2 * X..].iter_mut().zip(root) {
            *out = (sum / span.len() as f64 / ROOT_WEIGHT).asinh() as f32;
        }
        out
    }
}

/// Distances of summaries over the bones that two clips share, as if they shared all. A sum of lengths, not of squares:
/// what differs in one respect (style in the pose, say) does not drown agreement in the others.
pub struct SummaryDistance {
    shared: BoneSet,
    /// All bones over shared ones.
    scale: f32,
}

impl SummaryDistance {
    /// Over these bones.
    pub fn over(shared: BoneSet) -> Self {
        Self {
            shared,
            scale: BODY_BONES as f32 / shared.len().max(1) as f32,
        }
    }

    /// All bones over those that are compared.
    pub fn scale(&self) -> f32 {
        self.scale
    }

    /// 0 for the same, around 3 for unlike motion.
    pub fn distance(&self, a: &Summary, b: &Summary) -> f32 {
        let (motion, pose) = if self.shared == BoneSet::BODY {
            (
                squared(&a[..MEAN], &b[..MEAN]),
                squared(&a[MEAN..ROOT], &b[MEAN..ROOT]),
            )
        } else {
            self.masked(a, b)
        };
        let travel = squared(&a[ROOT..], &b[ROOT..]);
        WEIGHTS.motion * (self.scale * motion).sqrt()
            + WEIGHTS.pose * (self.scale * pose).sqrt()
            + WEIGHTS.travel * travel.sqrt()
    }

    /// A lower bound of [`distance`](Self::distance), by the triangle inequality in every coordinate's octaves.
    pub fn by_moments(&self, a: &MomentVector, b: &MomentVector) -> f32 {
        let over = |block: usize| -> f32 {
            self.shared
                .indices()
                .map(|bone| squared(&a[at(block, bone)], &b[at(block, bone)]))
                .sum()
        };
        WEIGHTS.motion * (self.scale * over(0)).sqrt()
            + WEIGHTS.pose * (self.scale * over(1)).sqrt()
            + WEIGHTS.travel * squared(&a[2 * X..], &b[2 * X..]).sqrt()
    }

    fn masked(&self, a: &Summary, b: &Summary) -> (f32, f32) {
        let of = |block: usize| -> f32 {
            let bone = |bone: usize| squared(&a[at(block, bone)], &b[at(block, bone)]);
            self.shared.indices().map(bone).sum()
        };
        ((0..OCTAVES).map(of).sum(), of(OCTAVES))
    }
}

/// Values of one bone in a block of `X`: an octave, or after these the mean pose.
fn at(block: usize, bone: usize) -> Range<usize> {
    let place = RowLayout::BODY.direction(bone);
    block * X + place.start..block * X + place.end
}

/// Squared Euclidean distance, in eight sums side by side.
fn squared(a: &[f32], b: &[f32]) -> f32 {
    let (a8, a_rest) = a.as_chunks::<8>();
    let (b8, b_rest) = b.as_chunks::<8>();
    let mut sums = [0f32; 8];
    for (a, b) in a8.iter().zip(b8) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += (a - b) * (a - b);
        }
    }
    let rest: f32 = a_rest
        .iter()
        .zip(b_rest)
        .map(|(a, b)| (a - b) * (a - b))
        .sum();
    sums.iter().sum::<f32>() + rest
}

/// The summary that the stretch's mirror image has: sides swapped, lateral parts of pose and travel the other way.
pub fn mirrored_summary(of: &Summary) -> Summary {
    let mut out = *of;
    for bone in 0..BODY_BONES {
        let opposite = opposite_bone(bone);
        for octave in 0..OCTAVES {
            out[at(octave, bone)].copy_from_slice(&of[at(octave, opposite)]);
        }
        let pose = reflected_direction(bone, &of[at(OCTAVES, opposite)]);
        out[at(OCTAVES, bone)].copy_from_slice(&pose);
    }
    out[ROOT] = -of[ROOT];
    out[ROOT + 3] = -of[ROOT + 3];
    out
}

/// The bone that value `i` of a summary belongs to; `None` for the root's.
pub fn bone_of(i: usize) -> Option<usize> {
    (i < ROOT).then_some(i % X / 3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::layout::{DIM, mirrored, to_canonical};
    use morec::features::Rows;
    use proptest::prelude::*;

    /// The obvious slow version: row by row, with every row cut up for the sixteenths it lies in.
    fn slowly(rows: &Rows, span: Range<usize>) -> Vec<f64> {
        let n = span.len();
        let value = |t: usize, i: usize| f64::from(rows.row(span.start + t)[i]);
        let mut out = vec![0.0; SUMMARY];
        for i in 0..X {
            // Sixteen rows of each row: then every sixteenth of the stretch is `n` whole ones.
            let fine: Vec<f64> = (0..PARTS * n).map(|t| value(t / PARTS, i)).collect();
            let mean = fine.iter().sum::<f64>() / fine.len() as f64;
            let mut left = fine.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / fine.len() as f64;
            // Variance of the means over 2, 4, 8, 16 parts: what each adds is its octave.
            let mut coarser = 0.0;
            for octave in 0..OCTAVES - 1 {
                let length = fine.len() >> (octave + 1);
                let means: Vec<f64> = fine
                    .chunks(length)
                    .map(|c| c.iter().sum::<f64>() / length as f64)
                    .collect();
                let variance =
                    means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / means.len() as f64;
                out[octave * X + i] = (variance - coarser).max(0.0).sqrt();
                left -= variance - coarser;
                coarser = variance;
            }
            out[(OCTAVES - 1) * X + i] = left.max(0.0).sqrt();
            out[MEAN + i] = mean;
        }
        for i in 0..4 {
            let mean = (0..n).map(|t| value(t, DIM - 4 + i)).sum::<f64>() / n as f64;
            out[ROOT + i] = (mean / ROOT_WEIGHT).asinh();
        }
        out
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn octaves_are_those_of_all_rows(
            values in prop::collection::vec(-1f32..1.0, 40 * DIM),
            start in 0usize..10,
            length in 1usize..30,
        ) {
            let rows = Rows::from_values(DIM, values);
            let fast = Sums::of(&rows).octaves(&(start..start + length));
            for (fast, slow) in fast.iter().zip(slowly(&rows, start..start + length)) {
                // Roots of differences: an error of 1e-7 in a variance of nothing is one of 1e-3 here.
                prop_assert!((f64::from(*fast) - slow).abs() < 2e-3, "{} {}", fast, slow);
            }
        }

        #[test]
        fn the_mirror_image_is_summed_up_in_the_mirror(values in prop::collection::vec(-1f32..1.0, 20 * DIM)) {
            let laid = to_canonical(&Rows::from_values(DIM, values), BoneSet::BODY);
            let of = Sums::of(&laid.rows).octaves(&(2..19));
            let image = Sums::of(&mirrored(&laid).rows).octaves(&(2..19));
            for (a, b) in mirrored_summary(&of).iter().zip(&image) {
                prop_assert!((a - b).abs() < 2e-3);
            }
        }

        #[test]
        fn moments_bound_the_distance_from_below(values in prop::collection::vec(-1f32..1.0, 40 * DIM)) {
            let sums = Sums::of(&Rows::from_values(DIM, values));
            let (a, b) = (3..20, 11..39);
            for (held, direct) in moments_in(&sums.octaves(&a)).iter().zip(sums.moments_of(&a)) {
                prop_assert!((held - direct).abs() < 2e-3);
            }
            for bones in [BoneSet::BODY, BoneSet::NONE.with(2).with(5)] {
                let over = SummaryDistance::over(bones);
                let bound = over.by_moments(&sums.moments_of(&a), &sums.moments_of(&b));
                prop_assert!(bound <= over.distance(&sums.octaves(&a), &sums.octaves(&b)) + 5e-3);
            }
        }

        #[test]
        fn distance_over_bones_leaves_the_others_out(
            a in prop::collection::vec(-1f32..1.0, SUMMARY),
            b in prop::collection::vec(-1f32..1.0, SUMMARY),
        ) {
            let (a, b): (Summary, Summary) = (a.try_into().unwrap(), b.try_into().unwrap());
            let few = BoneSet::NONE.with(1).with(7);
            let over = SummaryDistance::over(few);
            let mut changed = b;
            for (i, value) in changed.iter_mut().enumerate() {
                if bone_of(i).is_some_and(|bone| !few.contains(bone)) {
                    *value += 1.0;
                }
            }
            prop_assert_eq!(over.distance(&a, &b), over.distance(&a, &changed));
            let all = SummaryDistance::over(BoneSet::BODY);
            prop_assert!(all.distance(&a, &b) < all.distance(&a, &changed) + all.distance(&b, &changed) + 1e-4);
            let masked = SummaryDistance { shared: BoneSet::BODY, scale: 1.0 }.masked(&a, &b);
            prop_assert!((masked.0 - squared(&a[..MEAN], &b[..MEAN])).abs() < 1e-3);
            prop_assert_eq!(all.distance(&a, &a), 0.0);
        }
    }
}
