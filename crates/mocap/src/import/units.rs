//! Infers the file's unit of length from the height of the body.

use std::ops::RangeInclusive;

use super::body::BodyMeasures;
use super::options::Stated;
use crate::clip::Clip;
use crate::math::portable;
use crate::roles::proportions as human;
use crate::signed_axis::SignedAxis;

/// Units that files are written in: name, metres.
const UNITS: [(&str, f64); 6] = [
    ("m", 1.0),
    ("dm", 0.1),
    ("CMU unit (inch / 0.45)", 0.0254 / 0.45),
    ("inch", 0.0254),
    ("cm", 0.01),
    ("mm", 0.001),
];

/// The unit that the file or its format states, if the body's size is plausible in it; else the unit inferred from the body.
pub(super) fn choose(
    clip: &Clip,
    body: &BodyMeasures,
    up: SignedAxis,
    format: Option<Stated>,
    notes: &mut Vec<String>,
) -> f64 {
    let stated = clip
        .points
        .as_ref()
        .and_then(|points| points.metres_per_unit)
        .or(format.map(|stated| stated.metres_per_unit));
    let Some(stated) = stated else {
        return infer(body, up, notes);
    };
    let Some(height) = height(body, up) else {
        return stated;
    };
    if (0.5..=2.6).contains(&(height * stated)) {
        return stated;
    }
    if let Some((unit, metres)) = taken_for_metres(body, up, stated) {
        notes.push(format!(
            "the file's unit is {}, but then the body is {:.3} m tall; the lengths fit a person if they are in {unit} and a \
             program exported them as metres, which is assumed (--unit {stated} keeps the file's unit)",
            name(stated).unwrap_or("stated"),
            height * stated,
        ));
        return metres;
    }
    let inferred = infer(body, up, notes);
    // Who crawls is low, and no other unit fits the limbs better.
    if (inferred / stated - 1.0).abs() < 1e-6 {
        return stated;
    }
    notes.push(format!(
        "the file's unit is {}, but then the body is {:.3} m tall; {} is used (--unit {} keeps the file's unit)",
        name(stated).unwrap_or("stated"),
        height * stated,
        name(inferred).unwrap_or("another"),
        stated
    ));
    inferred
}

/// The height of a body, or what its legs make of it.
fn height(body: &BodyMeasures, up: SignedAxis) -> Option<f64> {
    // Legs from hip to ankle are half of what is above the ankles.
    let by_leg = body.leg.map(|leg| 2.0 * leg);
    body.height(up).or(by_leg).filter(|&height| height > 0.0)
}

/// Usual height from the ankles to the top of the head, metres.
const HEIGHT: f64 = 1.65;

/// Size of the body as a multiple of a usual adult's, by one of the file's units a metre.
///
/// Legs, arms and trunk belong to the skeleton: they are the same in every clip of it, however somebody crouches. The
/// median is taken, so that a cartoon's legs or long arms do not decide; only a body of which they are not
/// known is measured by its height.
fn size(body: &BodyMeasures, up: SignedAxis) -> Option<f64> {
    let usual = [
        (body.leg, human::LEG),
        (body.arm, human::LEG * human::ARM_TO_LEG),
        (body.trunk, human::LEG * human::TRUNK_TO_LEG),
    ];
    let shares = usual
        .into_iter()
        .filter_map(|(length, usual)| Some(length? / usual));
    let mut shares: Vec<f64> = shares.filter(|&share| share > 0.0).collect();
    shares.sort_by(f64::total_cmp);
    match shares.as_slice() {
        [_, middle, _] => Some(*middle),
        [a, b] => Some((a * b).sqrt()),
        [one] if body.leg.is_some() => Some(*one),
        _ => height(body, up)
            .map(|height| height / HEIGHT)
            .or_else(|| size_of_arms(body))
            .or_else(|| body.hand.map(|hand| hand / human::HAND)),
    }
}

/// The same of a body without legs.
fn size_of_arms(body: &BodyMeasures) -> Option<f64> {
    const ARM: f64 = human::LEG * human::ARM_TO_LEG;
    let arm = body.arm.map(|arm| arm / ARM);
    let shoulders = body
        .shoulders
        .map(|breadth| breadth / (ARM * human::BETWEEN_SHOULDERS));
    let size = match (arm, shoulders) {
        (Some(a), Some(b)) => Some((a * b).sqrt()),
        (a, b) => a.or(b),
    };
    size.filter(|&size| size > 0.0)
}

/// How tall a person with limbs and trunk of this size is, metres; what lies outside is doubted.
const TALL: RangeInclusive<f64> = 1.0..=2.3;

/// The known unit whose lengths a program took for metres and wrote in the stated unit, and what the file's unit then is in metres.
///
/// Blender reads BVH, which names no unit, as metres and writes FBX in centimetres. `None` if a known unit by itself makes a
/// person of the body, or none makes one in this way either.
fn taken_for_metres(
    body: &BodyMeasures,
    up: SignedAxis,
    stated: f64,
) -> Option<(&'static str, f64)> {
    let size = size(body, up)?;
    let makes_a_person = |metres: f64| TALL.contains(&(size * metres * HEIGHT));
    let (_, known) = nearest_known(size);
    if makes_a_person(known) {
        return None;
    }
    let (unit, metres) = nearest_known(size * stated);
    makes_a_person(stated * metres).then_some((unit, stated * metres))
}

/// The known unit, and its metres, in which a body of this size comes nearest to an adult's.
fn nearest_known(size: f64) -> (&'static str, f64) {
    let away = |metres: f64| portable::ln(size * metres).abs();
    let nearest = |a: &&(&str, f64), b: &&(&str, f64)| away(a.1).total_cmp(&away(b.1));
    UNITS.iter().min_by(nearest).copied().unwrap_or(("m", 1.0))
}

/// The known unit in which the body comes nearest to a person's size.
pub(super) fn infer(body: &BodyMeasures, up: SignedAxis, notes: &mut Vec<String>) -> f64 {
    let Some(size) = size(body, up) else {
        notes.push("no body to measure; lengths are read as metres".to_owned());
        return 1.0;
    };
    let (unit, metres) = nearest_known(size);
    let tall = size * metres * HEIGHT;
    if !TALL.contains(&tall) {
        notes.push(format!(
            "{unit} is the best-fitting unit, but then limbs and trunk are those of a person {tall:.2} m tall"
        ));
    }
    metres
}

/// A sentence about legs that, in this unit, are too short or too long for a person; `None` otherwise.
pub(super) fn doubt(body: &BodyMeasures, metres_per_unit: f64) -> Option<String> {
    let leg = body.leg? * metres_per_unit;
    (!(0.3..=1.3).contains(&leg)).then(|| {
        format!(
            "legs of {leg:.3} m do not fit a person: give the unit with --unit METRES, or the joints with --roles FILE"
        )
    })
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
