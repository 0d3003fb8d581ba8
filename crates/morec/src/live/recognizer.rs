//! The template recogniser on a live stream.

use std::sync::Arc;

use crate::classes::ClassId;
use crate::decode::TickDetection;
use crate::features::{BoneSet, FeatureStream, KeyPose, Pushed};
use crate::templates::{EarlyParams, TemplateEngine, TemplateModel, TemplateModelError, Underway};

use super::Hunch;

/// Detections that one push can complete at most; more than a motion a tick is not a motion.
const MAX_DETECTIONS_PER_PUSH: usize = 64;

/// A motion recognised in a stream.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// What it is: an index into the model's classes.
    pub class: ClassId,
    /// When it began, on the stream's clock.
    pub start_secs: f64,
    /// When it ended.
    pub stop_secs: f64,
    /// 0 just accepted … 1 identical to a sample.
    pub score: f64,
    /// The stream's clock when it was reported: the time of the pose that settled it.
    pub reported_secs: f64,
}

/// Recognises motions in one performer's stream of poses.
#[derive(Debug)]
pub struct Recognizer {
    model: Arc<TemplateModel>,
    features: FeatureStream,
    engine: TemplateEngine,
    found: Vec<Detection>,
    now_secs: f64,
    early: EarlyParams,
    seen: Seen,
}

/// What was under way at the last tick that was asked about.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    ticks: usize,
    underway: Option<Underway>,
    /// Ticks in a row at which it was this class.
    streak: usize,
}

impl Seen {
    fn take(&mut self, ticks: usize, underway: Option<Underway>) {
        let same = ticks > self.ticks && underway.map(|u| u.class) == self.underway.map(|u| u.class);
        self.streak = if same { self.streak + 1 } else { 1 };
        (self.ticks, self.underway) = (ticks, underway);
    }
}

impl Clone for Recognizer {
    /// A copy in the same state; by hand, because a copied vector has room only for what it holds.
    fn clone(&self) -> Self {
        let mut found = Vec::with_capacity(MAX_DETECTIONS_PER_PUSH);
        found.extend_from_slice(&self.found);
        Self {
            model: self.model.clone(),
            features: self.features.clone(),
            engine: self.engine.clone(),
            found,
            now_secs: self.now_secs,
            early: self.early,
            seen: self.seen,
        }
    }
}

impl Recognizer {
    /// For a stream that offers `bones`; what the index uses beyond them is left out of every comparison.
    ///
    /// Fails if the model's parts do not fit together or no bone is left.
    pub fn new(model: &Arc<TemplateModel>, bones: BoneSet) -> Result<Self, TemplateModelError> {
        let model = if model.bones.and(bones) == model.bones {
            model.clone()
        } else {
            Arc::new(model.restricted(bones)?)
        };
        Ok(Self {
            features: FeatureStream::new(model.bones, &model.features),
            engine: TemplateEngine::new(&model)?,
            found: Vec::with_capacity(MAX_DETECTIONS_PER_PUSH),
            now_secs: 0.0,
            early: EarlyParams::default(),
            seen: Seen::default(),
            model,
        })
    }

    /// The model in use, already without what the stream does not offer.
    pub fn model(&self) -> &TemplateModel {
        &self.model
    }

    /// Seconds from the end of a motion to its report at the earliest: filters, peak and gate windows, lag.
    pub fn latency_secs(&self) -> f64 {
        let features = &self.model.features;
        // A row stands at its tick's last frame; the tick itself ends one frame later.
        let filters = (features.look_ahead_frames() - 1) as f64 / features.rate_hz;
        filters + self.model.decode.look_ahead_ticks(self.model.rule()) as f64 / features.tick_hz()
    }

    /// Takes the pose at `time_secs` on the stream's clock and returns what it settled, in order of time.
    ///
    /// Poses may come at any rate, also unevenly; late and duplicate ones are ignored. After a gap of more than
    /// [`MAX_GAP_SECS`](crate::features::MAX_GAP_SECS) the stream begins anew. No allocation.
    pub fn push(&mut self, time_secs: f64, pose: &KeyPose) -> &[Detection] {
        self.found.clear();
        if self.features.breaks_at(time_secs) {
            self.end_stretch();
        }
        let (engine, found) = (&mut self.engine, &mut self.found);
        let tick_secs = 1.0 / self.model.features.tick_hz();
        // The first pose of a stretch sets its origin and completes no row: the origin read here is right.
        let origin_secs = self.features.origin_secs();
        let pushed = self.features.push(time_secs, pose, &mut |row| {
            engine.push(row, &mut |d| report(found, d, origin_secs, tick_secs, time_secs));
        });
        if matches!(pushed, Pushed::Taken | Pushed::Restarted) {
            self.now_secs = time_secs;
        }
        &self.found
    }

    /// Takes poses with their times, in order, and adds what they settled to `out`: the same detections as of
    /// pushing one by one. Allocates only if `out` has to grow.
    pub fn push_all(&mut self, poses: &[(f64, KeyPose)], out: &mut Vec<Detection>) {
        for (time_secs, pose) in poses {
            out.extend_from_slice(self.push(*time_secs, pose));
        }
    }

    /// Ends the stream: returns what its last moments still hold. The next push begins a new stream.
    pub fn finish(&mut self) -> &[Detection] {
        self.found.clear();
        self.end_stretch();
        &self.found
    }

    /// What seems to be under way after the last push, if anything does. Tentative: it says nothing about what
    /// [`push`](Self::push) will report, and asking changes nothing of that. No allocation.
    pub fn hunch(&mut self) -> Option<Hunch> {
        let ticks = self.engine.ticks();
        if ticks != self.seen.ticks {
            let underway = self.engine.underway(&self.early);
            self.seen.take(ticks, underway);
        }
        let underway = self.seen.underway.filter(|_| self.seen.streak >= self.early.streak)?;
        let tick_secs = 1.0 / self.model.features.tick_hz();
        let seen_secs = self.features.origin_secs() + ticks as f64 * tick_secs;
        Some(Hunch {
            class: underway.class,
            score: 1.0 - f64::from(underway.distance / (self.early.reach * self.engine.threshold())),
            progress: f64::from(underway.progress),
            start_secs: seen_secs - (underway.age + 1) as f64 * tick_secs,
            seen_secs,
        })
    }

    /// How near a beginning must be for [`hunch`](Self::hunch).
    pub fn set_early(&mut self, params: EarlyParams) {
        self.early = params;
    }

    fn end_stretch(&mut self) {
        let (engine, found, now_secs) = (&mut self.engine, &mut self.found, self.now_secs);
        let tick_secs = 1.0 / self.model.features.tick_hz();
        let origin_secs = self.features.origin_secs();
        let mut out = |d: TickDetection| report(found, d, origin_secs, tick_secs, now_secs);
        self.features.finish(&mut |row| engine.push(row, &mut out));
        engine.finish(&mut out);
    }
}

fn report(found: &mut Vec<Detection>, d: TickDetection, origin_secs: f64, tick_secs: f64, now_secs: f64) {
    // The buffer never grows: pushing must not allocate.
    if found.len() < found.capacity() {
        found.push(Detection {
            class: d.class,
            start_secs: origin_secs + d.start as f64 * tick_secs,
            stop_secs: origin_secs + d.stop as f64 * tick_secs,
            score: d.score,
            reported_secs: now_secs,
        });
    }
}
