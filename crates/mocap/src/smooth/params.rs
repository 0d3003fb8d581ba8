//! Thresholds of the difference between a compressed clip and its source.

/// Thresholds of [`compress`](super::compress).
///
/// The thesis (§3.3.3, Alg. 1) asks for "a given (small) threshold" and prints no value; the defaults here are
/// half a degree and five millimetres, about what marker-based capture itself is good for.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct SmoothParams {
    /// Largest angle between a joint's rotation and its curve's at any frame, radians; 1e-6 to 1.
    pub angle_rad: f64,
    /// Largest distance between a moving joint's position in its parent's frame and its curve's, metres; 1e-7 to 10.
    pub position_metres: f64,
    /// Largest distance between where a joint is in the world and where the curves put it, metres; 1e-6 to 10.
    /// `None` leaves this open: errors of the joints of a chain then add up.
    pub joint_position_metres: Option<f64>,
    /// Metres in one of the clip's units of length; 1 after [`import`](crate::import).
    pub metres_per_unit: f64,
}

impl Default for SmoothParams {
    /// Channel by channel, as in the thesis.
    fn default() -> Self {
        Self {
            angle_rad: 0.5f64.to_radians(),
            position_metres: 0.005,
            joint_position_metres: None,
            metres_per_unit: 1.0,
        }
    }
}

impl SmoothParams {
    /// The quality of databases: every angle within half a degree and every joint within five millimetres of where it
    /// was in the world.
    pub fn database() -> Self {
        Self {
            joint_position_metres: Some(0.005),
            ..Self::default()
        }
    }

    /// Checks that every number is within its range.
    pub(super) fn check(&self) -> Result<(), SmoothError> {
        let figures = [
            ("angle_rad", Some(self.angle_rad), 1e-6, 1.0),
            ("position_metres", Some(self.position_metres), 1e-7, 10.0),
            (
                "joint_position_metres",
                self.joint_position_metres,
                1e-6,
                10.0,
            ),
            ("metres_per_unit", Some(self.metres_per_unit), 1e-9, 1e9),
        ];
        for (name, value, least, most) in figures {
            if let Some(found) = value.filter(|value| !(least..=most).contains(value)) {
                return Err(SmoothError::Param {
                    name,
                    least,
                    most,
                    found,
                });
            }
        }
        Ok(())
    }
}

/// Why a clip was not compressed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SmoothError {
    /// A threshold beyond all use.
    #[error("{name}: expected {least:e} to {most:e}, found {found:e}")]
    Param {
        /// Name of the parameter.
        name: &'static str,
        /// The least it may be.
        least: f64,
        /// The most it may be.
        most: f64,
        /// The refused value.
        found: f64,
    },
    /// Tables whose sizes disagree, or a rate beyond all use.
    #[error("not a whole clip: {0}")]
    Clip(String),
    /// A value that is no number, or one too large for the thresholds.
    #[error(
        "joint {joint} ({name}), frame {frame}: expected finite values below {most:e}, found others"
    )]
    Value {
        /// Index of the joint in the skeleton.
        joint: usize,
        /// Name of the clip.
        name: String,
        /// Frame of the clip, from 0.
        frame: usize,
        /// The largest value allowed, in the clip's unit of length.
        most: f64,
    },
    /// The bound on world positions was not reached, however small the errors of single joints were made.
    #[error(
        "joints within {bound_metres} m of their original positions: the best reached is {reached_metres} m"
    )]
    Bound {
        /// The bound asked for, metres.
        bound_metres: f64,
        /// The smallest error that was reached, metres.
        reached_metres: f64,
    },
    /// The listener said so.
    #[error("cancelled")]
    Cancelled,
}
