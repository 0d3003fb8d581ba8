//! Pose rows and the stages of the thesis on one stream, on one thread.

use std::sync::Arc;

use crate::features::Pushed;
use crate::live::detection::{DetectionBuffer, Steps};
use crate::live::pipeline::Pipeline;
use crate::live::{RecognizerInput, StartError};
use crate::pivots::{PivotPose, PoseStream};
use crate::svrdm::{FrameDetection, SvrdmEngine, SvrdmModel};

/// Pose rows and the stages of the thesis.
#[derive(Debug, Clone)]
pub(in crate::live) struct SvrdmPipeline {
    rows: PoseStream,
    engine: SvrdmEngine,
}

impl SvrdmPipeline {
    pub(in crate::live) fn new(model: &Arc<SvrdmModel>) -> Result<Self, StartError> {
        let engine = SvrdmEngine::new(model)?;
        Ok(Self {
            rows: PoseStream::new(&model.pivots, &model.pose),
            engine,
        })
    }

    fn steps(&self) -> Steps {
        Steps::at_rate(self.rows.origin_secs(), self.engine.model().rate_hz())
    }
}

impl Pipeline for SvrdmPipeline {
    /// A segment is compared with those that end a chunk later, and a row waits for the frame after it.
    fn latency_secs(&self) -> f64 {
        (self.engine.latency_frames() + 1) as f64 / self.engine.model().rate_hz()
    }

    fn breaks_at(&self, time_secs: f64) -> bool {
        self.rows.breaks_at(time_secs)
    }

    fn push(
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
                found.add(d.class, steps, (d.start, d.stop), d.score, None)
            });
        })
    }

    fn end_stretch(&mut self, found: &mut DetectionBuffer) {
        let (steps, engine) = (self.steps(), &mut self.engine);
        let mut out =
            |d: FrameDetection| found.add(d.class, steps, (d.start, d.stop), d.score, None);
        self.rows.finish(&mut |row| engine.push(row, &mut out));
        engine.finish(&mut out);
    }

    fn boxed(&self) -> Box<dyn Pipeline> {
        Box::new(self.clone())
    }
}
