//! Matches templates with a stream and rejects matches that are not clearly better than a body at rest.

use std::sync::Arc;

use crate::decode::{DecodeParams, FAR};
use crate::features::Rows;

use super::bank::{Match, PartialMatch, TemplateBank};
use super::kernel::{self, SUMS};
use super::spread_norm::{self, NormBound, SpreadNorm};
use super::stretches::Stretches;
#[cfg(feature = "train")]
use super::units::StreamRows;
use super::units::Units;

/// A [`TemplateBank`] that also knows how far from each template a motionless body would be.
///
/// For template rows `T` with mean `m_T` and spread `V_T = mean |T_j − m_T|²`, and a matched stretch of the stream
/// with mean `m_S`, a performer frozen in the stretch's mean pose is at the distance `V_T + |m_T − m_S|²`. A match
/// that is hardly nearer than that says nothing of motion: standing still is near every template of small spread. A stretch
/// with a spread `V_S` of its own moves, if not as the template does: two motions that have nothing to do with each other are at
/// `V_T + V_S + |m_T − m_S|²` on average. Matches are held against `V_T + w V_S + |m_T − m_S|²`, `w` =
/// [`DecodeParams::rest_spread`]; with `w` = 1 the share of it is one minus the concordance coefficient of Lin, *A concordance
/// correlation coefficient to evaluate reproducibility*, 1989, Eq. 1.
///
/// Distances `D` are normalised to `D / ((V_T + V_S) / 2 V_0)^b` with an exponent `b`
/// ([`DecodeParams::spread_exponent`]) from 0 (plain) to 1 (a share of the motion that is not explained) and `V_0` =
/// [`DecodeParams::typical_spread`], which keeps their scale: a small gesture must be met more exactly than a large one. All are
/// multiplied by [`TYPICAL_SPREAD`](crate::decode::TYPICAL_SPREAD)` / V_0`, so that a threshold means the same whatever rows are made of.
///
/// Noise of the stream adds to `D` and `V_S` alike. What the stretches [measured](Stretches::noise) beyond the template's own noise is taken
/// off both, at most a [share](DecodeParams::noise_share) of `D`; up to 0.2 of the usual spread counts as none.
///
/// For performers unlike the teacher, a share `a` of the squared difference of means is taken as their stance and not as part of the motion
/// ([`NormalizedMatch::discounted`]): `D' = D − a |m_T − m_S|²`, held against a body at rest without it, too.
///
/// Means and spreads of stretches come from [`Stretches`].
#[derive(Debug, Clone)]
pub struct Matcher {
    bank: TemplateBank,
    norm: SpreadNorm,
    rest_spread: f32,
    spreads: Arc<[f32]>,
    /// Divisors of beginnings, whose spread is taken to be the template's.
    norms: Arc<[f32]>,
    /// Noise of each template's rows.
    noises: Arc<[f32]>,
    noise_share: f32,
    norm_bounds: Arc<[NormBound]>,
    /// `m_T` of each template, in [blocks](kernel::blocks).
    means: Arc<[Vec<[f32; SUMS]>]>,
    found: Found,
}

/// Matches of all templates at the tick looked at last, side by side.
#[derive(Debug, Clone)]
struct Found {
    /// Not normalised, without what noise adds.
    distances: Vec<f32>,
    ages: Vec<usize>,
    /// Of the matched stretches, without noise.
    spreads: Vec<f32>,
    normalized: Vec<f32>,
}

/// Noise up to this share of the typical spread counts as none: fast motion leaves as much.
const LEAST_NOISE: f32 = 0.2;

/// A template's match, held against a body at rest and normalised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalizedMatch {
    /// Normalised distance; [`FAR`] if nothing matches.
    pub distance: f32,
    /// Ticks since the match began.
    pub age: usize,
    /// Distance as a share of what a body that stands still, or moves otherwise, is at: see [`Matcher`].
    pub rest_share: f32,
    /// Spread of the matched stretch.
    pub spread: f32,
    /// Squared difference of mean poses, as a share of the distance before it was normalised.
    pub offset_share: f32,
}

