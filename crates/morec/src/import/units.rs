//! How long the file's unit of length is, from how tall a body is.

use super::SignedAxis;
use super::body::Body;
use crate::clip::Clip;

/// Units that files are written in: name, metres.
const UNITS: [(&str, f64); 6] = [
    ("m", 1.0),
    ("dm", 0.1),
    ("CMU unit (inch / 0.45)", 0.0254 / 0.45),
    ("inch", 0.0254),
    ("cm", 0.01),
    ("mm", 0.001),
];

/// What the height of most people comes to, measured from the ankles to the top of the head.
const HEIGHT: f64 = 1.65;

/// The known unit in which the body comes nearest to a person's height.
pub(super) fn infer(body: &Body, up: SignedAxis, notes: &mut Vec<String>) -> f64 {
    let Some(height) = body.height(up).filter(|&height| height > 0.0) else {
        notes.push("no body to measure; lengths are taken as metres".to_owned());
        return 1.0;
    };
    let away = |metres: f64| (height * metres / HEIGHT).ln().abs();
    let nearest = |a: &&(&str, f64), b: &&(&str, f64)| away(a.1).total_cmp(&away(b.1));
    let (unit, metres) = UNITS.iter().min_by(nearest).copied().unwrap_or(("m", 1.0));
    let tall = height * metres;
    if !(1.0..=2.3).contains(&tall) {
        notes.push(format!(
            "in {unit}, the nearest known unit, the body is {tall:.2} m tall"
        ));
    }
    metres
}

/// The name of a known unit.
pub(super) fn name(metres_per_unit: f64) -> Option<&'static str> {
    UNITS
        .iter()
        .find(|(_, metres)| (metres / metres_per_unit - 1.0).abs() < 1e-6)
        .map(|(name, _)| *name)
}

/// Multiplies every length of the clip.
pub(super) fn scale(clip: &mut Clip, factor: f64) {
    if factor == 1.0 {
        return;
    }
    clip.skeleton.map_offsets(|_, offset| offset * factor);
    clip.skeleton.map_tips(|tip| tip * factor);
    for track in &mut clip.tracks {
        for position in &mut track.positions {
            *position *= factor;
        }
    }
}
