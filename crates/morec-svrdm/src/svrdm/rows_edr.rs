//! Edit distance between runs of rows, with a graded cost: ours, beside the thesis's on one value a frame.
//!
//! The thesis compares segments by one value a frame, which matches or does not (§3.8). Different motions may look
//! alike along one direction, and where much matches, a whole neighbourhood of segments is equally near. Here whole
//! rows are compared, as edit distance on real sequences was defined for (Chen, Özsu and Oria 2005), and a pair costs
//! `min(1, ‖a − b‖² / ε²)`. Leaving a row out costs 1, as there.

use super::edr::least_ratio;

/// The dynamic program, with its memory: nothing is allocated after construction.
#[derive(Debug, Clone)]
pub struct RowsEdr {
    width: usize,
    per_square: f32,
    /// For each place in the second sequence, the cost of the cheapest path, and its steps; two rows of the table.
    costs: [Vec<f32>; 2],
    steps: [Vec<f32>; 2],
}

impl RowsEdr {
    /// For sequences of at most `longest` rows of `width` values, of which a pair at distance `epsilon` costs as much
    /// as leaving a row out.
    pub fn new(width: usize, epsilon: f32, longest: usize) -> Self {
        let row = || std::array::from_fn(|_| vec![0.0; longest + 1]);
        // Rows that may not differ at all: a difference costs what it can cost.
        let per_square = (1.0 / (epsilon * epsilon)).min(f32::MAX);
        Self {
            width: width.max(1),
            per_square,
            costs: row(),
            steps: row(),
        }
    }

    /// Cost a step of the cheapest path from `r` to `s`, 0 … 1; `None` if it is not below `bound`.
    /// O(rows of r · rows of s · width).
    pub fn normalised(&mut self, r: &[f32], s: &[f32], bound: f64) -> Option<f64> {
        let (m, n) = (r.len() / self.width, s.len() / self.width);
        if least_ratio(m, n) >= bound {
            return None;
        }
        let most = (bound * (m + n) as f64) as f32;
        let [costs, next_costs] = &mut self.costs;
        let [steps, next_steps] = &mut self.steps;
        let (mut costs, mut next_costs) = (&mut costs[..=n], &mut next_costs[..=n]);
        let (mut steps, mut next_steps) = (&mut steps[..=n], &mut next_steps[..=n]);
        (0..=n).for_each(|j| (costs[j], steps[j]) = (j as f32, j as f32));
        for (i, a) in r.chunks_exact(self.width).enumerate() {
            (next_costs[0], next_steps[0]) = ((i + 1) as f32, (i + 1) as f32);
            let mut least = next_costs[0];
            for (j, b) in s.chunks_exact(self.width).enumerate() {
                let square: f32 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
                let mut best = (
                    costs[j] + (square * self.per_square).min(1.0),
                    steps[j] + 1.0,
                );
                for left_out in [
                    (costs[j + 1] + 1.0, steps[j + 1] + 1.0),
                    (next_costs[j] + 1.0, next_steps[j] + 1.0),
                ] {
                    if left_out.0 < best.0 {
                        best = left_out;
                    }
                }
                (next_costs[j + 1], next_steps[j + 1]) = best;
                least = least.min(best.0);
            }
            // A path has at most m + n steps, and what it has cost so far it keeps.
            if least > most {
                return None;
            }
            std::mem::swap(&mut costs, &mut next_costs);
            std::mem::swap(&mut steps, &mut next_steps);
        }
        let ratio = f64::from(costs[n]) / f64::from(steps[n].max(1.0));
        Some(ratio).filter(|ratio| *ratio < bound)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The definition: least cost over all paths, by recursion.
    fn slow(r: &[[f32; 2]], s: &[[f32; 2]], epsilon: f32) -> f64 {
        let (Some(a), Some(b)) = (r.last(), s.last()) else {
            return (r.len() + s.len()) as f64;
        };
        let (before_r, before_s) = (&r[..r.len() - 1], &s[..s.len() - 1]);
        let square = (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
        let pair =
            slow(before_r, before_s, epsilon) + f64::from((square / (epsilon * epsilon)).min(1.0));
        pair.min(slow(before_r, s, epsilon) + 1.0)
            .min(slow(r, before_s, epsilon) + 1.0)
    }

    fn run() -> impl Strategy<Value = Vec<[f32; 2]>> {
        prop::collection::vec([-1.0f32..1.0, -1.0f32..1.0], 1..6)
    }

    proptest! {
        #[test]
        fn the_cost_is_the_least_of_all_paths(r in run(), s in run(), epsilon in 0.1f32..2.0) {
            let ratio = RowsEdr::new(2, epsilon, 8).normalised(r.as_flattened(), s.as_flattened(), 2.0).unwrap();
            let cost = slow(&r, &s, epsilon);
            // Steps of the path are between those of pairs alone and of none.
            let (least, most) = (r.len().max(s.len()) as f64, (r.len() + s.len()) as f64);
            prop_assert!(ratio <= cost / least + 1e-5 && ratio >= cost / most - 1e-5, "{ratio} of {cost}");
        }

        #[test]
        fn a_bound_changes_nothing_below_it(r in run(), s in run(), bound in 0.0f64..1.0) {
            let mut edr = RowsEdr::new(2, 0.7, 8);
            let whole = edr.normalised(r.as_flattened(), s.as_flattened(), 2.0).unwrap();
            let bounded = edr.normalised(r.as_flattened(), s.as_flattened(), bound);
            prop_assert_eq!(bounded, Some(whole).filter(|w| *w < bound));
        }
    }

    #[test]
    fn alike_is_nothing_and_a_difference_grows_to_one() {
        let mut edr = RowsEdr::new(1, 2.0, 8);
        assert_eq!(
            edr.normalised(&[1.0, 2.0, 3.0], &[1.0, 2.0, 3.0], 1.0),
            Some(0.0)
        );
        // A quarter of the way in squares, one of two steps.
        assert_eq!(edr.normalised(&[1.0, 2.0], &[1.0, 3.0], 1.0), Some(0.125));
        assert_eq!(edr.normalised(&[1.0], &[9.0], 2.0), Some(1.0));
        let mut strict = RowsEdr::new(1, 0.0, 8);
        assert_eq!(strict.normalised(&[1.0, 2.0], &[1.0, 2.0], 1.0), Some(0.0));
        assert_eq!(strict.normalised(&[1.0, 2.0], &[1.0, 2.1], 1.0), Some(0.5));
    }
}
