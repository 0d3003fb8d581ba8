//! Looking for what might be mistaken for a class: the threshold and the hard negatives.

use std::ops::Range;

use crate::decode::FAR;
use crate::features::Rows;
use crate::templates::{Match, MatchGate, Matcher, NormalizedMatch, Stretches};

use super::params::TrainParams;
use super::set::{StreamKind, TrainSample, TrainStream, overlap_share};

/// Every template's match at every tick of one stream: `ticks` × `templates`.
pub struct TemplateDistances {
    templates: usize,
    matches: Vec<Compared>,
    gate: MatchGate,
}

/// A match, in little space: there is one for each template and tick.
#[derive(Debug, Clone, Copy)]
struct Compared {
    distance: f32,
    age: u32,
    rest_share: f32,
    offset_share: f32,
}

impl Compared {
    const NOTHING: Self = Self {
        distance: FAR,
        age: 0,
        rest_share: f32::MAX,
        offset_share: 0.0,
    };

    fn of(found: NormalizedMatch) -> Self {
        Self {
            distance: found.distance,
            age: found.age as u32,
            rest_share: found.rest_share,
            offset_share: found.offset_share,
        }
    }

    fn found(&self) -> NormalizedMatch {
        NormalizedMatch {
            distance: self.distance,
            age: self.age as usize,
            rest_share: self.rest_share,
            spread: 0.0,
            offset_share: self.offset_share,
        }
    }
}

/// Ticks that one part of the templates takes before the next: its rows come from the cache after the first of them.
const TICKS_AT_ONCE: usize = 32;

/// Ticks to step through so that those that are `wanted` have the matches of the whole stream: a path is at most `lead`
/// ticks long.
fn spans(wanted: &[bool], lead: usize) -> Vec<Range<usize>> {
    let mut spans: Vec<Range<usize>> = Vec::new();
    for tick in (0..wanted.len()).filter(|tick| wanted[*tick]) {
        let start = tick.saturating_sub(lead);
        match spans.last_mut() {
            Some(last) if start <= last.end => last.end = tick + 1,
            _ => spans.push(start..tick + 1),
        }
    }
    spans
}

impl TemplateDistances {
    /// Matches at every tick.
    #[cfg(test)]
    pub fn of(parts: &mut [Matcher], rows: &Rows) -> Self {
        Self::at_ticks(parts, rows, &vec![true; rows.len()])
    }

    /// Runs the templates of all `parts`, in their order, over rows that are already in their metric: the matches at the
    /// ticks that are `wanted`; at the others nothing comes near. Parts of templates whose rows fit the processor's cache
    /// take less time than one of all. O(ticks · template rows · d), of the ticks that are wanted and the longest match before
    /// each.
    pub fn at_ticks(parts: &mut [Matcher], rows: &Rows, wanted: &[bool]) -> Self {
        let longest = parts.iter().map(Matcher::longest_match).max().unwrap_or(0);
        let templates = parts.iter().map(|part| part.bank().len()).sum();
        let mut stretches = Stretches::new(rows.dim(), longest);
        let mut matches = vec![Compared::NOTHING; rows.len() * templates];
        let mut matched = vec![Vec::new(); parts.len()];
        let mut pushed = 0;
        // Transitions look two ticks back.
        for span in spans(wanted, longest + 2) {
            parts.iter_mut().for_each(Matcher::reset);
            for first in span.clone().step_by(TICKS_AT_ONCE) {
                let ticks = first..(first + TICKS_AT_ONCE).min(span.end);
                for (part, matched) in parts.iter_mut().zip(&mut matched) {
                    matched.clear();
                    for tick in ticks.clone() {
                        part.step(rows.row(tick));
                        let bank = part.bank();
                        matched.extend((0..bank.len()).map(|template| bank.matched(template)));
                    }
                }
                for tick in ticks {
                    // Sums run over the whole stream, or they would round otherwise.
                    while pushed <= tick {
                        stretches.push(rows.row(pushed));
                        pushed += 1;
                    }
                    if !wanted[tick] {
                        continue;
                    }
                    let mut here = matches[tick * templates..][..templates].iter_mut();
                    for (part, matched) in parts.iter().zip(&matched) {
                        let count = part.bank().len();
                        let found = &matched[(tick - first) * count..][..count];
                        for ((template, found), out) in found.iter().enumerate().zip(&mut here) {
                            *out =
                                Compared::of(part.compare_match(template, *found, &mut stretches));
                        }
                    }
                }
            }
        }
        Self {
            templates,
            matches,
            gate: MatchGate::plain(0.0),
        }
    }

