//! The few pieces of geometry that every stage shares, over [`nalgebra`].

use nalgebra::{Unit, UnitQuaternion, Vector3};

/// A point or direction, in the units its name or docs give.
pub type Vec3 = Vector3<f64>;
/// A rotation; named `a_from_b`, it takes coordinates in frame `b` to coordinates in frame `a`.
pub type Quat = UnitQuaternion<f64>;

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

    /// 0, 1 or 2.
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

/// Sine and cosine of half an angle in degrees, as exact as doubles hold the angle: what reading BVH spends most of its time
/// on.
///
/// The half angle is a whole number of quarter turns and a rest of up to 45°, whose series (to the fifteenth and the
/// sixteenth power) are exact to the last bit of a double.
#[inline]
pub(crate) fn sin_cos_of_half(angle_deg: f64) -> (f64, f64) {
    /// Adding this leaves no room for a fraction: the sum is rounded, and its lowest bits are those of the whole number.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    const MOST_QUARTERS: f64 = 1e4;
    let quarters = angle_deg / 180.0;
    if quarters.is_nan() || quarters.abs() >= MOST_QUARTERS {
        return (angle_deg.to_radians() * 0.5).sin_cos();
    }
    let sum = quarters + ROUNDER;
    let rest = (quarters - (sum - ROUNDER)) * std::f64::consts::FRAC_PI_2;
    let square = rest * rest;
    let series = |terms: [f64; 7]| {
        terms
            .into_iter()
            .rev()
            .fold(0.0, |sum, term| sum * square + term)
    };
    let sin = rest + rest * square * series(SIN_TERMS);
    let cos = 1.0 - square * 0.5 + square * square * series(COS_TERMS);
    let quadrant = sum.to_bits();
    let (sin, cos) = if quadrant & 1 == 0 {
        (sin, cos)
    } else {
        (cos, sin)
    };
    let sign = |value: f64, bits: u64| f64::from_bits(value.to_bits() ^ ((bits & 2) << 62));
    (sign(sin, quadrant), sign(cos, quadrant.wrapping_add(1)))
}

/// (-1)ⁿ / (2n + 1)! from n = 1 on.
const SIN_TERMS: [f64; 7] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
];
/// (-1)ⁿ / (2n)! from n = 2 on.
const COS_TERMS: [f64; 7] = [
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
];

/// The sign of `q` (it and its negative are one rotation) that lies nearer to `previous`.
pub fn same_hemisphere(previous: &Quat, q: Quat) -> Quat {
    if previous.coords.dot(&q.coords) < 0.0 {
        Quat::new_unchecked(-q.into_inner())
    } else {
        q
    }
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

/// Interpolation of unit vectors along the great circle; exactly `a` at 0 and exactly `b` at 1.
///
/// Opposite vectors have no shortest arc: the result then passes through `a`'s side and stays finite.
pub fn slerp_direction(a: &Vec3, b: &Vec3, t: f64) -> Vec3 {
    if t <= 0.0 {
        return *a;
    }
    if t >= 1.0 {
        return *b;
    }
    let cos = a.dot(b).clamp(-1.0, 1.0);
    let (weight_a, weight_b) = slerp_weights(cos, t);
    let mixed = a * weight_a + b * weight_b;
    let length = mixed.norm();
    if length > 1e-9 { mixed / length } else { *a }
}

fn slerp_weights(cos: f64, t: f64) -> (f64, f64) {
    // Near-equal ends: the arc is its chord, and dividing by its sine would lose every digit.
    if !(-1.0 + 1e-9..=1.0 - 1e-9).contains(&cos) {
        return (1.0 - t, t);
    }
    let angle = cos.acos();
    let sin = angle.sin();
    (((1.0 - t) * angle).sin() / sin, (t * angle).sin() / sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn quat() -> impl Strategy<Value = Quat> {
        (-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0, 0.1f64..1.0)
            .prop_map(|(x, y, z, w)| Quat::new_normalize(nalgebra::Quaternion::new(w, x, y, z)))
    }

    proptest! {
        #[test]
        fn halves_of_degrees_are_those_of_the_standard_library(angle in -3600.0f64..3600.0, far in -1e12f64..1e12) {
            for angle in [angle, angle.round(), far] {
                let (sin, cos) = sin_cos_of_half(angle);
                let (expected_sin, expected_cos) = (angle.to_radians() * 0.5).sin_cos();
                let allowed = 2e-15 + angle.abs() * 4e-18;
                prop_assert!((sin - expected_sin).abs() < allowed, "{angle}: {sin} {expected_sin}");
                prop_assert!((cos - expected_cos).abs() < allowed, "{angle}: {cos} {expected_cos}");
            }
        }

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

    #[test]
    fn the_ends_are_exact() {
        let a = Axis::X.rotation(0.3);
        let b = Axis::Y.rotation(2.0);
        assert_eq!(slerp(&a, &b, 0.0), a);
        assert_eq!(slerp(&a, &b, 1.0), b);
    }
}
