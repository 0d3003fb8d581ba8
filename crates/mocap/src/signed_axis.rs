//! Coordinate axes with a sign.

use std::fmt;
use std::str::FromStr;

use crate::math::{Axis, Quat, Vec3};

/// An axis with a direction; written `y`, `-z`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(try_from = "String")]
pub struct SignedAxis {
    /// The axis without its direction.
    pub axis: Axis,
    /// Against its direction.
    pub negative: bool,
}

impl SignedAxis {
    /// Up in every imported clip.
    pub const Y: SignedAxis = SignedAxis {
        axis: Axis::Y,
        negative: false,
    };

    /// The direction, of length 1.
    pub fn unit(self) -> Vec3 {
        let unit = self.axis.unit().into_inner();
        if self.negative { -unit } else { unit }
    }

    /// A rotation by quarter turns that takes this axis to Y.
    pub fn to_y(self) -> Quat {
        use std::f64::consts::{FRAC_PI_2, PI};
        match (self.axis, self.negative) {
            (Axis::Y, false) => Quat::identity(),
            (Axis::Y, true) => Axis::X.rotation(PI),
            (Axis::Z, false) => Axis::X.rotation(-FRAC_PI_2),
            (Axis::Z, true) => Axis::X.rotation(FRAC_PI_2),
            (Axis::X, false) => Axis::Z.rotation(FRAC_PI_2),
            (Axis::X, true) => Axis::Z.rotation(-FRAC_PI_2),
        }
    }
}

impl TryFrom<String> for SignedAxis {
    type Error = NoAxis;

    fn try_from(text: String) -> Result<Self, NoAxis> {
        text.parse()
    }
}

impl fmt::Display for SignedAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.negative { "-" } else { "" };
        write!(f, "{sign}{}", ["x", "y", "z"][self.axis.index()])
    }
}

/// Text that is no axis.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("expected x, y, z, -x, -y or -z, found `{0}`")]
pub struct NoAxis(String);

impl FromStr for SignedAxis {
    type Err = NoAxis;

    fn from_str(text: &str) -> Result<Self, NoAxis> {
        let (negative, letter) = match text.strip_prefix('-') {
            Some(letter) => (true, letter),
            None => (false, text.strip_prefix('+').unwrap_or(text)),
        };
        let mut letters = letter.chars();
        match (letters.next().and_then(Axis::from_letter), letters.next()) {
            (Some(axis), None) => Ok(Self { axis, negative }),
            _ => Err(NoAxis(text.to_owned())),
        }
    }
}

impl serde::Serialize for SignedAxis {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
