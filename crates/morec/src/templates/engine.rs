//! Feature rows in, detections in ticks out.

use std::sync::Arc;

use crate::classes::ClassId;
use crate::decode::{Candidate, ClassDistance, Decoder, FAR, TickDetection};
use crate::features::Rows;

use super::early::{EarlyDetectionParams, OngoingMatch};
use super::verifier::{CandidateScorer, Evidence};
use super::{Calibration, Matcher, Metric, Stretches, TemplateModel, TemplateModelError};

/// The part of recognition that knows no clock: metric, templates, verifier, decoding.
#[derive(Debug, Clone)]
pub struct TemplateEngine {
    metric: Metric,
    matcher: Matcher,
    /// Matches count below this share of a motionless body's distance.
    rest_share: f32,
    negatives: Matcher,
    /// Of the mapped rows.
    stretches: Stretches,
    template_classes: Arc<[ClassId]>,
    judge: Option<CandidateScorer>,
    decoder: Decoder,
    recent: RecentRows,
    mapped: Vec<f32>,
    near: Vec<ClassDistance>,
    threshold: f32,
    calibration: Option<Calibration>,
}

/// The last rows of the stream, as many as a match can span.
#[derive(Debug, Clone)]
struct RecentRows {
    rows: Vec<f32>,
    dim: usize,
    mask: usize,
    pushed: usize,
}

impl RecentRows {
    fn new(dim: usize, capacity: usize) -> Self {
        let capacity = capacity.next_power_of_two();
        Self {
            rows: vec![0.0; dim * capacity],
            dim,
            mask: capacity - 1,
            pushed: 0,
        }
    }

    fn push(&mut self, row: &[f32]) {
        let slot = self.pushed & self.mask;
        self.rows[slot * self.dim..][..self.dim].copy_from_slice(row);
        self.pushed += 1;
    }

    fn row(&self, tick: usize) -> &[f32] {
        &self.rows[(tick & self.mask) * self.dim..][..self.dim]
    }
}

impl TemplateEngine {
    /// Lays the model out for streaming.
    pub fn new(model: &TemplateModel) -> Result<Self, TemplateModelError> {
        model.check()?;
        let metric = Metric::new(&model.ridged, &model.total);
        let map = |rows: &Rows| metric.apply_all(rows);
        let templates: Vec<Rows> = model.samples.iter().map(|s| map(&s.rows)).collect();
        let negatives: Vec<Rows> = model.negatives.iter().map(map).collect();
        let dim = metric.dim();
        let rule = model.rule();
        let window = model.decode.look_ahead_ticks(rule);
        let mut decoder = Decoder::new(&model.decode, rule, model.classes.len(), model.longest());
        decoder.set_thresholds(&model.class_thresholds);
        let matcher = Matcher::new(&templates, dim, model.decode.spread_exponent);
        let negatives = Matcher::new(&negatives, dim, model.decode.spread_exponent);
        let longest_match = matcher.longest_match().max(negatives.longest_match());
        Ok(Self {
            stretches: Stretches::new(dim, longest_match),
            matcher,
            rest_share: model.decode.rest_share(rule),
            negatives,
            template_classes: model.samples.iter().map(|s| s.class).collect(),
            judge: model
                .verifier
                .as_ref()
                .map(|v| CandidateScorer::new(v, &metric, model.threshold)),
            decoder,
            // A match of n rows spans at most 2 n ticks and is judged when its window has passed.
            recent: RecentRows::new(dim, 2 * model.longest() + window + 2),
            mapped: vec![0.0; dim],
            threshold: model.threshold,
            calibration: model.calibration_in_use(),
            near: vec![ClassDistance::NONE; model.classes.len()],
            metric,
        })
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.matcher.reset();
        self.negatives.reset();
        self.stretches.reset();
        self.decoder.reset();
        self.recent.pushed = 0;
    }

