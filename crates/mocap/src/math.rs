//! Geometry shared by all modules, on top of [`nalgebra`].

use nalgebra::{Unit, UnitQuaternion, Vector3};

/// A point or direction, in the units its name or docs give.
pub type Vec3 = Vector3<f64>;
/// A rotation; named `a_from_b`, it takes coordinates in frame `b` to coordinates in frame `a`.
pub type Quat = UnitQuaternion<f64>;

/// Functions that the standard library takes from the system, whose last digits differ from one to the other: these are the same
/// to the bit everywhere. What is not here (root, rounding, products) is exact in the standard library, too.
#[doc(hidden)] // Used by the crates that compute with clips only.
pub mod portable {
    use nalgebra::{ComplexField, RealField};

    macro_rules! functions {
        ($($kind:ident: $($name:ident($($argument:ident),*)),*;)*) => {
            $($(#[inline]
            #[allow(missing_docs)] // Named as in the standard library.
            pub fn $name<F: RealField + Copy>(x: F, $($argument: F),*) -> F {
                $kind::$name(x, $($argument),*)
            })*)*
        };
    }

    functions! {
        ComplexField: sin(), acos(), exp(), ln(), powf(exponent), hypot(y);
        RealField: atan2(x_axis);
    }

    /// Sine and cosine.
    #[inline]
    pub fn sin_cos<F: RealField + Copy>(angle_rad: F) -> (F, F) {
        ComplexField::sin_cos(angle_rad)
    }

    /// `base^exponent` of a normal positive number, where many are needed: to a relative error of 1e-10 before it is rounded, for results that are
    /// normal numbers. In sums and products alone, by the series of the inverse hyperbolic tangent and of the exponential.
    #[inline]
    pub fn power(base: f32, exponent: f32) -> f32 {
        let bits = f64::from(base).to_bits();
        // A mantissa from √½ to √2.
        const HALF: u64 = 0x3fe6_a09e_667f_3bcd;
        let twos = (bits.wrapping_sub(HALF) as i64) >> 52;
        let mantissa = f64::from_bits(bits.wrapping_sub((twos << 52) as u64));
        let t = (mantissa - 1.0) / (mantissa + 1.0);
        let square = t * t;
        // 1 + t²/3 + … + t^10/11, and 1 + x + … + x^9/9!, in pairs that do not wait for each other.
        let fourth = square * square;
        let series = (1.0 + square * (1.0 / 3.0))
            + fourth
                * ((1.0 / 5.0 + square * (1.0 / 7.0))
                    + fourth * (1.0 / 9.0 + square * (1.0 / 11.0)));
        let exponent =
            f64::from(exponent) * (twos as f64 + std::f64::consts::LOG2_E * 2.0 * t * series);
        // The nearest whole number stands in the last bits of this sum.
        const TO_WHOLE: f64 = 6_755_399_441_055_744.0;
        let whole = exponent + TO_WHOLE;
        let rest = (exponent - (whole - TO_WHOLE)) * std::f64::consts::LN_2;
        let (x, x2) = (rest, rest * rest);
        let x4 = x2 * x2;
        let low = (1.0 + x) + x2 * (1.0 / 2.0 + x * (1.0 / 6.0));
        let middle = (1.0 / 24.0 + x * (1.0 / 120.0)) + x2 * (1.0 / 720.0 + x * (1.0 / 5040.0));
        let value = low + x4 * (middle + x4 * (1.0 / 40320.0 + x * (1.0 / 362_880.0)));
        (value * f64::from_bits(whole.to_bits().wrapping_add(1023) << 52)) as f32
    }
}

/// A coordinate axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// First coordinate.
    X,
    /// Second coordinate.
    Y,
    /// Third coordinate.
    Z,
}

impl Axis {
    /// All three, in coordinate order.
    pub const ALL: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

    /// The axis that `x`, `y`, `z` (either case) names.
    pub(crate) fn from_letter(letter: char) -> Option<Self> {
        match letter.to_ascii_lowercase() {
            'x' => Some(Axis::X),
            'y' => Some(Axis::Y),
            'z' => Some(Axis::Z),
            _ => None,
        }
    }

    /// Index of the coordinate: 0 for x, 1 for y, 2 for z.
    pub fn index(self) -> usize {
        self as usize
    }

