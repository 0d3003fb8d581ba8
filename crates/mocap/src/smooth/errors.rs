//! Differences between a compressed clip and its source, as numbers.

/// Distances between a clip and its curves, over all frames and joints.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Errors {
    /// Largest angle between a joint's rotations in its parent's frame, radians.
    pub max_angle_rad: f64,
    /// Mean of these angles over joints and frames.
    pub mean_angle_rad: f64,
    /// Largest distance between positions in the parent's frame, metres, over joints that move in it.
    pub max_position_metres: f64,
    /// Mean of these distances.
    pub mean_position_metres: f64,
    /// Largest distance between positions in the world, metres, over all joints.
    pub max_joint_position_metres: f64,
    /// Mean of these distances.
    pub mean_joint_position_metres: f64,
}

impl Errors {
    pub(super) fn as_array(&self) -> [f64; 6] {
        [
            self.max_angle_rad,
            self.mean_angle_rad,
            self.max_position_metres,
            self.mean_position_metres,
            self.max_joint_position_metres,
            self.mean_joint_position_metres,
        ]
    }

    pub(super) fn from_array(values: [f64; 6]) -> Self {
        Self {
            max_angle_rad: values[0],
            mean_angle_rad: values[1],
            max_position_metres: values[2],
            mean_position_metres: values[3],
            max_joint_position_metres: values[4],
            mean_joint_position_metres: values[5],
        }
    }
}
