//! Sine, cosine and soft limits from arithmetic alone.
//!
//! The platform's own sine may differ in its last bit from one system to the next. Everything here is made of
//! additions, multiplications, divisions and square roots, which IEEE 754 fixes to the bit.

use nalgebra::Quaternion;

use crate::math::{Axis, Quat};

/// Sine and cosine of `angle_rad`, to about 1e-15 for angles below some thousand turns.
pub fn sin_cos(angle_rad: f64) -> (f64, f64) {
    // pi/2 in two parts, the first with trailing zeros, so that the multiple is exact.
    const HALF_PI_HIGH: f64 = 1.570_796_326_734_125_6;
    const HALF_PI_LOW: f64 = 6.077_100_506_506_192e-11;
    let quarter = (angle_rad / std::f64::consts::FRAC_PI_2).round();
    let r = (angle_rad - quarter * HALF_PI_HIGH) - quarter * HALF_PI_LOW;
    let (sin, cos) = (taylor(r, r, 1.0), taylor(1.0, r, 0.0));
    match quarter.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// `first - first r²/((k+1)(k+2)) + ...`: the Taylor series of sine (k = 1) and cosine (k = 0).
fn taylor(first: f64, r: f64, k: f64) -> f64 {
    let mut sum = first;
    let (mut term, mut n) = (first, k);
    for _ in 0..9 {
        term *= -r * r / ((n + 1.0) * (n + 2.0));
        n += 2.0;
        sum += term;
    }
    sum
}

/// Rotation by `angle_rad` about a coordinate axis.
pub fn turn(axis: Axis, angle_rad: f64) -> Quat {
    let (sin, cos) = sin_cos(angle_rad / 2.0);
    Quat::new_unchecked(Quaternion::from_parts(cos, axis.unit().into_inner() * sin))
}

/// Rest-to-rest course of a human reach, 0 to 1 over `u` in `[0, 1]`: velocity and acceleration vanish at both
/// ends (minimum jerk: Flash and Hogan, J. Neurosci. 5, 1985).
pub fn min_jerk(u: f64) -> f64 {
    let u = u.clamp(0.0, 1.0);
    u * u * u * (10.0 + u * (6.0 * u - 15.0))
}

/// The smaller of the two, rounded off over a width of `soft`.
pub fn soft_min(a: f64, b: f64, soft: f64) -> f64 {
    (a + b - ((a - b) * (a - b) + soft * soft).sqrt()) / 2.0
}

/// The larger of the two, rounded off over a width of `soft`.
pub fn soft_max(a: f64, b: f64, soft: f64) -> f64 {
    (a + b + ((a - b) * (a - b) + soft * soft).sqrt()) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn sine_and_cosine_are_right(angle in -500.0f64..500.0) {
            let (sin, cos) = sin_cos(angle);
            prop_assert!((sin - angle.sin()).abs() < 1e-13);
            prop_assert!((cos - angle.cos()).abs() < 1e-13);
        }

        #[test]
        fn turning_agrees_with_the_library(angle in -7.0f64..7.0) {
            for axis in Axis::ALL {
                prop_assert!(turn(axis, angle).angle_to(&axis.rotation(angle)) < 1e-7);
            }
        }

        #[test]
        fn soft_limits_stay_on_their_side(a in -2.0f64..2.0, b in -2.0f64..2.0) {
            prop_assert!(soft_min(a, b, 0.05) <= a.min(b));
            prop_assert!(soft_max(a, b, 0.05) >= a.max(b));
            prop_assert!((soft_min(a, b, 0.05) - a.min(b)).abs() <= 0.025 + 1e-12);
        }
    }

    #[test]
    fn a_reach_starts_and_ends_at_rest() {
        assert_eq!(
            (min_jerk(-1.0), min_jerk(0.0), min_jerk(1.0), min_jerk(2.0)),
            (0.0, 0.0, 1.0, 1.0)
        );
        assert!(min_jerk(1e-3) < 1e-8 && min_jerk(1.0 - 1e-3) > 1.0 - 1e-7);
    }
}