    /// The unit vector along this axis.
    pub fn unit(self) -> Unit<Vec3> {
        match self {
            Axis::X => Vec3::x_axis(),
            Axis::Y => Vec3::y_axis(),
            Axis::Z => Vec3::z_axis(),
        }
    }

    /// Rotation by `angle_rad` about this axis.
    pub fn rotation(self, angle_rad: f64) -> Quat {
        Quat::from_axis_angle(&self.unit(), angle_rad)
    }
}

/// The rotation of a quaternion `[x, y, z, w]` of any length but 0; `None` if it has no length or is not finite.
pub fn rotation_of_xyzw([x, y, z, w]: [f64; 4]) -> Option<Quat> {
    let q = nalgebra::Quaternion::new(w, x, y, z);
    let length = q.norm();
    (length.is_finite() && length > 1e-6).then(|| Quat::new_normalize(q))
}

/// The sign of `q` (it and its negative are one rotation) that lies nearer to `previous`.
pub fn same_hemisphere(previous: &Quat, q: Quat) -> Quat {
    if previous.coords.dot(&q.coords) < 0.0 {
        Quat::new_unchecked(-q.into_inner())
    } else {
        q
    }
}

/// The value of `values` nearest to this share of their order, 0 for the least and 1 for the largest; 0 of none. O(n log n).
#[cfg(feature = "formats")]
pub(crate) fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let at = (values.len().saturating_sub(1)) as f64 * share;
    values.get(at.round() as usize).copied().unwrap_or(0.0)
}

/// Spherical interpolation along the shorter arc; exactly `a` at 0 and exactly `b` at 1.
pub fn slerp(a: &Quat, b: &Quat, t: f64) -> Quat {
    if t <= 0.0 {
        return *a;
    }
    if t >= 1.0 {
        return *b;
    }
    let b = same_hemisphere(a, *b);
    let cos = a.coords.dot(&b.coords).min(1.0);
    let (weight_a, weight_b) = slerp_weights(cos, t);
    Quat::new_normalize(nalgebra::Quaternion::from(
        a.coords * weight_a + b.coords * weight_b,
    ))
}

/// Interpolation of unit vectors along great circles, one share of the way, for many pairs.
#[derive(Debug, Clone, Copy)]
pub struct DirectionSlerp {
    t: f64,
    /// Coefficients of the series of both weights.
    series: [[f64; 2]; DirectionSlerp::TERMS],
}

impl DirectionSlerp {
    const TERMS: usize = 12;
    /// `(1 − cos θ) / 2` up to which the series is exact to a relative 1e-15: angles up to 0.45.
    const LARGEST: f64 = 0.05;

    /// For vectors `t` of the way from the first to the second, 0 … 1.
    pub fn new(t: f64) -> Self {
        let mut series = [[1.0 - t, t]; Self::TERMS];
        for k in 1..Self::TERMS {
            let square = (k * k) as f64;
            let share = 1.0 / (square + 0.5 * k as f64);
            series[k] = [0, 1].map(|end| {
                let t = series[0][end];
                series[k - 1][end] * (square - t * t) * share
            });
        }
        Self { t, series }
    }

    /// The unit vector between `a` and `b`. Opposite vectors have no shortest arc: it then passes through `a`'s side and stays
    /// finite.
    #[inline]
    pub fn between(&self, a: &Vec3, b: &Vec3) -> Vec3 {
        let [weight_a, weight_b] = self.weights(a.dot(b).clamp(-1.0, 1.0));
        let mixed = a * weight_a + b * weight_b;
        let length = mixed.norm();
        if length > 1e-9 { mixed / length } else { *a }
    }

    /// `sin((1 − t) θ) / sin θ` and `sin(t θ) / sin θ`. The second is `t F(1 + t, 1 − t; 3/2; y)` of `y = sin²(θ/2)` (Abramowitz and
    /// Stegun, 15.1.16), a series of the coefficients `c_0 = t`, `c_k = c_{k−1} (k² − t²) / (k (k + ½))`.
    #[inline]
    fn weights(&self, cos: f64) -> [f64; 2] {
        let y = (1.0 - cos) / 2.0;
        if y > Self::LARGEST {
            return slerp_weights(cos, self.t).into();
        }
        let mut sums = self.series[Self::TERMS - 1];
        for terms in self.series[..Self::TERMS - 1].iter().rev() {
            sums = [terms[0] + y * sums[0], terms[1] + y * sums[1]];
        }
        sums
    }
}

