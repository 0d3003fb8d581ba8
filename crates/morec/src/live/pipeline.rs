//! The interface of a method of recognition on one stream, by which [`Recognizer`](super::Recognizer) uses it.

use std::fmt;

use crate::TimeSpan;
use crate::classes::ClassId;
use crate::features::Pushed;
use crate::templates::{Deviation, EarlyDetectionParams};

use super::detection::DetectionBuffer;
use super::{EarlyDetection, RecognizerInput};

/// From the poses of one stream to detections. Nothing allocates after construction.
pub(super) trait Pipeline: fmt::Debug + Send + Sync {
    /// Shortest time from the end of a motion to its report, seconds.
    fn latency_secs(&self) -> f64;

    /// True if a pose at this time begins a new stretch.
    fn breaks_at(&self, time_secs: f64) -> bool;

    /// Takes a pose of the present stretch and adds what it settles.
    fn push(
        &mut self,
        time_secs: f64,
        pose: RecognizerInput<'_>,
        found: &mut DetectionBuffer,
    ) -> Pushed;

    /// Ends the stretch and adds what its last moments hold.
    fn end_stretch(&mut self, found: &mut DetectionBuffer);

    /// With `wait`, rows are batched for speed from now on, and detections are delayed until a batch is full: read them only from
    /// [`push`](Self::push) and [`end_stretch`](Self::end_stretch). Without, batching ends and delayed detections are added.
    fn let_rows_wait(&mut self, _wait: bool, _found: &mut DetectionBuffer) {}

    /// The motion that seems to be under way, of methods that can tell.
    fn early_detection(&mut self) -> Option<EarlyDetection> {
        None
    }

    /// True while a wider gate for performers unlike the teacher is open.
    fn admits_strangers(&self) -> bool {
        false
    }

    /// Forgets what is known of the performer; the next stretch may be another's.
    fn forget_performer(&mut self) {}

    /// Sets the limits of [`early_detection`](Self::early_detection).
    fn set_early(&mut self, _params: EarlyDetectionParams) {}

    /// Follows progress from now on, for [`progress`](Self::progress). Allocates.
    fn follow_progress(&mut self) {}

    /// Gives what is nearest of each class at the newest tick, with its pace, if that is another than when it was last asked; of methods that
    /// can tell.
    fn progress(&mut self, _each: &mut dyn FnMut(EarlyDetection, f64)) {}

    /// Remembers rows from now on, for [`deviation`](Self::deviation). Allocates.
    fn measure_deviations(&mut self) {}

    /// How far the last performance of `class` in `span` was from the nearest sample, of methods that keep samples; with `repetition`, one of
    /// an activity.
    fn deviation(
        &mut self,
        _class: ClassId,
        _span: TimeSpan,
        _repetition: bool,
    ) -> Option<Deviation> {
        None
    }

    /// A copy with the state of the stream.
    fn boxed(&self) -> Box<dyn Pipeline>;
}

impl Clone for Box<dyn Pipeline> {
    fn clone(&self) -> Self {
        self.boxed()
    }
}
