//! Effects of usual devices on a motion.

use super::Perturbation;

/// A kind of capture device. The figures are of their order, not of any one product.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Device {
    /// Markers and many cameras: as good as the clip itself.
    Optical,
    /// Landmarks from a webcam: every joint trembles and wanders, frames are lost.
    Webcam,
    /// A depth camera before the performer: 30 frames a second, offsets of joints, hidden limbs.
    DepthCamera,
    /// Trackers on hands, feet, hips and head: little noise, slow drift, a tilted room.
    SixTrackers,
}

impl Device {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::Optical,
        Self::Webcam,
        Self::DepthCamera,
        Self::SixTrackers,
    ];

    /// As messages and tests call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Optical => "optical",
            Self::Webcam => "webcam",
            Self::DepthCamera => "depth camera",
            Self::SixTrackers => "six trackers",
        }
    }

    /// Perturbations of a motion by the device, in order.
    pub fn perturbations(self) -> Vec<Perturbation> {
        match self {
            Self::Optical => Vec::new(),
            Self::Webcam => vec![
                Perturbation::Rate(30.0),
                Perturbation::Camera(1.0),
                Perturbation::Repeat(0.05),
            ],
            Self::DepthCamera => vec![
                Perturbation::Rate(30.0),
                Perturbation::White(0.005),
                Perturbation::Slow(0.01),
                Perturbation::Constant(0.015),
                Perturbation::Occlude(0.02),
            ],
            Self::SixTrackers => vec![
                Perturbation::White(0.002),
                Perturbation::Slow(0.015),
                Perturbation::Tilt(3.0),
            ],
        }
    }
}
