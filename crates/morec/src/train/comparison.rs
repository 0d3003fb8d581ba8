//! Compares streams with templates in parallel. Most of the time of a training is spent here.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::decode::FAR;
use crate::features::{BoneSet, Rows};
use crate::progress::Progress;
use crate::templates::{Match, MatchGate, Matcher, Metric, Units};

use super::error::TrainError;
use super::examples::LeaveOneOutView;
use super::faster::{beginning, faster_copies, is_early, matches_beginning};
use super::mining::{
    NO_MATCH, NearMiss, NearestByGate, Offer, TrainGates, for_each_match, keep_nearest,
    ticks_within,
};
use super::params::TrainParams;
use super::set::{StreamKind, TrainSample, TrainSet, TrainStream};

/// State common to the steps of a training.
pub struct TrainingContext<'a> {
    /// Everything to train from.
    pub set: &'a TrainSet,
    /// Of the rows.
    pub metric: &'a Metric,
    /// Parameters of the training that compares.
    pub params: &'a TrainParams,
    /// Listener.
    pub progress: &'a dyn Progress,
}

/// What comes near in one stream.
#[derive(Debug, Clone)]
pub struct StreamMatches {
    /// The nearest template of all at every tick.
    pub all: NearestByGate,
    /// The nearest template that is not of the stream's group, under the plain gate: what a new person would be near.
    pub others: Vec<Match>,
    /// For each tick the nearest match of every class, by [`LeaveOneOutView`]; empty where nothing is verified.
    pub classes: Vec<Match>,
}

/// Values of templates' rows that are matched together, 192 kB of them: a core's own cache has room for twice that and more.
const VALUES_OF_PART: usize = 48 << 10;

/// Templates in the metric, and the units of all of them.
pub struct MappedTemplates {
    rows: Vec<Rows>,
    units: Units,
}

