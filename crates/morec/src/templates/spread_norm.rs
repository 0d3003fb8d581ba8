//! Divisors that make the distances of small and large motions comparable.

use multiversion::multiversion;

use crate::decode::{FAR, TYPICAL_SPREAD};
use crate::math::portable;

/// Smaller spreads, as shares of the typical one, count as this.
const LEAST_SPREAD: f32 = 1e-3;

/// Divisors of distances.
#[derive(Debug, Clone, Copy)]
pub(super) struct SpreadNorm {
    pub exponent: f32,
    /// `V_0`.
    pub typical: f32,
}

impl SpreadNorm {
    /// Divisor of a distance where the mean spread is `spread`.
    #[inline(always)]
    pub fn at(self, spread: f32) -> f32 {
        let scale = self.typical / TYPICAL_SPREAD;
        if self.exponent == 0.0 {
            scale
        } else {
            scale * portable::power((spread / self.typical).max(LEAST_SPREAD), self.exponent)
        }
    }
}

/// A line above a template's divisor of distances, as a function of the spread of the stretch.
#[derive(Debug, Clone, Copy)]
pub(super) struct NormBound {
    at_zero: f32,
    slope: f32,
}

impl NormBound {
    /// The tangent where both spreads are `spread`: a power of at most 1 is concave, so its tangents lie above it. A margin covers
    /// rounding.
    pub fn new(norm: SpreadNorm, spread: f32) -> Self {
        const MARGIN: f32 = 1.0 + 1e-4;
        let exponent = norm.exponent;
        if spread < LEAST_SPREAD * norm.typical || exponent > 1.0 {
            return Self {
                at_zero: f32::INFINITY,
                slope: 0.0,
            };
        }
        let at_tangent = MARGIN * norm.at(spread);
        Self {
            at_zero: (at_tangent * (1.0 - exponent / 2.0)).max(MARGIN * norm.at(0.0)),
            slope: at_tangent * exponent / (2.0 * spread),
        }
    }

    #[inline(always)]
    pub fn at(self, spread: f32) -> f32 {
        self.at_zero + self.slope * spread
    }
}

/// Distances that are normalised together.
const TOGETHER: usize = 16;

/// Normalises the `distances` of templates with the spreads `taught` from stretches with the spreads `seen`. A distance of [`FAR`] stays;
/// [`TOGETHER`] neighbours become [`FAR`] if their bounds say that none is below `reach`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub(super) fn normalize(
    (norm, bounds, reach): (SpreadNorm, &[NormBound], f32),
    (taught, seen): (&[f32], &[f32]),
    distances: &[f32],
    normalized: &mut [f32],
) {
    for (part, out) in normalized.chunks_mut(TOGETHER).enumerate() {
        let all = part * TOGETHER..part * TOGETHER + out.len();
        let (distances, bounds) = (&distances[all.clone()], &bounds[all.clone()]);
        let (taught, seen) = (&taught[all.clone()], &seen[all]);
        out.fill(FAR);
        let mut is_near = false;
        for ((distance, bound), seen) in distances.iter().zip(bounds).zip(seen) {
            is_near |= *distance < reach * bound.at(*seen);
        }
        if !is_near {
            continue;
        }
        for (((out, distance), taught), seen) in out.iter_mut().zip(distances).zip(taught).zip(seen)
        {
            let normalized = distance / norm.at((taught + seen) / 2.0);
            *out = if *distance < FAR { normalized } else { FAR };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_line_lies_above_the_divisor(
            exponent in 0.0f32..=1.0, typical in 0.1f32..5.0, template in 0.0f32..20.0, stretch in 0.0f32..60.0,
        ) {
            let norm = SpreadNorm { exponent, typical };
            let line = NormBound::new(norm, template).at(stretch);
            prop_assert!(line >= norm.at((template + stretch) / 2.0));
        }

        #[test]
        fn distances_within_reach_are_normalised_as_one_by_one(
            matches in prop::collection::vec((0.0f32..9.0, 0.0f32..20.0, 0.0f32..60.0, any::<bool>()), 0..40),
            exponent in 0.0f32..=1.0, typical in 0.1f32..5.0, reach in 0.0f32..4.0,
        ) {
            let norm = SpreadNorm { exponent, typical };
            let taught: Vec<f32> = matches.iter().map(|m| m.1).collect();
            let seen: Vec<f32> = matches.iter().map(|m| m.2).collect();
            let distances: Vec<f32> = matches.iter().map(|m| if m.3 { m.0 } else { FAR }).collect();
            let bounds: Vec<NormBound> = taught.iter().map(|t| NormBound::new(norm, *t)).collect();
            let mut normalized = vec![f32::NAN; matches.len()];
            normalize((norm, &bounds, reach), (&taught, &seen), &distances, &mut normalized);
            for (i, found) in normalized.iter().enumerate() {
                let alone = distances[i] / norm.at((taught[i] + seen[i]) / 2.0);
                let unreached = distances[i] >= FAR || alone >= reach;
                prop_assert!(found.to_bits() == alone.to_bits() || (unreached && *found == FAR));
                prop_assert!(distances[i] < FAR || *found == FAR);
            }
        }
    }
}
