//! Feature rows and templates on one stream.

use std::sync::Arc;

use crate::TimeSpan;
use crate::classes::ClassId;
use crate::features::{BoneSet, FeatureStream, Pushed, RowLayout};
use crate::templates::{
    AT_ONCE, ClassMatches, Deviation, EarlyDetectionParams, OngoingMatch, TemplateEngine,
    TemplateModel, TemplateSample,
};

use super::detection::{DetectionBuffer, Steps};
use super::performance_memory::PerformanceMemory;
use super::pipeline::Pipeline;
use super::start::check_shown;
use super::{EarlyDetection, RecognizerInput, StartError};

/// Feature rows and templates.
#[derive(Debug, Clone)]
pub(super) struct TemplatePipeline {
    pub(super) model: Arc<TemplateModel>,
    features: FeatureStream,
    engine: TemplateEngine,
    waiting: WaitingRows,
    early: EarlyDetectionParams,
    seen: PartialMatchTracker,
    /// Only where performances are compared with samples.
    memory: Option<Box<PerformanceMemory>>,
    /// Only where progress is followed.
    progress: Option<Box<ClassProgress>>,
}

/// The nearest beginning of each class at the last tick that was asked about.
#[derive(Debug, Clone)]
struct ClassProgress {
    ticks: usize,
    nearest: Vec<Option<OngoingMatch>>,
}

/// Rows that wait until there are as many as are matched at once.
#[derive(Debug, Clone)]
struct WaitingRows {
    values: Vec<f32>,
    /// Of each row, what noise it holds and the time of the pose that completed it.
    notes: [(f32, f64); AT_ONCE],
    count: usize,
    /// As many are matched at once.
    most: usize,
}

impl WaitingRows {
    /// None, of `dim` values; none will wait.
    fn new(dim: usize) -> Self {
        Self {
            values: vec![0.0; AT_ONCE * dim],
            notes: [(0.0, 0.0); AT_ONCE],
            count: 0,
            most: 1,
        }
    }

