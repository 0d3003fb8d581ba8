//! The engine of the method templates: feature rows in, detections in ticks out.

use crate::decode::{Candidate, Decoder, TickDetection};
use crate::features::RowLayout;
use crate::templates::second_look::LookDecoder;

use super::activities::ActivityDetector;
use super::class_matches::{ClassMatches, MatchReplay};
use super::early::{EarlyDetectionParams, OngoingMatch};
use super::held::HoldDetector;
use super::recent_rows::RecentRows;
use super::verifier::{CandidateScorer, Evidence};
use super::{
    Calibration, ClassMatcher, MatchGate, Metric, PerformerLevel, StrangerGate, TemplateModel,
    TemplateModelError,
};

/// The part of recognition that knows no clock: metric, templates, verifier, decoding.
#[derive(Debug, Clone)]
pub struct TemplateEngine {
    metric: Metric,
    matches: Matches,
    judge: Option<CandidateScorer>,
    decoder: Decoder,
    /// As many rows as a match can span.
    recent: RecentRows,
    threshold: f32,
    calibration: Option<Calibration>,
    stranger: Option<Box<PerformerAdaptation>>,
    /// Decides in the decoder's place, where there is one.
    looks: Option<Box<LookDecoder>>,
    held: Option<Box<HoldDetector>>,
    activities: Option<Box<ActivityDetector>>,
}

/// The wider gate and what is known of the performer.
#[derive(Debug, Clone)]
struct PerformerAdaptation {
    gate: StrangerGate,
    level: PerformerLevel,
    /// What holds while it is closed: the gate of matches, the share of rivals, the thresholds of classes.
    closed: (MatchGate, f32, Vec<f32>),
    /// The thresholds of classes while it is open.
    open: Vec<f32>,
}

impl PerformerAdaptation {
    fn new(gate: &StrangerGate, model: &TemplateModel) -> Self {
        let classes = model.classes.len();
        let mut thresholds = vec![model.threshold; classes];
        let own = model.class_thresholds.iter();
        thresholds
            .iter_mut()
            .zip(own)
            .for_each(|(t, own)| *t = *own);
        let rest_share = model.decode.rest_share(model.rule());
        let plain = MatchGate::plain(rest_share);
        Self {
            level: PerformerLevel::new(gate),
            closed: (plain, model.decode.rival_share, thresholds),
            open: vec![gate.threshold; classes],
            gate: gate.clone(),
        }
    }

    /// The gate of matches, the share of rivals and the thresholds of classes that hold now.
    fn rules(&self) -> (MatchGate, f32, &[f32]) {
        let (gate, rival_share, thresholds) = &self.closed;
        match self.level.is_open() {
            true => (self.gate.match_gate(), self.gate.rival_share, &self.open),
            false => (*gate, *rival_share, thresholds),
        }
    }

    /// Takes a detection whose score is its margin below the threshold.
    fn note(&mut self, found: &TickDetection) {
        let threshold = self.rules().2[found.class.index()];
        let distance = (1.0 - found.score) as f32 * threshold;
        self.level.note(distance, &self.gate);
    }
}

/// Source of the classes' nearest matches.
#[derive(Debug, Clone)]
enum Matches {
    Computed(Box<ClassMatcher>),
    /// Of the same stream, from elsewhere.
    Given(MatchReplay),
}

impl TemplateEngine {
    /// Lays the model out for streaming.
    ///
    /// # Errors
    /// As [`TemplateModel::check`].
    pub fn new(model: &TemplateModel) -> Result<Self, TemplateModelError> {
        Self::with(model, model.longest(), |metric| {
            Matches::Computed(Box::new(ClassMatcher::new(model, metric)))
        })
    }

    /// The same on matches that were computed elsewhere, of the stream that will be pushed. Templates of `model` are not
    /// looked at.
    ///
    /// # Errors
    /// As [`TemplateModel::check`].
    pub fn replay(
        model: &TemplateModel,
        matches: ClassMatches,
    ) -> Result<Self, TemplateModelError> {
        let longest = matches.longest();
        let replay = MatchReplay::new(matches, model.classes.len());
        Self::with(model, longest, |_| Matches::Given(replay))
    }

