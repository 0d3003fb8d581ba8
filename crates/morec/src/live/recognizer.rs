//! The recogniser on a live stream, whatever the method.

use std::sync::Arc;

use crate::features::{BoneSet, KeyPose, Pushed};
use crate::templates::{ClassMatches, EarlyDetectionParams, TemplateModel};

use super::detection::DetectionBuffer;
use super::paths::{SvrdmPipeline, TemplatePipeline};
use super::{Detection, EarlyDetection, Model, RecognizerInput, StartError};

/// Recognises motions in one performer's stream of poses.
#[derive(Debug, Clone)]
pub struct Recognizer {
    model: Model,
    path: Pipeline,
    found: DetectionBuffer,
    now_secs: f64,
}

#[derive(Debug, Clone)]
enum Pipeline {
    Templates(Box<TemplatePipeline>),
    Svrdm(Box<SvrdmPipeline>),
}

impl Recognizer {
    /// For a stream that offers `bones`; what a template model uses beyond them is left out of every comparison.
    ///
    /// Fails if the model's parts do not fit together, or no bone is left of a template model's.
    ///
    /// # Errors
    /// The model's parts do not fit together, or no bone of a template model is left.
    pub fn new<M: Clone + Into<Model>>(model: &M, bones: BoneSet) -> Result<Self, StartError> {
        let model = model.clone().into();
        let (model, path) = match model {
            Model::Templates(model) => {
                let path = TemplatePipeline::new(&model, bones)?;
                (
                    Model::Templates(path.model.clone()),
                    Pipeline::Templates(Box::new(path)),
                )
            }
            Model::Svrdm(model) => {
                let path = SvrdmPipeline::new(&model)?;
                (Model::Svrdm(model), Pipeline::Svrdm(Box::new(path)))
            }
        };
        Ok(Self {
            model,
            path,
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
        let path = TemplatePipeline::replay(&Arc::new(model.clone()), bones, matches)?;
        Ok(Self {
            model: Model::Templates(path.model.clone()),
            path: Pipeline::Templates(Box::new(path)),
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
        match &self.path {
            Pipeline::Templates(path) => path.latency_secs(),
            Pipeline::Svrdm(path) => path.latency_secs(),
        }
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
        if self.breaks_at(time_secs) {
            self.end_stretch();
        }
        self.found.reported_secs = time_secs;
        let (pose, found) = (pose.into(), &mut self.found);
        let pushed = match &mut self.path {
            Pipeline::Templates(path) => path.push(time_secs, pose, found),
            Pipeline::Svrdm(path) => path.push(time_secs, pose, found),
        };
        if matches!(pushed, Pushed::Taken | Pushed::Restarted) {
            self.now_secs = time_secs;
        }
        &self.found.detections
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
        self.found.begin(self.now_secs);
        self.end_stretch();
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
        match &mut self.path {
            Pipeline::Templates(path) => path.early_detection(),
            Pipeline::Svrdm(_) => None,
        }
    }

    /// Sets the limits of [`early_detection`](Self::early_detection).
    pub fn set_early(&mut self, params: EarlyDetectionParams) {
        if let Pipeline::Templates(path) = &mut self.path {
            path.set_early(params);
        }
    }

    fn breaks_at(&self, time_secs: f64) -> bool {
        match &self.path {
            Pipeline::Templates(path) => path.breaks_at(time_secs),
            Pipeline::Svrdm(path) => path.breaks_at(time_secs),
        }
    }

    fn end_stretch(&mut self) {
        match &mut self.path {
            Pipeline::Templates(path) => path.end_stretch(&mut self.found),
            Pipeline::Svrdm(path) => path.end_stretch(&mut self.found),
        }
    }
}
