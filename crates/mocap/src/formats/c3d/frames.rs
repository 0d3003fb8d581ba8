//! Frames of points.

use super::layout::C3dLayout;
use super::number::Processor;
use crate::formats::points::{Point, UNSEEN};
use crate::math::Vec3;

/// The positions of the points in `wanted`, frame by frame.
pub(super) fn points(
    bytes: &[u8],
    layout: &C3dLayout,
    processor: Processor,
    scale: f64,
    names: &[String],
    wanted: &[usize],
) -> Vec<Point> {
    let data = bytes.get(layout.start..).unwrap_or_default();
    let point_bytes = if layout.floats { 16 } else { 8 };
    let mut points: Vec<Point> = wanted
        .iter()
        .map(|&p| Point {
            name: names[p].clone(),
            positions: Vec::with_capacity(layout.frames),
        })
        .collect();
    for frame in data.chunks_exact(layout.frame_bytes()).take(layout.frames) {
        for (&p, point) in wanted.iter().zip(&mut points) {
            let value = &frame[p * point_bytes..(p + 1) * point_bytes];
            let position = match layout.floats {
                true => float_point(value, processor),
                false => integer_point(value, processor).map(|p| p * scale),
            };
            point.positions.push(position.unwrap_or(UNSEEN));
        }
    }
    points
}

/// A position and its residual, which is negative if the point was not seen.
fn float_point(value: &[u8], processor: Processor) -> Option<Vec3> {
    let at = |i: usize| {
        processor.f32([
            value[4 * i],
            value[4 * i + 1],
            value[4 * i + 2],
            value[4 * i + 3],
        ])
    };
    (at(3) >= 0.0 || at(3).is_nan()).then(|| Vec3::new(at(0), at(1), at(2)))
}

fn integer_point(value: &[u8], processor: Processor) -> Option<Vec3> {
    let at = |i: usize| processor.i16([value[2 * i], value[2 * i + 1]]);
    (at(3) >= 0).then(|| Vec3::new(at(0).into(), at(1).into(), at(2).into()))
}