impl TrainingContext<'_> {
    /// Maps templates.
    pub fn mapped<'r>(&self, rows: impl Iterator<Item = &'r Rows>) -> MappedTemplates {
        let rows: Vec<Rows> = rows.map(|r| self.metric.apply_all(r)).collect();
        let units = Units::of(&rows);
        MappedTemplates { rows, units }
    }

    /// Lays out the templates at `places` together.
    pub fn matcher(&self, mapped: &MappedTemplates, places: &[usize]) -> Matcher {
        let rows: Vec<Rows> = places.iter().map(|p| mapped.rows[*p].clone()).collect();
        let (dim, decode) = (self.metric.dim(), &self.params.decode);
        Matcher::in_units(&rows, dim, decode, mapped.units)
    }

    /// Lays out the templates at `places`, in parts whose rows fit the processor's cache.
    pub fn parts(&self, mapped: &MappedTemplates, places: &[usize]) -> Vec<Matcher> {
        let mut parts = Vec::new();
        let mut rest = places;
        while !rest.is_empty() {
            let mut values = 0;
            let fitting = rest.iter().take_while(|place| {
                values += mapped.rows[**place].values().len();
                values <= VALUES_OF_PART
            });
            let (part, others) = rest.split_at(fitting.count().max(1));
            parts.push(self.matcher(mapped, part));
            rest = others;
        }
        parts
    }

    /// Lays out templates that are not mapped yet, in such parts.
    fn matchers<'r>(&self, rows: impl Iterator<Item = &'r Rows>) -> Vec<Matcher> {
        let mapped = self.mapped(rows);
        let all: Vec<usize> = (0..mapped.rows.len()).collect();
        self.parts(&mapped, &all)
    }

    /// Runs `compare` on every stream of the set in parallel, each call with its own copies of `matchers`, and returns the
    /// results in the order of the set. `stage` names the work in reports of progress.
    ///
    /// # Errors
    /// Progress was cancelled.
    pub fn each_stream<T: Send>(
        &self,
        matchers: &[Matcher],
        stage: &str,
        compare: impl Fn(&mut [Matcher], usize, &TrainStream) -> T + Sync,
    ) -> Result<Vec<T>, TrainError> {
        let (done, total) = (AtomicUsize::new(0), self.set.streams.len());
        let of_stream = |matchers: &mut Vec<Matcher>, (place, stream): (usize, &TrainStream)| {
            if self.progress.cancelled() {
                return Err(TrainError::Cancelled);
            }
            let found = compare(matchers, place, stream);
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            self.progress.report(stage, done, total);
            Ok(found)
        };
        let streams = self.set.streams.par_iter().enumerate();
        streams.map_init(|| matchers.to_vec(), of_stream).collect()
    }

    /// Gives `take` the matches of `matchers` nearer than `reach` at the `wanted` ticks of a stream.
    pub fn matches(
        &self,
        matchers: &mut [Matcher],
        stream: &TrainStream,
        (wanted, reach): (&[bool], f32),
        take: impl FnMut(&Offer<'_>),
    ) {
        if wanted.contains(&true) {
            let rows = self.metric.apply_all(&stream.rows);
            for_each_match(matchers, &rows, (wanted, reach), take);
        }
    }

    /// The matches of the templates of `samples` in background; if a verifier is learned, whose gate is `verified`, in all
    /// streams.
    /// Without a verifier, matches farther than `most`, the upper bound of the threshold, are left out.
    ///
    /// # Errors
    /// Progress was cancelled.
    pub fn templates(
        &self,
        samples: &[TrainSample],
        gates: TrainGates,
        (verified, most): (Option<MatchGate>, f32),
    ) -> Result<Vec<StreamMatches>, TrainError> {
        let matchers = self.matchers(samples.iter().map(|s| &s.rows));
        // Nothing else asks for what is farther than both bounds; discounts make distances smaller.
        let discount = gates.wide.map_or(0.0, |gate| gate.discount);
        let reach = match verified {
            None => most.max(self.params.negative_below as f32) / (1.0 - discount),
            Some(_) => FAR,
        };
        let view = LeaveOneOutView::new(self.set, samples);
        self.each_stream(&matchers, "comparing clips", |matchers, place, stream| {
            let ticks = stream.rows.len();
            let classes = verified.map_or_else(Vec::new, |_| view.none(place));
            let mut found = StreamMatches {
                all: NearestByGate::none(ticks, gates),
                others: vec![NO_MATCH; ticks],
                classes,
            };
            let is_asked_for = verified.is_some()
                || stream.source != StreamKind::Labelled
                || stream.rest_is_background;
            let wanted = vec![is_asked_for; ticks];
            self.matches(matchers, stream, (&wanted, reach), |offer| {
                found.all.take(offer, gates);
                if samples[offer.template].group != stream.group {
                    keep_nearest(&mut found.others[offer.tick], offer, gates.plain);
                }
                if let Some(gate) = verified {
                    view.take(&mut found.classes, offer, place, gate);
                }
            });
            found
        })
    }

    /// The matches of `negatives` in streams of other groups than their own. The `gates` of negatives admit a body at rest.
    /// Without a verifier, only background is compared, and only where templates come nearer than `most`, the upper bound of
    /// the threshold.
    ///
    /// # Errors
    /// Progress was cancelled.
    pub fn negatives(
        &self,
        (negatives, rows): (&[NearMiss], &[Rows]),
        matches: &[StreamMatches],
        gates: TrainGates,
        (verifies, most): (bool, f64),
    ) -> Result<Vec<NearestByGate>, TrainError> {
        let streams = &self.set.streams;
        let wanted = |place: usize, stream: &TrainStream| {
            if verifies || stream.source == StreamKind::Labelled {
                return vec![verifies; stream.rows.len()];
            }
            let mut wanted = ticks_within(&matches[place].all.plain, most);
            let wide = ticks_within(&matches[place].all.wide, most);
            wanted.iter_mut().zip(wide).for_each(|(w, wide)| *w |= wide);
            wanted
        };
        let matchers = self.matchers(rows.iter());
        let stage = "comparing with near misses";
        self.each_stream(&matchers, stage, |matchers, place, stream| {
            let mut near = NearestByGate::none(stream.rows.len(), gates);
            self.matches(matchers, stream, (&wanted(place, stream), FAR), |offer| {
                if streams[negatives[offer.template].stream].group != stream.group {
                    near.take(offer, gates);
                }
            });
            near
        })
    }

    /// Faster copies of samples, to be used as templates. Copies that match the beginning of a sample of their class are
    /// left out, because they would report such a sample before its end.
    ///
    /// # Errors
    /// Progress was cancelled.
    pub fn faster_copies(
        &self,
        samples: &[TrainSample],
        bones: BoneSet,
        gate: MatchGate,
    ) -> Result<Vec<TrainSample>, TrainError> {
        let copies = faster_copies(self.set, samples, bones, self.params);
        if copies.is_empty() {
            return Ok(copies);
        }
        let stage = "comparing faster copies";
        let early = self.each_stream(&[], stage, |_, place, stream| {
            self.early_copies(&copies, samples, (place, stream), gate)
        })?;
        let early_of = |copy: usize| early.iter().flatten().filter(|c| **c == copy).count();
        let keep = |(place, copy): &(usize, TrainSample)| {
            let of_class = samples.iter().filter(|s| s.class == copy.class).count();
            !is_early(early_of(*place), of_class)
        };
        let kept = copies.into_iter().enumerate().filter(keep);
        Ok(kept.map(|(_, copy)| copy).collect())
    }

    /// The copies that match the beginning of a sample of their class in one stream, by their places, once for each sample.
    fn early_copies(
        &self,
        copies: &[TrainSample],
        samples: &[TrainSample],
        (place, stream): (usize, &TrainStream),
        gate: MatchGate,
    ) -> Vec<usize> {
        let ticks = stream.rows.len();
        let here: Vec<&TrainSample> = samples.iter().filter(|s| s.stream == place).collect();
        let is_shown = |copy: &TrainSample| here.iter().any(|s| s.class == copy.class);
        let shown: Vec<usize> = (0..copies.len())
            .filter(|c| is_shown(&copies[*c]))
            .collect();
        let mut wanted = vec![false; ticks];
        here.iter()
            .for_each(|s| wanted[beginning(s, ticks)].fill(true));
        let mut matchers = self.matchers(shown.iter().map(|c| &copies[*c].rows));
        let mut matches = vec![vec![NO_MATCH; ticks]; shown.len()];
        self.matches(&mut matchers, stream, (&wanted, FAR), |offer| {
            if let Some(found) = offer.nearer(FAR, gate) {
                matches[offer.template][offer.tick] = found;
            }
        });
        let most = self.params.max_threshold;
        let early = |(copy, matches): (usize, &Vec<Match>)| {
            let of_class = here.iter().filter(|s| s.class == copies[copy].class);
            let early = of_class.filter(|s| matches_beginning(matches, s, most));
            vec![copy; early.count()]
        };
        shown
            .iter()
            .copied()
            .zip(&matches)
            .flat_map(early)
            .collect()
    }
}