    fn push(&mut self, row: &[f32], noise_gain: f32, reported_secs: f64) {
        self.values[self.count * row.len()..][..row.len()].copy_from_slice(row);
        self.notes[self.count] = (noise_gain, reported_secs);
        self.count += 1;
    }
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
            waiting: WaitingRows::new(RowLayout::of(model.bones).dim()),
            features: FeatureStream::new(model.bones, &model.features),
            engine,
            model,
            early: EarlyDetectionParams::default(),
            seen: PartialMatchTracker::default(),
            memory: None,
            progress: None,
        }
    }

    /// Detections of the rows that are complete, but for those that wait.
    fn recognise_rows(&mut self, found: &mut DetectionBuffer) {
        loop {
            let noise_gain = self.features.noise_gain();
            let origin_secs = self.features.origin_secs();
            let Some(row) = self.features.next_row() else {
                break;
            };
            if let Some(memory) = &mut self.memory {
                memory.push(row, origin_secs);
            }
            self.waiting.push(row, noise_gain, found.reported_secs);
            if self.waiting.count == self.waiting.most {
                self.recognise_waiting(found);
            }
        }
    }

    /// Detections of the rows that wait, reported at the times of their poses.
    fn recognise_waiting(&mut self, found: &mut DetectionBuffer) {
        let steps = self.steps();
        let now_secs = found.reported_secs;
        let WaitingRows {
            values,
            notes,
            count,
            ..
        } = &mut self.waiting;
        let dim = self.features.dim();
        let values = &values[..*count * dim];
        self.engine.advance(values);
        for (at, row) in values.chunks_exact(dim).enumerate() {
            let (noise_gain, reported_secs) = notes[at];
            self.engine.set_noise_gain(noise_gain);
            found.reported_secs = reported_secs;
            for d in self.engine.decide(at, row) {
                found.add(d.class, steps, (d.start, d.stop), d.score, d.repetitions);
            }
        }
        *count = 0;
        found.reported_secs = now_secs;
    }

    /// The source's clock at a tick.
    fn secs_at(&self, ticks: usize) -> f64 {
        self.features.origin_secs() + ticks as f64 / self.model.features.tick_hz()
    }

    /// What is under way at a tick, on the source's clock.
    fn at_tick(&self, underway: &OngoingMatch, ticks: usize) -> EarlyDetection {
        let farthest = self.early.reach * self.engine.threshold();
        let (tick_secs, seen_secs) = (1.0 / self.model.features.tick_hz(), self.secs_at(ticks));
        EarlyDetection {
            class: underway.class,
            score: 1.0 - f64::from(underway.distance / farthest),
            progress: f64::from(underway.progress),
            start_secs: seen_secs - (underway.age + 1) as f64 * tick_secs,
            seen_secs,
            goes_on: underway.goes_on,
            repetitions: underway.repetitions,
            whole: (underway.whole).map(|(count, ticks)| (count, seen_secs - ticks * tick_secs)),
        }
    }

    /// Nothing of a class at a tick.
    fn nothing_of(&self, class: ClassId, ticks: usize) -> EarlyDetection {
        let seen_secs = self.secs_at(ticks);
        EarlyDetection {
            class,
            score: 0.0,
            progress: 0.0,
            start_secs: seen_secs,
            seen_secs,
            goes_on: false,
            repetitions: None,
            whole: None,
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
        self.recognise_waiting(found);
        let steps = self.steps();
        for d in self.engine.finish() {
            found.add(d.class, steps, (d.start, d.stop), d.score, d.repetitions);
        }
        self.features.reset();
        if let Some(memory) = &mut self.memory {
            memory.end();
        }
    }

    fn let_rows_wait(&mut self, wait: bool, found: &mut DetectionBuffer) {
        self.waiting.most = if wait { AT_ONCE } else { 1 };
        if !wait {
            self.recognise_waiting(found);
        }
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
        Some(self.at_tick(&underway, ticks))
    }

    fn follow_progress(&mut self) {
        self.progress = Some(Box::new(ClassProgress {
            ticks: 0,
            nearest: vec![None; self.model.classes.len()],
        }));
    }

    fn progress(&mut self, each: &mut dyn FnMut(EarlyDetection, f64)) {
        let ticks = self.engine.ticks();
        let Some(mut progress) = self.progress.take() else {
            return;
        };
        if ticks != progress.ticks {
            progress.ticks = ticks;
            self.engine.progress(&self.early, &mut progress.nearest);
            for (class, nearest) in (0..).map(ClassId).zip(&progress.nearest) {
                let alike = nearest.map(|n| (self.at_tick(&n, ticks), f64::from(n.pace)));
                let alike = alike.filter(|(now, _)| now.score > 0.0);
                let (now, pace) = alike.unwrap_or_else(|| (self.nothing_of(class, ticks), 0.0));
                each(now, pace);
            }
        }
        self.progress = Some(progress);
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

    fn measure_deviations(&mut self) {
        self.memory = Some(Box::new(PerformanceMemory::new(&self.model)));
    }

    fn deviation(&mut self, class: ClassId, span: TimeSpan, repetition: bool) -> Option<Deviation> {
        let memory = self.memory.as_mut()?;
        let samples = match repetition {
            true => &self.model.activities.as_ref()?.repetitions,
            false => &self.model.samples,
        };
        memory.compare(span, TemplateSample::rows_of(samples, class), repetition)
    }

    fn boxed(&self) -> Box<dyn Pipeline> {
        Box::new(self.clone())
    }
}

/// The model for a stream that shows `bones`; the same if that is all of them.
pub(crate) fn restricted(
    model: &Arc<TemplateModel>,
    bones: BoneSet,
) -> Result<Arc<TemplateModel>, StartError> {
    if model.bones.and(bones) == model.bones {
        return Ok(model.clone());
    }
    check_shown(model.bones, bones)?;
    Ok(Arc::new(model.restricted(bones)?))
}