    /// For each tick, whether some match that counts is nearer than `distance`.
    pub fn ticks_within(&self, distance: f64) -> Vec<bool> {
        let is_near = |tick| f64::from(self.nearest(tick, |_| true).distance) < distance;
        (0..self.len()).map(is_near).collect()
    }

    /// Lets matches count that pass `gate` only, discounted as it says.
    pub fn set_gate(&mut self, gate: MatchGate) {
        self.gate = gate;
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
        let found = found.found().discounted(self.gate.discount);
        let counts = found.moves(self.gate.rest_share);
        Match {
            distance: if counts { found.distance } else { FAR },
            age: found.age,
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
    /// Distance from the class.
    pub distance: f32,
    /// Its stream's place in the set.
    pub stream: usize,
    /// Its ticks.
    pub ticks: Range<usize>,
}

/// Local minima of the nearest template's distance outside everything labelled, nearest first and none
/// overlapping another by more than half.
///
/// In labelled streams this is done twice, the second time without the same person's templates, as a new person's
/// stream would be seen.
pub fn hard_negatives(
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decode::DecodeParams;
    use proptest::prelude::*;

    fn rows(len: std::ops::Range<usize>) -> impl Strategy<Value = Rows> {
        len.prop_flat_map(|n| prop::collection::vec((-3.0f32..3.0).prop_map(|v| v * 1.1), 2 * n))
            .prop_map(|v| Rows::from_values(2, v))
    }

    fn bits(distances: &TemplateDistances, tick: usize) -> Vec<(u32, u32, u32)> {
        let here = &distances.matches[tick * distances.templates..][..distances.templates];
        let bits = |m: &Compared| (m.distance.to_bits(), m.age, m.rest_share.to_bits());
        here.iter().map(bits).collect()
    }

    proptest! {
        /// Parts and spans change no bit of what is asked for, against one matcher that takes tick after tick.
        #[test]
        fn parts_and_spans_give_the_matches_of_the_whole(
            templates in prop::collection::vec(rows(1..7), 1..6),
            stream in rows(1..120),
            wanted in prop::collection::vec(prop::bool::weighted(0.05), 120),
            cut in 0usize..6,
        ) {
            let (dim, decode) = (2, DecodeParams::default());
            let mut whole = Matcher::new(&templates, dim, &decode);
            let mut stretches = Stretches::new(dim, whole.longest_match());
            let (before, behind) = templates.split_at(cut.min(templates.len()));
            let mut parts = [before, behind].map(|part| Matcher::new(part, dim, &decode));
            let all = TemplateDistances::of(&mut parts, &stream);
            let some = TemplateDistances::at_ticks(&mut parts, &stream, &wanted[..stream.len()]);
            for (tick, row) in stream.iter().enumerate() {
                whole.step(row);
                stretches.push(row);
                let plain: Vec<_> = (0..templates.len())
                    .map(|template| Compared::of(whole.compare(template, &mut stretches)))
                    .map(|m| (m.distance.to_bits(), m.age, m.rest_share.to_bits()))
                    .collect();
                prop_assert_eq!(&bits(&all, tick), &plain);
                let nothing = |m: &(u32, u32, u32)| f32::from_bits(m.0) >= FAR;
                match wanted[tick] {
                    true => prop_assert_eq!(&bits(&some, tick), &plain),
                    false => prop_assert!(bits(&some, tick).iter().all(nothing)),
                }
            }
        }
    }
}
