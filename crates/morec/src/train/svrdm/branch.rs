//! One branch of the tree: the plane of two sides, and the machines in it (thesis, Alg. 8).

use crate::svrdm::tree::{outputs_at, reduce};

use super::cross;
use super::gram::Distances;
use super::params::TreeParams;
use super::reduce::centroid_factor;
use super::sigma::{Algorithm4, SigmaRule, algorithm4, of_sides, quantile};
use super::sphere::enclosing;
use super::svrm::{MachineParams, svrdm};

/// The samples of two macro-classes, and motion that is neither.
#[derive(Debug, Clone, Copy)]
pub struct MacroClasses<'a> {
    /// Feature vectors of each side; neither is empty.
    pub vectors: [&'a [&'a [f64]]; 2],
    /// Who shows each of these: what is left out together.
    pub groups: [&'a [usize]; 2],
    /// Feature vectors of motion that is neither; may be empty.
    pub background: &'a [&'a [f64]],
}

/// The plane of two sides' centroids.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// `σ_f`.
    pub sigma: f64,
    /// For each side, which of its samples its enclosing sphere rests on.
    pub exemplars: [Vec<usize>; 2],
    /// `L₁₁`, `L₂₁`, `L₂₂` (Eq. 3.39).
    pub factor: [f64; 3],
}

impl Plane {
    /// The plane of two sides under a kernel of this width. O(m²) and more for the spheres.
    pub fn new(sides: [&[&[f64]]; 2], sigma: f64) -> Self {
        let exemplars = sides.map(|side| enclosing(&Distances::new(side).kernel(sigma)).holders());
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
    pub fn new(sides: [&[[f64; 2]]; 2], sigma: f64, params: &MachineParams) -> Self {
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

    /// What both say of a place in the plane, by the function that recognises.
    pub fn outputs(&self, place: &[f64; 2]) -> [f64; 2] {
        outputs_at(&self.points, &self.weights, self.sigma, *place)
    }
}

/// A trained branch that does not know its place in the tree yet.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainedBranch {
    /// The plane.
    pub plane: Plane,
    /// The machines in it.
    pub machines: Machines,
    /// Where widths were cross-validated: what they did.
    pub cross: Option<cross::WidthOutcome>,
}

/// Trains a branch: plane, then machines, with widths by the rule (Alg. 8).
pub fn train(sides: &MacroClasses, params: &TreeParams) -> TrainedBranch {
    if let SigmaRule::CrossValidated(how) = &params.sigma {
        let (full, reduced, outcome) = cross::choose(sides, how, &params.machine);
        return with_widths(sides, full, |_| reduced, params, Some(outcome));
    }
    let full = of_sides(sides.vectors, |side| one_width(side, params, Space::Full));
    let reduced =
        |planar: [&[[f64; 2]]; 2]| of_sides(planar, |side| one_width(side, params, Space::Reduced));
    with_widths(sides, full, reduced, params, None)
}

fn with_widths(
    sides: &MacroClasses,
    full: f64,
    reduced: impl Fn([&[[f64; 2]]; 2]) -> f64,
    params: &TreeParams,
    cross: Option<cross::WidthOutcome>,
) -> TrainedBranch {
    let plane = Plane::new(sides.vectors, full);
    let [a, b] = sides
        .vectors
        .map(|side| plane.reduce_all(sides.vectors, side));
    let machines = Machines::new([&a, &b], reduced([&a, &b]), &params.machine);
    TrainedBranch {
        plane,
        machines,
        cross,
    }
}

/// Which of the two widths is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Space {
    /// `σ_f`, between feature vectors.
    Full,
    /// `σ_r`, in the plane.
    Reduced,
}

/// The width for one set of samples by a rule that looks at these alone; the median distance where widths are
/// cross-validated later. `None` where the samples say nothing.
pub fn one_width<V: AsRef<[f64]>>(samples: &[V], params: &TreeParams, space: Space) -> Option<f64> {
    let pick = |full, reduced| if space == Space::Full { full } else { reduced };
    let estimate = |how: &Algorithm4| Some(algorithm4(samples, how, &params.machine)?.sigma);
    let at = |q| quantile(&Distances::new(samples).sorted(), q);
    match params.sigma {
        SigmaRule::Algorithm4 => estimate(&params.algorithm4),
        SigmaRule::Scaled { full, reduced } => {
            Some(estimate(&params.algorithm4)? * pick(full, reduced))
        }
        SigmaRule::Quantile { full, reduced } => at(pick(full, reduced)),
        SigmaRule::Fixed { full, reduced } => Some(pick(full, reduced)),
        SigmaRule::CrossValidated(_) => at(0.5),
    }
}
