//! Infers the up axis, and rotates the clip so that Y is up.

use super::body::BodyMeasures;
use super::options::Stated;
use crate::clip::Clip;
use crate::math::{Axis, Quat, Vec3, portable, quantile, same_hemisphere};
use crate::signed_axis::SignedAxis;

/// The axis that the format states, unless the body clearly stands along another; else the axis inferred from the body.
pub(super) fn choose(
    clip: &Clip,
    body: &BodyMeasures,
    stated: Option<Stated>,
    notes: &mut Vec<String>,
) -> SignedAxis {
    let Some(Stated { up: stated, .. }) = stated else {
        return infer_up(clip, body, notes);
    };
    match standing(body) {
        // Who crawls or lies through the whole clip is on the floor of the axis that is stated.
        Some(up) if up != stated && !lies(body, stated, up) => {
            notes.push(format!(
                "the file's format has {stated} up, but the body stands along {up}, which is used (--up AXIS overrides it)"
            ));
            up
        }
        _ => stated,
    }
}

/// The axis along which the head is above the feet, over the whole clip.
fn infer_up(clip: &Clip, body: &BodyMeasures, notes: &mut Vec<String>) -> SignedAxis {
    if body.upwards.iter().all(|v| v.norm() == 0.0) {
        // A hand points anywhere.
        if body.hand.is_some() && body.head_over_shoulders.is_empty() {
            return SignedAxis::Y;
        }
        if let Some(up) = along(&body.head_over_shoulders) {
            return up;
        }
        if is_flat(clip) {
            notes.push(
                "points in two dimensions: the picture is taken for the floor, seen from above"
                    .to_owned(),
            );
            return SignedAxis {
                axis: Axis::Z,
                negative: false,
            };
        }
        if let Some(up) = floor(clip) {
            notes.push(format!(
                "the up axis is unknown, because no head is above feet; {up} is used, because all points are above 0 along it \
                 only (--up AXIS overrides it)"
            ));
            return up;
        }
        notes.push("the up axis is unknown, because no head is above feet; Y is assumed (--up AXIS overrides it)".to_owned());
        return SignedAxis::Y;
    }
    let Some(up) = standing(body) else {
        return lying(body, notes);
    };
    // Who starts a sprint or crawls lies along an axis on the floor of another. X is up nowhere; places in pictures,
    // where Y points down, may begin at 0 with the head.
    if up.axis != Axis::X || is_on_floor(body, up) {
        return up;
    }
    let usual = [Axis::Y, Axis::Z].map(|axis| SignedAxis {
        axis,
        negative: false,
    });
    let mut floors = usual.into_iter().filter(|axis| is_on_floor(body, *axis));
    match (floors.next(), floors.next()) {
        (Some(floor), None) => {
            notes.push(format!(
                "the body is longest along {up}, but stays on the floor along {floor}, which is used as the up axis (--up AXIS \
                 overrides it)"
            ));
            floor
        }
        _ => up,
    }
}

/// The axis along which the body stands through most of the clip; `None` where it lies, turns over or is not known.
fn standing(body: &BodyMeasures) -> Option<SignedAxis> {
    along(&body.upwards)
}

/// The axis that lines of a body point along through most of the clip, if one clearly is.
fn along(lines: &[Vec3]) -> Option<SignedAxis> {
    /// A mean shorter than this share of the body, or not longer than its next axis by this factor, says little.
    const SHORT: f64 = 0.5;
    const CLEAR: f64 = 1.5;
    let sum: Vec3 = lines.iter().sum();
    let lengths: f64 = lines.iter().map(|v| v.norm()).sum();
    let biggest = sum.iamax();
    let next = (0..3)
        .filter(|&axis| axis != biggest)
        .map(|axis| sum[axis].abs())
        .fold(0.0, f64::max);
    let clear = sum.norm() >= SHORT * lengths && sum[biggest].abs() >= CLEAR * next;
    (lengths > 0.0 && clear).then(|| SignedAxis {
        axis: Axis::ALL[biggest],
        negative: sum[biggest] < 0.0,
    })
}