/// What a match must be like to count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatchGate {
    /// Share of the squared difference of mean poses that is no part of the distance; 0: it is all part of it.
    pub discount: f32,
    /// See [`NormalizedMatch::moves`].
    pub rest_share: f32,
}

impl MatchGate {
    /// Admits plain distances below this share of a body's distance at rest; 0 admits all.
    pub fn plain(rest_share: f32) -> Self {
        Self {
            discount: 0.0,
            rest_share,
        }
    }
}

impl NormalizedMatch {
    /// The match without `discount` of the squared difference of mean poses, which counts at most as the whole distance.
    pub fn discounted(self, discount: f32) -> Self {
        if discount == 0.0 || self.distance >= FAR {
            return self;
        }
        let left = 1.0 - discount * self.offset_share.min(1.0);
        let at_rest = 1.0 / self.rest_share - discount * self.offset_share;
        Self {
            distance: self.distance * left,
            rest_share: left / at_rest.max(f32::MIN_POSITIVE),
            ..self
        }
    }

    /// True if the match is nearer than `share` of that distance; 0 admits all.
    pub fn moves(&self, share: f32) -> bool {
        share <= 0.0 || self.rest_share < share
    }
}

impl Matcher {
    /// Lays out `templates`, all of rows of `dim` values; of `decode` only what concerns spreads counts.
    pub fn new(templates: &[Rows], dim: usize, decode: &DecodeParams) -> Self {
        Self::in_units(templates, dim, decode, Units::of(templates))
    }

    /// The same in units that other templates share: parts of them match as all together.
    pub(crate) fn in_units(
        templates: &[Rows],
        dim: usize,
        decode: &DecodeParams,
        units: Units,
    ) -> Self {
        let norm = SpreadNorm {
            exponent: decode.spread_exponent,
            typical: decode.typical_spread,
        };
        let mut means = Vec::with_capacity(templates.len());
        let mut spreads = Vec::with_capacity(templates.len());
        for template in templates {
            let (mean, spread) = mean_and_spread(template, dim);
            means.push(kernel::blocks(&mean).collect());
            spreads.push(spread);
        }
        Self {
            bank: TemplateBank::in_units(templates, dim, units),
            norm,
            rest_spread: decode.rest_spread,
            norm_bounds: (spreads.iter())
                .map(|spread| NormBound::new(norm, *spread))
                .collect(),
            norms: spreads.iter().map(|spread| norm.at(*spread)).collect(),
            spreads: spreads.into(),
            noises: templates.iter().map(Stretches::noise_of).collect(),
            noise_share: decode.noise_share,
            means: means.into(),
            found: Found {
                distances: vec![FAR; templates.len()],
                ages: vec![0; templates.len()],
                spreads: vec![0.0; templates.len()],
                normalized: vec![FAR; templates.len()],
            },
        }
    }

    /// The templates' dynamic program.
    pub fn bank(&self) -> &TemplateBank {
        &self.bank
    }

    /// Ticks that a match spans at most: a template of n rows matches at most 2 n.
    pub fn longest_match(&self) -> usize {
        2 * self.bank.longest()
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.bank.reset();
    }

    /// Advances by one tick with the stream's row, of `dim` values. O(template rows · d).
    pub fn step(&mut self, row: &[f32]) {
        self.bank.step(row);
    }