    /// With room for matches of templates of up to `longest` rows.
    fn with(
        model: &TemplateModel,
        longest: usize,
        matches: impl FnOnce(&Metric) -> Matches,
    ) -> Result<Self, TemplateModelError> {
        model.check()?;
        let metric = Metric::new(&model.ridged, &model.total);
        let (dim, rule) = (metric.dim(), model.rule());
        let window = model.decode.look_ahead_ticks(rule);
        let mut decoder = Decoder::new(&model.decode, rule, model.classes.len(), longest);
        decoder.set_thresholds(&model.class_thresholds);
        let matches = matches(&metric);
        // Matches from elsewhere have passed the narrow gate.
        let computed = matches!(matches, Matches::Computed(_)) && model.verifier.is_none();
        let gate = model.stranger.as_ref().filter(|_| computed);
        let stranger = gate.map(|gate| Box::new(PerformerAdaptation::new(gate, model)));
        let mut engine = Self {
            matches,
            judge: model
                .verifier
                .as_ref()
                .map(|v| CandidateScorer::new(v, &metric, model.threshold)),
            decoder,
            // A match of n rows spans at most 2 n ticks and is judged when its window has passed.
            recent: RecentRows::new(dim, 2 * longest + window + 2),
            threshold: model.threshold,
            calibration: model.calibration_in_use(),
            stranger,
            looks: LookDecoder::new(model, 2 * longest).map(Box::new),
            held: (model.held.as_ref()).map(|held| Box::new(HoldDetector::new(held))),
            activities: (model.activities.as_ref()).map(|activities| {
                let layout = RowLayout::of(model.bones);
                let detector = ActivityDetector::new(activities, layout, model.features.tick_hz());
                // The map of distances' margins holds for windows' as well, and they are never verified.
                let calibration = model.calibration.map(|_| Calibration::MEASURED);
                Box::new(detector.calibrated(calibration))
            }),
            metric,
        };
        engine.apply_rules();
        Ok(engine)
    }

    /// Lets the rules hold that fit the performer.
    fn apply_rules(&mut self) {
        let (Some(stranger), Matches::Computed(matcher)) = (&self.stranger, &mut self.matches)
        else {
            return;
        };
        let (gate, rival_share, thresholds) = stranger.rules();
        matcher.set_gate(gate);
        self.decoder.set_rival_share(rival_share);
        self.decoder.set_thresholds(thresholds);
    }

    /// True while the wider gate is open: the performer moves unlike the teacher, or anyone is expected.
    pub fn is_open(&self) -> bool {
        self.stranger.as_ref().is_some_and(|s| s.level.is_open())
    }

    /// Forgets the stream so far, but not the performer.
    pub fn reset(&mut self) {
        if let Matches::Computed(matcher) = &mut self.matches {
            matcher.reset();
        }
        if let Some(held) = &mut self.held {
            held.reset();
        }
        if let Some(activities) = &mut self.activities {
            activities.reset();
        }
        if let Some(looks) = &mut self.looks {
            looks.reset();
        }
        self.decoder.reset();
        self.recent.restart();
    }

    /// Forgets how the performer moves: the next row may be another performer's.
    pub fn forget_performer(&mut self) {
        if let Some(looks) = &mut self.looks {
            looks.forget_performer();
        }
        if let Some(stranger) = &mut self.stranger {
            stranger.level = PerformerLevel::new(&stranger.gate);
        }
        self.apply_rules();
    }

    /// Says how much of noise the rows that come hold: [`FeatureStream::noise_gain`](crate::features::FeatureStream::noise_gain).
    pub fn set_noise_gain(&mut self, gain: f32) {
        if let Matches::Computed(matcher) = &mut self.matches {
            matcher.set_noise_gain(gain);
        }
    }

    /// Takes the next tick's row and returns the detections that are now certain. No allocation.
    pub fn push(&mut self, row: &[f32]) -> impl Iterator<Item = &TickDetection> {
        self.advance(row);
        self.decide(0, row)
    }

