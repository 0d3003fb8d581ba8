//! Distances and kernels between all samples of a set.

use nalgebra::DMatrix;

use crate::svrdm::kernel::{Gaussian, squared_distance};

/// Squared distances between `m` vectors, `m × m`, symmetric: computed once, used for every width of the kernel.
#[derive(Debug, Clone, PartialEq)]
pub struct Distances(DMatrix<f64>);

impl Distances {
    /// Between all of these. O(m² n).
    pub fn new<V: AsRef<[f64]>>(vectors: &[V]) -> Self {
        let m = vectors.len();
        let mut squared = DMatrix::zeros(m, m);
        for i in 0..m {
            for j in 0..i {
                let d = squared_distance(vectors[i].as_ref(), vectors[j].as_ref());
                squared[(i, j)] = d;
                squared[(j, i)] = d;
            }
        }
        Self(squared)
    }

    /// Number of vectors.
    pub fn len(&self) -> usize {
        self.0.nrows()
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// `‖xᵢ − xⱼ‖`.
    pub fn between(&self, i: usize, j: usize) -> f64 {
        self.0[(i, j)].sqrt()
    }

    /// Those among `members` alone.
    #[must_use]
    pub fn among(&self, members: &[usize]) -> Self {
        let m = members.len();
        Self(DMatrix::from_fn(m, m, |i, j| {
            self.0[(members[i], members[j])]
        }))
    }

    /// The kernel's matrix `K` at this width. O(m²).
    pub(crate) fn kernel(&self, sigma: f64) -> DMatrix<f64> {
        let kernel = Gaussian::new(sigma);
        self.0.map(|d| kernel.of_squared(d))
    }

    /// All distances of different vectors that are above 0, ascending. Vectors whose squared distance is lost in
    /// rounding count as equal.
    pub fn sorted(&self) -> Vec<f64> {
        let pairs = (0..self.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let mut all: Vec<f64> = pairs
            .map(|(i, j)| self.between(i, j))
            .filter(|d| *d > SAME)
            .collect();
        all.sort_unstable_by(f64::total_cmp);
        all
    }

    /// The mean distance of a vector from the nearest other one, equal ones included; 0 if there is only one.
    pub fn mean_nearest(&self) -> f64 {
        let m = self.len();
        if m < 2 {
            return 0.0;
        }
        let nearest = |i: usize| {
            (0..m)
                .filter(|j| *j != i)
                .map(|j| self.between(i, j))
                .fold(f64::INFINITY, f64::min)
        };
        (0..m).map(nearest).sum::<f64>() / m as f64
    }
}

/// Vectors nearer than this are taken for the same.
pub const SAME: f64 = 1e-9;
