//! Chooses the samples that represent their class among the templates, if whole motions are judged by the second look.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::templates::second_look::{Comparison, SecondLook};

use super::set::evenly;

/// Samples of a group that are compared with each other at most.
const MOST_COMPARED: usize = 60;

/// Up to `most` samples of each group, in order: the first has the least sum of distances to the others, each further one lowers the sum of
/// distances to the nearest chosen sample most (Kaufman and Rousseeuw, *Finding groups in data*, 1990, BUILD of k-medoids).
///
/// `segments` are the samples' places in `look`, which `comparison` compares with, `groups` what they belong to. Distances are those of the second look.
/// O(samples of a group² · rows · band · d).
pub fn representatives<G: Ord + Sync>(
    (look, comparison): (&SecondLook, &Comparison),
    segments: &[usize],
    groups: &[G],
    most: usize,
) -> Vec<usize> {
    let mut by_group = BTreeMap::<&G, Vec<usize>>::new();
    for (sample, group) in groups.iter().enumerate() {
        by_group.entry(group).or_default().push(sample);
    }
    let choose = |comparison: &mut Comparison, of_group: Vec<usize>| {
        if of_group.len() <= most {
            return of_group;
        }
        let compared: Vec<usize> = evenly(&of_group, MOST_COMPARED).copied().collect();
        let places: Vec<usize> = compared.iter().map(|s| segments[*s]).collect();
        let rows = compared.iter().map(|s| look.segment(segments[*s]));
        let distances: Vec<Vec<f32>> = rows
            .map(|segment| comparison.distances_to(segment, &places))
            .collect();
        let chosen = medoids(&distances, most);
        chosen.into_iter().map(|k| compared[k]).collect()
    };
    let groups: Vec<Vec<usize>> = by_group.into_values().collect();
    let chosen = groups
        .into_par_iter()
        .map_init(|| comparison.clone(), choose);
    let mut chosen: Vec<usize> = chosen.flatten_iter().collect();
    chosen.sort_unstable();
    chosen
}

/// Places of up to `most` rows of `distances` as [`representatives`] chooses them. A distance counts as the larger of both directions.
fn medoids(distances: &[Vec<f32>], most: usize) -> Vec<usize> {
    let count = distances.len();
    let apart = |a: usize, b: usize| distances[a][b].max(distances[b][a]);
    let mut nearest = vec![f32::MAX; count];
    let mut chosen: Vec<usize> = Vec::new();
    while chosen.len() < most.min(count) {
        let sum = |k: usize| -> f64 {
            let each = (0..count).map(|other| f64::from(nearest[other].min(apart(k, other))));
            each.sum()
        };
        let left = (0..count).filter(|k| !chosen.contains(k));
        let Some(best) = left.min_by(|a, b| sum(*a).total_cmp(&sum(*b))) else {
            break;
        };
        for (other, nearest) in nearest.iter_mut().enumerate() {
            *nearest = nearest.min(apart(best, other));
        }
        chosen.push(best);
    }
    chosen
}
