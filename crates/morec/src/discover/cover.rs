//! Chooses sets of neighbouring candidates greedily, each covering as much motion as possible.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BinaryHeap};

use super::candidates::MovingStretch;
use super::neighbours::Neighbours;

/// Sets that explain less are left out.
const LEAST_GAIN_SECS: f64 = 0.3;
const MOST_SETS: usize = 400;
/// A candidate that shares more than this share of the shorter with a member of a set is used up.
const SHARED: f64 = 0.15;

/// What a candidate would explain, as known at a time: by sets found so far.
#[derive(PartialEq)]
struct CoverOffer {
    gain: f64,
    of: usize,
    /// Sets found when it was counted; `None` for a bound that counts overlapping neighbours too.
    known: Option<usize>,
}

impl Eq for CoverOffer {}

impl Ord for CoverOffer {
    /// The greater gain, then the earlier candidate.
    fn cmp(&self, other: &Self) -> Ordering {
        self.gain
            .total_cmp(&other.gain)
            .then(other.of.cmp(&self.of))
    }
}

impl PartialOrd for CoverOffer {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Candidates that are still free, and what each would explain.
struct Cover<'a> {
    stretches: &'a [MovingStretch],
    neighbours: &'a Neighbours,
    theta: f64,
    free: Vec<bool>,
}

/// Sets of candidates: a candidate and its neighbours. Greedy: gains only fall, so the first of the heap that was
/// counted lately is the best (lazy evaluation; Minoux, *Accelerated greedy algorithms for maximizing submodular set functions*, 1978).
pub(super) fn cover(
    stretches: &[MovingStretch],
    neighbours: &Neighbours,
    theta: f64,
) -> Vec<Vec<usize>> {
    let mut cover = Cover {
        stretches,
        neighbours,
        theta,
        free: vec![true; stretches.len()],
    };
    let bound = |of: usize| CoverOffer {
        gain: cover.gains(of).iter().map(|(_, gain)| gain).sum(),
        of,
        known: None,
    };
    let mut heap: BinaryHeap<CoverOffer> = (0..stretches.len()).map(bound).collect();
    let mut sets: Vec<Vec<usize>> = Vec::new();
    while let Some(best) = heap.pop() {
        if best.gain < LEAST_GAIN_SECS || sets.len() == MOST_SETS {
            break;
        }
        if !cover.free[best.of] {
            continue;
        }
        let (gain, members) = cover.members(best.of);
        if best.known == Some(sets.len()) {
            cover.use_up(&members);
            sets.push(members);
        } else if members.len() >= 2 {
            heap.push(CoverOffer {
                gain,
                of: best.of,
                known: Some(sets.len()),
            });
        }
    }
    sets
}

impl Cover<'_> {
    /// The free neighbours of a candidate, with the moving time that each explains.
    fn gains(&self, of: usize) -> Vec<(usize, f64)> {
        let own = self.stretches[of].moving_secs;
        let near = self
            .neighbours
            .near(of)
            .filter(|(other, _)| self.free[*other]);
        let gain = |(other, r): (usize, f32)| {
            let share = 1.0 - (f64::from(r) / self.theta).powi(2);
            (other, self.stretches[other].moving_secs.min(own) * share)
        };
        near.map(gain).filter(|(_, gain)| *gain > 0.0).collect()
    }

    /// The candidate and those neighbours that overlap neither it nor better ones; what they explain.
    fn members(&self, of: usize) -> (f64, Vec<usize>) {
        let mut gains = self.gains(of);
        gains.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let mut by_clip: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        by_clip.entry(self.stretches[of].clip).or_default().push(of);
        let (mut sum, mut members) = (0.0, vec![of]);
        for (other, gain) in gains {
            let stretch = &self.stretches[other];
            let taken = by_clip.entry(stretch.clip).or_default();
            if taken.iter().any(|&t| self.stretches[t].overlaps(stretch)) {
                continue;
            }
            taken.push(other);
            members.push(other);
            sum += gain;
        }
        (sum, members)
    }

    fn use_up(&mut self, members: &[usize]) {
        for &member in members {
            let of = self.stretches[member];
            let of_clip = self.stretches.partition_point(|s| s.clip < of.clip)
                ..self.stretches.partition_point(|s| s.clip <= of.clip);
            for other in of_clip {
                let stretch = &self.stretches[other];
                let start = stretch.start.max(of.start);
                let shared = stretch.stop.min(of.stop).saturating_sub(start) as f64;
                let shorter = stretch.ticks().min(of.ticks()) as f64;
                if shared > (SHARED * shorter).max(2.0) {
                    self.free[other] = false;
                }
            }
            self.free[member] = false;
        }
    }
}
