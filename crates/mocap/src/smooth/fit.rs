//! Least-squares fit of one Bézier curve to a stretch of samples (thesis, §3.3.2).
//!
//! Everything is seen from the first key, so rotations and positions are one problem. The thesis leaves the inner
//! points of a quaternion curve free in four dimensions (Eq. 3.5 and 3.6); here each keeps to the tangent space of
//! its key, as corrected: a value is brought to length 1 when it is used, so the fourth number would say nothing.

use nalgebra::{Matrix3, Matrix4x3, Vector3, Vector4};

use super::bezier::{ChannelKind, ChannelValue, Tangent, bernstein};

/// Samples between two keys, seen from the first: `samples[0]` is (nearly) the identity.
pub(super) struct FitSpan<'a> {
    kind: ChannelKind,
    samples: &'a [ChannelValue],
    end: ChannelValue,
    /// Derivative by a tangent at the last key.
    end_tangents: Matrix4x3<f64>,
}

/// The sums of the normal equations.
struct NormalEquations {
    /// Σ B₁², Σ B₁B₂, Σ B₂² over the inner samples.
    b11: f64,
    b12: f64,
    b22: f64,
    /// Σ B₁ d and Σ B₂ d, where d is what the keys leave of the samples (Eq. 3.6, right-hand side).
    b1d: Vector4<f64>,
    b2d: Vector4<f64>,
}

/// The sample that a curve misses most.
#[derive(Debug, Clone, Copy)]
pub(super) struct Worst {
    /// Its number, from the start of the stretch.
    pub index: usize,
    /// Squared distance over the squared distance allowed there.
    pub ratio: f64,
}

impl<'a> FitSpan<'a> {
    /// A stretch of at least two `samples`, which end near `end`.
    pub fn new(kind: ChannelKind, samples: &'a [ChannelValue], end: ChannelValue) -> Self {
        Self {
            kind,
            samples,
            end,
            end_tangents: kind.tangents(&end),
        }
    }

    /// The vector part of the last key.
    pub fn chord(&self) -> Tangent {
        self.end.xyz()
    }

    fn parameter(&self, i: usize) -> f64 {
        i as f64 / (self.samples.len() - 1) as f64
    }

    fn sums(&self) -> NormalEquations {
        let start = self.kind.identity();
        let zero = Vector4::zeros();
        let mut sums = NormalEquations {
            b11: 0.0,
            b12: 0.0,
            b22: 0.0,
            b1d: zero,
            b2d: zero,
        };
        for i in 1..self.samples.len() - 1 {
            let [b0, b1, b2, b3] = bernstein(self.parameter(i));
            let d = self.samples[i] - start * (b0 + b1) - self.end * (b2 + b3);
            sums.b11 += b1 * b1;
            sums.b12 += b1 * b2;
            sums.b22 += b2 * b2;
            sums.b1d += d * b1;
            sums.b2d += d * b2;
        }
        sums
    }

    /// Tangents of the best cubic; `None` where fewer than two samples lie between the keys. O(samples).
    pub fn cubic(&self) -> Option<(Tangent, Tangent)> {
        if self.samples.len() < 4 {
            return None;
        }
        let s = self.sums();
        // b11 a + b12 M b = u,  b12 Mᵀ a + b22 b = v,  by elimination of a.
        let m = self.mixing();
        let (u, v) = (s.b1d.xyz(), self.end_tangents.transpose() * s.b2d);
        let left = Matrix3::identity() * s.b22 - m.transpose() * m * (s.b12 * s.b12 / s.b11);
        let b = left.try_inverse()? * (v - m.transpose() * u * (s.b12 / s.b11));
        let a = (u - m * b * s.b12) / s.b11;
        finite(a).zip(finite(b))
    }

    /// First tangent of the best parabola: the second is the first less two thirds of the chord. `None` where no
    /// sample lies between the keys. O(samples).
    pub fn parabola(&self) -> Option<Tangent> {
        if self.samples.len() < 3 {
            return None;
        }
        let s = self.sums();
        let m = self.mixing();
        let shift = self.chord() * (2.0 / 3.0);
        let right =
            s.b1d.xyz() + m * shift * s.b12 + self.end_tangents.transpose() * s.b2d + shift * s.b22;
        let left = Matrix3::identity() * (s.b11 + s.b22) + (m + m.transpose()) * s.b12;
        finite(left.try_inverse()? * right)
    }

