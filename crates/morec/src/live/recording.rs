//! Records frames of a live stream and makes a clip of them.

mod tree;

use std::sync::Arc;

use crate::clip::Clip;
use crate::features::Profile;
use crate::resample::usual_step;
use crate::roles::Role;
use crate::roles::mapping::Mapping;

use super::{Frame, Rig};
use tree::RecordedJoints;

/// Rates of clips made of streams.
const RATES_HZ: std::ops::RangeInclusive<f64> = 1.0..=1000.0;
/// A clip of an hour at 1000 Hz; what is longer has a wrong clock.
const MOST_FRAMES: f64 = 3.6e6;

/// A recording that is no clip.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RecordingError {
    /// Too little came.
    #[error("a clip needs at least two frames at different times, the recording has {frames}")]
    TooShort {
        /// Frames recorded.
        frames: usize,
    },
    /// No joint was ever seen.
    #[error("none of the {frames} recorded frames contains a joint")]
    Nobody {
        /// Frames recorded.
        frames: usize,
    },
    /// The times of the frames are too far apart.
    #[error("the recorded frames span {secs} s at {rate_hz} Hz: are their times seconds?")]
    TooLong {
        /// From the first to the last.
        secs: f64,
        /// Frames a second.
        rate_hz: f64,
    },
}

/// Poses of one performer of a live source.
#[derive(Debug, Clone, Default)]
pub struct Recording {
    rig: Arc<Rig>,
    frames: Vec<Frame>,
}

impl Recording {
    /// Nothing yet, of a performer with this skeleton.
    pub fn new(rig: &Arc<Rig>) -> Self {
        Self {
            rig: rig.clone(),
            frames: Vec::new(),
        }
    }

    /// Goes on with another skeleton of as many joints: a source may get to know joints as it goes. `false`, and
    /// nothing happens, if there are frames of a skeleton with another number.
    pub fn set_rig(&mut self, rig: &Arc<Rig>) -> bool {
        let fits = self.frames.is_empty() || rig.skeleton.len() == self.rig.skeleton.len();
        if fits {
            self.rig = rig.clone();
        }
        fits
    }

    /// Keeps a frame; one that is not later than the last, or of another skeleton, is left out.
    pub fn push(&mut self, frame: &Frame) {
        let joints = frame.pose.positions.len() == self.rig.skeleton.len();
        let later = self
            .frames
            .last()
            .is_none_or(|last| frame.time_secs > last.time_secs);
        if joints && later && frame.time_secs.is_finite() {
            self.frames.push(frame.clone());
        }
    }

    /// The frames kept, in order of time.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// Whose skeleton they pose.
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// From the first frame to the last.
    pub fn secs(&self) -> f64 {
        match (self.frames.first(), self.frames.last()) {
            (Some(first), Some(last)) => last.time_secs - first.time_secs,
            _ => 0.0,
        }
    }

    /// Frames a second: one over the usual interval, whole.
    pub fn rate_hz(&self) -> Option<f64> {
        let pairs = self.frames.windows(2);
        let intervals: Vec<f64> = pairs.map(|w| w[1].time_secs - w[0].time_secs).collect();
        let usual = usual_step(&intervals)?;
        Some(
            (1.0 / usual)
                .round()
                .clamp(*RATES_HZ.start(), *RATES_HZ.end()),
        )
    }

    /// A clip at the stream's own rate, even where frames came unevenly or are missing: places on straight lines and
    /// rotations on great circles between those that were seen. Joints hang together as in the skeleton; a stream of
    /// roles gets the bones of a body. Joints that were never seen are left out, or stay where the skeleton has them.
    ///
    /// # Errors
    /// Fewer than two frames, no joint at all, or more frames than an hour at 1000 Hz has. O(frames · joints).
    pub fn to_clip(&self, name: &str) -> Result<Clip, RecordingError> {
        let frames = self.frames.len();
        let rate_hz = self.rate_hz().ok_or(RecordingError::TooShort { frames })?;
        let secs = self.secs();
        if secs * rate_hz > MOST_FRAMES {
            return Err(RecordingError::TooLong { secs, rate_hz });
        }
        let tree =
            RecordedJoints::of(&self.rig, &self.frames).ok_or(RecordingError::Nobody { frames })?;
        // The last frame counts, even where it lies a little before its place on the grid.
        let count = (secs * rate_hz + 0.5).floor() as usize + 1;
        Ok(tree.clip(&self.frames, name, rate_hz, count))
    }

    /// Which joints of `clip`, made by [`to_clip`](Self::to_clip), play which roles, for reading its file again: names alone do not say
    /// it of a hand or a custom skeleton. `None` where the source says the skeleton of a body, whose names and tree do.
    pub fn mapping(&self, clip: &Clip) -> Option<Mapping> {
        let (joints, roles) = (self.rig.skeleton.joints(), &self.rig.roles);
        let flat = joints.len() > 1 && joints.iter().all(|joint| joint.parent.is_none());
        if !flat && roles.profile() == Profile::Body {
            return None;
        }
        let line = |(role, joint): (Role, usize)| {
            let name = match flat {
                true => tree::name_of(role),
                false => &joints[joint].name,
            };
            clip.skeleton.find(name)?;
            Some(format!("{}\t{name}\n", role.name()))
        };
        let mut lines: String = roles.played().filter_map(line).collect();
        if lines.is_empty() {
            return None;
        }
        if roles.profile() != Profile::Body {
            // A reader takes the first joint of a tree for the hips, and what hangs on it for limbs.
            let others = Role::ALL.into_iter().filter(|role| role.is_of_body());
            let others = others.filter(|role| roles.joint(*role).is_none());
            lines.extend(others.map(|role| format!("{}\t-\n", role.name())));
        }
        Mapping::read(lines.as_bytes()).ok()
    }
}

#[cfg(test)]
mod tests;
