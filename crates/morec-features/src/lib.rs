//! Feature rows, which training and live recognition compare, and numbers of classes: what every recogniser of `morec` builds on.
//!
//! A row describes one tick (1/30 s): for each bone its direction in the performer's heading frame and its
//! velocity with saturated length, then the root's velocity and turning. Rows do not depend on body size, facing direction or
//! skeleton. Hands and tracked points have rows of the same form over bones of their own ([`Profile`]).
//!
//! Notation: `b` bones, `d = 6 b + 4` values in a row: `[x (3 b) ; β v (3 b) ; γ root (4)]`, single precision; [`RowLayout`]
//! says where each value stands, and nothing else does.
//! The same [`FeatureStream`] makes the rows of training clips and of live streams, at the instants of a [`Grid`].
//!
//! Times are seconds, angles radians, lengths those of the source. Parameters and their sources: [`FeatureParams`] and
//! `docs/parameters.md` of the repository; the method: `docs/method.md`. `morec` passes this crate on as `morec::features`.

#![warn(clippy::missing_errors_doc, clippy::missing_panics_doc)]

mod blocks;
pub mod classes;
mod grid;
mod layout;
mod mirror;
mod noise;
mod observe;
mod of_clip;
mod packed;
mod params;
mod retime;
mod rows;
mod smooth;
mod spikes;
mod stream;
mod weights;

pub use classes::{ClassId, ClassInfo};
pub use grid::{Grid, GridFrame, MAX_GAP_SECS, breaks_stretch};
pub use layout::RowLayout;
pub use mirror::{mirrored_rows, opposite_bone, reflected_direction};
pub use mocap::pose::{
    ALL_BONES, BODY_BONES, BONES, Bone, BoneKind, BoneSet, Hand, HandPoints, KeyPose, PalmFrame,
    Profile, all_bones_of_clip, bones_of_clip, for_each_pose, shows_hips,
};
pub use noise::USUAL_NOISE_GAIN;
pub use observe::{Observation, Observer};
pub use of_clip::rows_of_clip;
pub use params::{FeatureParams, HeadingLine};
pub use retime::retimed_rows;
pub use rows::Rows;
pub use stream::{FeatureStream, Pushed};
pub use weights::BONE_WEIGHTS;

/// The Rust of README, so that it compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
