//! Matches every template with every stream and keeps the near matches. Only the nearest match of each tick is kept, so that
//! memory grows with the ticks and not with the templates.

use std::ops::Range;

use crate::decode::FAR;
use crate::features::Rows;
use crate::templates::{Match, MatchGate, Matcher, StreamRows, Stretches};

use super::params::TrainParams;
use super::set::{StreamKind, TrainStream, overlap_share};

/// A template's match at a tick of a stream.
pub struct Offer<'a> {
    /// The tick at which the match ends.
    pub tick: usize,
    /// Place of the template among those of all parts.
    pub template: usize,
    /// Ticks since the match began.
    pub age: usize,
    matcher: &'a Matcher,
    index: usize,
    stretches: &'a Stretches,
}

impl Offer<'_> {
    /// Ticks from start to stop, the stop not included.
    pub fn ticks(&self) -> Range<usize> {
        self.tick - self.age.min(self.tick)..self.tick + 1
    }

    /// The match with its normalised distance, if it passes `gate` and is nearer than `distance`. O(1) for most that are not.
    pub fn nearer(&self, distance: f32, gate: MatchGate) -> Option<Match> {
        let found = (self.matcher).nearer(self.index, distance, gate, self.stretches)?;
        Some(Match {
            distance: found.distance,
            age: found.age,
        })
    }
}

/// Nothing comes near.
pub const NO_MATCH: Match = Match {
    distance: FAR,
    age: 0,
};

/// What a match must be like to count in training.
#[derive(Debug, Clone, Copy)]
pub struct TrainGates {
    /// For performers like the teacher.
    pub plain: MatchGate,
    /// For strangers, where so few teach.
    pub wide: Option<MatchGate>,
}

/// The nearest of some templates at every tick of a stream.
#[derive(Debug, Clone, Default)]
pub struct NearestByGate {
    /// Of those that pass the plain gate.
    pub plain: Vec<Match>,
    /// Of those that pass the wide gate; empty without one.
    pub wide: Vec<Match>,
}

impl NearestByGate {
    /// Nothing near at any of `ticks`.
    pub fn none(ticks: usize, gates: TrainGates) -> Self {
        Self {
            plain: vec![NO_MATCH; ticks],
            wide: vec![NO_MATCH; if gates.wide.is_some() { ticks } else { 0 }],
        }
    }

    /// Keeps a match that is the nearest so far.
    pub fn take(&mut self, offer: &Offer<'_>, gates: TrainGates) {
        keep_nearest(&mut self.plain[offer.tick], offer, gates.plain);
        if let Some(wide) = gates.wide {
            keep_nearest(&mut self.wide[offer.tick], offer, wide);
        }
    }
}

/// Lets the match be `best` if it passes `gate` and is nearer.
pub fn keep_nearest(best: &mut Match, offer: &Offer<'_>, gate: MatchGate) {
    if let Some(nearer) = offer.nearer(best.distance, gate) {
        *best = nearer;
    }
}

/// For each tick, whether something is nearer than `distance`.
pub fn ticks_within(nearest: &[Match], distance: f64) -> Vec<bool> {
    let is_near = |found: &Match| f64::from(found.distance) < distance;
    nearest.iter().map(is_near).collect()
}