    /// Takes the next tick's row; calls `out` with what is now certain.
    pub fn push(&mut self, row: &[f32], out: &mut impl FnMut(TickDetection)) {
        self.recent.push(row);
        self.metric.apply(row, &mut self.mapped);
        self.matcher.step(&self.mapped);
        self.negatives.step(&self.mapped);
        self.stretches.push(&self.mapped);
        self.nearest_by_class();
        let negative = nearest(&self.negatives, &mut self.stretches);
        let (judge, recent, metric) = (&mut self.judge, &self.recent, &self.metric);
        self.decoder.push(
            &self.near,
            negative,
            &mut |c| score(judge, recent, metric, c),
            &mut |found| out(calibrated(self.calibration, found)),
        );
    }

    /// The nearest match of each class that is no body at rest.
    fn nearest_by_class(&mut self) {
        self.near.fill(ClassDistance::NONE);
        for (template, class) in self.template_classes.iter().enumerate() {
            let best = &mut self.near[class.index()];
            let nearer = self.matcher.nearer(
                template,
                best.distance,
                self.rest_share,
                &mut self.stretches,
            );
            if let Some(found) = nearer {
                *best = ClassDistance {
                    distance: found.distance,
                    age: found.age,
                    spread: found.spread,
                };
            }
        }
    }

    /// Ticks taken since the stretch began.
    pub fn ticks(&self) -> usize {
        self.recent.pushed
    }

    /// The class whose beginning is nearest at the last tick, if one is near enough by `params`. O(template rows),
    /// no allocation; changes nothing.
    pub fn underway(&self, params: &EarlyDetectionParams) -> Option<OngoingMatch> {
        let (mut best, mut other) = (None::<OngoingMatch>, FAR);
        for (template, class) in self.template_classes.iter().enumerate() {
            let length = self.matcher.bank().template_len(template);
            let Some(found) = self.matcher.partial(template, params.least_rows(length)) else {
                continue;
            };
            let progress = found.rows as f32 / length as f32;
            let new = OngoingMatch {
                class: *class,
                distance: found.distance,
                age: found.age,
                progress,
            };
            match best {
                Some(old) if found.distance >= old.distance => {
                    if old.class != *class {
                        other = other.min(found.distance);
                    }
                }
                old => {
                    if let Some(old) = old.filter(|old| old.class != *class) {
                        other = other.min(old.distance);
                    }
                    best = Some(new);
                }
            }
        }
        let bank = self.negatives.bank();
        let negatives = (0..bank.len()).filter_map(|i| {
            let least = params.least_rows(bank.template_len(i));
            self.negatives.partial(i, least)
        });
        let negative = negatives.map(|n| n.distance).fold(FAR, f32::min);
        best.filter(|b| {
            b.distance < params.reach * self.threshold
                && b.distance < params.gate * negative
                && b.distance < params.rival * other
                && b.age + 1 >= params.least_ticks
        })
    }

    /// Distances at or above this are never reported.
    pub fn threshold(&self) -> f32 {
        self.threshold
    }

    /// Ends the stretch: calls `out` with what the last ticks still hold.
    pub fn finish(&mut self, out: &mut impl FnMut(TickDetection)) {
        let (judge, recent, metric) = (&mut self.judge, &self.recent, &self.metric);
        let calibration = self.calibration;
        self.decoder
            .finish(&mut |c| score(judge, recent, metric, c), &mut |found| {
                out(calibrated(calibration, found));
            });
        self.reset();
    }
}

/// `found` with the probability that it is right as its score.
fn calibrated(calibration: Option<Calibration>, found: TickDetection) -> TickDetection {
    match calibration {
        Some(calibration) => TickDetection {
            score: calibration.probability(found.score),
            ..found
        },
        None => found,
    }
}

fn nearest(matcher: &Matcher, stretches: &mut Stretches) -> f32 {
    let mut nearest = FAR;
    for i in 0..matcher.bank().len() {
        if let Some(found) = matcher.nearer(i, nearest, 0.0, stretches) {
            nearest = found.distance;
        }
    }
    nearest
}

fn score(
    judge: &mut Option<CandidateScorer>,
    recent: &RecentRows,
    metric: &Metric,
    candidate: &Candidate,
) -> f64 {
    let Some(judge) = judge else { return 0.0 };
    let first = candidate.tick as usize - candidate.age;
    judge.score(
        candidate.class,
        &Evidence::of(candidate),
        metric,
        candidate.age + 1,
        |i| recent.row(first + i),
    )
}
