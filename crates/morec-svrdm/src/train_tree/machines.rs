//! The plane of two sides, and the machines in it (thesis, Alg. 8).

use crate::svrdm::tree::{outputs_at, reduce};

use super::TreeParams;
use super::gram::Distances;
use super::reduce::centroid_factor;
use super::sphere::smallest_enclosing_sphere;
use super::svrm::svrdm;

/// The samples of two macro-classes, and motion that is neither.
#[derive(Debug, Clone, Copy)]
pub struct MacroClasses<'a> {
    /// Feature vectors of each side; neither is empty.
    pub vectors: [&'a [&'a [f64]]; 2],
    /// Group of each of these: what is left out together.
    pub groups: [&'a [usize]; 2],
    /// Feature vectors of motion that is neither; may be empty.
    pub background: &'a [&'a [f64]],
}

/// The plane of two sides' centroids.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Width of the kernel over feature vectors, `σ_f`.
    pub sigma: f64,
    /// For each side, which of its samples its enclosing sphere rests on.
    pub exemplars: [Vec<usize>; 2],
    /// `L₁₁`, `L₂₁`, `L₂₂` (Eq. 3.39).
    pub factor: [f64; 3],
}

impl Plane {
    /// The plane of two sides under a kernel of this width. O(m²) and more for the spheres.
    pub fn new(sides: [&[&[f64]]; 2], sigma: f64) -> Self {
        let exemplars = sides.map(|side| {
            smallest_enclosing_sphere(&Distances::new(side).kernel(sigma)).support_vectors()
        });
        let [a, b] = [0, 1].map(|k| {
            exemplars[k]
                .iter()
                .map(|&i| sides[k][i])
                .collect::<Vec<_>>()
        });
        Self {
            sigma,
            factor: centroid_factor([&a, &b], sigma),
            exemplars,
        }
    }

    /// `vector` in this plane of these sides, by the function that recognises (Eq. 3.40).
    pub fn reduce(&self, sides: [&[&[f64]]; 2], vector: &[f64]) -> [f64; 2] {
        let exemplars = [0, 1].map(|k| self.exemplars[k].iter().map(move |&i| sides[k][i]));
        reduce(exemplars, self.factor, self.sigma, vector)
    }

    /// All of a side.
    pub fn reduce_all(&self, sides: [&[&[f64]]; 2], vectors: &[&[f64]]) -> Vec<[f64; 2]> {
        vectors.iter().map(|v| self.reduce(sides, v)).collect()
    }
}

/// Both machines of a branch, in its plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Machines {
    /// `σ_r`.
    pub sigma: f64,
    /// Training samples in the plane that have a weight.
    pub points: Vec<[f64; 2]>,
    /// Their weights in each machine.
    pub weights: [Vec<f64>; 2],
    /// By how much the optimum's conditions are missed at most.
    pub residual: f64,
}

impl Machines {
    /// Trains both on samples in the plane.
    pub fn new(sides: [&[[f64; 2]]; 2], sigma: f64, params: &TreeParams) -> Self {
        let points = sides.concat();
        let side_of: Vec<usize> = (0..points.len())
            .map(|i| usize::from(i >= sides[0].len()))
            .collect();
        let pair = svrdm(&Distances::new(&points).kernel(sigma), &side_of, params);
        let [first, second] = &pair.weights;
        let used: Vec<usize> = (0..points.len())
            .filter(|&i| first[i] != 0.0 || second[i] != 0.0)
            .collect();
        Self {
            sigma,
            points: used.iter().map(|&i| points[i]).collect(),
            weights: [first, second].map(|w| used.iter().map(|&i| w[i]).collect()),
            residual: pair.residual,
        }
    }

    /// Outputs of both sides at a place in the plane, by the function that recognises.
    pub fn outputs(&self, place: &[f64; 2]) -> [f64; 2] {
        outputs_at(&self.points, &self.weights, self.sigma, *place)
    }
}