    /// Takes the rows of the next ticks, one after the other, [`AT_ONCE`](super::dot::AT_ONCE) at most. What each makes certain comes from
    /// [`decide`](Self::decide), which must be called for each in turn: the same as of pushing one by one, and faster.
    pub fn advance(&mut self, rows: &[f32]) {
        if let Matches::Computed(matcher) = &mut self.matches {
            matcher.advance(rows);
        }
    }

    /// The detections that are certain with `row`, the `at`th of those that it last advanced by. No allocation.
    pub fn decide(&mut self, at: usize, row: &[f32]) -> impl Iterator<Item = &TickDetection> {
        self.recent.push(row);
        if let Some(held) = &mut self.held {
            held.push(row);
        }
        if let Some(activities) = &mut self.activities {
            activities.push(row);
        }
        let (near, negative) = match &mut self.matches {
            Matches::Computed(matcher) => {
                matcher.look(at);
                (matcher.near(), matcher.negative())
            }
            Matches::Given(replay) => replay.step(),
        };
        match &mut self.looks {
            Some(looks) => looks.push(row, near),
            None => {
                self.decoder.push(near, negative);
                self.decode(false);
            }
        }
        self.found()
    }

    fn found(&self) -> impl Iterator<Item = &TickDetection> {
        let held = self.held.as_ref().and_then(|held| held.found());
        let activities = self.activities.iter().flat_map(|a| a.found());
        let found = match &self.looks {
            Some(looks) => looks.found(),
            None => self.decoder.found(),
        };
        found.iter().chain(held).chain(activities)
    }

    /// Decides the ticks that are due, and reports.
    fn decode(&mut self, ended: bool) {
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
        let wide = self.stranger.as_ref().filter(|s| s.level.is_open());
        let calibration = wide.and_then(|s| s.gate.calibration).or(self.calibration);
        for detection in self.decoder.report(ended) {
            if let Some(stranger) = &mut self.stranger {
                stranger.note(detection);
            }
            *detection = calibrated(calibration, *detection);
        }
        if self.is_open() != was_open {
            self.apply_rules();
        }
    }

    /// Ticks taken since the stretch began.
    pub fn ticks(&self) -> usize {
        self.recent.pushed()
    }

    /// The class whose beginning is nearest at the last tick, if one is within the bounds of `params`. O(template rows),
    /// no allocation; changes nothing. None on matches from elsewhere.
    pub fn underway(&self, params: &EarlyDetectionParams) -> Option<OngoingMatch> {
        let farthest = params.reach * self.threshold;
        let held = self.held.as_ref().and_then(|held| held.underway(farthest));
        // What begins within an activity is reported at its end: one tentative motion at a time.
        let activity = (self.activities.as_ref()).and_then(|a| a.underway(farthest));
        let motion = |matcher: &ClassMatcher| matcher.underway(params, self.threshold).or(held);
        match &self.matches {
            Matches::Computed(matcher) => activity.or_else(|| motion(matcher)),
            Matches::Given(_) => None,
        }
    }

    /// Puts what is nearest of each class at the last tick into the class's place in `nearest`: the beginning of a gesture, a pose that is held, an
    /// activity that goes on. O(template rows), no allocation; changes nothing else. Nothing on matches from elsewhere.
    pub fn progress(&self, params: &EarlyDetectionParams, nearest: &mut [Option<OngoingMatch>]) {
        let farthest = params.reach * self.threshold;
        nearest.fill(None);
        if let Matches::Computed(matcher) = &self.matches {
            matcher.progress(params, nearest);
        }
        let held = self.held.as_ref().and_then(|held| held.underway(farthest));
        let activity = (self.activities.as_ref()).and_then(|a| a.underway(farthest));
        for found in held.into_iter().chain(activity) {
            nearest[found.class.index()] = Some(found);
        }
    }

    /// Distances at or above this are never reported.
    pub fn threshold(&self) -> f32 {
        self.threshold
    }

    /// Ends the stretch and returns the detections that its last ticks still hold. The next row begins a new one.
    pub fn finish(&mut self) -> impl Iterator<Item = &TickDetection> {
        match &mut self.looks {
            Some(looks) => looks.finish(),
            None => self.decode(true),
        }
        if let Some(held) = &mut self.held {
            held.finish();
        }
        if let Some(activities) = &mut self.activities {
            activities.finish();
        }
        self.reset();
        self.found()
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
