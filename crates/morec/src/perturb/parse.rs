//! Perturbations as people type them: `white:0.01`.

use std::fmt;
use std::str::FromStr;

use super::Perturbation;

/// A text that names no perturbation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "expected white:METRES, slow:METRES, const:METRES, tilt:DEGREES, speed:FACTOR, drop:SHARE, repeat:SHARE, \
     spikes:SHARE, cam:FACTOR, rate:HZ or mirror, found `{0}`"
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
            "cam" => Self::Camera(value),
            "rate" => Self::Rate(value),
            _ => return Err(unknown()),
        };
        let fits = match made {
            Self::Duration(v) => (0.1..=10.0).contains(&v),
            Self::Rate(v) => (1.0..=1000.0).contains(&v),
            Self::Drop(v) | Self::Repeat(v) | Self::Spikes(v) => (0.0..1.0).contains(&v),
            _ => value.is_finite() && value >= 0.0,
        };
        if fits { Ok(made) } else { Err(unknown()) }
    }
}

impl fmt::Display for Perturbation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::White(v) => write!(f, "white:{v}"),
            Self::Slow(v) => write!(f, "slow:{v}"),
            Self::Constant(v) => write!(f, "const:{v}"),
            Self::Tilt(v) => write!(f, "tilt:{v}"),
            Self::Duration(v) => write!(f, "speed:{v}"),
            Self::Drop(v) => write!(f, "drop:{v}"),
            Self::Repeat(v) => write!(f, "repeat:{v}"),
            Self::Spikes(v) => write!(f, "spikes:{v}"),
            Self::Mirror => f.write_str("mirror"),
            Self::Camera(v) => write!(f, "cam:{v}"),
            Self::Rate(v) => write!(f, "rate:{v}"),
        }
    }
}
