//! The BVH broadcast of Axis Neuron and Axis Studio (Noitom's Perception Neuron): frames of a BVH file's values over
//! TCP, port 7001 by custom, or UDP.
//!
//! A frame is a header of 64 bytes and then numbers (all little-endian, without padding):
//!
//! | bytes | are |
//! |---|---|
//! | 0–1 | `0xDDFF` |
//! | 2–5 | version |
//! | 6–7 | how many numbers follow |
//! | 8 | 1 if every bone has a position, 0 if only the hips |
//! | 9 | 1 if a reference of six numbers goes before the hips |
//! | 10–13 | which avatar |
//! | 14–45 | its name, ended by 0 |
//! | 46–49 | number of the frame |
//! | 50–61 | unused |
//! | 62–63 | `0xEEFF` |
//!
//! The numbers are `f32`: for each of 59 bones in the order of [`AXIS_BONES`] its position in its parent's frame in
//! centimetres, if it has one, and its angles in degrees in the order Y, X, Z (`parent_from_bone = R_y · R_x · R_z`).
//! So there are 180 without positions, 354 with; 6 more with a reference. Axes are right-handed, Y up; turned by nothing
//! a person stands in a T-pose and faces +Z, the left side at +X.
//!
//! [`AxisDecoder`] makes frames of bytes, [`AxisReceiver`] poses of frames, [`AxisSender`] bytes of poses, without a
//! connection. [`AxisSource`] is a receiver with one.

mod bones;
mod clock;
mod decoder;
mod receiver;
mod sender;
mod source;
#[cfg(test)]
mod tests;

pub use bones::{AXIS_BONE_COUNT, AXIS_BONES, AxisBone, AxisSkeleton, AxisSkeletonError};
pub use clock::FrameClock;
pub use decoder::{AxisDecoder, AxisError, AxisFrame, MAX_VALUES};
pub use receiver::{AxisOptions, AxisReceiver};
pub use sender::AxisSender;
pub use source::{AxisSource, axis_skeleton};
