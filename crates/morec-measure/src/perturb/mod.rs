//! Copies of motion as worse devices would have captured it: sensor noise, tilt, another pace, lost frames.
//!
//! Training learns from such copies what noise does to distances, and
//! [`crossval`](crate::crossval) measures what recognition loses by them. All randomness is seeded: the same clip
//! and seed give the same copy on every platform.
//!
//! ```
//! use morec::Take;
//! use morec_measure::perturb::{Perturbation, perturb};
//! use morec::synth::{DatabaseSpec, database};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let take = Take::new(database(1, &DatabaseSpec { people: 1, ..Default::default() }).remove(0).clip)?;
//! let webcam = [Perturbation::Rate(30.0), "cam:1".parse()?];
//! let worse = perturb(take.poses(), &webcam, 7);
//! assert!(worse.poses.len() < take.clip.frames);
//! # Ok(())
//! # }
//! ```

mod apply;
mod device;
mod noise;
mod parse;

pub use apply::{Perturbed, perturb};
pub use device::Device;
pub use parse::UnknownPerturbation;

/// One way in which a capture can be worse than the clip. Lengths are metres for a leg of
/// [`REFERENCE_LEG_METRES`] and are scaled with the performer's leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Perturbation {
    /// Independent noise of this standard deviation at every frame, joint and axis.
    White(f64),
    /// Noise of this standard deviation that is smooth over time ([`SLOW_SIGMA_SECS`]), for each joint and axis.
    Slow(f64),
    /// An offset of this standard deviation that stays for the whole clip, for each joint and axis.
    Constant(f64),
    /// The world turned by this angle in degrees about a random horizontal axis.
    Tilt(f64),
    /// Durations times this factor: 2 is half as fast.
    Duration(f64),
    /// This share of the frames vanishes and time closes up behind them.
    Drop(f64),
    /// This share of the frames shows the frame before once more.
    Repeat(f64),
    /// In this share of the frames one joint lies [`SPIKE_METRES`] off.
    Spikes(f64),
    /// In this share of the time the joints of one limb are not seen, for [`OCCLUSION_SECS`] at a time.
    Occlude(f64),
    /// Left and right exchanged, as in a mirror.
    Mirror,
    /// A webcam: white 1 cm, slow 2 cm and constant 1.5 cm, times this factor.
    Camera(f64),
    /// Frames a second, by linear interpolation.
    Rate(f64),
}

/// Lengths of noise are for a leg of this length.
pub const REFERENCE_LEG_METRES: f64 = 0.85;
/// Standard deviation of the Gaussian that makes slow noise smooth.
pub const SLOW_SIGMA_SECS: f64 = 0.35;
/// Duration for which a limb stays hidden.
pub const OCCLUSION_SECS: f64 = 0.4;
/// Distance of a spike.
pub const SPIKE_METRES: f64 = 1.0;

#[cfg(test)]
mod tests;