/// The smallest distance anywhere.
pub fn smallest(nearest: &[Match]) -> f32 {
    nearest.iter().map(|m| m.distance).fold(FAR, f32::min)
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

/// Runs the templates of all `parts`, in their order and in the same units, over `rows`, which are already in their metric, and gives
/// `take` the matches at the ticks that are `wanted`, in order of ticks, then of templates; what is not nearer than `reach` is left
/// out. Parts of templates whose rows fit the processor's cache take less time than one of all. O(ticks · template rows · d), of the
/// ticks that are wanted and the longest match before each.
pub fn for_each_match(
    parts: &mut [Matcher],
    rows: &Rows,
    (wanted, reach): (&[bool], f32),
    mut take: impl FnMut(&Offer<'_>),
) {
    let Some(units) = parts.first().map(|part| part.bank().units()) else {
        return;
    };
    let longest = parts.iter().map(Matcher::longest_match).max().unwrap_or(0);
    let mut stretches = Stretches::new(rows.dim(), longest);
    let mut matched = vec![Vec::new(); parts.len()];
    let mut pushed = 0;
    // Transitions look two ticks back.
    for span in spans(wanted, longest + 2) {
        parts.iter_mut().for_each(Matcher::reset);
        for first in span.clone().step_by(TICKS_AT_ONCE) {
            let ticks = first..(first + TICKS_AT_ONCE).min(span.end);
            let of_ticks = ticks.clone().map(|tick| rows.row(tick));
            let streams = StreamRows::of(of_ticks, rows.dim(), units);
            for (part, matched) in parts.iter_mut().zip(&mut matched) {
                matched.clear();
                for stream in &streams {
                    part.step_by(stream, |found| matched.push(found));
                }
            }
            for tick in ticks {
                // Sums run over the whole stream, or they would round otherwise.
                while pushed <= tick {
                    stretches.push(rows.row(pushed));
                    pushed += 1;
                }
                if wanted[tick] {
                    let place = (tick, tick - first);
                    offer(
                        (&mut *parts, reach),
                        &matched,
                        place,
                        &mut stretches,
                        &mut take,
                    );
                }
            }
        }
    }
}

/// Offers the matches at `tick`, the tick at `place` of those that were `matched`.
fn offer(
    (parts, reach): (&mut [Matcher], f32),
    matched: &[Vec<Match>],
    (tick, place): (usize, usize),
    stretches: &mut Stretches,
    take: &mut impl FnMut(&Offer<'_>),
) {
    let mut before = 0;
    for (matcher, matched) in parts.iter_mut().zip(matched) {
        let count = matcher.bank().len();
        matcher.look_at(&matched[place * count..][..count], reach, stretches);
        let ages = (0..count).filter_map(|index| Some((index, matcher.age_within(index, reach)?)));
        for (index, age) in ages {
            take(&Offer {
                tick,
                template: before + index,
                age,
                matcher,
                index,
                stretches,
            });
        }
        before += count;
    }
}

/// A stretch of a stream that comes near to some template.
#[derive(Debug, Clone, PartialEq)]
pub struct NearMiss {
    /// Distance from the class.
    pub distance: f32,
    /// Its stream's place in the set.
    pub stream: usize,
    /// Ticks from start to stop, the stop not included.
    pub ticks: Range<usize>,
}

/// Local minima of the nearest template's distance outside everything labelled, nearest first and none
/// overlapping another by more than half.
///
/// In labelled streams this is done twice, the second time without the same person's templates, as a new person's
/// stream would be seen.
///
/// `nearest` is the nearest of all templates at every tick, `others` the same without those of the stream's own group.
pub fn hard_negatives(
    [nearest, others]: [&[Match]; 2],
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
    for nearest in &[nearest, others][..if labelled { 2 } else { 1 }] {
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
    use crate::templates::Units;
    use proptest::prelude::*;

    fn rows(len: std::ops::Range<usize>) -> impl Strategy<Value = Rows> {
        len.prop_flat_map(|n| prop::collection::vec((-3.0f32..3.0).prop_map(|v| v * 1.1), 2 * n))
            .prop_map(|v| Rows::from_values(2, v))
    }

    type Bits = (u32, usize);

    fn bits(found: Option<Match>) -> Option<Bits> {
        found.map(|m| (m.distance.to_bits(), m.age))
    }

    proptest! {
        /// Parts and spans change no bit of what is asked for, against one matcher that takes tick after tick.
        #[test]
        fn parts_and_spans_give_the_matches_of_the_whole(
            templates in prop::collection::vec(rows(1..7), 1..6),
            stream in rows(1..120),
            wanted in prop::collection::vec(prop::bool::weighted(0.05), 120),
            cut in 0usize..6,
            (discount, rest_share) in (0.0f32..0.5, 0.5f32..1.5),
            reach in prop_oneof![Just(FAR), 0.0f32..8.0],
        ) {
            let (dim, decode) = (2, DecodeParams::default());
            let gate = MatchGate { discount, rest_share };
            let mut whole = Matcher::new(&templates, dim, &decode);
            let mut stretches = Stretches::new(dim, whole.longest_match());
            let (before, behind) = templates.split_at(cut.min(templates.len()));
            let units = Units::of(&templates);
            let mut parts = [before, behind].map(|part| Matcher::in_units(part, dim, &decode, units));
            let count = templates.len();
            let mut found = vec![None; stream.len() * count];
            for_each_match(&mut parts, &stream, (&wanted[..stream.len()], reach), |offer| {
                found[offer.tick * count + offer.template] = bits(offer.nearer(FAR, gate));
            });
            for (tick, row) in stream.iter().enumerate() {
                whole.step(row);
                stretches.push(row);
                for template in 0..count {
                    let plain = whole.compare(template, &mut stretches);
                    let is_near = wanted[tick] && plain.distance < reach;
                    let plain = plain.discounted(discount);
                    let counts = is_near && plain.moves(rest_share);
                    let plain = Match { distance: plain.distance, age: plain.age };
                    prop_assert_eq!(found[tick * count + template], bits(counts.then_some(plain)));
                }
            }
        }
    }
}
