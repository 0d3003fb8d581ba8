//! Pose rows of joint rotations: the pose description of the thesis (Bucur 2009, §4.2).
//!
//! A pivot is a joint whose rotation counts. A row describes one frame at the model's rate (120 Hz): for each
//! pivot the quaternion relative to its parent pivot, whatever joints lie between them; for the root its relative
//! orientation to the next frame, which stands for its angular velocity. Neither bone lengths nor places nor (with
//! the root in the body's frame) headings come in. Unlike [feature rows](morec_features), these do depend on the
//! axes that a rig gave its joints: train and recognise on skeletons of one kind.
//!
//! Notation: `p` pivots, at most [`MAX_PIVOTS`]; `D = 4 p` values in a row, each pivot's as `w x y z`, single
//! precision. The same [`PoseStream`] makes the rows of clips and of live streams.

mod map;
mod of_clip;
mod params;
mod pose;
mod rebuilt;
mod set;
mod stream;
mod tables;

pub use map::{NoPivots, PivotMap};
pub use of_clip::{for_each_pivot_pose, pose_rows_of_clip};
pub use params::{PoseParams, QuaternionSign, RootForm};
pub use pose::{MAX_PIVOTS, PivotPose};
pub use rebuilt::clip_of_pose_rows;
pub use set::{Pivot, PivotSet, PivotSetError};
pub use stream::PoseStream;

#[cfg(test)]
mod tests;
