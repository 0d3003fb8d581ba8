//! Looking for what might be mistaken for a class: the threshold and the hard negatives.

use std::ops::Range;

use crate::decode::FAR;
use crate::features::Rows;
use crate::templates::{Match, Matcher, Stretches};

use super::params::TrainParams;
use super::set::{StreamKind, TrainSample, TrainStream, overlap_share};

/// Every template's match at every tick of one stream: `ticks` × `templates`.
pub struct TemplateDistances {
    templates: usize,
    matches: Vec<Compared>,
    /// Matches count below this share of a motionless body's distance; 0 admits all.
    rest_share: f32,
}

/// A match, in little space: there is one for each template and tick.
#[derive(Debug, Clone, Copy)]
struct Compared {
    distance: f32,
    age: u32,
    rest_share: f32,
}

impl TemplateDistances {
    /// Runs `matcher` over rows that are already in its metric. O(ticks · template rows · d).
    pub fn of(matcher: &mut Matcher, rows: &Rows) -> Self {
        matcher.reset();
        let mut stretches = Stretches::new(rows.dim(), matcher.longest_match());
        let templates = matcher.bank().len();
        let mut matches = Vec::with_capacity(rows.len() * templates);
        for row in rows.iter() {
            matcher.step(row);
            stretches.push(row);
            matches.extend((0..templates).map(|template| {
                let found = matcher.compare(template, &mut stretches);
                Compared {
                    distance: found.distance,
                    age: found.age as u32,
                    rest_share: found.rest_share,
                }
            }));
        }
        Self {
            templates,
            matches,
            rest_share: 0.0,
        }
    }

    /// Lets matches count below this share of a motionless body's distance only.
    pub fn set_rest_share(&mut self, share: f32) {
        self.rest_share = share;
    }

    /// Number of ticks.
    pub fn len(&self) -> usize {
        self.matches.len().checked_div(self.templates).unwrap_or(0)
    }

    /// Matches of all templates at `tick`.
    pub fn at(&self, tick: usize) -> impl Iterator<Item = Match> + '_ {
        let here = &self.matches[tick * self.templates..(tick + 1) * self.templates];
        here.iter().map(|m| self.counted(m))
    }

    fn counted(&self, found: &Compared) -> Match {
        let moves = self.rest_share <= 0.0 || found.rest_share < self.rest_share;
        Match {
            distance: if moves { found.distance } else { FAR },
            age: found.age as usize,
        }
    }

    /// The smallest distance anywhere.
    pub fn smallest(&self) -> f32 {
        let counted = self.matches.iter().map(|m| self.counted(m).distance);
        counted.fold(FAR, f32::min)
    }

    /// The nearest of the templates that `counts` admits, at `tick`.
    pub fn nearest(&self, tick: usize, counts: impl Fn(usize) -> bool) -> Match {
        let admitted = self
            .at(tick)
            .enumerate()
            .filter(|(i, _)| counts(*i))
            .map(|(_, m)| m);
        admitted
            .reduce(|best, m| if m.distance < best.distance { m } else { best })
            .unwrap_or(NO_MATCH)
    }
}

const NO_MATCH: Match = Match {
    distance: FAR,
    age: 0,
};

/// A stretch of a stream that comes near to some template.
#[derive(Debug, Clone, PartialEq)]
pub struct NearMiss {
    /// How near.
    pub distance: f32,
    /// Its stream's place in the set.
    pub stream: usize,
    /// Which ticks.
    pub ticks: Range<usize>,
}

/// Local minima of the nearest template's distance outside everything labelled, nearest first and none
/// overlapping another by more than half.
///
/// In labelled streams this is done twice, the second time without the same person's templates, as a new person's
/// stream would be seen.
pub fn near_misses(
    distances: &TemplateDistances,
    samples: &[TrainSample],
    (index, stream): (usize, &TrainStream),
    threshold: f32,
    params: &TrainParams,
) -> Vec<NearMiss> {
    let labelled = stream.source == StreamKind::Labelled;
    let floor = if labelled {
        params.suspicious_below as f32 * threshold
    } else {
        0.0
    };
    let mut found = Vec::new();
    let all = |_: usize| true;
    let others = |template: usize| samples[template].group != stream.group;
    let views: [&dyn Fn(usize) -> bool; 2] = [&all, &others];
    for counts in &views[..if labelled { 2 } else { 1 }] {
        let nearest: Vec<Match> = (0..distances.len())
            .map(|t| distances.nearest(t, counts))
            .collect();
        for t in 1..nearest.len().saturating_sub(1) {
            let Match { distance, age } = nearest[t];
            let dip = distance <= nearest[t - 1].distance && distance < nearest[t + 1].distance;
            let ticks = t - age.min(t)..t + 1;
            let near = floor <= distance && distance < params.negative_below as f32;
            if near && dip && !stream.overlaps_known(&ticks, 0.3) {
                found.push(NearMiss {
                    distance,
                    stream: index,
                    ticks,
                });
            }
        }
    }
    keep_apart(found)
}

/// The nearest first; none that shares more than half of the shorter with one already kept.
fn keep_apart(mut found: Vec<NearMiss>) -> Vec<NearMiss> {
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let mut kept: Vec<NearMiss> = Vec::new();
    for miss in found {
        if kept
            .iter()
            .all(|k| overlap_share(&k.ticks, &miss.ticks) <= 0.5)
        {
            kept.push(miss);
        }
    }
    kept
}
