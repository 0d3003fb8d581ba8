//! Nodes of the tree, as they are kept.

use serde::{Deserialize, Serialize};

use morec_features::ClassId;

/// A [`Tree`](super::Tree) before its consistency was checked: what index files hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TreeParts {
    /// Values in a feature vector, `n`.
    pub dim: usize,
    /// Training vectors that branches refer to, `rows × n`, row by row.
    pub vectors: Vec<f64>,
    /// The nodes; the root is the first, children come after their parent.
    pub nodes: Vec<Node>,
}

/// A place in the tree.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Node {
    /// One class is left.
    Leaf(ClassId),
    /// Two macro-classes are distinguished.
    Branch(Box<Branch>),
}

/// A node that separates two macro-classes and rejects what is neither (thesis, Alg. 8).
///
/// A vector `x` is taken to the plane of the two centroids in feature space, `x̂ = L⁻¹ [k₁(x), k₂(x)]`, where `k_j` is
/// the mean of `K(a, x)` over the exemplars of side `j` (Eq. 3.40; both parts are means over `i`, as in 3.39). There
/// the machines are `f_j(x̂) = Σᵢ w_ji K(zᵢ, x̂)` (the solutions of Eqs. 3.27 and 3.28).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Branch {
    /// Width `σ_f` of the kernel between feature vectors.
    pub sigma_full: f64,
    /// For each side, the rows of [`TreeParts::vectors`] that its enclosing sphere rests on.
    pub exemplars: [Vec<u32>; 2],
    /// `L₁₁`, `L₂₁`, `L₂₂` of the Cholesky factor of the centroids' products (Eq. 3.39).
    pub factor: [f64; 3],
    /// Width `σ_r` of the kernel in the plane.
    pub sigma_reduced: f64,
    /// Training samples in the plane, `zᵢ`: those with a weight in either machine.
    pub points: Vec<[f64; 2]>,
    /// For each machine, the weights `±αᵢ` of the points.
    pub weights: [Vec<f64>; 2],
    /// For each side, its node.
    pub children: [u32; 2],
    /// For each side, its classes, in ascending order.
    pub classes: [Vec<ClassId>; 2],
}
