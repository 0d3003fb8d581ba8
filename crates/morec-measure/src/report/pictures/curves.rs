//! A channel with its curves and keyframes, drawn.

use crate::plot::Chart;
use morec::clip::Clip;
use morec::smooth::{Bezier, ChannelKind, ChannelValue, CompressedClip, Curve};

/// Points drawn for each frame of the source.
const POINTS_A_FRAME: f64 = 4.0;
const NAMES: [&str; 4] = ["x", "y", "z", "w"];

/// A chart of a joint's rotation (as a quaternion) or position over time: samples of `source` (the clip that
/// was compressed), curves, keyframes. With `axis` (0 to 3 for x, y, z, w) only that component, and the curves'
/// control points with it. `None` if there is no such channel. O(frames).
pub fn channel_chart(
    compressed: &CompressedClip,
    source: &Clip,
    joint: usize,
    kind: ChannelKind,
    axis: Option<usize>,
) -> Option<Chart> {
    let curve = compressed.curve(joint, kind)?;
    let components = match kind {
        ChannelKind::Rotation => 0..4,
        ChannelKind::Position => 0..3,
    };
    let components = match axis {
        Some(axis) if components.contains(&axis) => axis..axis + 1,
        Some(_) => return None,
        None => components,
    };
    let what = match kind {
        ChannelKind::Rotation => "rotation",
        ChannelKind::Position => "position",
    };
    let name = &compressed.skeleton().joints()[joint].name;
    let title = format!(
        "{}: {what} of {name}, {} keyframes",
        compressed.name(),
        curve.keyframes()
    );
    let unit = if kind == ChannelKind::Rotation {
        "quaternion"
    } else {
        "units of the clip"
    };
    let mut chart = Chart::new(title).axes("seconds", unit);
    let samples = samples(source, curve);
    let drawn = drawn(compressed, curve);
    for c in components {
        let at = |i: usize| i as f64 / compressed.source_rate_hz();
        chart = chart.line(
            NAMES[c],
            samples.iter().enumerate().map(|(i, p)| (at(i), p[c])),
        );
        chart = chart.line(
            &format!("{} curves", NAMES[c]),
            drawn.iter().map(|(t, p)| (*t, p[c])),
        );
        if axis.is_some() {
            chart = chart.points("control points", control_points(compressed, curve, c));
        }
    }
    let first = std::iter::once(0.0);
    let keys = first.chain(
        compressed
            .beziers(curve)
            .map(|bezier| bezier.span.stop_secs),
    );
    Some(chart.marks("keyframes", keys))
}

/// The curve, finely.
fn drawn(compressed: &CompressedClip, curve: &Curve) -> Vec<(f64, ChannelValue)> {
    let last = compressed.source_frames().saturating_sub(1) as f64;
    let places = (0..=(last * POINTS_A_FRAME) as usize).map(|i| i as f64 / POINTS_A_FRAME);
    let mut drawn = Vec::new();
    curve.along(places, |point| {
        drawn.push((
            drawn.len() as f64 / POINTS_A_FRAME / compressed.source_rate_hz(),
            point,
        ))
    });
    drawn
}

/// Inner control points, at the thirds of their curves' times.
fn control_points(compressed: &CompressedClip, curve: &Curve, component: usize) -> Vec<(f64, f64)> {
    let inner = |bezier: Bezier| {
        let third = bezier.span.duration_secs() / 3.0;
        [1, 2].map(|i| {
            (
                bezier.span.start_secs + i as f64 * third,
                bezier.points[i][component],
            )
        })
    };
    compressed.beziers(curve).flat_map(inner).collect()
}

/// The channel's samples, with the signs that its curves have.
fn samples(source: &Clip, curve: &Curve) -> Vec<ChannelValue> {
    if curve.kind() == ChannelKind::Position {
        return source.track(curve.joint()).map_or_else(Vec::new, |track| {
            track.positions.iter().map(|p| p.push(0.0)).collect()
        });
    }
    let mut last = curve.at(0.0);
    let of_joint = source
        .rotations
        .iter()
        .skip(curve.joint())
        .step_by(source.skeleton.len());
    let signed = |q: &morec::math::Quat| {
        last = if last.dot(&q.coords) < 0.0 {
            -q.coords
        } else {
            q.coords
        };
        last
    };
    of_joint.map(signed).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use mocap::testing::pushing;
    use morec::smooth::{SmoothParams, compress};

    #[test]
    fn every_channel_can_be_drawn() {
        let clip = pushing();
        let compressed = compress(&clip, &SmoothParams::default(), &()).unwrap();
        let svg =
            |kind, axis| channel_chart(&compressed, &clip, 0, kind, axis).map(|chart| chart.svg());
        let all = svg(ChannelKind::Rotation, None).unwrap();
        assert!(
            all.contains("rotation of Hips")
                && all.contains("w curves")
                && all.contains("keyframes")
        );
        let one = svg(ChannelKind::Position, Some(0)).unwrap();
        assert!(
            one.contains("x curves") && !one.contains("y curves") && one.contains("control points")
        );
        assert!(
            svg(ChannelKind::Position, Some(3)).is_none()
                && svg(ChannelKind::Rotation, Some(4)).is_none()
        );
        let none = clip.skeleton.joints().len();
        assert!(channel_chart(&compressed, &clip, none, ChannelKind::Rotation, None).is_none());
    }
}
