//! Cubic Bézier segments of one channel.

use nalgebra::{Matrix4x3, Quaternion, Vector3, Vector4};

use crate::math::Quat;

/// A value of a channel: a quaternion `[x, y, z, w]`, or a position `[x, y, z, 0]`.
pub type ChannelValue = Vector4<f64>;
/// A tangent: of a rotation in the frame of its key, of a position as it is.
pub(super) type Tangent = Vector3<f64>;

/// Kind of a channel's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ChannelKind {
    /// Rotations of a joint, as unit quaternions. A curve's value is brought to length 1.
    Rotation,
    /// Positions of a joint in its parent's frame.
    Position,
}

/// A curve's value, which has length 1 already.
pub(super) fn rotation(point: &ChannelValue) -> Quat {
    Quat::new_unchecked(Quaternion::from(*point))
}

/// Bernstein polynomials of degree 3 at `t` (thesis, Eq. 3.3).
pub(super) fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// A stretch of a channel: a cubic Bézier curve (thesis, Eq. 3.2 and 3.4) over `frames` sample periods.
///
/// Lower degrees stand in their cubic form. The parameter runs evenly in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CurveSegment {
    /// First sample.
    pub start: u32,
    /// Sample periods that the curve lasts.
    pub frames: u32,
    /// Control points P0 to P3; P0 and P3 are the keys.
    pub points: [ChannelValue; 4],
}

impl CurveSegment {
    /// The value at `place` (in sample periods from the clip's start).
    pub fn at(&self, kind: ChannelKind, place: f64) -> ChannelValue {
        let t = ((place - f64::from(self.start)) / f64::from(self.frames)).clamp(0.0, 1.0);
        let weights = bernstein(t);
        let [p0, p1, p2, p3] = &self.points;
        let sum = p0 * weights[0] + p1 * weights[1] + p2 * weights[2] + p3 * weights[3];
        kind.finish(sum).unwrap_or(*p0)
    }
}

impl ChannelKind {
    /// A curve's raw value made a value of the channel; `None` for a quaternion that vanishes.
    pub(super) fn finish(self, raw: ChannelValue) -> Option<ChannelValue> {
        match self {
            ChannelKind::Position => Some(raw),
            ChannelKind::Rotation => {
                let norm = raw.norm();
                (norm > 1e-9).then(|| raw / norm)
            }
        }
    }

    /// `value` as seen from `origin`: `origin* value` for rotations, the difference for positions. Keeps distances.
    pub(super) fn local(self, origin: &ChannelValue, value: &ChannelValue) -> ChannelValue {
        match self {
            ChannelKind::Position => value - origin,
            ChannelKind::Rotation => product(
                &ChannelValue::new(-origin.x, -origin.y, -origin.z, origin.w),
                value,
            ),
        }
    }

    /// The origin as seen from itself.
    pub(super) fn identity(self) -> ChannelValue {
        match self {
            ChannelKind::Position => ChannelValue::zeros(),
            ChannelKind::Rotation => ChannelValue::w(),
        }
    }

    /// Derivative of the value by a tangent at `key`, in the coordinates that `key` is given in: 4 × 3, columns
    /// orthonormal.
    pub(super) fn tangents(self, key: &ChannelValue) -> Matrix4x3<f64> {
        match self {
            ChannelKind::Position => Matrix4x3::identity(),
            ChannelKind::Rotation => {
                let [x, y, z, w]: [f64; 4] = (*key).into();
                Matrix4x3::new(w, -z, y, z, w, -x, -y, x, w, -x, -y, -z)
            }
        }
    }
}

/// Hamilton's product.
fn product(a: &ChannelValue, b: &ChannelValue) -> ChannelValue {
    ChannelValue::new(
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
        a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x,
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
    )
}