    /// Advances by the stream's rows, [`AT_ONCE`](super::dot::AT_ONCE) at most.
    pub(super) fn advance<'r>(&mut self, rows: impl Iterator<Item = &'r [f32]>) {
        self.bank.advance(rows);
    }

    /// Shows the matches at tick `at` of those that it last advanced by.
    pub(super) fn show(&mut self, at: usize) {
        self.bank.show(at);
    }

    /// Advances by the rows of `stream`, in the units of the templates, and gives `take` the matches at each of them.
    #[cfg(feature = "train")]
    pub(crate) fn step_by(&mut self, stream: &StreamRows, mut take: impl FnMut(Match)) {
        self.bank.advance_by(stream);
        for at in 0..stream.count {
            self.bank.show(at);
            (0..self.bank.len()).for_each(|index| take(self.bank.matched(index)));
        }
    }

    /// Match of template `index` to a stretch that ends with the last tick; `stretches` has taken the same rows.
    /// O(d).
    pub fn compare(&self, index: usize, stretches: &mut Stretches) -> NormalizedMatch {
        let (matched, noise) = self.without_noise(index, self.bank.matched(index), stretches);
        let near = self.nearness(index, matched, noise, stretches);
        self.held_against_rest(index, matched.distance, near, stretches)
    }

    /// A match of template `index` without what noise adds to it, and that noise.
    fn without_noise(&self, index: usize, matched: Match, stretches: &Stretches) -> (Match, f32) {
        let least = self.noises[index] + LEAST_NOISE * self.norm.typical;
        let noise = stretches.noise() - least;
        if self.noise_share == 0.0 || noise <= 0.0 || matched.distance >= FAR {
            return (matched, 0.0);
        }
        let distance = matched.distance - noise.min(self.noise_share * matched.distance);
        (
            Match {
                distance,
                ..matched
            },
            noise,
        )
    }

    /// Normalises the matches of all templates at the tick that the bank shows, for [`nearer`](Self::nearer); `stretches` has taken the
    /// same rows. Distances from `reach` on may stay [`FAR`]. O(templates), and O(d) for each age among them.
    pub fn look(&mut self, reach: f32, stretches: &mut Stretches) {
        self.look_with(TemplateBank::matched, reach, stretches);
    }

    /// The same of matches that the bank gave, whatever it has gone on to.
    #[cfg(feature = "train")]
    pub(crate) fn look_at(&mut self, matched: &[Match], reach: f32, stretches: &mut Stretches) {
        self.look_with(|_, index| matched[index], reach, stretches);
    }

    fn look_with(
        &mut self,
        matched: impl Fn(&TemplateBank, usize) -> Match,
        reach: f32,
        stretches: &mut Stretches,
    ) {
        for index in 0..self.bank.len() {
            let matched = matched(&self.bank, index);
            let (matched, noise) = self.without_noise(index, matched, stretches);
            self.found.distances[index] = matched.distance;
            self.found.ages[index] = matched.age;
            self.found.spreads[index] = (stretches.spread(matched.age) - noise).max(0.0);
        }
        let Found {
            distances,
            spreads,
            normalized,
            ..
        } = &mut self.found;
        spread_norm::normalize(
            (self.norm, &self.norm_bounds, reach),
            (&self.spreads, spreads),
            distances,
            normalized,
        );
    }

    /// The match of template `index` that was [looked at](Self::look) if it passes `gate` and is nearer than `distance`. O(1) for most
    /// templates that are not nearer.
    pub fn nearer(
        &self,
        index: usize,
        distance: f32,
        gate: MatchGate,
        stretches: &Stretches,
    ) -> Option<NormalizedMatch> {
        let found = &self.found;
        let near = NormalizedMatch {
            distance: found.normalized[index],
            age: found.ages[index],
            rest_share: f32::MAX,
            spread: found.spreads[index],
            offset_share: 0.0,
        };
        self.admitted(
            index,
            found.distances[index],
            near,
            distance,
            gate,
            stretches,
        )
    }

    /// Ticks since the match of template `index` began that was [looked at](Self::look), if it is nearer than `reach` and not [`FAR`].
    #[cfg(feature = "train")]
    pub(crate) fn age_within(&self, index: usize, reach: f32) -> Option<usize> {
        let found = &self.found;
        let is_near = found.distances[index] < FAR && found.normalized[index] < reach;
        is_near.then_some(found.ages[index])
    }

    /// `near`, whose distance was `plain`, if it passes `gate` and is nearer than `distance`.
    fn admitted(
        &self,
        index: usize,
        plain: f32,
        near: NormalizedMatch,
        distance: f32,
        gate: MatchGate,
        stretches: &Stretches,
    ) -> Option<NormalizedMatch> {
        if near.distance >= FAR || near.distance * (1.0 - gate.discount) >= distance {
            return None;
        }
        let found = self.held_against_rest(index, plain, near, stretches);
        let found = found.discounted(gate.discount);
        (found.distance < distance && found.moves(gate.rest_share)).then_some(found)
    }

    /// A match that is not compared with a body at rest.
    fn nearness(
        &self,
        index: usize,
        Match { distance, age }: Match,
        noise: f32,
        stretches: &mut Stretches,
    ) -> NormalizedMatch {
        let mut found = NormalizedMatch {
            distance: FAR,
            age,
            rest_share: f32::MAX,
            spread: 0.0,
            offset_share: 0.0,
        };
        if distance < FAR {
            found.spread = (stretches.spread(age) - noise).max(0.0);
            found.distance = distance / self.norm.at((self.spreads[index] + found.spread) / 2.0);
        }
        found
    }

    /// `near` with its plain `distance` as a share of that of a body at rest, or in other motion of its spread.
    fn held_against_rest(
        &self,
        index: usize,
        distance: f32,
        near: NormalizedMatch,
        stretches: &Stretches,
    ) -> NormalizedMatch {
        if distance >= FAR {
            return near;
        }
        let offset = stretches.mean_offset(near.age, &self.means[index]);
        let other = self.spreads[index] + offset + self.rest_spread * near.spread;
        NormalizedMatch {
            rest_share: distance / other.max(f32::MIN_POSITIVE),
            offset_share: offset / distance.max(f32::MIN_POSITIVE),
            ..near
        }
    }

    /// Match of the first rows of template `index`, at least `least` of them, as [`TemplateBank::partial`] has it, with the
    /// distance normalised by the template's spread. O(rows).
    pub fn partial(&self, index: usize, least: usize) -> Option<PartialMatch> {
        let found = self.bank.partial(index, least)?;
        Some(PartialMatch {
            distance: found.distance / self.norms[index],
            ..found
        })
    }
}

