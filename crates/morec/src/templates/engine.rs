//! The engine of the method templates: feature rows in, detections in ticks out.

use crate::decode::TickDetection;
use crate::features::{RowLayout, Rows};

use super::activities::ActivityDetector;
use super::class_matches::{ClassMatches, MatchReplay};
use super::dot::AT_ONCE;
use super::early::{EarlyDetectionParams, OngoingMatch};
use super::gestures::{GestureDetector, Matches};
use super::held::HoldDetector;
use super::{Calibration, ClassMatcher, Metric, TemplateModel, TemplateModelError};

/// The part of recognition that knows no clock. Each kind of class has a detector of its own, and all see every row: gestures are
/// matched with templates, poses are held for a while, activities go on for several seconds.
#[derive(Debug, Clone)]
pub struct TemplateEngine {
    gestures: GestureDetector,
    held: Option<Box<HoldDetector>>,
    activities: Option<Box<ActivityDetector>>,
    threshold: f32,
    /// Taken since the stretch began.
    ticks: usize,
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
        let matches = matches(&metric);
        let held = model.held.as_ref();
        let activities = model.activities.as_ref();
        Ok(Self {
            gestures: GestureDetector::new(model, longest, metric, matches),
            held: held.map(|held| Box::new(HoldDetector::new(held))),
            activities: activities.map(|activities| {
                let layout = RowLayout::of(model.bones);
                let detector = ActivityDetector::new(activities, layout, model.features.tick_hz());
                // The map of distances' margins holds for windows' as well, and they are never verified.
                let calibration = model.calibration.map(|_| Calibration::MEASURED);
                Box::new(detector.calibrated(calibration))
            }),
            threshold: model.threshold,
            ticks: 0,
        })
    }

    /// True while the wider gate is open: the performer moves unlike the teacher, or anyone is expected.
    pub fn is_open(&self) -> bool {
        self.gestures.is_open()
    }

    /// Forgets the stream so far, but not the performer.
    pub fn reset(&mut self) {
        self.gestures.reset();
        if let Some(held) = &mut self.held {
            held.reset();
        }
        if let Some(activities) = &mut self.activities {
            activities.reset();
        }
        self.ticks = 0;
    }

    /// Forgets how the performer moves: the next row may be another performer's.
    pub fn forget_performer(&mut self) {
        self.gestures.forget_performer();
    }

    /// Says how much of noise the rows that come hold: [`FeatureStream::noise_gain`](crate::features::FeatureStream::noise_gain).
    pub fn set_noise_gain(&mut self, gain: f32) {
        self.gestures.set_noise_gain(gain);
    }

    /// Takes the next tick's row and returns the detections that are now certain. No allocation.
    pub fn push(&mut self, row: &[f32]) -> impl Iterator<Item = &TickDetection> {
        self.advance(row);
        self.decide(0, row)
    }

    /// Takes the rows of the next ticks, one after the other, [`AT_ONCE`] at most. What each makes certain comes from
    /// [`decide`](Self::decide), which must be called for each in turn: the same as of pushing one by one, and faster.
    pub fn advance(&mut self, rows: &[f32]) {
        self.gestures.advance(rows);
    }

    /// The detections that are certain with `row`, the `at`th of those that it last advanced by. No allocation.
    pub fn decide(&mut self, at: usize, row: &[f32]) -> impl Iterator<Item = &TickDetection> {
        self.ticks += 1;
        if let Some(held) = &mut self.held {
            held.push(row);
        }
        if let Some(activities) = &mut self.activities {
            activities.push(row);
        }
        self.gestures.decide(at, row);
        self.found()
    }

    /// Recognises a whole stretch: takes its rows, ends it, and calls `take` with each detection. The same as [`push`](Self::push) for each row
    /// and [`finish`](Self::finish), but faster: templates are read from memory once for [`AT_ONCE`] rows.
    pub fn detect(&mut self, rows: &Rows, mut take: impl FnMut(&TickDetection)) {
        let dim = rows.dim();
        for ticks in rows.values().chunks(AT_ONCE * dim) {
            self.advance(ticks);
            for (at, row) in ticks.chunks_exact(dim).enumerate() {
                self.decide(at, row).for_each(&mut take);
            }
        }
        self.finish().for_each(take);
    }

    /// Ends the stretch and returns the detections that its last ticks still hold. The next row begins a new one.
    pub fn finish(&mut self) -> impl Iterator<Item = &TickDetection> {
        self.gestures.finish();
        if let Some(held) = &mut self.held {
            held.finish();
        }
        if let Some(activities) = &mut self.activities {
            activities.finish();
        }
        self.reset();
        self.found()
    }

    fn found(&self) -> impl Iterator<Item = &TickDetection> {
        let held = self.held.as_ref().and_then(|held| held.found());
        let activities = self.activities.iter().flat_map(|a| a.found());
        self.gestures.found().iter().chain(held).chain(activities)
    }

    /// Ticks taken since the stretch began.
    pub fn ticks(&self) -> usize {
        self.ticks
    }

    /// The class whose beginning is nearest at the last tick, if one is within the bounds of `params`. O(template rows),
    /// no allocation; changes nothing. None on matches from elsewhere.
    pub fn underway(&self, params: &EarlyDetectionParams) -> Option<OngoingMatch> {
        let matcher = self.gestures.matcher()?;
        let (held, activity) = self.others_underway(params);
        // What begins within an activity is reported at its end: one tentative motion at a time.
        activity
            .or_else(|| matcher.underway(params, self.threshold))
            .or(held)
    }

    /// Puts what is nearest of each class at the last tick into the class's place in `nearest`: the beginning of a gesture, a pose that is held, an
    /// activity that goes on. O(template rows), no allocation; changes nothing else. Nothing on matches from elsewhere.
    pub fn progress(&self, params: &EarlyDetectionParams, nearest: &mut [Option<OngoingMatch>]) {
        nearest.fill(None);
        if let Some(matcher) = self.gestures.matcher() {
            matcher.progress(params, nearest);
        }
        let (held, activity) = self.others_underway(params);
        for found in held.into_iter().chain(activity) {
            nearest[found.class.index()] = Some(found);
        }
    }

    /// The pose that is held and the activity that goes on.
    fn others_underway(
        &self,
        params: &EarlyDetectionParams,
    ) -> (Option<OngoingMatch>, Option<OngoingMatch>) {
        let farthest = params.reach * self.threshold;
        let held = self.held.as_ref().and_then(|held| held.underway(farthest));
        let activity = self.activities.as_ref();
        (held, activity.and_then(|a| a.underway(farthest)))
    }

    /// Distances at or above this are never reported.
    pub fn threshold(&self) -> f32 {
        self.threshold
    }
}
