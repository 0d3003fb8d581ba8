//! From poses to detections by each method: what a [`Recognizer`](super::Recognizer) runs inside.

use std::sync::Arc;

use crate::decode::TickDetection;
use crate::features::{BoneSet, FeatureStream, Pushed};
use crate::pivots::{PivotPose, PoseStream};
use crate::svrdm::{FrameDetection, SvrdmEngine, SvrdmModel};
use crate::templates::{EarlyDetectionParams, OngoingMatch, TemplateEngine, TemplateModel};

use super::recognizer::{DetectionBuffer, Steps};
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

/// What was under way at the last tick that was asked about.
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
        let model = if model.bones.and(bones) == model.bones {
            model.clone()
        } else {
            Arc::new(model.restricted(bones)?)
        };
        let features = FeatureStream::new(model.bones, &model.features);
        let (early, seen) = (
            EarlyDetectionParams::default(),
            PartialMatchTracker::default(),
        );
        Ok(Self {
            features,
            engine: TemplateEngine::new(&model)?,
            model,
            early,
            seen,
        })
    }

    pub(super) fn latency_secs(&self) -> f64 {
        let features = &self.model.features;
        // A row stands at its tick's last frame; the tick itself ends one frame later.
        let filters = (features.look_ahead_frames() - 1) as f64 / features.rate_hz;
        filters + self.model.decode.look_ahead_ticks(self.model.rule()) as f64 / features.tick_hz()
    }

    pub(super) fn breaks_at(&self, time_secs: f64) -> bool {
        self.features.breaks_at(time_secs)
    }

    pub(super) fn push(
        &mut self,
        time_secs: f64,
        pose: RecognizerInput<'_>,
        found: &mut DetectionBuffer,
    ) -> Pushed {
        // The first pose of a stretch sets its origin and completes no row: the origin read here is right.
        let (steps, engine) = (self.steps(), &mut self.engine);
        self.features.push(time_secs, pose.key, &mut |row| {
            engine.push(row, &mut |d| {
                found.add(d.class, steps, d.start, d.stop, d.score)
            });
        })
    }

    pub(super) fn end_stretch(&mut self, found: &mut DetectionBuffer) {
        let (steps, engine) = (self.steps(), &mut self.engine);
        let mut out = |d: TickDetection| found.add(d.class, steps, d.start, d.stop, d.score);
        self.features.finish(&mut |row| engine.push(row, &mut out));
        engine.finish(&mut out);
    }

    fn steps(&self) -> Steps {
        let step_secs = 1.0 / self.model.features.tick_hz();
        Steps {
            origin_secs: self.features.origin_secs(),
            step_secs,
        }
    }

    pub(super) fn hunch(&mut self) -> Option<EarlyDetection> {
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
        })
    }

    pub(super) fn set_early(&mut self, params: EarlyDetectionParams) {
        self.early = params;
    }
}

/// Pose rows and the stages of the thesis.
#[derive(Debug, Clone)]
pub(super) struct SvrdmPipeline {
    rows: PoseStream,
    engine: SvrdmEngine,
}

impl SvrdmPipeline {
    pub(super) fn new(model: &Arc<SvrdmModel>) -> Result<Self, StartError> {
        let engine = SvrdmEngine::new(model)?;
        Ok(Self {
            rows: PoseStream::new(&model.pivots, &model.pose),
            engine,
        })
    }

    /// A segment is compared with those that end a chunk later, and a row waits for the frame after it.
    pub(super) fn latency_secs(&self) -> f64 {
        (self.engine.latency_frames() + 1) as f64 / self.engine.model().rate_hz()
    }

    pub(super) fn breaks_at(&self, time_secs: f64) -> bool {
        self.rows.breaks_at(time_secs)
    }

    pub(super) fn push(
        &mut self,
        time_secs: f64,
        pose: RecognizerInput<'_>,
        found: &mut DetectionBuffer,
    ) -> Pushed {
        let (steps, engine) = (self.steps(), &mut self.engine);
        let unknown;
        let pivots = match pose.pivots {
            Some(pivots) => pivots,
            None => {
                unknown = PivotPose::default();
                &unknown
            }
        };
        self.rows.push(time_secs, pivots, &mut |row| {
            engine.push(row, &mut |d| {
                found.add(d.class, steps, d.start, d.stop, d.score)
            });
        })
    }

    pub(super) fn end_stretch(&mut self, found: &mut DetectionBuffer) {
        let (steps, engine) = (self.steps(), &mut self.engine);
        let mut out = |d: FrameDetection| found.add(d.class, steps, d.start, d.stop, d.score);
        self.rows.finish(&mut |row| engine.push(row, &mut out));
        engine.finish(&mut out);
    }

    fn steps(&self) -> Steps {
        let step_secs = 1.0 / self.engine.model().rate_hz();
        Steps {
            origin_secs: self.rows.origin_secs(),
            step_secs,
        }
    }
}
