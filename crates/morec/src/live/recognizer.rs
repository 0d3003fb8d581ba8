//! The recogniser of a live stream, for every method. Batches rows if asked to, and measures its own time.

use std::sync::Arc;

use crate::TimeSpan;
use crate::classes::ClassId;
use crate::features::{BoneSet, KeyPose, Pushed};
use crate::templates::{ClassMatches, Deviation, EarlyDetectionParams, TemplateModel};

use super::detection::DetectionBuffer;
use super::pipeline::Pipeline;
use super::svrdm::SvrdmPipeline;
use super::template_pipeline::TemplatePipeline;
use super::{Detection, EarlyDetection, Model, RecognizerInput, StartError};

/// Recognises motions in one performer's stream of poses.
#[derive(Debug, Clone)]
pub struct Recognizer {
    model: Model,
    pipeline: Box<dyn Pipeline>,
    found: DetectionBuffer,
    now_secs: f64,
}

impl Recognizer {
    /// For a stream that offers `bones`; what a template model uses beyond them is left out of every comparison.
    ///
    /// Fails if the model's parts do not fit together, or no bone is left of a template model's.
    ///
    /// # Errors
    /// The model's parts do not fit together, or no bone of a template model is left.
    pub fn new<M: Clone + Into<Model>>(model: &M, bones: BoneSet) -> Result<Self, StartError> {
        let (model, pipeline) = pipeline(model.clone().into(), bones)?;
        Ok(Self {
            model,
            pipeline,
            found: DetectionBuffer::new(),
            now_secs: 0.0,
        })
    }

    /// A recogniser that decides between matches of the stream that will be pushed, found by all parts of an index and
    /// [merged](ClassMatches::merge); `model` is the first part.
    ///
    /// # Errors
    /// The model uses none of `bones`.
    pub fn replay(
        model: &TemplateModel,
        bones: BoneSet,
        matches: ClassMatches,
    ) -> Result<Self, StartError> {
        let pipeline = TemplatePipeline::replay(&Arc::new(model.clone()), bones, matches)?;
        Ok(Self {
            model: Model::Templates(pipeline.model.clone()),
            pipeline: Box::new(pipeline),
            found: DetectionBuffer::new(),
            now_secs: 0.0,
        })
    }

    /// The model in use, already without what the stream does not offer.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Seconds from the end of a motion to its report at the earliest: filters, windows, lag.
    pub fn latency_secs(&self) -> f64 {
        self.pipeline.latency_secs()
    }

    /// Takes the pose at `time_secs` on the stream's clock and returns what it settled, in order of time.
    ///
    /// Poses may come at any rate, also unevenly; late and duplicate ones are ignored. After a gap of more than
    /// [`MAX_GAP_SECS`](crate::features::MAX_GAP_SECS) the stream begins anew. No allocation.
    pub fn push<'p>(
        &mut self,
        time_secs: f64,
        pose: impl Into<RecognizerInput<'p>>,
    ) -> &[Detection] {
        self.found.begin(self.now_secs);
        if self.pipeline.breaks_at(time_secs) {
            self.pipeline.end_stretch(&mut self.found);
        }
        self.found.reported_secs = time_secs;
        let pushed = self.pipeline.push(time_secs, pose.into(), &mut self.found);
        if matches!(pushed, Pushed::Taken | Pushed::Restarted) {
            self.now_secs = time_secs;
        }
        &self.found.detections
    }

    /// Takes poses with their times, in order, and adds what they settled to `out`: the same detections as of
    /// pushing one by one. Allocates only if `out` has to grow.
    pub fn push_all(&mut self, poses: &[(f64, KeyPose)], out: &mut Vec<Detection>) {
        self.push_each(out, |each| {
            (poses.iter()).for_each(|(time_secs, pose)| each(*time_secs, pose.into()));
        });
    }

    /// [`push_all`](Self::push_all) of the poses that `poses` gives to the function it is called with.
    pub(super) fn push_each(
        &mut self,
        out: &mut Vec<Detection>,
        poses: impl FnOnce(&mut dyn FnMut(f64, RecognizerInput<'_>)),
    ) {
        self.pipeline.let_rows_wait(true, &mut self.found);
        poses(&mut |time_secs, pose| out.extend_from_slice(self.push(time_secs, pose)));
        self.found.begin(self.now_secs);
        self.pipeline.let_rows_wait(false, &mut self.found);
        out.extend_from_slice(&self.found.detections);
    }

    /// Ends the stream: returns what its last moments still hold. The next push begins a new stream, of any performer: nothing is
    /// kept of the one before.
    pub fn finish(&mut self) -> &[Detection] {
        self.found.begin(self.now_secs);
        self.pipeline.end_stretch(&mut self.found);
        self.pipeline.forget_performer();
        &self.found.detections
    }

    /// Detections that were lost because one push settled more than 64. None in practice: a push that follows a gap
    /// completes a second of ticks at most.
    pub fn dropped(&self) -> u64 {
        self.found.dropped
    }

    /// The motion that seems to be under way after the last push, if any. Tentative: it says nothing about what
    /// [`push`](Self::push) will report, and asking changes nothing of that. Templates only. No allocation.
    pub fn early_detection(&mut self) -> Option<EarlyDetection> {
        self.pipeline.early_detection()
    }

    /// Follows the progress of all classes from now on, so that [`progress`](Self::progress) can be asked for. Allocates.
    pub fn follow_progress(&mut self) {
        self.pipeline.follow_progress();
    }

    /// Gives `each` how far every class has come after the last push, in the order of classes, with its pace (its duration so far over that of
    /// the sample so far): nothing if no tick was completed since it was last asked. Score, progress and pace are 0 for classes that nothing is
    /// like. Templates only. No allocation.
    pub fn progress(&mut self, mut each: impl FnMut(EarlyDetection, f64)) {
        self.pipeline.progress(&mut each);
    }

    /// Remembers motion from now on, so that [`deviation`](Self::deviation) can be asked for. Allocates.
    pub fn measure_deviations(&mut self) {
        self.pipeline.measure_deviations();
    }

    /// How far a performance of `class` in `span`, of the last 20 s, was from the nearest sample; with `repetition`, one
    /// repetition of an activity. `None` if it was not [remembered](Self::measure_deviations) or no sample is kept: of held poses and of the
    /// method of 2009. No allocation. O(samples · rows²).
    pub fn deviation(
        &mut self,
        class: ClassId,
        span: TimeSpan,
        repetition: bool,
    ) -> Option<Deviation> {
        self.pipeline.deviation(class, span, repetition)
    }

    /// True while the relaxed gate for unseen performers is open: the performer's recognised motions are unlike the training subject's,
    /// or anyone is expected ([`Model::with_performer`]). Only for templates of one or two training subjects.
    pub fn admits_strangers(&self) -> bool {
        self.pipeline.admits_strangers()
    }

    /// Sets the limits of [`early_detection`](Self::early_detection).
    pub fn set_early(&mut self, params: EarlyDetectionParams) {
        self.pipeline.set_early(params);
    }
}

/// The pipeline of a model's method on a stream that shows `bones`, and the model as it is used there.
fn pipeline(model: Model, bones: BoneSet) -> Result<(Model, Box<dyn Pipeline>), StartError> {
    Ok(match model {
        Model::Templates(model) => {
            let pipeline = TemplatePipeline::new(&model, bones)?;
            let model = Model::Templates(pipeline.model.clone());
            (model, Box::new(pipeline))
        }
        Model::Svrdm(model) => {
            let pipeline = SvrdmPipeline::new(&model)?;
            (Model::Svrdm(model), Box::new(pipeline))
        }
    })
}