/// Mean row, and mean squared distance from it.
pub fn mean_and_spread(rows: &Rows, dim: usize) -> (Vec<f32>, f32) {
    let count = rows.len().max(1) as f64;
    let mut mean = vec![0.0f64; dim];
    let mut square = 0.0;
    for row in rows.iter() {
        for (sum, value) in mean.iter_mut().zip(row) {
            *sum += f64::from(*value);
            square += f64::from(*value).powi(2);
        }
    }
    mean.iter_mut().for_each(|sum| *sum /= count);
    let spread = square / count - mean.iter().map(|m| m * m).sum::<f64>();
    (
        mean.into_iter().map(|m| m as f32).collect(),
        spread.max(0.0) as f32,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;
    use proptest::prelude::*;

    fn by_half() -> DecodeParams {
        DecodeParams {
            spread_exponent: 0.5,
            rest_spread: 0.5,
            ..DecodeParams::reference()
        }
    }

    fn rows(len: std::ops::Range<usize>) -> impl Strategy<Value = Rows> {
        len.prop_flat_map(|n| prop::collection::vec(-3.0f32..3.0, 3 * n))
            .prop_map(|v| Rows::from_values(3, v))
    }

    /// The match of a swing with this noise on the stream.
    fn of_noisy_swing(deviation: f64, noise_share: f32) -> NormalizedMatch {
        let mut rng = Rng::new(5);
        let swing = |tick: usize| (tick as f32 * std::f32::consts::TAU / 15.0).sin();
        let template = Rows::from_values(3, (0..30).flat_map(|t| [swing(t); 3]).collect());
        let params = DecodeParams {
            noise_share,
            ..by_half()
        };
        let mut matcher = Matcher::new(&[template], 3, &params);
        let mut stretches = Stretches::new(3, matcher.longest_match());
        stretches.set_noise_gain(70.0);
        for tick in 0..120 {
            let row = [0; 3].map(|_| swing(tick) + (deviation * rng.normal()) as f32);
            matcher.step(&row);
            stretches.push(&row);
        }
        matcher.compare(0, &mut stretches)
    }

    #[test]
    fn noise_of_the_stream_is_taken_off_and_a_clean_stream_is_as_it_was() {
        assert_eq!(of_noisy_swing(0.05, 0.5), of_noisy_swing(0.05, 0.0));
        let [clean, noisy, freed] =
            [(0.0, 0.0), (0.6, 0.0), (0.6, 0.5)].map(|(noise, share)| of_noisy_swing(noise, share));
        assert!(freed.distance < noisy.distance && freed.distance >= 0.4 * noisy.distance);
        assert!(freed.rest_share < noisy.rest_share && freed.rest_share > clean.rest_share);
        assert!(freed.spread < noisy.spread);
    }

    proptest! {
        #[test]
        fn running_sums_agree_with_the_stretch_itself(template in rows(2..9), stream in rows(1..60)) {
            let mut matcher = Matcher::new(std::slice::from_ref(&template), 3, &by_half());
            let mut stretches = Stretches::new(3, matcher.longest_match());
            let (mean_t, spread_t) = mean_and_spread(&template, 3);
            for (t, row) in stream.iter().enumerate() {
                matcher.step(row);
                stretches.push(row);
                let found = matcher.bank().matched(0);
                if found.distance >= FAR {
                    let all = MatchGate::plain(0.0);
                    matcher.look(f32::INFINITY, &mut stretches);
                    prop_assert!(matcher.nearer(0, f32::INFINITY, all, &stretches).is_none());
                    continue;
                }
                let stretch = stream.slice(t - found.age..t + 1);
                let (mean_s, spread_s) = mean_and_spread(&stretch, 3);
                let offset: f32 = mean_t.iter().zip(&mean_s).map(|(a, b)| (a - b) * (a - b)).sum();
                prop_assert!((stretches.spread(found.age) - spread_s).abs() < 1e-3);
                let other = spread_t + 0.5 * spread_s + offset;
                let share = matcher.compare(0, &mut stretches).rest_share;
                prop_assert!((share * other - found.distance).abs() < 1e-2 * (1.0 + share));
                let compared = matcher.compare(0, &mut stretches);
                prop_assert!((compared.offset_share * found.distance - offset).abs() < 1e-3);
                let all = MatchGate::plain(0.0);
                matcher.look(FAR, &mut stretches);
                prop_assert!(matcher.nearer(0, FAR, all, &stretches) == Some(compared));
                prop_assert!(matcher.nearer(0, compared.distance, all, &stretches).is_none());
                let open = MatchGate { discount: 0.5, ..all };
                let nearer = matcher.nearer(0, FAR, open, &stretches).unwrap();
                let left = found.distance - 0.5 * offset.min(found.distance);
                let scale = compared.distance / found.distance.max(f32::MIN_POSITIVE);
                prop_assert!((nearer.distance - left * scale).abs() < 1e-3 * (1.0 + nearer.distance));
                prop_assert!((nearer.rest_share * (other - 0.5 * offset) - left).abs() < 1e-2 * (1.0 + nearer.rest_share));
            }
        }

        #[test]
        fn whoever_is_nearer_is_found_and_nobody_else(
            template in rows(2..9), stream in rows(1..60), within in 0.0f32..12.0, discount in 0.0f32..0.9,
        ) {
            let mut matcher = Matcher::new(std::slice::from_ref(&template), 3, &by_half());
            let mut stretches = Stretches::new(3, matcher.longest_match());
            let gate = MatchGate { discount, rest_share: 0.7 };
            for row in stream.iter() {
                matcher.step(row);
                stretches.push(row);
                let found = matcher.compare(0, &mut stretches).discounted(discount);
                let is_nearer = found.distance < within && found.moves(0.7);
                matcher.look(within / (1.0 - discount), &mut stretches);
                let nearer = matcher.nearer(0, within, gate, &stretches);
                prop_assert_eq!(nearer, is_nearer.then_some(found));
            }
        }

        #[test]
        fn a_body_that_stands_still_never_matches(
            template in rows(4..12),
            pose in prop::collection::vec(-3.0f32..3.0, 3),
        ) {
            let mut matcher = Matcher::new(std::slice::from_ref(&template), 3, &by_half());
            let mut stretches = Stretches::new(3, matcher.longest_match());
            for _ in 0..40 {
                matcher.step(&pose);
                stretches.push(&pose);
                let found = matcher.compare(0, &mut stretches);
                prop_assert!(found.rest_share > 0.99);
                prop_assert!(found.discounted(0.5).rest_share > 0.98);
            }
        }
    }
}
