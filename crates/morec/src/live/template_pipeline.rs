//! Feature rows and templates on one stream.

use std::sync::Arc;

use crate::features::{BoneSet, FeatureStream, Pushed};
use crate::templates::{
    ClassMatches, EarlyDetectionParams, OngoingMatch, TemplateEngine, TemplateModel,
};

use super::detection::{DetectionBuffer, Steps};
use super::pipeline::Pipeline;
use super::start::check_shown;
use super::{EarlyDetection, RecognizerInput, StartError};

/// Feature rows and templates.
#[derive(Debug, Clone)]
pub(super) struct TemplatePipeline {
    pub(super) model: Arc<TemplateModel>,
    features: FeatureStream,
    engine: TemplateEngine,
    early: EarlyDetectionParams,
    seen: PartialMatchTracker,
}

/// The partial match at the last tick that was asked about.
#[derive(Debug, Clone, Copy, Default)]
struct PartialMatchTracker {
    ticks: usize,
    underway: Option<OngoingMatch>,
    /// Ticks in a row at which it was this class.
    streak: usize,
}

impl PartialMatchTracker {
    fn take(&mut self, ticks: usize, underway: Option<OngoingMatch>) {
        let same =
            ticks > self.ticks && underway.map(|u| u.class) == self.underway.map(|u| u.class);
        self.streak = if same { self.streak + 1 } else { 1 };
        (self.ticks, self.underway) = (ticks, underway);
    }
}

impl TemplatePipeline {
    pub(super) fn new(model: &Arc<TemplateModel>, bones: BoneSet) -> Result<Self, StartError> {
        let model = restricted(model, bones)?;
        let engine = TemplateEngine::new(&model)?;
        Ok(Self::with(model, engine))
    }

    /// On matches from elsewhere, of the stream that will be pushed.
    pub(super) fn replay(
        model: &Arc<TemplateModel>,
        bones: BoneSet,
        matches: ClassMatches,
    ) -> Result<Self, StartError> {
        let model = restricted(model, bones)?;
        let engine = TemplateEngine::replay(&model, matches)?;
        Ok(Self::with(model, engine))
    }

    fn with(model: Arc<TemplateModel>, engine: TemplateEngine) -> Self {
        Self {
            features: FeatureStream::new(model.bones, &model.features),
            engine,
            model,
            early: EarlyDetectionParams::default(),
            seen: PartialMatchTracker::default(),
        }
    }

    /// Detections of the rows that are complete.
    fn recognise_rows(&mut self, found: &mut DetectionBuffer) {
        let steps = self.steps();
        loop {
            self.engine.set_noise_gain(self.features.noise_gain());
            let Some(row) = self.features.next_row() else {
                break;
            };
            for d in self.engine.push(row) {
                found.add(d.class, steps, (d.start, d.stop), d.score, d.repetitions);
            }
        }
    }

    fn steps(&self) -> Steps {
        let rate_hz = self.model.features.tick_hz();
        Steps::at_rate(self.features.origin_secs(), rate_hz)
    }
}

impl Pipeline for TemplatePipeline {
    fn latency_secs(&self) -> f64 {
        let features = &self.model.features;
        // A row stands at its tick's last frame; the tick itself ends one frame later.
        let filters = (features.look_ahead_frames() - 1) as f64 / features.rate_hz;
        filters + self.model.decode.look_ahead_ticks(self.model.rule()) as f64 / features.tick_hz()
    }

    fn breaks_at(&self, time_secs: f64) -> bool {
        self.features.breaks_at(time_secs)
    }

    fn push(
        &mut self,
        time_secs: f64,
        pose: RecognizerInput<'_>,
        found: &mut DetectionBuffer,
    ) -> Pushed {
        let pushed = self.features.take(time_secs, pose.key);
        self.recognise_rows(found);
        pushed
    }

    fn end_stretch(&mut self, found: &mut DetectionBuffer) {
        self.features.end();
        self.recognise_rows(found);
        let steps = self.steps();
        for d in self.engine.finish() {
            found.add(d.class, steps, (d.start, d.stop), d.score, d.repetitions);
        }
        self.features.reset();
    }

    fn early_detection(&mut self) -> Option<EarlyDetection> {
        let ticks = self.engine.ticks();
        if ticks != self.seen.ticks {
            let underway = self.engine.underway(&self.early);
            self.seen.take(ticks, underway);
        }
        let underway = self
            .seen
            .underway
            .filter(|_| self.seen.streak >= self.early.streak)?;
        let tick_secs = 1.0 / self.model.features.tick_hz();
        let seen_secs = self.features.origin_secs() + ticks as f64 * tick_secs;
        Some(EarlyDetection {
            class: underway.class,
            score: 1.0
                - f64::from(underway.distance / (self.early.reach * self.engine.threshold())),
            progress: f64::from(underway.progress),
            start_secs: seen_secs - (underway.age + 1) as f64 * tick_secs,
            seen_secs,
            goes_on: underway.goes_on,
            repetitions: underway.repetitions,
            whole: (underway.whole).map(|(count, ticks)| (count, seen_secs - ticks * tick_secs)),
        })
    }

    fn admits_strangers(&self) -> bool {
        self.engine.is_open()
    }

    fn forget_performer(&mut self) {
        self.engine.forget_performer();
    }

    fn set_early(&mut self, params: EarlyDetectionParams) {
        self.early = params;
    }

    fn boxed(&self) -> Box<dyn Pipeline> {
        Box::new(self.clone())
    }
}

/// The model for a stream that shows `bones`; the same if that is all of them.
fn restricted(
    model: &Arc<TemplateModel>,
    bones: BoneSet,
) -> Result<Arc<TemplateModel>, StartError> {
    if model.bones.and(bones) == model.bones {
        return Ok(model.clone());
    }
    check_shown(model.bones, bones)?;
    Ok(Arc::new(model.restricted(bones)?))
}
