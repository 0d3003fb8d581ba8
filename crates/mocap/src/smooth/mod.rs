//! Smoothing and keyframes: a clip as cubic Bézier curves, independent of its frame rate (thesis, §3.3, Alg. 1).
//!
//! Each joint's rotation, and the position of each joint that moves in its parent's frame, is a channel. A channel
//! becomes a run of curves, each the least-squares fit to the samples between two keyframes, split where it is
//! furthest from them until it is nowhere further than a threshold. What lies below the threshold is smoothed away.
//!
//! ```
//! use mocap::smooth::{CompressedClip, SmoothParams, compress};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let bytes = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/testdata/mclip/v1.mclip"));
//! let clip = mocap::read(bytes, "push.mclip")?.clips.remove(0);       // in metres
//! let compressed = compress(&clip, &SmoothParams::database(), &())?;
//! assert!(compressed.errors().max_joint_position_metres <= 0.005);
//!
//! let bytes = compressed.to_bytes();
//! assert_eq!(CompressedClip::from_bytes(&bytes)?, compressed);
//! let at_60_hz = compressed.sample(60.0)?;
//! assert_eq!(at_60_hz.skeleton, clip.skeleton);
//! # Ok(())
//! # }
//! ```
//!
//! Where this follows the thesis and where it does not is said in [`compress`].

mod bezier;
mod bound;
mod compress;
mod curve;
mod errors;
mod fit;
mod lattice;
mod measure;
mod noise;
mod params;
mod playhead;
mod sample;
mod samples;
mod split;
mod stored;

pub use bezier::ChannelKind;
pub use bezier::ChannelValue;
pub use compress::compress;
pub use curve::{Bezier, Curve};
pub use errors::Errors;
pub use noise::MeasuredNoise;
pub use params::{SmoothError, SmoothParams};
pub use stored::{MAGIC, VERSION};

use crate::clip::{Points, Skeleton, Span};

/// A clip as curves: the same motion at every rate, within stated errors.
#[derive(Debug, Clone, PartialEq)]
pub struct CompressedClip {
    name: String,
    skeleton: Skeleton,
    rate_hz: f64,
    frames: usize,
    repaired: Vec<Span>,
    points: Option<Points>,
    params: SmoothParams,
    errors: Errors,
    /// One for each joint.
    rotations: Vec<Curve>,
    /// One for each joint that moves in its parent's frame, in increasing joint order.
    positions: Vec<Curve>,
}

impl CompressedClip {
    /// Name of the clip.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The joints, exactly as the clip had them.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// Frames a second of the clip that was compressed; keyframes lie on its frames.
    pub fn source_rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// Frames of the clip that was compressed.
    pub fn source_frames(&self) -> usize {
        self.frames
    }

    /// Length in seconds, as [`Clip::duration_secs`](crate::clip::Clip::duration_secs) has it.
    pub fn duration_secs(&self) -> f64 {
        self.frames as f64 / self.rate_hz
    }

    /// Frames of the source that were filled by interpolation.
    pub fn repaired(&self) -> &[Span] {
        &self.repaired
    }

    /// The thresholds it was made with.
    pub fn params(&self) -> &SmoothParams {
        &self.params
    }

    /// Distance from the clip it was made of, measured when it was made.
    pub fn errors(&self) -> &Errors {
        &self.errors
    }

    /// All channels: rotations joint by joint, then positions.
    pub fn curves(&self) -> impl Iterator<Item = &Curve> {
        self.rotations.iter().chain(&self.positions)
    }

    /// The channel of one joint, if it has one of this kind.
    pub fn curve(&self, joint: usize, kind: ChannelKind) -> Option<&Curve> {
        match kind {
            ChannelKind::Rotation => self.rotations.get(joint),
            ChannelKind::Position => self.positions.iter().find(|curve| curve.joint == joint),
        }
    }

    /// The Bézier curves of a channel, in order; none for a channel that stands still.
    pub fn beziers<'a>(&self, curve: &'a Curve) -> impl Iterator<Item = Bezier> + 'a {
        curve.beziers(self.rate_hz)
    }

    /// Keyframes of all channels together.
    pub fn keyframes(&self) -> usize {
        self.curves().map(Curve::keyframes).sum()
    }

    /// Numbers in all control points, with the times of keys.
    pub fn control_values(&self) -> usize {
        self.curves().map(Curve::control_values).sum()
    }

    /// Numbers in the frames of the source: four for each rotation, three for each position.
    pub fn raw_values(&self) -> usize {
        self.frames * (4 * self.rotations.len() + 3 * self.positions.len())
    }

    /// Raw numbers for each number that is kept.
    pub fn compression_ratio(&self) -> f64 {
        self.raw_values() as f64 / self.control_values().max(1) as f64
    }
}

#[cfg(test)]
pub(crate) mod tests;