fn slerp_weights(cos: f64, t: f64) -> (f64, f64) {
    // Near-equal ends: the arc is its chord, and dividing by its sine would lose every digit.
    if !(-1.0 + 1e-9..=1.0 - 1e-9).contains(&cos) {
        return (1.0 - t, t);
    }
    let angle = portable::acos(cos);
    let sin = portable::sin(angle);
    (
        portable::sin((1.0 - t) * angle) / sin,
        portable::sin(t * angle) / sin,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_power_is_that_of_the_standard_library(base in 1e-6f32..1e6, exponent in -2.0f32..2.0) {
            let plain = f64::from(base).powf(f64::from(exponent));
            let relative = (f64::from(portable::power(base, exponent)) - plain) / plain;
            prop_assert!(relative.abs() < 6.1e-8, "{relative:e}");
        }
    }

    fn quat() -> impl Strategy<Value = Quat> {
        (-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0, 0.1f64..1.0)
            .prop_map(|(x, y, z, w)| Quat::new_normalize(nalgebra::Quaternion::new(w, x, y, z)))
    }

    proptest! {
        #[test]
        fn slerp_divides_the_angle(a in quat(), b in quat(), t in 0.0f64..1.0) {
            let whole = a.angle_to(&b);
            prop_assert!((a.angle_to(&slerp(&a, &b, t)) - t * whole).abs() < 1e-6);
        }

        #[test]
        fn slerp_ignores_the_sign_of_its_ends(a in quat(), b in quat(), t in 0.0f64..1.0) {
            let flipped = Quat::new_unchecked(-b.into_inner());
            prop_assert!(slerp(&a, &b, t).angle_to(&slerp(&a, &flipped, t)) < 1e-6);
        }
    }

    proptest! {
        #[test]
        fn a_quaternion_of_any_length_is_its_rotation(q in quat(), scale in 1e-3f64..1e3) {
            let [x, y, z, w] = [q.i, q.j, q.k, q.w].map(|c| c * scale);
            let found = rotation_of_xyzw([x, y, z, w]);
            prop_assert!(found.is_some_and(|found| found.angle_to(&q) < 1e-6));
        }
    }

    #[test]
    fn a_quaternion_without_a_length_is_no_rotation() {
        for none in [[0.0; 4], [f64::NAN, 0.0, 0.0, 1.0], [f64::INFINITY; 4]] {
            assert_eq!(rotation_of_xyzw(none), None);
        }
        let quarter = rotation_of_xyzw([0.0, 1.0, 0.0, 1.0]).unwrap();
        assert!((quarter * Vec3::z() - Vec3::x()).norm() < 1e-12);
    }

    proptest! {
        #[test]
        fn directions_divide_the_angle(a in quat(), angle in -3.1f64..3.1, small in 0.0f64..1.0, t in 0.0f64..1.0) {
            for angle in [angle, angle * small.powi(8)] {
                let [from, to] = [0.0, angle].map(|angle| a * (Axis::Z.rotation(angle) * Vec3::x()));
                let expected = a * (Axis::Z.rotation(t * angle) * Vec3::x());
                let found = DirectionSlerp::new(t).between(&from, &to);
                // Towards opposite directions rounding grows with the inverse square of the sine.
                let allowed = 1e-13 + 1e-15 / (1.0 + angle.cos());
                prop_assert!((found - expected).norm() < allowed, "{}", (found - expected).norm());
            }
        }
    }

    #[test]
    fn between_opposite_directions_lies_a_finite_one() {
        let found = DirectionSlerp::new(0.5).between(&Vec3::x(), &-Vec3::x());
        assert_eq!(found, Vec3::x());
    }

    #[test]
    fn the_ends_are_exact() {
        let a = Axis::X.rotation(0.3);
        let b = Axis::Y.rotation(2.0);
        assert_eq!(slerp(&a, &b, 0.0), a);
        assert_eq!(slerp(&a, &b, 1.0), b);
    }
}
