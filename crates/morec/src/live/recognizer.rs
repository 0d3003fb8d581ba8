//! The recogniser on a live stream, whatever the method.

use std::fmt;

use crate::classes::ClassId;
use crate::features::{BoneSet, KeyPose, Pushed};
use crate::templates::EarlyDetectionParams;

use super::paths::{SvrdmPipeline, TemplatePipeline};
use super::{EarlyDetection, Model, RecognizerInput, StartError};

/// Detections that one push can complete at most; more than a motion a tick is not a motion.
const MAX_DETECTIONS_PER_PUSH: usize = 64;

/// A motion recognised in a stream. Its class is a number of the index's, or a name ([`named`](Detection::named)).
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Detection<C = ClassId> {
    /// What it is.
    pub class: C,
    /// When it began, on the stream's clock.
    pub start_secs: f64,
    /// When it ended.
    pub stop_secs: f64,
    /// 0 just accepted … 1 identical to a sample.
    pub score: f64,
    /// The stream's clock when it was reported: the time of the pose that settled it.
    pub reported_secs: f64,
}

impl Detection {
    /// The same with the name of its class in `model`.
    pub fn named(self, model: &Model) -> Detection<&str> {
        Detection {
            class: model.class_name(self.class),
            start_secs: self.start_secs,
            stop_secs: self.stop_secs,
            score: self.score,
            reported_secs: self.reported_secs,
        }
    }
}

impl<C: fmt::Display> fmt::Display for Detection<C> {
    /// `wave from 1.23 s to 2.50 s, score 0.87`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} from {:.2} s to {:.2} s, score {:.2}",
            self.class, self.start_secs, self.stop_secs, self.score
        )
    }
}

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

/// How a path counts time: from where, and in what.
#[derive(Debug, Clone, Copy)]
pub(super) struct Steps {
    pub origin_secs: f64,
    pub step_secs: f64,
}

/// Detections of the present push, with the time at which they are reported.
#[derive(Debug)]
pub(super) struct DetectionBuffer {
    detections: Vec<Detection>,
    reported_secs: f64,
    /// Detections for which there was no room.
    dropped: u64,
}

impl DetectionBuffer {
    fn new() -> Self {
        Self {
            detections: Vec::with_capacity(MAX_DETECTIONS_PER_PUSH),
            reported_secs: 0.0,
            dropped: 0,
        }
    }

    fn begin(&mut self, reported_secs: f64) {
        self.detections.clear();
        self.reported_secs = reported_secs;
    }

    /// Adds what lies from step `start` to step `stop`.
    pub(super) fn add(&mut self, class: ClassId, at: Steps, start: i64, stop: i64, score: f64) {
        // The buffer never grows: pushing must not allocate.
        if self.detections.len() < self.detections.capacity() {
            self.detections.push(Detection {
                class,
                start_secs: at.origin_secs + start as f64 * at.step_secs,
                stop_secs: at.origin_secs + stop as f64 * at.step_secs,
                score,
                reported_secs: self.reported_secs,
            });
        } else {
            self.dropped += 1;
        }
    }
}

impl Clone for DetectionBuffer {
    /// By hand, because a copied vector has room only for what it holds.
    fn clone(&self) -> Self {
        let mut copy = Self {
            reported_secs: self.reported_secs,
            dropped: self.dropped,
            ..Self::new()
        };
        copy.detections.extend_from_slice(&self.detections);
        copy
    }
}

impl Recognizer {
    /// For a stream that offers `bones`; what a template model uses beyond them is left out of every comparison.
    ///
    /// Fails if the model's parts do not fit together, or no bone is left of a template model's.
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

    /// What seems to be under way after the last push, if anything does. Tentative: it says nothing about what
    /// [`push`](Self::push) will report, and asking changes nothing of that. Templates only. No allocation.
    pub fn hunch(&mut self) -> Option<EarlyDetection> {
        match &mut self.path {
            Pipeline::Templates(path) => path.hunch(),
            Pipeline::Svrdm(_) => None,
        }
    }

    /// How near a beginning must be for [`hunch`](Self::hunch).
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_there_is_no_room_for_is_counted() {
        let mut found = DetectionBuffer::new();
        let at = Steps {
            origin_secs: 0.0,
            step_secs: 0.1,
        };
        found.begin(1.0);
        for start in 0..70 {
            found.add(ClassId(0), at, start, start + 1, 0.5);
        }
        assert_eq!((found.detections.len(), found.dropped), (64, 6));
        found.begin(2.0);
        found.add(ClassId(0), at, 0, 1, 0.5);
        assert_eq!((found.detections.len(), found.dropped), (1, 6));
        assert_eq!(found.clone().dropped, 6);
    }
}
