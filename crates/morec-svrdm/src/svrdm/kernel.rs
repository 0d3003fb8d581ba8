//! The Gaussian kernel, in the thesis's convention for its width.

use mocap::math::portable;

/// `‖a − b‖²`. O(n), no allocation.
pub fn squared_distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// `K = exp(−d² / (2 σ²))` of a squared distance `d²` (thesis, Eq. 3.25).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gaussian {
    /// `−1 / (2 σ²)`.
    exponent: f64,
}

impl Gaussian {
    /// The kernel of width `sigma > 0`.
    pub fn new(sigma: f64) -> Self {
        Self {
            exponent: -0.5 / (sigma * sigma),
        }
    }

    /// The kernel of two vectors this squared distance apart: 1 at 0, down to 0.
    pub fn of_squared(self, squared_distance: f64) -> f64 {
        portable::exp(self.exponent * squared_distance)
    }

    /// `K(a, b)`.
    pub fn of(self, a: &[f64], b: &[f64]) -> f64 {
        self.of_squared(squared_distance(a, b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sigma_is_the_deviation_of_the_bell() {
        let kernel = Gaussian::new(0.5);
        assert_eq!(kernel.of(&[1.0, 2.0], &[1.0, 2.0]), 1.0);
        assert!((kernel.of(&[0.0, 0.3], &[0.4, 0.0]) - (-0.5f64).exp()).abs() < 1e-15);
    }
}
