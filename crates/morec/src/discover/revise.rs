//! Compares every candidate with the sets again: adds missed instances and adjusts their extents.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::candidates::MovingStretch;
use super::schedule::schedule;
use super::sets::median_of;
use super::shapes::ShapeTable;
use super::split::by_clip;

/// Members of a set in each clip that stand for it: the most central ones.
const EXEMPLARS: usize = 3;
/// SetExemplars, nearest at an even pace, that a candidate is compared with elastically.
const COMPARED: usize = 24;
/// They are no farther at an even pace than this many bounds.
const PREFILTER: f32 = 2.0;
/// The nearest set is nearer than this share of the next set's distance.
const CLEAR: f32 = 0.85;
/// A candidate is as long as the median of its set's exemplars but for this factor.
const LENGTH_FACTOR: f64 = 1.6;
/// Lengths of what is compared at all.
const LENGTHS_COMPARED: f64 = 2.0;

/// Members of sets that stand for them.
pub(super) struct SetExemplars<'a> {
    stretches: &'a [MovingStretch],
    shapes: &'a ShapeTable,
    /// Candidate and its set.
    of: Vec<(usize, usize)>,
}

impl<'a> SetExemplars<'a> {
    pub(super) fn of(
        sets: &[Vec<usize>],
        stretches: &'a [MovingStretch],
        shapes: &'a ShapeTable,
    ) -> Self {
        let mut of = Vec::new();
        for part in by_clip(sets, stretches) {
            let members = match part.members.len() > EXEMPLARS {
                true => shapes.central_first(&part.members),
                false => part.members,
            };
            of.extend(members.into_iter().take(EXEMPLARS).map(|m| (m, part.set)));
        }
        Self {
            stretches,
            shapes,
            of,
        }
    }

    /// The sets by their distance from a candidate, nearest first, up to `bound` times [`PREFILTER`]: the mean of the two nearest exemplars of each. What overlaps the
    /// candidate does not count.
    pub(super) fn nearest_sets(&self, candidate: usize, bound: f32) -> Vec<(f32, usize)> {
        let stretch = &self.stretches[candidate];
        let mut near: Vec<(f32, usize, usize)> = Vec::new();
        let mut reach = PREFILTER * bound;
        for &(exemplar, set) in &self.of {
            let other = &self.stretches[exemplar];
            if !stretch.as_long(other, LENGTHS_COMPARED) || stretch.overlaps(other) {
                continue;
            }
            let Some(even) = self.shapes.linear(candidate, exemplar, reach) else {
                continue;
            };
            let at = near.partition_point(|n| n.0 <= even);
            near.insert(at, (even, exemplar, set));
            if near.len() > COMPARED {
                near.truncate(COMPARED);
            }
            if let [.., last] = near.as_slice()
                && near.len() == COMPARED
            {
                reach = last.0;
            }
        }
        let mut of_sets: BTreeMap<usize, Vec<f32>> = BTreeMap::new();
        for (_, exemplar, set) in near {
            let r = self.shapes.elastic(candidate, exemplar, f32::INFINITY);
            of_sets.entry(set).or_default().extend(r);
        }
        let mean = |(set, of)| (mean_of_nearest(of), set);
        let mut sets: Vec<(f32, usize)> = of_sets.into_iter().map(mean).collect();
        sets.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        sets
    }

    /// Mean distance of a member from the nearest two of its set that stand for it, itself left out.
    pub(super) fn distance(&self, member: usize, set: usize) -> f32 {
        let others = self.of.iter().filter(|(e, of)| *of == set && *e != member);
        let r = |&(e, _): &(usize, usize)| self.shapes.elastic(member, e, f32::INFINITY);
        mean_of_nearest(others.filter_map(r).collect())
    }

    fn median_ticks(&self) -> BTreeMap<usize, f64> {
        let mut ticks: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        for &(exemplar, set) in &self.of {
            ticks
                .entry(set)
                .or_default()
                .push(self.stretches[exemplar].ticks() as f64);
        }
        ticks
            .into_iter()
            .map(|(set, ticks)| (set, median_of(ticks)))
            .collect()
    }
}

fn mean_of_nearest(mut distances: Vec<f32>) -> f32 {
    distances.sort_by(f32::total_cmp);
    distances.truncate(2);
    distances.iter().sum::<f32>() / distances.len().max(1) as f32
}

/// The sets made anew: of the candidates that are clearly nearest to one set, in each clip those that do not overlap and explain most. A set
/// with fewer than two instances is dropped.
pub(super) fn revise(
    sets: &[Vec<usize>],
    stretches: &[MovingStretch],
    shapes: &ShapeTable,
    bound: f32,
) -> Vec<Vec<usize>> {
    let exemplars = SetExemplars::of(sets, stretches, shapes);
    let lengths = exemplars.median_ticks();
    let offer = |candidate: usize| -> Option<(usize, usize, f64)> {
        let near = exemplars.nearest_sets(candidate, bound);
        let &(r, set) = near.first()?;
        let next = near.get(1).map_or(f32::INFINITY, |next| next.0);
        let stretch = &stretches[candidate];
        let ratio = stretch.ticks() as f64 / lengths.get(&set)?;
        let fits = ratio < LENGTH_FACTOR && ratio > 1.0 / LENGTH_FACTOR;
        let share = 1.0 - f64::from(r / bound).powi(2);
        (fits && r < bound && r < CLEAR * next).then_some((
            candidate,
            set,
            stretch.moving_secs * share,
        ))
    };
    let all = (0..stretches.len()).into_par_iter();
    let offers: Vec<(usize, usize, f64)> = all.filter_map(offer).collect();
    let mut revised = vec![Vec::new(); sets.len()];
    for of_clip in offers.chunk_by(|a, b| stretches[a.0].clip == stretches[b.0].clip) {
        let set_of: BTreeMap<usize, usize> = of_clip.iter().map(|o| (o.0, o.1)).collect();
        let worth = of_clip.iter().map(|o| (o.0, o.2)).collect();
        for chosen in schedule(worth, stretches) {
            revised[set_of[&chosen]].push(chosen);
        }
    }
    revised.retain(|set| set.len() > 1);
    revised
}
