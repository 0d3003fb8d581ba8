//! The distance of a stream to every class at each tick, before any decision. Used by training and explanations.

use crate::classes::ClassId;
use crate::decode::{Candidate, FAR};
use crate::features::Rows;

use super::matcher::{Matcher, NormalizedMatch};
use super::stretches::Stretches;
use super::verifier::{CandidateScorer, Evidence};
use super::{Metric, StrangerGate, TemplateModel, TemplateModelError};

/// The nearest template of a class at a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Distance and gate of its match.
    pub comparison: NormalizedMatch,
    /// Its place among the model's samples.
    pub template: usize,
}

impl Nearest {
    const NONE: Self = Self {
        comparison: NormalizedMatch {
            distance: FAR,
            age: 0,
            rest_share: f32::MAX,
            spread: 0.0,
            offset_share: 0.0,
        },
        template: 0,
    };
}

/// A model's matches over a whole stream. Memory: O(ticks · classes).
#[derive(Debug)]
pub struct Trace<'a> {
    model: &'a TemplateModel,
    rows: &'a Rows,
    metric: Metric,
    /// ticks × classes; of matches that move more than a body at rest.
    moving: Vec<Nearest>,
    /// ticks × classes; of all matches.
    all: Vec<Nearest>,
    negatives: Vec<f32>,
    /// `moving` and `negatives` as under the wider gate; empty without one.
    wide: Vec<Nearest>,
    wide_negatives: Vec<f32>,
    judge: Option<CandidateScorer>,
}

impl<'a> Trace<'a> {
    /// Runs `model` over feature rows of its bones. O(ticks · template rows · d).
    ///
    /// # Errors
    /// Parts of the model that do not fit together.
    pub fn of(model: &'a TemplateModel, rows: &'a Rows) -> Result<Self, TemplateModelError> {
        model.check()?;
        let metric = Metric::new(&model.ridged, &model.total);
        let lay_out = |rows: Vec<Rows>| Matcher::new(&rows, metric.dim(), &model.decode);
        let samples = model.samples.iter().map(|s| metric.apply_all(&s.rows));
        let mut templates = lay_out(samples.collect());
        let negatives = model.negatives.iter().map(|r| metric.apply_all(r));
        let mut negatives = lay_out(negatives.collect());
        let longest = templates.longest_match().max(negatives.longest_match());
        let mut stretches = Stretches::new(metric.dim(), longest);
        let rest_share = model.decode.rest_share(model.rule());
        let classes = model.classes.len();
        let mut trace = Self {
            moving: Vec::with_capacity(rows.len() * classes),
            all: Vec::with_capacity(rows.len() * classes),
            negatives: Vec::with_capacity(rows.len()),
            wide: Vec::new(),
            wide_negatives: Vec::new(),
            judge: model
                .verifier
                .as_ref()
                .map(|v| CandidateScorer::new(v, &metric, model.threshold)),
            model,
            rows,
            metric,
        };
        for row in trace.metric.apply_all(rows).iter() {
            templates.step(row);
            negatives.step(row);
            stretches.push(row);
            trace.push(&templates, rest_share, &mut stretches);
            trace.push_negatives(&negatives, &mut stretches);
        }
        Ok(trace)
    }

    fn push(&mut self, templates: &Matcher, rest_share: f32, stretches: &mut Stretches) {
        let classes = self.model.classes.len();
        let first = self.all.len();
        self.all.resize(first + classes, Nearest::NONE);
        self.moving.resize(first + classes, Nearest::NONE);
        let wide = self.model.stranger.as_ref().map(StrangerGate::match_gate);
        if wide.is_some() {
            self.wide.resize(first + classes, Nearest::NONE);
        }
        for (template, sample) in self.model.samples.iter().enumerate() {
            let comparison = templates.compare(template, stretches);
            let found = Nearest {
                comparison,
                template,
            };
            let place = first + sample.class.index();
            if comparison.distance < self.all[place].comparison.distance {
                self.all[place] = found;
            }
            let moves = comparison.moves(rest_share);
            if moves && comparison.distance < self.moving[place].comparison.distance {
                self.moving[place] = found;
            }
            let Some(gate) = wide else { continue };
            let comparison = comparison.discounted(gate.discount);
            let nearer = comparison.distance < self.wide[place].comparison.distance;
            if nearer && comparison.moves(gate.rest_share) {
                self.wide[place] = Nearest {
                    comparison,
                    template,
                };
            }
        }
    }

    fn push_negatives(&mut self, negatives: &Matcher, stretches: &mut Stretches) {
        let discount = self.model.stranger.as_ref().map(|gate| gate.discount);
        let (mut nearest, mut wide) = (FAR, FAR);
        for i in 0..negatives.bank().len() {
            let found = negatives.compare(i, stretches);
            nearest = nearest.min(found.distance);
            wide = wide.min(found.discounted(discount.unwrap_or(0.0)).distance);
        }
        self.negatives.push(nearest);
        if discount.is_some() {
            self.wide_negatives.push(wide);
        }
    }

    /// Number of ticks.
    pub fn ticks(&self) -> usize {
        self.rows.len()
    }

    /// The nearest match of a class that ends at `tick` and moves more than a body at rest.
    pub fn moving(&self, tick: usize, class: ClassId) -> Nearest {
        self.moving[tick * self.model.classes.len() + class.index()]
    }

    /// The nearest match of a class that ends at `tick` and passes the wider gate, discounted; none without such a gate.
    pub fn wide(&self, tick: usize, class: ClassId) -> Nearest {
        let place = tick * self.model.classes.len() + class.index();
        self.wide.get(place).copied().unwrap_or(Nearest::NONE)
    }

    /// Smallest distance to a negative at `tick` as under the wider gate; [`FAR`] if there is none.
    pub fn wide_negative(&self, tick: usize) -> f32 {
        self.wide_negatives.get(tick).copied().unwrap_or(FAR)
    }

    /// The nearest match of a class that ends at `tick`, moving or not.
    pub fn nearest(&self, tick: usize, class: ClassId) -> Nearest {
        self.all[tick * self.model.classes.len() + class.index()]
    }

    /// Smallest distance to a negative at `tick`; [`FAR`] if there is none.
    pub fn negative(&self, tick: usize) -> f32 {
        self.negatives[tick]
    }

    /// The verifier's score of the candidate of `class` that ends at `tick`, above 0 is accepted, and its evidence.
    /// `None` without a verifier.
    pub fn verify(&mut self, tick: usize, class: ClassId) -> Option<(f64, Evidence)> {
        let NormalizedMatch { distance, age, .. } = self.moving(tick, class).comparison;
        let reach = self.model.decode.peak_ticks;
        let around = tick.saturating_sub(reach)..=(tick + reach).min(self.ticks() - 1);
        let (mut other, mut negative) = (FAR, FAR);
        for t in around {
            negative = negative.min(self.negative(t));
            for rival in (0..self.model.classes.len()).filter(|c| *c != class.index()) {
                let rival = self.moving(t, ClassId(rival as u16));
                other = other.min(rival.comparison.distance);
            }
        }
        let evidence = Evidence::of(&Candidate {
            class,
            tick: tick as i64,
            age,
            distance,
            other,
            negative,
        });
        let judge = self.judge.as_mut()?;
        let first = tick - age.min(tick);
        let row = |i: usize| self.rows.row(first + i);
        let score = judge.score(class, &evidence, &self.metric, tick - first + 1, row);
        Some((score, evidence))
    }
}
