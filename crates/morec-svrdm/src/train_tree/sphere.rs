//! The smallest sphere around samples in feature space.

use nalgebra::{DMatrix, DVector};

/// The smallest enclosing sphere of samples in the feature space of a kernel.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sphere {
    /// Its centre is `Σ αᵢ ψ(xᵢ)`; `αᵢ ≥ 0`, and their sum is 1.
    pub alpha: DVector<f64>,
    /// Radius of the sphere.
    pub radius: f64,
    /// By how much a sample may still lie outside, in squared distance.
    pub gap: f64,
}

/// Samples with less weight than this do not hold the sphere.
const HOLDS: f64 = 1e-6;

impl Sphere {
    /// The samples it rests on: those with a weight.
    pub fn support_vectors(&self) -> Vec<usize> {
        (0..self.alpha.len())
            .filter(|&i| self.alpha[i] > HOLDS)
            .collect()
    }
}

/// The smallest enclosing sphere by the kernel's matrix, whose diagonal must be 1 (Eqs. 3.41 and 3.42, as corrected:
/// *minimise* `αᵀKα` with `Σα = 1`, `0 ≤ α`; the upper bound `C = 10` of the thesis never binds).
///
/// Weight goes from one sample to another, the pair that gains most (Fan, Chen and Lin, *Working set selection using
/// second order information for training support vector machines*, 2005), until no pair gains anything notable.
/// O(m) a step.
pub(crate) fn smallest_enclosing_sphere(kernel: &DMatrix<f64>) -> Sphere {
    let m = kernel.nrows();
    let mut alpha = DVector::from_element(m, 1.0 / m.max(1) as f64);
    let mut product = kernel * &alpha;
    let mut gap = 0.0;
    for _ in 0..1000 * m {
        let Some((to, from, open)) = pair(kernel, &alpha, &product) else {
            break;
        };
        gap = open;
        if gap < 1e-10 {
            break;
        }
        let curvature =
            (kernel[(to, to)] + kernel[(from, from)] - 2.0 * kernel[(to, from)]).max(1e-12);
        let step = alpha[from].min((product[from] - product[to]) / curvature);
        alpha[to] += step;
        alpha[from] -= step;
        product.axpy(step, &kernel.column(to), 1.0);
        product.axpy(-step, &kernel.column(from), 1.0);
    }
    let radius = (1.0 - alpha.dot(&(kernel * &alpha))).max(0.0).sqrt();
    Sphere {
        alpha,
        radius,
        gap: 2.0 * gap,
    }
}

/// The index that should gain weight, the one that should lose it, and the violation of balance.
fn pair(
    kernel: &DMatrix<f64>,
    alpha: &DVector<f64>,
    product: &DVector<f64>,
) -> Option<(usize, usize, f64)> {
    let to = product.argmin().0;
    let holding = || (0..alpha.len()).filter(|&i| alpha[i] > 0.0 && i != to);
    let gain = |from: usize| {
        let curvature = kernel[(to, to)] + kernel[(from, from)] - 2.0 * kernel[(to, from)];
        (product[from] - product[to]).powi(2) / curvature.max(1e-12)
    };
    let from = holding().max_by(|&a, &b| gain(a).total_cmp(&gain(b)))?;
    let open = holding()
        .map(|i| product[i] - product[to])
        .fold(0.0, f64::max);
    Some((to, from, open))
}
