//! The nearest match of every class at each tick.

use std::sync::Arc;

use crate::classes::ClassId;
use crate::decode::{ClassDistance, FAR};
use crate::features::Rows;

use super::dot::AT_ONCE;
use super::early::{EarlyDetectionParams, OngoingMatch};
use super::{MatchGate, Matcher, Metric, Stretches, TemplateModel};

/// Templates and negatives of a model, matched against a stream of rows.
#[derive(Debug, Clone)]
pub struct ClassMatcher {
    metric: Metric,
    /// The rows that it last advanced by, mapped; room for [`AT_ONCE`].
    mapped: Vec<f32>,
    matcher: Matcher,
    negatives: Matcher,
    /// Of the mapped rows.
    stretches: Stretches,
    template_classes: Arc<[ClassId]>,
    gate: MatchGate,
    /// See [`TemplateModel::reach`].
    reach: f32,
    near: Vec<ClassDistance>,
    negative: f32,
}

impl ClassMatcher {
    /// Lays the templates of `model` out for streaming. `metric` is the model's, and maps them and the stream.
    pub fn new(model: &TemplateModel, metric: &Metric) -> Self {
        let map = |rows: &Rows| metric.apply_all(rows);
        let templates: Vec<Rows> = model.samples.iter().map(|s| map(&s.rows)).collect();
        let negatives: Vec<Rows> = model.negatives.iter().map(map).collect();
        let dim = metric.dim();
        let matcher = Matcher::new(&templates, dim, &model.decode);
        let negatives = Matcher::new(&negatives, dim, &model.decode);
        let longest_match = matcher.longest_match().max(negatives.longest_match());
        Self {
            metric: metric.clone(),
            mapped: vec![0.0; AT_ONCE * dim],
            stretches: Stretches::new(dim, longest_match),
            matcher,
            negatives,
            template_classes: model.samples.iter().map(|s| s.class).collect(),
            gate: MatchGate::plain(model.decode.rest_share(model.rule())),
            reach: model.reach(),
            near: vec![ClassDistance::NONE; model.classes.len()],
            negative: FAR,
        }
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.matcher.reset();
        self.negatives.reset();
        self.stretches.reset();
    }

    /// From the next tick on, matches of classes count that pass `gate`; distances of negatives are discounted like them.
    pub fn set_gate(&mut self, gate: MatchGate) {
        self.gate = gate;
    }

    /// See [`Stretches::set_noise_gain`].
    pub fn set_noise_gain(&mut self, gain: f32) {
        self.stretches.set_noise_gain(gain);
    }

    /// Takes the next tick's row and looks at it. O(template rows · d), no allocation.
    pub fn step(&mut self, row: &[f32]) {
        self.advance(row);
        self.look(0);
    }

    /// Takes the rows of the next ticks, one after the other, [`AT_ONCE`] at most. Each must be [looked at](Self::look) in turn: the same as
    /// step by step, and faster. No allocation.
    pub fn advance(&mut self, rows: &[f32]) {
        let dim = self.metric.dim();
        let mapped = &mut self.mapped[..rows.len()];
        self.metric.apply_each(rows, mapped);
        self.matcher.advance(mapped.chunks_exact(dim));
        if !self.negatives.bank().is_empty() {
            self.negatives.advance(mapped.chunks_exact(dim));
        }
    }

    /// Finds the nearest matches at tick `at` of those that it last advanced by.
    pub fn look(&mut self, at: usize) {
        self.matcher.show(at);
        self.negatives.show(at);
        let dim = self.metric.dim();
        self.stretches.push(&self.mapped[at * dim..][..dim]);
        // The gate takes the discount off distances that are normalised without it.
        let undiscounted_reach = self.reach / (1.0 - self.gate.discount);
        self.matcher.look(undiscounted_reach, &mut self.stretches);
        self.negatives.look(undiscounted_reach, &mut self.stretches);
        self.match_classes();
        self.negative = FAR;
        let all = MatchGate {
            rest_share: 0.0,
            ..self.gate
        };
        for i in 0..self.negatives.bank().len() {
            let within = self.negative.min(self.reach);
            let nearer = self.negatives.nearer(i, within, all, &self.stretches);
            if let Some(found) = nearer {
                self.negative = found.distance;
            }
        }
    }

    fn match_classes(&mut self) {
        self.near.fill(ClassDistance::NONE);
        for (template, class) in self.template_classes.iter().enumerate() {
            let best = &mut self.near[class.index()];
            let within = best.distance.min(self.reach);
            let nearer = (self.matcher).nearer(template, within, self.gate, &self.stretches);
            if let Some(found) = nearer {
                *best = ClassDistance {
                    distance: found.distance,
                    age: found.age,
                    spread: found.spread,
                    rest_share: found.rest_share,
                };
            }
        }
    }

    /// The nearest match of each class at the tick looked at last that is no body at rest, of those nearer than [`reach`](TemplateModel::reach).
    pub fn near(&self) -> &[ClassDistance] {
        &self.near
    }

    /// Distance of the nearest negative at the tick looked at last; [`FAR`] if none is nearer than [`reach`](TemplateModel::reach).
    pub fn negative(&self) -> f32 {
        self.negative
    }

    /// The nearest part of each template from its beginning on, at the last tick, which must be looked at.
    fn beginnings(&self, params: &EarlyDetectionParams) -> impl Iterator<Item = OngoingMatch> {
        let templates = self.template_classes.iter().enumerate();
        templates.filter_map(|(template, class)| {
            let length = self.matcher.bank().template_len(template);
            let found = self.matcher.partial(template, params.least_rows(length))?;
            Some(OngoingMatch {
                class: *class,
                distance: found.distance,
                age: found.age,
                progress: found.rows as f32 / length as f32,
                pace: (found.age + 1) as f32 / found.rows as f32,
                goes_on: false,
                repetitions: None,
                whole: None,
            })
        })
    }

    /// Puts the nearest beginning of each class at the last tick, which must be looked at, into the class's place in `nearest`; classes without
    /// a match keep what is there. O(template rows), no allocation.
    pub fn progress(&self, params: &EarlyDetectionParams, nearest: &mut [Option<OngoingMatch>]) {
        for found in self.beginnings(params) {
            let best = &mut nearest[found.class.index()];
            if best.is_none_or(|best| found.distance < best.distance) {
                *best = Some(found);
            }
        }
    }

    /// The class whose beginning is nearest at the last tick, which must be looked at, if one is within the bounds of `params` under this threshold.
    /// O(template rows), no allocation; changes nothing.
    pub fn underway(&self, params: &EarlyDetectionParams, threshold: f32) -> Option<OngoingMatch> {
        let (mut best, mut other) = (None::<OngoingMatch>, FAR);
        for found in self.beginnings(params) {
            match best {
                Some(old) if found.distance >= old.distance => {
                    if old.class != found.class {
                        other = other.min(found.distance);
                    }
                }
                old => {
                    if let Some(old) = old.filter(|old| old.class != found.class) {
                        other = other.min(old.distance);
                    }
                    best = Some(found);
                }
            }
        }
        let is_near = |best: &OngoingMatch| {
            best.distance < params.reach * threshold
                && best.distance < params.rival * other
                && best.age + 1 >= params.least_ticks
        };
        let best = best.filter(is_near)?;
        let bank = self.negatives.bank();
        let nearer = |negative: usize| {
            let least = params.least_rows(bank.template_len(negative));
            let found = self.negatives.partial(negative, least);
            found.is_some_and(|found| best.distance >= params.gate * found.distance)
        };
        (best.distance < params.gate * FAR && !(0..bank.len()).any(nearer)).then_some(best)
    }
}
