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
    /// A recogniser for a stream with `bones`. Other bones of a template model are left out of all comparisons.
    ///
    /// # Errors
    /// The parts of the model do not fit together, or a template model has none of `bones`.
    pub fn new<M: Clone + Into<Model>>(model: &M, bones: BoneSet) -> Result<Self, StartError> {
        let (model, pipeline) = pipeline(model.clone().into(), bones)?;
        Ok(Self {
            model,
            pipeline,
            found: DetectionBuffer::new(),
            now_secs: 0.0,
        })
    }

    /// A recogniser for an index that is divided among machines: decides between the matches found by all parts of the index and
    /// [merged](ClassMatches::merge), while the same stream is pushed again. `model` is the first part.
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

    /// The model in use, without the bones that the stream lacks.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Shortest time from the end of a motion to its report, seconds: the sum of filters, windows and lag.
    pub fn latency_secs(&self) -> f64 {
        self.pipeline.latency_secs()
    }

    /// Processes the pose at `time_secs` on the stream's clock and returns the detections that it completes, in order of time.
    ///
    /// Poses may have any rate, also an irregular one; late and duplicate poses are ignored. After a gap of more than
    /// [`MAX_GAP_SECS`](crate::features::MAX_GAP_SECS) seconds the stream starts again. Allocates no memory.
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

    /// Processes poses with their times, in order, and appends the detections that they complete to `out`: the same as with
    /// [`push`](Self::push), one by one. Allocates only if `out` has to grow.
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

    /// Ends the stream and returns its last detections. The next push starts a new stream, of any performer: nothing of the
    /// previous stream is kept.
    pub fn finish(&mut self) -> &[Detection] {
        self.found.begin(self.now_secs);
        self.pipeline.end_stretch(&mut self.found);
        self.pipeline.forget_performer();
        &self.found.detections
    }

    /// Number of detections lost because one push completed more than 64. In practice 0: a push after a gap completes at
    /// most one second of ticks.
    pub fn dropped(&self) -> u64 {
        self.found.dropped
    }

    /// The motion that is probably being performed at the last push, if any. Tentative: it neither predicts nor changes what
    /// [`push`](Self::push) will report. Method templates only. Allocates no memory.
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

    /// Keeps the last seconds of motion from now on, as [`deviation`](Self::deviation) requires. Allocates memory.
    pub fn measure_deviations(&mut self) {
        self.pipeline.measure_deviations();
    }

    /// Compares a performance of `class` in `span`, within the last 20 s, with the nearest sample; with `repetition`, one
    /// repetition of an activity. `None` if the motion was not [kept](Self::measure_deviations), and for held poses and the method svrdm.
    /// Allocates no memory. O(samples · rows²).
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
