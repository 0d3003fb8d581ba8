//! From a stream of poses at any rate to feature rows at the model's.

use mocap::pose::lone_left_as_right;

use crate::grid::Grid;
use crate::observe::{Observation, Observer};
use crate::params::FeatureParams;
use crate::smooth::Smoother;
use crate::spikes::SpikeFilter;
use crate::{BoneSet, KeyPose, Profile, RowLayout};

/// Effect of a pose on the stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pushed {
    /// It was taken.
    Taken,
    /// It came after a gap of more than [`MAX_GAP_SECS`](crate::MAX_GAP_SECS), or its clock ran back by as much: the stream was
    /// finished and begins anew with this pose.
    Restarted,
    /// It was not later than the pose before it (a duplicate or a late packet) or its time is not finite.
    Ignored,
    /// Neither the hip joints nor the shoulders have been seen yet, so there is no heading; or nothing of the hand or the tracked
    /// points that the index is of.
    NoHips,
}

/// Makes feature rows of poses, one for each tick, for training and for live streams alike.
///
/// Rows depend on the poses alone, not on how they were cut into pushes. Nothing is allocated after `new`.
#[derive(Debug, Clone)]
pub struct FeatureStream {
    spikes: SpikeFilter,
    observer: Observer,
    smoother: Smoother,
    grid: Grid<Observation>,
    /// A grid frame between two poses.
    between: Observation,
    dim: usize,
    bones: BoneSet,
    profile: Profile,
}

impl FeatureStream {
    /// A stream whose rows hold `bones`.
    pub fn new(bones: BoneSet, params: &FeatureParams) -> Self {
        Self {
            spikes: SpikeFilter::new(Profile::of(bones)),
            observer: Observer::new(bones, params.heading),
            smoother: Smoother::new(bones, params),
            grid: Grid::new(params.rate_hz, Observation::blank(bones)),
            between: Observation::blank(bones),
            dim: RowLayout::of(bones).dim(),
            bones,
            profile: Profile::of(bones),
        }
    }

    /// Values in a row.
    #[inline]
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Time of the first frame of the present stretch: tick `i`'s row ends at
    /// `origin_secs() + (i + 1) * frames_per_tick / rate_hz`.
    #[inline]
    pub fn origin_secs(&self) -> f64 {
        self.grid.origin_secs()
    }

    /// Noise of the last second or so: the root mean square of what a short filter takes away from the bones' unit
    /// vectors. 0.002 to 0.009 on clean optical clips, about 0.075 with 1 cm of white noise on every joint at 120 Hz.
    /// `None` in the first moments, and where the filters do not
    /// [follow it](FeatureParams::follow_noise).
    #[inline]
    pub fn noise(&self) -> Option<f64> {
        self.smoother.noise()
    }

    /// The squared fourth difference of the velocities in rows that the stream's noise leaves, over its variance there, under the filter
    /// in use. `morec::templates::Stretches` divides what it measures by it.
    #[inline]
    pub fn noise_gain(&self) -> f32 {
        self.smoother.noise_gain()
    }

    /// True if a pose at `time_secs` would begin a new stretch, so that the caller can
    /// [`finish`](FeatureStream::finish) the old one first.
    #[inline]
    pub fn breaks_at(&self, time_secs: f64) -> bool {
        self.grid.breaks_at(time_secs)
    }

    /// Takes the pose at `time_secs` on the stream's clock; calls `out` with every row now complete.
    ///
    /// At most `MAX_GAP_SECS` of rows come of one push.
    pub fn push(&mut self, time_secs: f64, pose: &KeyPose, out: &mut impl FnMut(&[f32])) -> Pushed {
        let restarts = time_secs.is_finite() && self.breaks_at(time_secs);
        if restarts {
            self.finish(out);
        }
        let pushed = self.take(time_secs, pose);
        while let Some(row) = self.next_row() {
            out(row);
        }
        match pushed {
            Pushed::Taken if restarts => Pushed::Restarted,
            pushed => pushed,
        }
    }

    /// Ends the stretch: calls `out` with the rows that still waited for later frames, and forgets it.
    pub fn finish(&mut self, out: &mut impl FnMut(&[f32])) {
        self.end();
        while let Some(row) = self.next_row() {
            out(row);
        }
        self.reset();
    }

    /// Takes the pose at `time_secs`, which must not [break](Self::breaks_at) the stretch. Rows that are now complete
    /// come from [`next_row`](Self::next_row), and must be taken before the next pose.
    pub fn take(&mut self, time_secs: f64, pose: &KeyPose) -> Pushed {
        if self.grid.ignores(time_secs) {
            return Pushed::Ignored;
        }
        let image = match self.profile {
            Profile::Hand => lone_left_as_right(pose),
            _ => None,
        };
        let pose = image.as_ref().unwrap_or(pose);
        let cleaned = self
            .spikes
            .clean(time_secs, pose, self.observer.unit_length());
        let pose = cleaned.as_ref().unwrap_or(pose);
        let Some(observation) = self.observer.observe(pose) else {
            return Pushed::NoHips;
        };
        self.grid.push(time_secs, observation);
        Pushed::Taken
    }

    /// The next row that is complete.
    pub fn next_row(&mut self) -> Option<&[f32]> {
        while !self.smoother.has_row() {
            let frame = self.grid.next_frame()?;
            match frame.before {
                Some((last, t)) if t < 1.0 => {
                    self.between.set(last, frame.now, t, self.bones);
                    self.smoother.push(&self.between);
                }
                _ => self.smoother.push(frame.now),
            }
        }
        self.smoother.next_row()
    }

    /// Ends the stretch: rows that still waited for later frames come from [`next_row`](Self::next_row), until
    /// [`reset`](Self::reset).
    pub fn end(&mut self) {
        self.smoother.end();
    }

    /// Forgets the stretch.
    pub fn reset(&mut self) {
        self.smoother.reset();
        self.observer.reset();
        self.spikes.reset();
        self.grid.end();
    }
}
