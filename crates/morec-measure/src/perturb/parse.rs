//! Perturbations as people type them: `white:0.01`.

use std::fmt;
use std::str::FromStr;

use super::Perturbation;

/// A text that names no perturbation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "expected white:METRES, slow:METRES, const:METRES, tilt:DEGREES, speed:FACTOR, drop:SHARE, repeat:SHARE, \
     spikes:SHARE, occlude:SHARE, cam:FACTOR, rate:HZ or mirror, found `{0}`"
)]
pub struct UnknownPerturbation(String);

impl FromStr for Perturbation {
    type Err = UnknownPerturbation;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let unknown = || UnknownPerturbation(text.to_owned());
        let text = text.trim();
        if text == "mirror" {
            return Ok(Self::Mirror);
        }
        let (name, value) = text.split_once(':').ok_or_else(unknown)?;
        let value: f64 = value.parse().map_err(|_| unknown())?;
        let made = match name {
            "white" => Self::White(value),
            "slow" => Self::Slow(value),
            "const" => Self::Constant(value),
            "tilt" => Self::Tilt(value),
            "speed" => Self::Duration(value),
            "drop" => Self::Drop(value),
            "repeat" => Self::Repeat(value),
            "spikes" => Self::Spikes(value),
            "occlude" => Self::Occlude(value),
            "cam" => Self::Camera(value),
            "rate" => Self::Rate(value),
            _ => return Err(unknown()),
        };
        let fits = match made {
            Self::Duration(v) => (0.1..=10.0).contains(&v),
            Self::Rate(v) => (1.0..=1000.0).contains(&v),
            Self::Drop(v) | Self::Repeat(v) | Self::Spikes(v) | Self::Occlude(v) => {
                (0.0..1.0).contains(&v)
            }
            _ => value.is_finite() && value >= 0.0,
        };
        if fits { Ok(made) } else { Err(unknown()) }
    }
}

impl Perturbation {
    /// Its name on the command line.
    pub fn name(&self) -> &'static str {
        self.parts().0
    }

    /// Its size, in [`unit`](Self::unit).
    pub fn size(&self) -> f64 {
        self.parts().1
    }

    /// Unit of its size.
    pub fn unit(&self) -> &'static str {
        self.parts().2
    }

    /// The size that changes nothing, where there is one.
    pub fn unchanged_size(&self) -> Option<f64> {
        match self {
            Self::Duration(_) => Some(1.0),
            Self::Mirror | Self::Rate(_) => None,
            _ => Some(0.0),
        }
    }

    fn parts(&self) -> (&'static str, f64, &'static str) {
        match *self {
            Self::White(v) => ("white", v, "metres"),
            Self::Slow(v) => ("slow", v, "metres"),
            Self::Constant(v) => ("const", v, "metres"),
            Self::Tilt(v) => ("tilt", v, "degrees"),
            Self::Duration(v) => ("speed", v, "times the duration"),
            Self::Drop(v) => ("drop", v, "share of the frames"),
            Self::Repeat(v) => ("repeat", v, "share of the frames"),
            Self::Spikes(v) => ("spikes", v, "share of the frames"),
            Self::Occlude(v) => ("occlude", v, "share of the time, each limb"),
            Self::Mirror => ("mirror", 1.0, ""),
            Self::Camera(v) => ("cam", v, "times the noise of a webcam"),
            Self::Rate(v) => ("rate", v, "frames a second"),
        }
    }
}

impl fmt::Display for Perturbation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mirror => f.write_str(self.name()),
            _ => write!(f, "{}:{}", self.name(), self.size()),
        }
    }
}
