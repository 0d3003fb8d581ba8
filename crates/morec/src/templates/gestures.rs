//! Gestures in a stream of feature rows: templates find matches, and a decision is made about each of them.

use crate::decode::{Candidate, Decoder, TickDetection};
use crate::templates::second_look::LookDecoder;

use super::adaptation::PerformerAdaptation;
use super::class_matches::MatchReplay;
use super::recent_rows::RecentRows;
use super::verifier::{CandidateScorer, Evidence};
use super::{Calibration, ClassMatcher, Metric, TemplateModel};

/// Matches of templates, and what decides about them.
#[derive(Debug, Clone)]
pub(super) struct GestureDetector {
    matches: Matches,
    decision: MatchDecision,
}

/// Source of the classes' nearest matches.
#[derive(Debug, Clone)]
pub(super) enum Matches {
    Computed(Box<ClassMatcher>),
    /// Of the same stream, from elsewhere.
    Given(MatchReplay),
}

/// What becomes of a match.
#[derive(Debug, Clone)]
enum MatchDecision {
    /// The whole motion around it is compared with all samples.
    SecondLook(Box<LookDecoder>),
    /// Its distance passes gates and a threshold, and a verifier if there is one.
    ByDistance(Box<DistanceDecision>),
}

impl GestureDetector {
    /// With room for matches of templates of up to `longest` rows.
    pub(super) fn new(
        model: &TemplateModel,
        longest: usize,
        metric: Metric,
        matches: Matches,
    ) -> Self {
        // Matches from elsewhere have passed the narrow gate.
        let computed = matches!(matches, Matches::Computed(_));
        let decision = match LookDecoder::new(model, 2 * longest) {
            Some(looks) => MatchDecision::SecondLook(Box::new(looks)),
            None => MatchDecision::ByDistance(Box::new(DistanceDecision::new(
                model, longest, metric, computed,
            ))),
        };
        let mut detector = Self { matches, decision };
        detector.apply_rules();
        detector
    }

    /// The matcher, unless matches come from elsewhere.
    pub(super) fn matcher(&self) -> Option<&ClassMatcher> {
        match &self.matches {
            Matches::Computed(matcher) => Some(matcher),
            Matches::Given(_) => None,
        }
    }

    fn matcher_mut(&mut self) -> Option<&mut ClassMatcher> {
        match &mut self.matches {
            Matches::Computed(matcher) => Some(matcher),
            Matches::Given(_) => None,
        }
    }

    /// True while the wider gate is open.
    pub(super) fn is_open(&self) -> bool {
        match &self.decision {
            MatchDecision::SecondLook(_) => false,
            MatchDecision::ByDistance(decision) => decision.is_open(),
        }
    }

    /// Forgets the stream so far, but not the performer.
    pub(super) fn reset(&mut self) {
        if let Some(matcher) = self.matcher_mut() {
            matcher.reset();
        }
        match &mut self.decision {
            MatchDecision::SecondLook(looks) => looks.reset(),
            MatchDecision::ByDistance(decision) => decision.reset(),
        }
    }

    /// Forgets how the performer moves.
    pub(super) fn forget_performer(&mut self) {
        match &mut self.decision {
            MatchDecision::SecondLook(looks) => looks.forget_performer(),
            MatchDecision::ByDistance(decision) => decision.forget_performer(),
        }
        self.apply_rules();
    }

    pub(super) fn set_noise_gain(&mut self, gain: f32) {
        if let Some(matcher) = self.matcher_mut() {
            matcher.set_noise_gain(gain);
        }
    }

    /// Matches the rows of the next ticks.
    pub(super) fn advance(&mut self, rows: &[f32]) {
        if let Some(matcher) = self.matcher_mut() {
            matcher.advance(rows);
        }
    }

    /// Decides what is certain with `row`, the `at`th of those that it last advanced by.
    pub(super) fn decide(&mut self, at: usize, row: &[f32]) {
        let (near, negative) = match &mut self.matches {
            Matches::Computed(matcher) => {
                matcher.look(at);
                (matcher.near(), matcher.negative())
            }
            Matches::Given(replay) => replay.step(),
        };
        match &mut self.decision {
            MatchDecision::SecondLook(looks) => looks.push(row, near),
            MatchDecision::ByDistance(decision) => {
                decision.recent.push(row);
                decision.decoder.push(near, negative);
                if decision.decode(false) {
                    self.apply_rules();
                }
            }
        }
    }

