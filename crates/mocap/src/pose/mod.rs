//! Poses by the parts of the body: [`KeyPose`], hands, and the bones between them.

mod bones;
mod hand;
mod key_pose;
mod of_clip;
mod profile;

pub use bones::{ALL_BONES, BODY_BONES, BONES, Bone, BoneKind, BoneSet};
pub use hand::{Hand, HandPoints, PalmFrame, lone_left_as_right};
pub use key_pose::KeyPose;
pub use of_clip::{all_bones_of_clip, bones_of_clip, for_each_pose, shows_hips};
pub use profile::Profile;
