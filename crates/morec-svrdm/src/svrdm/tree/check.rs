//! Whether the parts of a tree fit together: they may come from a file.

use std::collections::BTreeSet;

use morec_features::ClassId;

use super::parts::{Branch, Node, TreeParts};

/// More classes than this are refused: descent is recursive, and a tree may be as deep as it has classes.
pub const MAX_CLASSES: usize = 1024;

/// Why parts are no tree.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TreeError {
    /// Vectors without values.
    #[error("a tree needs vectors of at least one value")]
    NoValues,
    /// The table of vectors has the wrong size.
    #[error("{found} values are no whole rows of {dim}")]
    Ragged {
        /// Values in a row.
        dim: usize,
        /// Values there are.
        found: usize,
    },
    /// Too few or too many classes.
    #[error("a tree has 2 to {MAX_CLASSES} classes, this one {found}")]
    Classes {
        /// Leaves there are.
        found: usize,
    },
    /// Something about a node.
    #[error("node {node}: {what}")]
    Node {
        /// Index of the branch.
        node: usize,
        /// The fault, as the end of a sentence.
        what: &'static str,
    },
}

/// Says what is wrong with `parts`, if anything. O(size · log size).
pub(super) fn check(parts: &TreeParts) -> Result<(), TreeError> {
    if parts.dim == 0 {
        return Err(TreeError::NoValues);
    }
    let found = parts.vectors.len();
    if !found.is_multiple_of(parts.dim) || parts.vectors.iter().any(|v| !v.is_finite()) {
        return Err(TreeError::Ragged {
            dim: parts.dim,
            found,
        });
    }
    let leaves = parts
        .nodes
        .iter()
        .filter(|n| matches!(n, Node::Leaf(_)))
        .count();
    if !(2..=MAX_CLASSES).contains(&leaves) {
        return Err(TreeError::Classes { found: leaves });
    }
    let rows = found / parts.dim;
    // Children come after their parent, so going backwards meets every subtree before what hangs it up.
    let mut below: Vec<Option<BTreeSet<ClassId>>> = vec![None; parts.nodes.len()];
    for (at, node) in parts.nodes.iter().enumerate().rev() {
        let classes = match node {
            Node::Leaf(class) => Ok(BTreeSet::from([*class])),
            Node::Branch(branch) => {
                figures(branch, rows).and_then(|()| join(branch, at, &mut below))
            }
        };
        below[at] = Some(classes.map_err(|what| TreeError::Node { node: at, what })?);
    }
    match below.iter().skip(1).position(Option::is_some) {
        Some(stray) => Err(TreeError::Node {
            node: stray + 1,
            what: "hangs on no branch",
        }),
        None => Ok(()),
    }
}

/// The classes below a branch, taken from its children.
fn join(
    branch: &Branch,
    at: usize,
    below: &mut [Option<BTreeSet<ClassId>>],
) -> Result<BTreeSet<ClassId>, &'static str> {
    let mut all = BTreeSet::new();
    for (child, listed) in branch.children.iter().zip(&branch.classes) {
        let child = *child as usize;
        if child <= at {
            return Err("a child does not come after its parent");
        }
        let classes = below
            .get_mut(child)
            .and_then(Option::take)
            .ok_or("a child is missing or shared")?;
        if !classes.iter().eq(listed) {
            return Err("the listed classes are not those below");
        }
        let count = all.len() + classes.len();
        all.extend(classes);
        if all.len() != count {
            return Err("a class is on both sides");
        }
    }
    Ok(all)
}

fn figures(branch: &Branch, rows: usize) -> Result<(), &'static str> {
    let width = |sigma: f64| sigma.is_finite() && sigma > 0.0 && (sigma * sigma).is_normal();
    let finite = |values: &[f64]| values.iter().all(|v| v.is_finite());
    if !width(branch.sigma_full) || !width(branch.sigma_reduced) {
        return Err("a kernel's width is not above 0");
    }
    if branch.exemplars.iter().any(Vec::is_empty) {
        return Err("a side has no exemplars");
    }
    if branch
        .exemplars
        .iter()
        .flatten()
        .any(|&row| row as usize >= rows)
    {
        return Err("an exemplar is not among the vectors");
    }
    let [l11, _, l22] = branch.factor;
    if !finite(&branch.factor) || l11 <= 0.0 || l22 <= 0.0 {
        return Err("the factor's diagonal is not above 0");
    }
    if branch
        .weights
        .iter()
        .any(|w| w.len() != branch.points.len() || !finite(w))
    {
        return Err("the weights do not fit the points");
    }
    if !branch.points.iter().all(|p| finite(p)) {
        return Err("a point is not finite");
    }
    Ok(())
}
