//! The tree of classes: at each branch two machines say left, right or neither (thesis, §3.7.6 and §4.6.5).

use serde::{Deserialize, Serialize};

use super::kernel::Gaussian;

mod check;
mod descent;
mod parts;
#[cfg(test)]
mod tests;

pub use check::{MAX_CLASSES, TreeError};
pub use descent::{Acceptance, ClassCandidate, ClassCandidates, Descent, MAX_CANDIDATES, PathStep};
pub use parts::{Branch, Node, TreeParts};

/// A trained classifier: branches that part the classes in two until each stands alone.
///
/// Training vectors that enclosing spheres rest on are kept once, however many branches use them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "TreeParts", into = "TreeParts")]
pub struct Tree {
    parts: TreeParts,
}

impl Tree {
    /// A tree of these parts, if they fit together. O(size).
    ///
    /// # Errors
    /// The first part that does not fit the others.
    pub fn new(parts: TreeParts) -> Result<Self, TreeError> {
        check::check(&parts)?;
        Ok(Self { parts })
    }

    /// Branches and machines, as they are stored.
    pub fn parts(&self) -> &TreeParts {
        &self.parts
    }

    /// Values in a feature vector.
    pub fn dim(&self) -> usize {
        self.parts.dim
    }

    /// The nodes; the root is the first, children come after their parent.
    pub fn nodes(&self) -> &[Node] {
        &self.parts.nodes
    }

    /// The branches with their places among the nodes, the root first.
    pub fn branches(&self) -> impl Iterator<Item = (usize, &Branch)> {
        self.nodes()
            .iter()
            .enumerate()
            .filter_map(|(at, node)| match node {
                Node::Branch(branch) => Some((at, &**branch)),
                Node::Leaf(_) => None,
            })
    }

    /// `vector` (`n` values) in the plane of `branch`, one of this tree's (Eq. 3.40). O(exemplars · n), no
    /// allocation.
    pub fn reduce(&self, branch: &Branch, vector: &[f64]) -> [f64; 2] {
        debug_assert_eq!(vector.len(), self.dim());
        let exemplars =
            [0, 1].map(|side| branch.exemplars[side].iter().map(|&row| self.exemplar(row)));
        reduce(exemplars, branch.factor, branch.sigma_full, vector)
    }

    /// Outputs of both machines of `branch` for `vector`. O(exemplars · n + points), no allocation.
    pub fn outputs(&self, branch: &Branch, vector: &[f64]) -> [f64; 2] {
        branch.outputs_at(self.reduce(branch, vector))
    }

    fn exemplar(&self, row: u32) -> &[f64] {
        let start = row as usize * self.parts.dim;
        &self.parts.vectors[start..start + self.parts.dim]
    }
}

impl Branch {
    /// Outputs of both machines at a place in the plane: about `T` and more at samples of their own side. O(points), no
    /// allocation.
    pub fn outputs_at(&self, place: [f64; 2]) -> [f64; 2] {
        outputs_at(&self.points, &self.weights, self.sigma_reduced, place)
    }
}

/// Outputs of two kernel machines at a place in the plane: `f_j = Σᵢ w_ji K(zᵢ, place)` over `points` `zᵢ`. O(points), no
/// allocation.
pub fn outputs_at(
    points: &[[f64; 2]],
    weights: &[Vec<f64>; 2],
    sigma: f64,
    place: [f64; 2],
) -> [f64; 2] {
    let kernel = Gaussian::new(sigma);
    let mut outputs = [0.0; 2];
    for (i, point) in points.iter().enumerate() {
        let k = kernel.of(point, &place);
        outputs[0] += weights[0][i] * k;
        outputs[1] += weights[1][i] * k;
    }
    outputs
}

/// `vector` in the plane of two sets of exemplars (none empty), whose centroids have this factor under a kernel of this
/// width (Eq. 3.40). O(exemplars · n), no allocation.
pub fn reduce<'a>(
    exemplars: [impl Iterator<Item = &'a [f64]>; 2],
    factor: [f64; 3],
    sigma: f64,
    vector: &[f64],
) -> [f64; 2] {
    let kernel = Gaussian::new(sigma);
    let [first, second] = exemplars.map(|mut side| {
        let (mut sum, mut total) = (0.0, 0);
        loop {
            let (mut rows, mut count) = ([vector; AT_ONCE], 0);
            for (row, exemplar) in rows.iter_mut().zip(&mut side) {
                *row = exemplar;
                count += 1;
            }
            let squared = squared_distances(&rows, vector);
            let kernels = squared[..count].iter().map(|d| kernel.of_squared(*d));
            sum = kernels.fold(sum, |sum, k| sum + k);
            total += count;
            if count < AT_ONCE {
                return sum / total as f64;
            }
        }
    });
    let [l11, l21, l22] = factor;
    let along = first / l11;
    [along, (second - l21 * along) / l22]
}

/// Exemplars that are compared at once.
const AT_ONCE: usize = 8;

/// `‖row − vector‖²` of several rows of as many values: each sum in the order of the values, side by side.
fn squared_distances(rows: &[&[f64]; AT_ONCE], vector: &[f64]) -> [f64; AT_ONCE] {
    let rows = rows.map(|row| &row[..vector.len()]);
    let mut sums = [0.0; AT_ONCE];
    for (k, value) in vector.iter().enumerate() {
        for (sum, row) in sums.iter_mut().zip(&rows) {
            let apart = row[k] - value;
            *sum += apart * apart;
        }
    }
    sums
}

impl TryFrom<TreeParts> for Tree {
    type Error = TreeError;

    fn try_from(parts: TreeParts) -> Result<Self, TreeError> {
        Self::new(parts)
    }
}

impl From<Tree> for TreeParts {
    fn from(tree: Tree) -> Self {
        tree.parts
    }
}
