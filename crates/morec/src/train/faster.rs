//! Faster copies of samples as templates, for people who perform faster than the training subjects.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::decode::FAR;
use crate::features::{BoneSet, retimed_rows};
use crate::templates::Match;

use super::mining::NO_MATCH;
use super::params::TrainParams;
use super::set::{TrainSample, TrainSet};

/// A match that ends before this share of a sample is of its beginning.
const BEGINNING: f64 = 0.7;

/// A match of a sample starts at most this share of it before the sample.
const START_TOLERANCE: f64 = 0.2;

/// A copy may match the beginning of this share of its class's samples.
const MAY_MATCH_BEGINNINGS: f64 = 0.1;

/// Copies of the samples of median duration, of the classes that several people show. A template matches motion of half to
/// twice its duration, but a fast motion has other velocities; a slow one is matched without help.
pub fn faster_copies(
    set: &TrainSet,
    samples: &[TrainSample],
    bones: BoneSet,
    params: &TrainParams,
) -> Vec<TrainSample> {
    let person = |s: &TrainSample| {
        let named = set.streams[s.stream].person.clone();
        named.unwrap_or_else(|| s.group.clone())
    };
    let copied_of_class = |class: usize| {
        let mut shown: Vec<&TrainSample> = samples
            .iter()
            .filter(|s| s.class.index() == class)
            .collect();
        let people: BTreeSet<String> = shown.iter().map(|s| person(s)).collect();
        if people.len() < params.faster_people {
            return Vec::new();
        }
        shown.sort_by_key(|s| s.rows.len());
        let median = shown.get(shown.len() / 2).map_or(0, |s| s.rows.len());
        shown.sort_by_key(|s| s.rows.len().abs_diff(median));
        shown.truncate(params.faster_copies);
        shown
    };
    let faster = |sample: &TrainSample| TrainSample {
        rows: retimed_rows(
            &sample.rows,
            bones,
            &params.features,
            params.faster_duration,
        ),
        is_faster: true,
        ..sample.clone()
    };
    (0..set.classes.len())
        .flat_map(copied_of_class)
        .map(faster)
        .collect()
}

/// Ticks at which a match of a copy ends in the beginning of `sample`, and one more on both sides.
pub fn beginning(sample: &TrainSample, ticks: usize) -> Range<usize> {
    let ends = ends_in_beginning(sample, ticks);
    ends.start.saturating_sub(1)..(ends.end + 1).min(ticks)
}

fn ends_in_beginning(sample: &TrainSample, ticks: usize) -> Range<usize> {
    let start = sample.ticks.start;
    start..(start + share_of(sample, BEGINNING)).min(ticks)
}

fn share_of(sample: &TrainSample, share: f64) -> usize {
    (sample.ticks.len() as f64 * share) as usize
}

/// Whether a copy that matches the beginnings of `early` of its class's `samples` would report them before their end.
pub fn is_early(early: usize, samples: usize) -> bool {
    early as f64 > MAY_MATCH_BEGINNINGS * samples as f64
}

/// True if a match nearer than `threshold` ends in the beginning of `sample`: `matches` are those of one template at every tick of
/// the sample's stream.
pub fn matches_beginning(matches: &[Match], sample: &TrainSample, threshold: f64) -> bool {
    let at = |tick: Option<usize>| *tick.and_then(|tick| matches.get(tick)).unwrap_or(&NO_MATCH);
    let is_match = |end: usize| {
        let here = at(Some(end)).distance;
        let is_nearest =
            here <= at(end.checked_sub(1)).distance && here < at(Some(end + 1)).distance;
        is_nearest && f64::from(here) < threshold.min(f64::from(FAR))
    };
    let mut ends = ends_in_beginning(sample, matches.len()).filter(|end| is_match(*end));
    let start = sample.ticks.start;
    ends.any(|end| end + 1 + share_of(sample, START_TOLERANCE) >= start + matches[end].age)
}
