//! Reads and writes the model of the method svrdm as manifest and tensors.
//!
//! The tree is divided: its nodes and their figures are words, in the order of the nodes, and the points, weights and exemplars of all
//! branches lie one behind the other in tables, in the order of the branches, beside tables of how many each has.

use std::collections::BTreeMap;

use crate::classes::ClassId;
use crate::pca::Pca;
use crate::svrdm::tree::{Branch, Node, Tree, TreeParts};
use crate::svrdm::{Profiles, SvrdmModel};

use super::manifest::{BranchWords, FORMAT, NodeWords, SvrdmManifest};
use super::tensors::{Tables, Tensor, class_id};
use super::{INDEX_VERSION, IndexError, MotionIndex};

/// The part of `model` that is written in words.
pub(super) fn manifest(model: &SvrdmModel, index: &MotionIndex) -> SvrdmManifest {
    let nodes = model.tree.nodes().iter().map(|node| match node {
        Node::Leaf(class) => NodeWords::Leaf(*class),
        Node::Branch(branch) => NodeWords::Branch(BranchWords {
            sigma_full: branch.sigma_full,
            sigma_reduced: branch.sigma_reduced,
            factor: branch.factor,
            children: branch.children,
            classes: branch.classes.clone(),
        }),
    });
    SvrdmManifest {
        format: FORMAT.to_owned(),
        version: INDEX_VERSION,
        method: "svrdm".to_owned(),
        checksum: 0,
        classes: model.classes.clone(),
        pivots: model.pivots.clone(),
        pose: model.pose,
        params: model.params.clone(),
        pca_rows: model.pca.rows(),
        nodes: nodes.collect(),
        mean_secs: model.mean_secs.clone(),
        epsilon: model.epsilon,
        roles: index.roles.clone(),
        provenance: index.provenance.clone(),
    }
}

/// The part of `model` that is written in tables, in single precision: a [compact](SvrdmModel::compact) model is read back as
/// it was.
pub(super) fn tensors(model: &SvrdmModel) -> BTreeMap<String, Tensor> {
    let pca = &model.pca;
    let axes: Vec<f64> = (0..pca.dims())
        .flat_map(|i| pca.axis(i).iter().copied())
        .collect();
    let branches: Vec<&Branch> = model.tree.branches().map(|(_, branch)| branch).collect();
    let sides = || branches.iter().flat_map(|b| b.exemplars.iter());
    let points: Vec<f64> = branches
        .iter()
        .flat_map(|b| b.points.iter().flatten().copied())
        .collect();
    let weights: Vec<f64> = branches
        .iter()
        .flat_map(|b| b.weights.iter().flatten().copied())
        .collect();
    let profiles = &model.profiles;
    let step = profiles.step.as_deref();
    let rows = profiles.values.chunks_exact(profiles.width);
    let mut tensors = BTreeMap::from([
        ("pca.axes".to_owned(), single(&axes)),
        ("pca.eigenvalues".to_owned(), single(pca.eigenvalues())),
        ("pca.mean".to_owned(), single(pca.mean())),
        (
            "profiles.classes".to_owned(),
            Tensor::of_u32(profiles.classes.iter().map(|c| u32::from(c.0))),
        ),
        (
            "profiles.lengths".to_owned(),
            Tensor::of_u32(profiles.lengths.iter().map(|n| *n as u32)),
        ),
        (
            "profiles.values".to_owned(),
            Tensor::of_rows(rows, profiles.width, step),
        ),
        ("signs".to_owned(), single(&model.signs)),
        (
            "tree.exemplar_counts".to_owned(),
            Tensor::of_u32(sides().map(|s| s.len() as u32)),
        ),
        (
            "tree.exemplars".to_owned(),
            Tensor::of_u32(sides().flatten().copied()),
        ),
        (
            "tree.point_counts".to_owned(),
            Tensor::of_u32(branches.iter().map(|b| b.points.len() as u32)),
        ),
        ("tree.points".to_owned(), single(&points)),
        (
            "tree.vectors".to_owned(),
            single(&model.tree.parts().vectors),
        ),
        ("tree.weights".to_owned(), single(&weights)),
    ]);
    if let Some(step) = step {
        tensors.insert("profiles.step".to_owned(), Tensor::of_f32(step));
    }
    tensors
}

fn single(values: &[f64]) -> Tensor {
    let values: Vec<f32> = values.iter().map(|v| *v as f32).collect();
    Tensor::of_f32(&values)
}

