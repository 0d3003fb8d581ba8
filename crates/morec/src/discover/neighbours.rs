//! Finds the neighbours of each candidate: similar stretches in all clips.

use rayon::prelude::*;

use super::candidates::MovingStretch;
use super::error::DiscoverError;
use super::shapes::{HEAD, ShapeTable};
use crate::progress::Progress;
use crate::templates::kernel::{self, LANES};

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
        stretches: &[MovingStretch],
        shapes: &ShapeTable,
        bound: f32,
        progress: &dyn Progress,
    ) -> Result<Self, DiscoverError> {
        // By length: those that are too long for one end the list.
        let mut order: Vec<usize> = (0..stretches.len()).collect();
        order.sort_by_key(|&i| (stretches[i].ticks(), i));
        let heads = order.iter().map(|&i| shapes.head(i)).enumerate();
        let heads = kernel::interleaved(order.len(), HEAD, heads);
        let of_one = |at: usize| -> Vec<(u32, u32, f32)> {
            let one = order[at];
            let as_long = |&b: &usize| stretches[b].as_long(&stretches[one], LENGTH_FACTOR);
            let end = at + 1 + order[at + 1..].partition_point(as_long);
            // The first coordinates of many at once: what is far in them is far.
            let blocks = (at + 1) / LANES..end.div_ceil(LANES);
            let mut apart = vec![[0.0; LANES]; blocks.len()];
            let of_blocks = &heads[blocks.start * HEAD..blocks.end * HEAD];
            kernel::squared_distances(of_blocks, shapes.head(one), &mut apart);
            let mut found = Vec::new();
            for place in at + 1..end {
                let other = order[place];
                let head = apart[place / LANES - blocks.start][place % LANES];
                if head >= PREFILTER * bound * shapes.unit(one, other)
                    || shapes.linear(one, other, PREFILTER * bound).is_none()
                    || stretches[one].overlaps(&stretches[other])
                {
                    continue;
                }
                let r = shapes.elastic(one, other, bound);
                found.extend(r.map(|r| (one as u32, other as u32, r)));
            }
            found
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
