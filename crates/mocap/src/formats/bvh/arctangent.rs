//! Angles of many points in a plane at once, for the Euler angles of a frame.
//!
//! Writing BVH spent a third of its time on the standard library's `atan2`. The loop here has no branches, so that the compiler makes
//! it work on several points at once; figures are in `docs/figures.md`, "Reading and writing BVH".

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4, FRAC_PI_8, PI};

use multiversion::multiversion;

/// Replaces `angles` by the angles of the points `(xs, ys)` in radians, -π to π, within 1e-15; 0 for the origin, NaN for NaN.
/// All three are as long as each other.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn atan2_all(ys: &[f64], xs: &[f64], angles: &mut [f64]) {
    for ((y, x), angle) in ys.iter().zip(xs).zip(angles) {
        *angle = atan2(*y, *x);
    }
}

/// The point is mirrored into the lowest eighth of the circle and turned back by 0°, 22.5° or 45°, whichever leaves least: the
/// series of the arctangent is exact to the last bits for what remains (11.25°).
#[inline(always)]
fn atan2(y: f64, x: f64) -> f64 {
    let (width, height) = (x.abs(), y.abs());
    let is_steep = height > width;
    let (long, short) = if is_steep {
        (height, width)
    } else {
        (width, height)
    };
    let (turn, cos, sin) = if short > TAN_THREE_SIXTEENTHS * long {
        (FRAC_PI_4, FRAC_1_SQRT_2, FRAC_1_SQRT_2)
    } else if short > TAN_SIXTEENTH * long {
        (FRAC_PI_8, COS_EIGHTH, SIN_EIGHTH)
    } else {
        (0.0, 1.0, 0.0)
    };
    let (up, along) = (short * cos - long * sin, long * cos + short * sin);
    let tangent = up / if along == 0.0 { 1.0 } else { along };
    let in_eighth = turn + (tangent + tangent * series(tangent * tangent));
    let in_quarter = if is_steep {
        FRAC_PI_2 - in_eighth
    } else {
        in_eighth
    };
    let in_half = if x < 0.0 { PI - in_quarter } else { in_quarter };
    in_half.copysign(y)
}

/// (arctan t) / t - 1 from t²: the terms (-t²)ⁿ / (2n + 1) from n = 1 on.
#[inline(always)]
fn series(square: f64) -> f64 {
    let mut sum = 0.0;
    let mut n = TERMS;
    while n > 0 {
        sum = -square * (1.0 / (2 * n + 1) as f64 + sum);
        n -= 1;
    }
    sum
}

/// tan²(11.25°)¹² / 25 is below a thousandth of a double's last bit.
const TERMS: u32 = 11;
/// tan(π/16)
const TAN_SIXTEENTH: f64 = 0.198_912_367_379_658;
/// tan(3π/16)
const TAN_THREE_SIXTEENTHS: f64 = 0.668_178_637_919_298_9;
/// cos(π/8) and sin(π/8)
const COS_EIGHTH: f64 = 0.923_879_532_511_286_7;
const SIN_EIGHTH: f64 = 0.382_683_432_365_089_8;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn one(y: f64, x: f64) -> f64 {
        let mut angle = [0.0];
        atan2_all(&[y], &[x], &mut angle);
        angle[0]
    }

    proptest! {
        #[test]
        fn angles_are_those_of_the_standard_library(y in -2.0f64..2.0, x in -2.0f64..2.0, small in -320i32..0) {
            for (y, x) in [(y, x), (y * 10f64.powi(small), x), (y, x * 10f64.powi(small)), (y, y), (y, -y)] {
                prop_assert!((one(y, x) - y.atan2(x)).abs() < 1e-15, "{y} {x}: {} {}", one(y, x), y.atan2(x));
            }
        }
    }

    #[test]
    fn points_on_the_axes_and_what_is_no_point() {
        assert_eq!(one(0.0, 0.0), 0.0);
        assert_eq!(one(0.0, 1.0), 0.0);
        assert_eq!(one(1.0, 0.0), FRAC_PI_2);
        assert_eq!(one(-1.0, 0.0), -FRAC_PI_2);
        assert_eq!(one(0.0, -1.0), PI);
        assert_eq!(one(-0.0, -1.0), -PI);
        assert!(one(f64::NAN, 1.0).is_nan() && one(1.0, f64::NAN).is_nan());
    }
}