    /// The last key's tangents in the first key's.
    fn mixing(&self) -> Matrix3<f64> {
        self.end_tangents.fixed_rows::<3>(0).into()
    }

    /// The place where the curve with these tangents is furthest from the samples, against `allowed(i)`, the squared
    /// distance that sample `i` may lie from it. Both ends are looked at as well. O(samples).
    pub fn worst(&self, (a, b): (Tangent, Tangent), allowed: impl Fn(usize) -> f64) -> Worst {
        let p0 = self.kind.identity();
        let (p1, p2) = (p0 + a.push(0.0), self.end + self.end_tangents * b);
        let mut worst = Worst {
            index: 0,
            ratio: 0.0,
        };
        let last = self.samples.len() - 1;
        for (i, sample) in self.samples.iter().enumerate() {
            let [b0, b1, b2, b3] = bernstein(self.parameter(i));
            let raw = p0 * b0 + p1 * b1 + p2 * b2 + self.end * b3;
            let value = self.kind.finish(raw).unwrap_or(p0);
            let mut square = (value - sample).norm_squared();
            if last == 1 && self.kind == ChannelKind::Rotation {
                // From one frame to the next a joint may flip: which way round is then nobody's to say.
                square = square.min((value + sample).norm_squared());
            }
            let ratio = square / allowed(i);
            if ratio > worst.ratio {
                worst = Worst { index: i, ratio };
            }
        }
        worst
    }
}

fn finite(v: Vector3<f64>) -> Option<Vector3<f64>> {
    v.iter().all(|x| x.is_finite()).then_some(v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point(spread: f64) -> impl Strategy<Value = ChannelValue> {
        let s = -spread..spread;
        [s.clone(), s.clone(), s.clone(), s].prop_map(ChannelValue::from)
    }

    /// Sum of squared distances of the raw curve, which is what is minimised.
    fn cost(stretch: &FitSpan, (a, b): (Tangent, Tangent)) -> f64 {
        let p0 = stretch.kind.identity();
        let points = [
            p0,
            p0 + a.push(0.0),
            stretch.end + stretch.end_tangents * b,
            stretch.end,
        ];
        let last = stretch.samples.len() - 1;
        let square = |i: usize| {
            let weights = bernstein(i as f64 / last as f64);
            let at: ChannelValue = (0..4).map(|k| points[k] * weights[k]).sum();
            (at - stretch.samples[i]).norm_squared()
        };
        (1..last).map(square).sum()
    }

    proptest! {
        /// No step away from the solution, in any direction, comes nearer to the samples.
        #[test]
        fn fits_are_least_squares(
            rotation in any::<bool>(),
            end in point(0.7),
            noise in prop::collection::vec(point(0.3), 1..12),
            step in point(0.01), other in point(0.01),
        ) {
            let kind = if rotation { ChannelKind::Rotation } else { ChannelKind::Position };
            let end = match kind {
                ChannelKind::Rotation => (ChannelValue::w() + end).normalize(),
                ChannelKind::Position => end.xyz().push(0.0),
            };
            let last = noise.len() + 1;
            let mut samples = vec![kind.identity()];
            for (i, n) in noise.iter().enumerate() {
                let n = if rotation { *n } else { n.xyz().push(0.0) };
                samples.push(kind.identity().lerp(&end, (i + 1) as f64 / last as f64) + n);
            }
            samples.push(end);
            let stretch = FitSpan::new(kind, &samples, end);
            let (step, other) = (step.xyz(), other.xyz());
            if let Some((a, b)) = stretch.cubic() {
                let best = cost(&stretch, (a, b));
                prop_assert!(cost(&stretch, (a + step, b + other)) >= best - 1e-9);
            } else {
                prop_assert!(samples.len() < 4);
            }
            let shift = end.xyz() * (2.0 / 3.0);
            let a = stretch.parabola().unwrap();
            let best = cost(&stretch, (a, a - shift));
            prop_assert!(cost(&stretch, (a + step, a + step - shift)) >= best - 1e-9);
        }
    }
}
