//! Divisors that make distances of small and of large motions comparable.

use crate::decode::TYPICAL_SPREAD;
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

    pub fn at(self, spread: f32) -> f32 {
        self.at_zero + self.slope * spread
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
    }
}
