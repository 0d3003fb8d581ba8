//! Feature rows: what training and live recognition compare.
//!
//! A row describes one tick (1/30 s): for each bone its direction in the performer's heading frame and its
//! velocity with saturated length, then the root's velocity and turning. People of any size, facing anywhere,
//! on any skeleton come out alike. Hands and tracked points have rows of the same form over bones of their own ([`Profile`]).
//!
//! Notation: `b` bones, `d = 6 b + 4` values in a row: `[x (3 b) ; β v (3 b) ; γ root (4)]`, single precision; [`RowLayout`]
//! says where each value stands, and nothing else does.
//! The same [`FeatureStream`] makes the rows of training clips and of live streams.

mod bones;
pub(crate) mod grid;
mod hand;
mod key_pose;
mod layout;
mod mirror;
mod noise;
mod observe;
mod of_clip;
mod packed;
mod params;
mod profile;
mod retime;
mod rows;
mod smooth;
mod spikes;
mod stream;

pub use bones::{ALL_BONES, BODY_BONES, BONES, Bone, BoneKind, BoneSet};
pub use grid::MAX_GAP_SECS;
#[cfg(test)]
pub(crate) use hand::flat_hand;
pub use hand::{Hand, HandPoints, PalmFrame};
pub use key_pose::KeyPose;
pub use layout::RowLayout;
pub use mirror::{mirrored_rows, opposite_bone, reflected_direction};
pub(crate) use noise::USUAL_NOISE_GAIN;
pub use observe::{Observation, Observer};
pub use of_clip::{all_bones_of_clip, bones_of_clip, for_each_pose, rows_of_clip, shows_hips};
pub use params::{FeatureParams, HeadingLine};
pub use profile::Profile;
pub use retime::retimed_rows;
pub use rows::Rows;
pub use stream::{FeatureStream, Pushed};