    /// Decides all that the stretch still holds.
    pub(super) fn finish(&mut self) {
        match &mut self.decision {
            MatchDecision::SecondLook(looks) => looks.finish(),
            MatchDecision::ByDistance(decision) => {
                if decision.decode(true) {
                    self.apply_rules();
                }
            }
        }
    }

    /// What the last row, or the end, made certain.
    pub(super) fn found(&self) -> &[TickDetection] {
        match &self.decision {
            MatchDecision::SecondLook(looks) => looks.found(),
            MatchDecision::ByDistance(decision) => decision.decoder.found(),
        }
    }

    /// Lets the rules hold that fit the performer.
    fn apply_rules(&mut self) {
        let (Matches::Computed(matcher), MatchDecision::ByDistance(decision)) =
            (&mut self.matches, &mut self.decision)
        else {
            return;
        };
        if let Some(adaptation) = &decision.adaptation {
            let (gate, rival_share, thresholds) = adaptation.rules();
            matcher.set_gate(gate);
            decision.decoder.set_rival_share(rival_share);
            decision.decoder.set_thresholds(thresholds);
        }
    }
}

/// Gates, thresholds and the verifier.
#[derive(Debug, Clone)]
struct DistanceDecision {
    metric: Metric,
    judge: Option<CandidateScorer>,
    decoder: Decoder,
    /// As many rows as a match can span.
    recent: RecentRows,
    calibration: Option<Calibration>,
    adaptation: Option<PerformerAdaptation>,
}

impl DistanceDecision {
    fn new(model: &TemplateModel, longest: usize, metric: Metric, computed: bool) -> Self {
        let rule = model.rule();
        let window = model.decode.look_ahead_ticks(rule);
        let mut decoder = Decoder::new(&model.decode, rule, model.classes.len(), longest);
        decoder.set_thresholds(&model.class_thresholds);
        let verifier = model.verifier.as_ref();
        let adapts = computed && verifier.is_none();
        let gate = model.stranger.as_ref().filter(|_| adapts);
        Self {
            judge: verifier.map(|v| CandidateScorer::new(v, &metric, model.threshold)),
            decoder,
            // A match of n rows spans at most 2 n ticks and is judged when its window has passed.
            recent: RecentRows::new(metric.dim(), 2 * longest + window + 2),
            calibration: model.calibration_in_use(),
            adaptation: gate.map(|gate| PerformerAdaptation::new(gate, model)),
            metric,
        }
    }

    fn is_open(&self) -> bool {
        self.adaptation.as_ref().is_some_and(|a| a.is_open())
    }

    fn reset(&mut self) {
        self.decoder.reset();
        self.recent.restart();
    }

    fn forget_performer(&mut self) {
        if let Some(adaptation) = &mut self.adaptation {
            adaptation.forget();
        }
    }

    /// Decides the ticks that are due, and reports. True if other rules hold from now on.
    fn decode(&mut self, ended: bool) -> bool {
        while self.decoder.is_due(ended) {
            let candidates = self.decoder.candidates();
            if let Some(judge) = &mut self.judge {
                for scored in candidates {
                    scored.score = score(judge, &self.recent, &self.metric, &scored.candidate);
                }
            }
            self.decoder.decide();
        }
        let was_open = self.is_open();
        let wide = self.adaptation.as_ref().and_then(|a| a.calibration());
        let calibration = wide.or(self.calibration);
        for detection in self.decoder.report(ended) {
            if let Some(adaptation) = &mut self.adaptation {
                adaptation.note(detection);
            }
            *detection = calibrated(calibration, *detection);
        }
        self.is_open() != was_open
    }
}

/// `found` with the probability that it is right as its score.
fn calibrated(calibration: Option<Calibration>, found: TickDetection) -> TickDetection {
    match calibration {
        Some(calibration) => TickDetection {
            score: calibration.probability(found.score, found.separation, found.rest_share),
            ..found
        },
        None => found,
    }
}

fn score(
    judge: &mut CandidateScorer,
    recent: &RecentRows,
    metric: &Metric,
    candidate: &Candidate,
) -> f64 {
    let first = candidate.tick as usize - candidate.age;
    judge.score(
        candidate.class,
        &Evidence::of(candidate),
        metric,
        candidate.age + 1,
        |i| recent.row(first + i),
    )
}
