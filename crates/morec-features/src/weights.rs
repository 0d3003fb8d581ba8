//! How much each bone counts.

use crate::BONES;

/// Weight of each of [`ALL_BONES`](crate::ALL_BONES) in a distance between poses.
///
/// Those of the body were chosen on referee signals: arms tell gestures apart, legs matter less, the head's direction is noisy.
/// Those of hands and tracked points are a prototype's, in the units of these rows.
pub const BONE_WEIGHTS: [f64; BONES] = [
    0.8, 0.8, 0.8, 0.8, 1.0, 0.6, 1.0, 1.0, 1.0, 1.0, 0.3, // the body
    0.6, 0.6, 0.6, 0.6, 0.6, 0.5, 0.5, // the left hand
    0.6, 0.6, 0.6, 0.6, 0.6, 0.5, 0.5, // the right hand
    0.6, // between the palms
    1.8, 1.8, 1.0, // tracked points
    1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, // a custom skeleton's points of the middle
    1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, // of the left
    1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, // of the right
];
