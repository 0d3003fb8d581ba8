//! Sines and cosines of half the angles of a row, for the quaternions of its rotations.
//!
//! Reading BVH spent most of its time on the standard library's `sin_cos`. The loop here has no branches, so that the compiler
//! makes it work on several angles at once; figures are in `docs/figures.md`, "Reading and writing BVH".

use multiversion::multiversion;

use crate::math::portable;

/// Sines and cosines of half angles, one of each for every column of a row.
#[derive(Debug, Default)]
pub(super) struct HalfAngles {
    pub sines: Vec<f64>,
    pub cosines: Vec<f64>,
}

/// Angles from here on, 2·10⁴ quarter turns, are left to the standard library.
const MOST_DEGREES: f64 = 1.8e6;

impl HalfAngles {
    /// Replaces all values by those of `angles_deg`, as exact as doubles hold an angle in degrees; NaN for NaN and for infinities.
    pub fn set(&mut self, angles_deg: &[f64]) {
        self.sines.resize(angles_deg.len(), 0.0);
        self.cosines.resize(angles_deg.len(), 0.0);
        sin_cos(angles_deg, &mut self.sines, &mut self.cosines);
        let is_far = |angle: &f64| angle.abs() >= MOST_DEGREES;
        if angles_deg.iter().any(is_far) {
            let far = angles_deg.iter().enumerate().filter(|(_, a)| is_far(a));
            for (column, angle) in far {
                let (sin, cos) = portable::sin_cos(angle.to_radians() * 0.5);
                self.sines[column] = sin;
                self.cosines[column] = cos;
            }
        }
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn sin_cos(angles_deg: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    for ((angle, sin), cos) in angles_deg.iter().zip(sines).zip(cosines) {
        (*sin, *cos) = sin_cos_of_half(*angle);
    }
}

/// Sine and cosine of half of an angle below [`MOST_DEGREES`].
///
/// The half angle is a whole number of quarter turns and a rest of up to 45°, whose series (to the fifteenth and the
/// sixteenth power) are exact to the last bit of a double.
#[inline(always)]
fn sin_cos_of_half(angle_deg: f64) -> (f64, f64) {
    /// Adding this leaves no room for a fraction: the sum is rounded, and its lowest bits are those of the whole number.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    let quarters = angle_deg / 180.0;
    let sum = quarters + ROUNDER;
    let rest = (quarters - (sum - ROUNDER)) * std::f64::consts::FRAC_PI_2;
    let square = rest * rest;
    let sin = rest + rest * square * series(&SIN_TERMS, square);
    let cos = 1.0 - square * 0.5 + square * square * series(&COS_TERMS, square);
    // In every other quarter the two change places.
    let quadrant = sum.to_bits();
    let odd = 0u64.wrapping_sub(quadrant & 1);
    let choose = |even: f64, other: f64| (even.to_bits() & !odd) | (other.to_bits() & odd);
    let sign = |quadrant: u64| (quadrant & 2) << 62;
    (
        f64::from_bits(choose(sin, cos) ^ sign(quadrant)),
        f64::from_bits(choose(cos, sin) ^ sign(quadrant.wrapping_add(1))),
    )
}

#[inline(always)]
fn series(terms: &[f64; 7], square: f64) -> f64 {
    let highest_first = terms.iter().rev();
    highest_first.fold(0.0, |sum, term| sum * square + term)
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn halves_of_degrees_are_those_of_the_standard_library(angle in -3600.0f64..3600.0, far in -1e12f64..1e12) {
            let angles = [angle, angle.round(), far, far / 1e6];
            let mut halves = HalfAngles::default();
            halves.set(&angles);
            for (k, angle) in angles.into_iter().enumerate() {
                let (sin, cos) = (halves.sines[k], halves.cosines[k]);
                let (expected_sin, expected_cos) = (angle.to_radians() * 0.5).sin_cos();
                let allowed = 2e-15 + angle.abs() * 4e-18;
                prop_assert!((sin - expected_sin).abs() < allowed, "{angle}: {sin} {expected_sin}");
                prop_assert!((cos - expected_cos).abs() < allowed, "{angle}: {cos} {expected_cos}");
            }
        }
    }

    #[test]
    fn what_is_no_angle_has_neither() {
        let mut halves = HalfAngles::default();
        halves.set(&[f64::NAN, 180.0, f64::INFINITY]);
        assert!(halves.sines[0].is_nan() && halves.cosines[2].is_nan());
        assert_eq!(
            (halves.sines[1], halves.cosines[1].abs() < 1e-15),
            (1.0, true)
        );
    }
}