/// The direction that is up where somebody lies, crawls or turns over: along which axis the body stands at its straightest, and
/// where the floor is, which its lowest point never leaves.
fn lying(body: &BodyMeasures, notes: &mut Vec<String>) -> SignedAxis {
    const UNSURE: f64 = 0.25;
    let size = body.upwards.iter().map(|v| v.norm()).fold(0.0, f64::max);
    let mut scores: Vec<(f64, SignedAxis)> = Vec::with_capacity(6);
    for axis in Axis::ALL {
        for negative in [false, true] {
            let up = SignedAxis { axis, negative };
            let along = |v: &Vec3| v.dot(&up.unit());
            let stands = quantile(body.upwards.iter().map(along).collect(), 0.95) / size;
            let lowest = lowest(body, up);
            let spread = (quantile(lowest.clone(), 0.9) - quantile(lowest, 0.1)) / size;
            let usual = match (axis, negative) {
                (Axis::Y, false) => 0.2,
                (Axis::Z, false) => 0.1,
                _ => 0.0,
            };
            scores.push((stands + 0.5 * portable::exp(-10.0 * spread) + usual, up));
        }
    }
    scores.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (best, up) = scores[0];
    if best - scores[1].0 < UNSURE {
        notes.push(format!(
            "the body hardly stands; {up} is assumed to be up (--up AXIS overrides it)"
        ));
    }
    up
}

/// How high the lowest point of the body is in each pose, in the file's units.
fn lowest(body: &BodyMeasures, up: SignedAxis) -> Vec<f64> {
    let up = up.unit();
    let lowest = |pose: &Vec<Vec3>| pose.iter().map(|v| v.dot(&up)).fold(f64::MAX, f64::min);
    body.poses.iter().map(lowest).collect()
}

/// True if the body, which is longest along one axis, stays on the floor of another.
fn lies(body: &BodyMeasures, up: SignedAxis, along: SignedAxis) -> bool {
    is_on_floor(body, up) && !is_on_floor(body, along)
}

/// True if through nearly all of the clip the lowest point of the body is at height 0, or a bent leg's foot above.
fn is_on_floor(body: &BodyMeasures, up: SignedAxis) -> bool {
    const BELOW: f64 = -0.025;
    const ABOVE: f64 = 0.25;
    let size = body.upwards.iter().map(|v| v.norm()).fold(0.0, f64::max);
    let lowest = lowest(body, up);
    !lowest.is_empty()
        && quantile(lowest.clone(), 0.1) > BELOW * size
        && quantile(lowest, 0.9) < ABOVE * size
}

/// The one axis, Y or Z, along which no point of a clip of points is ever below the floor of the room.
fn floor(clip: &Clip) -> Option<SignedAxis> {
    if clip.has_rotations() {
        return None;
    }
    let positions = || clip.tracks.iter().flat_map(|track| &track.positions);
    let mut above = [Axis::Y, Axis::Z].into_iter().filter(|axis| {
        let values = || positions().map(|p| p[axis.index()]);
        let (low, high) = (
            values().fold(f64::MAX, f64::min),
            values().fold(f64::MIN, f64::max),
        );
        // Markers on soles sink a little.
        high > 0.0 && low > -0.02 * high
    });
    let axis = above.next().filter(|_| above.next().is_none())?;
    Some(SignedAxis {
        axis,
        negative: false,
    })
}

/// True of points in a picture, whose z is 0.
fn is_flat(clip: &Clip) -> bool {
    let mut positions = clip.tracks.iter().flat_map(|track| &track.positions);
    !clip.has_rotations() && positions.all(|p| p.z == 0.0 || p.z.is_nan())
}

/// Turns the whole clip so that `up` becomes Y: only what is in the world's frame changes, that is, the roots.
pub(super) fn turn_up(clip: &mut Clip, up: SignedAxis) {
    if up == SignedAxis::Y {
        return;
    }
    let turn = up.to_y();
    let joints = clip.skeleton.len();
    let roots: Vec<usize> = (0..joints)
        .filter(|&j| clip.skeleton.joints()[j].parent.is_none())
        .collect();
    // Points do not turn.
    let turned: &[usize] = if clip.has_rotations() { &roots } else { &[] };
    for &root in turned {
        let mut previous: Option<Quat> = None;
        for frame in 0..clip.frames {
            let rotation = &mut clip.rotations[frame * joints + root];
            let turned = turn * *rotation;
            *rotation = previous.map_or(turned, |p| same_hemisphere(&p, turned));
            previous = Some(*rotation);
        }
    }
    for track in clip
        .tracks
        .iter_mut()
        .filter(|track| roots.contains(&track.joint))
    {
        for position in &mut track.positions {
            *position = turn * *position;
        }
    }
    clip.skeleton.map_offsets(|joint, offset| {
        if joint.parent.is_none() {
            turn * offset
        } else {
            offset
        }
    });
}
