//! Report of an import.

use crate::clip::Span;

use crate::signed_axis::SignedAxis;

/// Properties of a clip that were inferred, or given in the options.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ImportReport {
    /// The direction that was up in the file; it is Y in the imported clip.
    pub up: SignedAxis,
    /// Metres in one of the file's units.
    pub metres_per_unit: f64,
    /// The unit's name, if it is a known one.
    pub unit: Option<&'static str>,
    /// Frames at the start that show a rest pose: `0..1`, or `0..0` if there is none.
    pub rest_frames: Span,
    /// From the soles to the top of the head, metres, as far as the joints tell.
    pub body_height: Option<f64>,
    /// Thigh and shin together, metres.
    pub leg_length: Option<f64>,
    /// True if the hips travel along the floor; without it, root motion says nothing.
    pub travels: bool,
    /// True if joints are known to turn; a clip of points has positions alone.
    pub has_rotations: bool,
    /// The published set of points, of a clip of points that was recognised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point_set: Option<&'static str>,
    /// Guesses worth doubting, each in a sentence.
    pub notes: Vec<String>,
    /// Properties that no person's body has, and which mislead recognition: each a sentence with a remedy.
    pub doubts: Vec<String>,
}
