//! Faster copies of samples as templates, for people who perform faster than those who teach.

use std::collections::BTreeSet;

use crate::decode::FAR;
use crate::features::{BoneSet, retimed_rows};

use super::mining::TemplateDistances;
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

/// Those of `copies` that match no beginnings of samples of their class, which they would report before their end. They are
/// the templates of `distances`, which has those of the samples' streams at least.
pub fn without_early(
    copies: Vec<TrainSample>,
    samples: &[TrainSample],
    distances: &[TemplateDistances],
    threshold: f64,
) -> Vec<TrainSample> {
    let is_early = |place: usize, copy: &TrainSample| {
        let of_class = samples.iter().filter(|s| s.class == copy.class);
        let early = of_class
            .clone()
            .filter(|s| matches_beginning(&distances[s.stream], place, s, threshold));
        early.count() as f64 > MAY_MATCH_BEGINNINGS * of_class.count() as f64
    };
    copies
        .into_iter()
        .enumerate()
        .filter(|(place, copy)| !is_early(*place, copy))
        .map(|(_, copy)| copy)
        .collect()
}

/// True if the template at `place` has a match nearer than `threshold` that ends in the beginning of `sample`.
fn matches_beginning(
    distances: &TemplateDistances,
    place: usize,
    sample: &TrainSample,
    threshold: f64,
) -> bool {
    let ticks = &sample.ticks;
    let share = |share: f64| (ticks.len() as f64 * share) as usize;
    let ends = ticks.start..(ticks.start + share(BEGINNING)).min(distances.len());
    let distance = |tick: Option<usize>| {
        let tick = tick.filter(|tick| *tick < distances.len());
        let found = tick.and_then(|tick| distances.at(tick).nth(place));
        found.map_or(FAR, |found| found.distance)
    };
    let is_match = |end: usize| {
        let here = distance(Some(end));
        let is_nearest = here <= distance(end.checked_sub(1)) && here < distance(Some(end + 1));
        is_nearest && f64::from(here) < threshold
    };
    ends.filter(|end| is_match(*end)).any(|end| {
        let age = distances.at(end).nth(place).map_or(0, |found| found.age);
        end + 1 + share(START_TOLERANCE) >= ticks.start + age
    })
}
