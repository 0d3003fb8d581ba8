//! A take: a clip after import.

use crate::clip::{Clip, Joint, Skeleton, Span};
use crate::formats::Warning;
use crate::pose::{BoneSet, KeyPose, bones_of_clip, for_each_pose};
use crate::roles::{Role, RoleMap};

use super::report::ImportReport;

/// A clip made ready for training and recognition: in metres, Y up, the roles of its joints known.
#[derive(Debug, Clone, PartialEq)]
pub struct Take {
    /// The motion, in metres and Y up. No frame is taken away.
    pub clip: Clip,
    /// The joint of each part of the body.
    pub roles: RoleMap,
    /// What was inferred: unit, up axis, roles, rest pose.
    pub report: ImportReport,
    /// Repairs and oddities of the file it is from; clips of one file share them.
    pub warnings: Vec<Warning>,
}

impl Take {
    /// The take under another name, by which labels refer to it.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.clip.name = name.into();
        self
    }

    /// The name by which labels refer to it: the stem of its file.
    pub fn name(&self) -> &str {
        &self.clip.name
    }

    /// Number of frames at the start that show a rest pose instead of the motion.
    pub fn rest(&self) -> &Span {
        &self.report.rest_frames
    }

    /// The bones that are [used](crate::pose::Profile::usual_bones) of it unless others are asked for.
    pub fn bones(&self) -> BoneSet {
        bones_of_clip(&self.clip, &self.roles, self.rest())
    }

    /// Time of every frame in seconds, and its key pose, as a live source would have sent them.
    pub fn poses(&self) -> Vec<(f64, KeyPose)> {
        let mut poses = Vec::with_capacity(self.clip.frames);
        for_each_pose(&self.clip, &self.roles, self.rest(), |time_secs, pose| {
            poses.push((time_secs, *pose));
        });
        poses
    }
}

/// Positions of a clip's joints in metres, for lines of JSON that are read live. A joint with a role has the role's name. Another joint that has a role's name is marked by an apostrophe. O(frames · joints).
pub fn points_by_role(clip: &Clip, roles: &RoleMap) -> Clip {
    let mut points = clip.to_points(Some(1.0));
    let mut joints: Vec<Joint> = points.skeleton.joints().to_vec();
    for joint in &mut joints {
        if Role::from_name(&joint.name).is_some() {
            joint.name.push('\'');
        }
    }
    for (role, joint) in roles.played() {
        joints[joint].name = role.name().to_owned();
    }
    if let Ok(skeleton) = Skeleton::new(joints) {
        points.skeleton = skeleton;
    }
    points
}
