//! A clip made ready for everything that follows.

use crate::clip::{Clip, Span};
use crate::features::{BoneSet, KeyPose, bones_of_clip, for_each_pose};
use crate::formats::bvh::{self, BvhOptions};
use crate::formats::{Limits, ParseError, Place, Warning};
use crate::roles::RoleMap;

use super::{ImportOptions, ImportReport, normalize};

/// A clip made ready for training and recognition: in metres, Y up, the roles of its joints known.
#[derive(Debug, Clone, PartialEq)]
pub struct Take {
    /// The motion, in metres and Y up. No frame is taken away.
    pub clip: Clip,
    /// Which joint is which part of the body.
    pub roles: RoleMap,
    /// What was inferred.
    pub report: ImportReport,
    /// What was repaired or looks wrong in the file it is from; clips of one file share them.
    pub warnings: Vec<Warning>,
}

impl Take {
    /// Infers what `clip` is and makes it ready, as [`normalize`] with its defaults.
    ///
    /// # Errors
    /// None at present: only a mapping of roles, which the defaults lack, can be wrong.
    pub fn new(clip: Clip) -> Result<Self, ParseError> {
        normalize(clip, &ImportOptions::default())
    }

    /// The first clip in the bytes of a BVH file; further characters are named in [`warnings`](Self::warnings). Its name
    /// is `clip`: see [`named`](Self::named).
    ///
    /// # Errors
    /// Bytes that are no BVH, or too damaged to be read.
    pub fn from_bvh(bytes: &[u8]) -> Result<Self, ParseError> {
        let loaded = bvh::read(bytes, "clip", &BvhOptions::default(), &Limits::default())?;
        let mut clips = loaded.clips.into_iter();
        let none = || ParseError::new(Place::File, "a character", "none");
        let mut take = normalize(clips.next().ok_or_else(none)?, &ImportOptions::default())?;
        take.warnings = loaded.warnings;
        for other in clips {
            let text = format!("a second character, {}; left out", other.name);
            take.warnings.push(Warning::new(Place::File, text));
        }
        Ok(take.named("clip"))
    }

    /// The take under another name, by which labels speak of it.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.clip.name = name.into();
        self
    }

    /// The name by which labels speak of it: the stem of its file.
    pub fn name(&self) -> &str {
        &self.clip.name
    }

    /// Frames at the start that show a rest pose and not the motion.
    pub fn rest(&self) -> &Span {
        &self.report.rest_frames
    }

    /// The bones that recognition can use of it.
    pub fn bones(&self) -> BoneSet {
        bones_of_clip(&self.clip, &self.roles, self.rest())
    }

    /// What a live source would have sent: the time of every frame in seconds, and its pose.
    pub fn poses(&self) -> Vec<(f64, KeyPose)> {
        let mut poses = Vec::with_capacity(self.clip.frames);
        for_each_pose(&self.clip, &self.roles, self.rest(), |time_secs, pose| {
            poses.push((time_secs, *pose));
        });
        poses
    }
}
