//! From a stream of poses at any rate to feature rows at the model's.

use super::bones::BoneSet;
use super::observe::{Observation, Observer};
use super::params::FeatureParams;
use super::smooth::Smoother;
use super::{KeyPose, row_dim};

/// A pause longer than this ends one stretch of stream and begins another: what lies between is unknown, and
/// interpolating it would invent motion.
pub const MAX_GAP_SECS: f64 = 0.5;

/// What a pose did to the stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pushed {
    /// It was taken.
    Taken,
    /// It came after a gap of more than [`MAX_GAP_SECS`], or its clock ran back by as much: the stream was
    /// finished and begins anew with this pose.
    Restarted,
    /// It was not later than the pose before it (a duplicate or a late packet) or its time is not finite.
    Ignored,
    /// The hip joints have not been seen yet: there is no heading.
    NoHips,
}

/// Makes feature rows of poses, one for each tick, for training and for live streams alike.
///
/// Rows depend on the poses alone, not on how they were cut into pushes. Nothing is allocated after `new`.
#[derive(Debug, Clone)]
pub struct FeatureStream {
    observer: Observer,
    smoother: Smoother,
    rate_hz: f64,
    dim: usize,
    /// Time of grid frame 0 of this stretch.
    origin_secs: f64,
    /// Grid frames made in this stretch.
    grid_frames: u64,
    last: Option<(f64, Observation)>,
    bones: BoneSet,
}

impl FeatureStream {
    /// A stream whose rows hold `bones`.
    pub fn new(bones: BoneSet, params: &FeatureParams) -> Self {
        Self {
            observer: Observer::new(bones),
            smoother: Smoother::new(bones, params),
            rate_hz: params.rate_hz,
            dim: row_dim(bones),
            origin_secs: 0.0,
            grid_frames: 0,
            last: None,
            bones,
        }
    }

    /// Values in a row.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Time of the first frame of the present stretch: tick `i`'s row ends at
    /// `origin_secs() + (i + 1) * frames_per_tick / rate_hz`.
    pub fn origin_secs(&self) -> f64 {
        self.origin_secs
    }

    /// Whether a pose at `time_secs` would begin a new stretch, so that the caller can
    /// [`finish`](FeatureStream::finish) the old one first.
    pub fn breaks_at(&self, time_secs: f64) -> bool {
        self.last.is_some_and(|(last, _)| time_secs > last + MAX_GAP_SECS || time_secs < last - MAX_GAP_SECS)
    }

    /// Takes the pose at `time_secs` on the stream's clock; calls `out` with every row now complete.
    ///
    /// At most `MAX_GAP_SECS` of rows come of one push.
    pub fn push(&mut self, time_secs: f64, pose: &KeyPose, out: &mut impl FnMut(&[f32])) -> Pushed {
        if !time_secs.is_finite() {
            return Pushed::Ignored;
        }
        let restarted = self.breaks_at(time_secs);
        if restarted {
            self.finish(out);
        }
        if self.last.is_some_and(|(last, _)| time_secs <= last) {
            return Pushed::Ignored;
        }
        let Some(observation) = self.observer.observe(pose) else { return Pushed::NoHips };
        match self.last {
            None => {
                self.origin_secs = time_secs;
                self.grid_frames = 1;
                self.smoother.push(&observation, out);
            }
            Some((last_secs, last)) => self.fill(last_secs, &last, time_secs, &observation, out),
        }
        self.last = Some((time_secs, observation));
        if restarted { Pushed::Restarted } else { Pushed::Taken }
    }

    /// Every grid frame in `(last_secs, time_secs]`, interpolated.
    fn fill(
        &mut self,
        last_secs: f64,
        last: &Observation,
        time_secs: f64,
        now: &Observation,
        out: &mut impl FnMut(&[f32]),
    ) {
        // A source at the model's own rate must fall on the grid whatever its clock's last bits say.
        let tolerance_secs = 1e-6;
        loop {
            let grid_secs = self.origin_secs + self.grid_frames as f64 / self.rate_hz;
            if grid_secs > time_secs + tolerance_secs {
                return;
            }
            let t = (grid_secs - last_secs) / (time_secs - last_secs);
            let t = if time_secs - grid_secs < tolerance_secs { 1.0 } else { t };
            self.smoother.push(&Observation::between(last, now, t, self.bones), out);
            self.grid_frames += 1;
        }
    }

    /// Ends the stretch: calls `out` with the rows that still waited for later frames, and forgets it.
    pub fn finish(&mut self, out: &mut impl FnMut(&[f32])) {
        self.smoother.finish(out);
        self.smoother.reset();
        self.observer.reset();
        self.last = None;
        self.grid_frames = 0;
    }
}
