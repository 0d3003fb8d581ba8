//! Support vector representation (one class) and discrimination machines (two).

use nalgebra::{DMatrix, DVector};

use super::params::{MachineParams, TreeParams};
use super::qp::{BoxQp, Solution};

/// A coefficient this near to 0 or to `C` is taken to be there.
const AT_BOUND: f64 = 1e-6;

/// The machine that represents one class, `f(x) = Σ αᵢ K(xᵢ, x)` (Eq. 3.36, as corrected), from its samples' kernel.
pub(crate) fn svrm(kernel: DMatrix<f64>, params: &TreeParams) -> Solution {
    let machine = &params.machine;
    let linear = DVector::from_element(kernel.nrows(), machine.own);
    BoxQp {
        matrix: kernel,
        linear,
        upper: machine.penalty,
    }
    .solved_by(params.solver, machine.stop)
}

/// The samples on a machine's bounding boundary: `0 < αᵢ < C`, where `f(xᵢ) = T` (§3.7.3).
pub(crate) fn on_boundary(alpha: &DVector<f64>, params: &MachineParams) -> Vec<bool> {
    alpha
        .iter()
        .map(|a| *a > AT_BOUND && *a < params.penalty - AT_BOUND)
        .collect()
}

/// The two machines of a pair.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MachinePair {
    /// For each machine the weights `±αᵢ` of the samples: `f_j(x) = Σᵢ wᵢ K(xᵢ, x)`.
    pub weights: [DVector<f64>; 2],
    /// By how much the conditions of either problem are missed at most.
    pub residual: f64,
}

/// The machine that says at least `T` of side 0 and at most `t` of side 1 (Eq. 3.27), and the one that has it the
/// other way round (Eq. 3.28; the thesis says that only thresholds change places, which is so once labels do), from
/// all samples' kernel and their sides.
pub(crate) fn svrdm(kernel: &DMatrix<f64>, sides: &[usize], params: &TreeParams) -> MachinePair {
    let solutions = [0, 1].map(|side| {
        let qp = problem(kernel, sides, side, &params.machine);
        let solution = qp.solved_by(params.solver, params.machine.stop);
        let signed = solution
            .alpha
            .map_with_location(|i, _, a| if sides[i] == side { a } else { -a });
        (signed, solution.residual)
    });
    let residual = solutions[0].1.max(solutions[1].1);
    MachinePair {
        weights: solutions.map(|(weights, _)| weights),
        residual,
    }
}

/// The quadratic program of the machine for `side` (Eq. 3.31): labels are +1 on that side, `τ` is `T` there and `−t`
/// on the other.
pub(crate) fn problem(
    kernel: &DMatrix<f64>,
    sides: &[usize],
    side: usize,
    params: &MachineParams,
) -> BoxQp {
    let label = |i: usize| if sides[i] == side { 1.0 } else { -1.0 };
    BoxQp {
        matrix: kernel.map_with_location(|i, j, k| label(i) * label(j) * k),
        linear: DVector::from_fn(sides.len(), |i, _| {
            if sides[i] == side {
                params.own
            } else {
                -params.other
            }
        }),
        upper: params.penalty,
    }
}
