//! One branch of the tree: the plane of two sides, and the machines in it (thesis, Alg. 8).

use super::cross;
use super::gram::Distances;
use super::machines::{Machines, MacroClasses, Plane};
use super::params::SigmaRule;
use super::params::TreeParams;
use super::sigma::{algorithm4, of_sides, quantile};

/// A trained branch that does not know its place in the tree yet.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainedBranch {
    /// Projects feature vectors to the plane of the two sides' centroids.
    pub plane: Plane,
    /// One for each side, over points of the plane.
    pub machines: Machines,
    /// Results of the cross-validation of widths, if there was one.
    pub cross: Option<cross::WidthOutcome>,
}

/// Trains a branch: plane, then machines, with widths by the rule (Alg. 8).
pub fn train(sides: &MacroClasses, params: &TreeParams) -> TrainedBranch {
    if let SigmaRule::CrossValidated(how) = &params.sigma {
        let (full, reduced, outcome) = cross::choose(sides, how, params);
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
    let machines = Machines::new([&a, &b], reduced([&a, &b]), params);
    TrainedBranch {
        plane,
        machines,
        cross,
    }
}

/// Selects one of the two widths.
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
    let estimate = || Some(algorithm4(samples, params)?.sigma);
    let at = |q| quantile(&Distances::new(samples).sorted(), q);
    match params.sigma {
        SigmaRule::Algorithm4 => estimate(),
        SigmaRule::Scaled { full, reduced } => Some(estimate()? * pick(full, reduced)),
        SigmaRule::Quantile { full, reduced } => at(pick(full, reduced)),
        SigmaRule::Fixed { full, reduced } => Some(pick(full, reduced)),
        SigmaRule::CrossValidated(_) => at(0.5),
    }
}