/// The model of an opened file.
pub(super) fn read(manifest: &SvrdmManifest, tables: &Tables) -> Result<SvrdmModel, IndexError> {
    let content = |message: String| IndexError::Content(message);
    let double = |name: &str| -> Result<Vec<f64>, IndexError> {
        Ok(tables.f32s(name)?.into_iter().map(f64::from).collect())
    };
    let (mean, axes, eigenvalues) = (
        double("pca.mean")?,
        double("pca.axes")?,
        double("pca.eigenvalues")?,
    );
    let pca = Pca::from_parts(mean, axes, eigenvalues, manifest.pca_rows)
        .map_err(|e| content(e.to_string()))?;
    let width = manifest.params.comparison.width(pca.dims());
    let profiles = profiles(tables, width)?;
    let dim = manifest.params.eigenvectors.saturating_mul(pca.dims());
    let nodes = nodes(manifest, tables)?;
    let parts = TreeParts {
        dim,
        vectors: double("tree.vectors")?,
        nodes,
    };
    let model = SvrdmModel {
        classes: manifest.classes.clone(),
        pivots: manifest.pivots.clone(),
        pose: manifest.pose,
        pca,
        params: manifest.params.clone(),
        signs: double("signs")?,
        tree: Tree::new(parts).map_err(|e| content(e.to_string()))?,
        profiles,
        mean_secs: manifest.mean_secs.clone(),
        epsilon: manifest.epsilon,
    };
    model.check().map_err(|e| content(e.to_string()))?;
    Ok(model)
}

fn profiles(tables: &Tables, width: usize) -> Result<Profiles, IndexError> {
    let step = tables.steps("profiles.step", width)?;
    let classes: Result<Vec<ClassId>, _> = tables
        .u32s("profiles.classes")?
        .into_iter()
        .map(class_id)
        .collect();
    let lengths = tables.u32s("profiles.lengths")?;
    let rows = tables.pieces("profiles.values", width, &lengths, step.as_deref())?;
    let values = rows
        .iter()
        .flat_map(|rows| rows.values().iter().copied())
        .collect();
    let lengths = lengths.into_iter().map(|n| n as usize).collect();
    Ok(Profiles {
        width,
        values,
        step,
        lengths,
        classes: classes?,
    })
}

/// The tree's nodes: words and tables put together again.
fn nodes(manifest: &SvrdmManifest, tables: &Tables) -> Result<Vec<Node>, IndexError> {
    let short = |name: &str| {
        IndexError::Content(format!("tensor {name:?} is shorter than the tree requires"))
    };
    let mut exemplar_counts = tables.u32s("tree.exemplar_counts")?.into_iter();
    let exemplars = tables.u32s("tree.exemplars")?;
    let mut exemplars = &exemplars[..];
    let mut point_counts = tables.u32s("tree.point_counts")?.into_iter();
    let (points, weights) = (tables.f32s("tree.points")?, tables.f32s("tree.weights")?);
    let (mut points, mut weights) = (&points[..], &weights[..]);
    let mut nodes = Vec::with_capacity(manifest.nodes.len());
    for words in &manifest.nodes {
        let words = match words {
            NodeWords::Leaf(class) => {
                nodes.push(Node::Leaf(*class));
                continue;
            }
            NodeWords::Branch(words) => words,
        };
        let mut side = || {
            let count = exemplar_counts
                .next()
                .ok_or_else(|| short("tree.exemplar_counts"))? as usize;
            Ok(take(&mut exemplars, count)
                .ok_or_else(|| short("tree.exemplars"))?
                .to_vec())
        };
        let exemplars = [side()?, side()?];
        let count = point_counts
            .next()
            .ok_or_else(|| short("tree.point_counts"))? as usize;
        let places =
            take(&mut points, count.saturating_mul(2)).ok_or_else(|| short("tree.points"))?;
        let places = places
            .as_chunks::<2>()
            .0
            .iter()
            .map(|p| p.map(f64::from))
            .collect();
        let mut of_machine = || {
            let weights = take(&mut weights, count).ok_or_else(|| short("tree.weights"))?;
            Ok(weights.iter().map(|w| f64::from(*w)).collect())
        };
        nodes.push(Node::Branch(Box::new(Branch {
            sigma_full: words.sigma_full,
            exemplars,
            factor: words.factor,
            sigma_reduced: words.sigma_reduced,
            points: places,
            weights: [of_machine()?, of_machine()?],
            children: words.children,
            classes: words.classes.clone(),
        })));
    }
    Ok(nodes)
}

/// The first `count` of `values`, which then begin after them.
fn take<'v, T>(values: &mut &'v [T], count: usize) -> Option<&'v [T]> {
    let (first, rest) = values.split_at_checked(count)?;
    *values = rest;
    Some(first)
}
