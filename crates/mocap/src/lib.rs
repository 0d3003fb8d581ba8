#![cfg_attr(feature = "files", doc = include_str!("../README.md"))]
#![cfg_attr(
    not(feature = "files"),
    doc = "Clips, skeletons and roles of motion capture."
)]
//!
//! # The way of the data
//!
//! | step | module | gives |
//! |---|---|---|
//! | a path | [`files`] | bytes, archives unpacked, skeletons found; clips and [`Take`]s |
//! | bytes of a file | [`formats`] | a [`Clip`]: skeleton, frames, and what had to be repaired |
//! | units, axes, parts of the body | [`import`], [`roles`] | metres, Y up, a [`RoleMap`](roles::RoleMap) |
//! | rotations of what has positions only | [`fitting`] | a skeleton of fixed bone lengths, and its residuals |
//! | poses in the world | [`kinematics`], [`pose`] | joints' places; a [`KeyPose`] of the parts of the body |
//! | a small form to keep | [`smooth`] | keyframes and Bézier curves, `.mclip` |
//!
//! Times are seconds, angles radians, ranges half-open. A rotation called `a_from_b` takes coordinates in `b` to coordinates in
//! `a`. [`math`], [`resample`] and [`progress`] are shared by several of these.

#![warn(clippy::missing_errors_doc, clippy::missing_panics_doc)]

pub mod clip;
#[doc(hidden)] // Shared with the rows that `morec` stores; no one else's stored form is made of it.
pub mod coder;
pub mod humanoid;
pub mod kinematics;
#[cfg(feature = "formats")]
mod limits;
pub mod math;
#[doc(hidden)] // For lines of JSON that arrive live.
pub mod nan;
mod parse_error;
pub mod pose;
pub mod progress;
pub mod resample;
pub mod rng;
mod role;
pub mod roles;
mod signed_axis;
mod time_span;

#[cfg(feature = "files")]
pub mod files;
#[cfg(feature = "formats")]
pub mod fitting;
#[cfg(feature = "formats")]
pub mod formats;
#[cfg(feature = "formats")]
pub mod import;
#[cfg(feature = "formats")]
pub mod smooth;

#[cfg(any(test, feature = "testing"))]
#[doc(hidden)]
pub mod testing;

pub use clip::{Clip, Skeleton};
#[cfg(feature = "files")]
pub use files::read;
#[cfg(feature = "formats")]
pub use formats::{Limits, Loaded};
#[cfg(feature = "formats")]
pub use import::{ImportOptions, Take};
#[doc(hidden)] // For messages of `morec` that quote a file.
pub use parse_error::shortened;
pub use parse_error::{ParseError, Place, Warning};
pub use pose::{BoneSet, KeyPose};
pub use signed_axis::SignedAxis;
pub use time_span::TimeSpan;
