//! A recognised motion, as returned by the eight calls.

use std::ffi::c_char;

/// Bytes for the name of a class, with the zero at its end; longer names are cut.
pub(crate) const NAME_BYTES: usize = 64;

/// A recognised motion: a segment of the stream and its class.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionSeg {
    /// Its number, from 1 since `mrStart`.
    pub number: u64,
    /// Its class in the index, from 0.
    pub class_id: u32,
    /// First frame of the motion in the clip.
    pub start_frame: u32,
    /// Frame of the clip after the motion's last frame.
    pub stop_frame: u32,
    /// Length of `class_name` in bytes, without the zero.
    pub class_name_bytes: u32,
    /// Start, seconds from the beginning of the clip.
    pub start_secs: f64,
    /// Stop, seconds.
    pub stop_secs: f64,
    /// Probability that the detection is right, 0 to 1. The lowest accepted score is 0.05 to 0.44, depending on the index. For
    /// held poses and indexes without calibration (svrdm, older files) it is the similarity to a sample instead.
    pub confidence: f64,
    /// Name of its class, UTF-8, zero-terminated; truncated if it is longer.
    pub class_name: [c_char; 64],
}
