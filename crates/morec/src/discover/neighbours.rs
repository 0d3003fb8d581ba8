//! Candidates that are alike.

use rayon::prelude::*;

use super::DiscoverError;
use super::candidates::Stretch;
use super::shapes::ShapeTable;
use crate::progress::Progress;

/// Pairs whose even distance is farther than this many bounds are not compared elastically.
const PREFILTER: f32 = 2.0;
/// Lengths of neighbours differ by less than this factor.
const LENGTH_FACTOR: f64 = 2.0;
/// Candidates between two looks at progress.
const AT_ONCE: usize = 512;

/// For each candidate those near it, with their distances.
pub(super) struct Neighbours {
    first: Vec<usize>,
    near: Vec<(u32, f32)>,
}

impl Neighbours {
    /// Pairs below `bound` that do not overlap. Exact but for the prefilter; O(stretches²) sums of few values, and elastic distances of what
    /// is left of them.
    pub(super) fn of(
        stretches: &[Stretch],
        shapes: &ShapeTable,
        bound: f32,
        progress: &dyn Progress,
    ) -> Result<Self, DiscoverError> {
        // By length: those that are too long for one end the list.
        let mut order: Vec<usize> = (0..stretches.len()).collect();
        order.sort_by_key(|&i| (stretches[i].ticks(), i));
        let of_one = |at: usize| -> Vec<(u32, u32, f32)> {
            let one = order[at];
            let longer = order[at + 1..].iter().copied();
            let longer =
                longer.take_while(|&b| stretches[b].as_long(&stretches[one], LENGTH_FACTOR));
            longer
                .filter_map(|other| {
                    shapes.linear(one, other, PREFILTER * bound)?;
                    if stretches[one].overlaps(&stretches[other]) {
                        return None;
                    }
                    let r = shapes.elastic(one, other, bound)?;
                    Some((one as u32, other as u32, r))
                })
                .collect()
        };
        let mut pairs = Vec::new();
        for start in (0..order.len()).step_by(AT_ONCE) {
            if progress.cancelled() {
                return Err(DiscoverError::Cancelled);
            }
            progress.report("comparing", start, order.len());
            let stop = (start + AT_ONCE).min(order.len());
            let found: Vec<_> = (start..stop).into_par_iter().map(of_one).collect();
            pairs.extend(found.into_iter().flatten());
        }
        Ok(Self::both_ways(stretches.len(), &pairs))
    }

    fn both_ways(count: usize, pairs: &[(u32, u32, f32)]) -> Self {
        let mut first = vec![0; count + 1];
        for (a, b, _) in pairs {
            first[*a as usize + 1] += 1;
            first[*b as usize + 1] += 1;
        }
        for i in 0..count {
            first[i + 1] += first[i];
        }
        let mut next = first.clone();
        let mut near = vec![(0, 0.0); 2 * pairs.len()];
        let mut put = |of: u32, other: u32, r: f32| {
            near[next[of as usize]] = (other, r);
            next[of as usize] += 1;
        };
        for &(a, b, r) in pairs {
            put(a, b, r);
            put(b, a, r);
        }
        Self { first, near }
    }

    pub(super) fn near(&self, of: usize) -> impl Iterator<Item = (usize, f32)> {
        let near = &self.near[self.first[of]..self.first[of + 1]];
        near.iter().map(|(other, r)| (*other as usize, *r))
    }
}
