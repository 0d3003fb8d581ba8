//! The tree of branches (thesis, Alg. 7).

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use serde::Serialize;

use crate::svrdm::tree::{Branch, Node, Tree, TreeError, TreeParts};
use morec_features::ClassId;

use super::branch::{Space, TrainedBranch, one_width, train};
use super::cross::WidthOutcome;
use super::cross_params::CrossParams;
use super::machines::MacroClasses;
use super::params::SigmaRule;
use super::params::TreeParams;
use super::partition::{function_products, partition};

/// A sample of a class as the tree sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct FeatureSample {
    /// Number of the class.
    pub class: ClassId,
    /// The group that shows it: what is left out together.
    pub group: usize,
    /// Its feature vector, `n` values.
    pub vector: Vec<f64>,
}

/// A tree and what was found while it grew.
#[derive(Debug, Clone, PartialEq)]
pub struct Grown {
    /// Ready to descend.
    pub tree: Tree,
    /// Of each branch, the root first.
    pub branches: Vec<BranchReport>,
}

/// Results at a branch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BranchReport {
    /// Its place among the tree's nodes.
    pub node: usize,
    /// Samples of each side.
    pub samples: [usize; 2],
    /// Of these, how many the enclosing sphere rests on.
    pub exemplars: [usize; 2],
    /// Width under which the classes were parted.
    pub sigma_partition: f64,
    /// Width of the kernel over feature vectors, `σ_f`.
    pub sigma_full: f64,
    /// `σ_r`.
    pub sigma_reduced: f64,
    /// By how much the conditions of the machines' optimum are missed at most, in units of their outputs.
    pub residual: f64,
    /// Background vectors that came here.
    pub background: usize,
    /// Of these, how many each side accepts.
    pub passed: [usize; 2],
    /// Results of the cross-validation of widths, if there was one.
    pub cross: Option<WidthOutcome>,
}

/// Why no tree grows.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GrowError {
    /// There is nothing to tell apart.
    #[error("a tree needs at least 2 classes; the samples show {found}")]
    TooFewClasses {
        /// Classes there are.
        found: usize,
    },
    /// A vector has another number of values than the first sample's.
    #[error("{what} {index} has {found} values where {expected} are expected")]
    Dimension {
        /// Sample or background.
        what: &'static str,
        /// Index of the sample.
        index: usize,
        /// Values of the first sample.
        expected: usize,
        /// Values it has.
        found: usize,
    },
    /// A value is no number.
    #[error("{what} {index} has a value that is not finite")]
    NotFinite {
        /// Sample or background.
        what: &'static str,
        /// Index of the sample.
        index: usize,
    },
    /// Algorithm 4 has no widths to try.
    #[error("algorithm4.sweep: {0}")]
    Sweep(String),
    /// The result is no tree: too many classes, or widths of 0 asked for.
    #[error(transparent)]
    Tree(#[from] TreeError),
}

/// Grows the tree over the classes of `samples` (at least two classes): they are parted in two (Alg. 6), machines are
/// trained for both sides (Alg. 8), and each side of more than one class goes on likewise (Alg. 7).
///
/// `background` vectors are motion of no class; only cross-validated widths look at them, at each
/// branch at those that the branches above let pass. The outcome depends on the arguments alone, seed included.
///
/// # Errors
/// Fewer than two classes, vectors of different length, or parameters that no tree grows with.
pub fn grow(
    samples: &[FeatureSample],
    background: &[Vec<f64>],
    params: &TreeParams,
) -> Result<Grown, GrowError> {
    let dim = checked(samples, background)?;
    params.algorithm4.sweep.check().map_err(GrowError::Sweep)?;
    let mut grower = Grower {
        samples,
        params,
        nodes: vec![],
        used: BTreeSet::new(),
        reports: vec![],
    };
    let classes: Vec<ClassId> = samples
        .iter()
        .map(|s| s.class)
        .collect::<BTreeSet<_>>()
        .into_iter()
        .collect();
    if classes.len() < 2 {
        return Err(GrowError::TooFewClasses {
            found: classes.len(),
        });
    }
    grower.nodes.push(Node::Leaf(classes[0])); // its place; the branch comes below
    let mut queue = VecDeque::from([(
        0,
        classes,
        background.iter().map(Vec::as_slice).collect::<Vec<_>>(),
    )]);
    while let Some((at, classes, background)) = queue.pop_front() {
        queue.extend(grower.branch(at, &classes, &background));
    }
    grower.grown(dim)
}

fn checked(samples: &[FeatureSample], background: &[Vec<f64>]) -> Result<usize, GrowError> {
    let expected = samples.first().map_or(0, |s| s.vector.len());
    let named = samples
        .iter()
        .map(|s| &s.vector)
        .enumerate()
        .map(|(i, v)| ("sample", i, v));
    for (what, index, vector) in named.chain(
        background
            .iter()
            .enumerate()
            .map(|(i, v)| ("background", i, v)),
    ) {
        if vector.len() != expected {
            return Err(GrowError::Dimension {
                what,
                index,
                expected,
                found: vector.len(),
            });
        }
        if vector.iter().any(|v| !v.is_finite()) {
            return Err(GrowError::NotFinite { what, index });
        }
    }
    Ok(expected)
}

struct Grower<'a> {
    samples: &'a [FeatureSample],
    params: &'a TreeParams,
    nodes: Vec<Node>,
    /// Samples that are exemplars anywhere.
    used: BTreeSet<u32>,
    reports: Vec<BranchReport>,
}

/// A node that is still to be grown: its place, its classes, the background that reaches it.
type Task<'a> = (usize, Vec<ClassId>, Vec<&'a [f64]>);

impl<'a> Grower<'a> {
    /// Grows the branch at node `at`; gives its sides that have more than one class.
    fn branch(
        &mut self,
        at: usize,
        classes: &[ClassId],
        background: &[&'a [f64]],
    ) -> Vec<Task<'a>> {
        let (sigma_partition, parted) = self.part(classes);
        let members = [0, 1].map(|k| self.members(&parted[k]));
        let of_side = |k: usize| members[k].iter().map(|&i| &self.samples[i as usize]);
        let vectors = [0, 1].map(|k| of_side(k).map(|s| &s.vector[..]).collect::<Vec<_>>());
        let groups = [0, 1].map(|k| of_side(k).map(|s| s.group).collect::<Vec<_>>());
        let sides = MacroClasses {
            vectors: [&vectors[0], &vectors[1]],
            groups: [&groups[0], &groups[1]],
            background,
        };
        let trained = train(&sides, self.params);
        let passed = passing(&trained, sides.vectors, background, self.accept());
        self.reports.push(BranchReport {
            node: at,
            samples: [0, 1].map(|k| members[k].len()),
            exemplars: [0, 1].map(|k| trained.plane.exemplars[k].len()),
            sigma_partition,
            sigma_full: trained.plane.sigma,
            sigma_reduced: trained.machines.sigma,
            residual: trained.machines.residual,
            background: background.len(),
            passed: [0, 1].map(|k| passed[k].len()),
            cross: trained.cross,
        });
        let children = self.place(at, trained, &members, &parted);
        let tasks = children.into_iter().zip(parted).zip(passed);
        tasks
            .filter(|((_, classes), _)| classes.len() > 1)
            .map(|((at, c), b)| (at, c, b))
            .collect()
    }

    /// The classes in two (Alg. 6), and the width they were parted under.
    fn part(&self, classes: &[ClassId]) -> (f64, [Vec<ClassId>; 2]) {
        let vectors = |class: &ClassId| -> Vec<&[f64]> {
            self.samples
                .iter()
                .filter(|s| s.class == *class)
                .map(|s| &s.vector[..])
                .collect()
        };
        let by_class: Vec<Vec<&[f64]>> = classes.iter().map(vectors).collect();
        let sigma = one_width(&by_class.concat(), self.params, Space::Full).unwrap_or(1.0);
        let products = function_products(&by_class, sigma, self.params);
        let split = partition(&products, &self.params.partition);
        let side = |k: usize| {
            (0..classes.len())
                .filter(|&i| split.sides[i] == k)
                .map(|i| classes[i])
                .collect()
        };
        (sigma, [side(0), side(1)])
    }

    /// Samples of these classes, by number.
    fn members(&self, classes: &[ClassId]) -> Vec<u32> {
        (0..)
            .zip(self.samples)
            .filter(|(_, s)| classes.contains(&s.class))
            .map(|(i, _)| i)
            .collect()
    }

    /// From which output on background passes.
    fn accept(&self) -> f64 {
        match self.params.sigma {
            SigmaRule::CrossValidated(CrossParams { accept, .. }) => accept,
            _ => self.params.machine.own,
        }
    }

    /// Puts a branch at its place and leaves behind the places of its children, for the time being as leaves.
    fn place(
        &mut self,
        at: usize,
        trained: TrainedBranch,
        members: &[Vec<u32>; 2],
        parted: &[Vec<ClassId>; 2],
    ) -> [usize; 2] {
        let exemplars = [0, 1].map(|k| {
            trained.plane.exemplars[k]
                .iter()
                .map(|&i| members[k][i])
                .collect()
        });
        self.used
            .extend(exemplars.iter().flat_map(|e: &Vec<u32>| e.iter().copied()));
        let first = self.nodes.len();
        self.nodes
            .extend(parted.iter().map(|classes| Node::Leaf(classes[0])));
        self.nodes[at] = Node::Branch(Box::new(Branch {
            sigma_full: trained.plane.sigma,
            exemplars,
            factor: trained.plane.factor,
            sigma_reduced: trained.machines.sigma,
            points: trained.machines.points,
            weights: trained.machines.weights,
            children: [first as u32, first as u32 + 1],
            classes: parted.clone(),
        }));
        [first, first + 1]
    }

    /// The tree, its exemplars kept once.
    fn grown(self, dim: usize) -> Result<Grown, GrowError> {
        let rows: BTreeMap<u32, u32> = self
            .used
            .iter()
            .zip(0..)
            .map(|(&sample, row)| (sample, row))
            .collect();
        let vectors = self
            .used
            .iter()
            .flat_map(|&i| self.samples[i as usize].vector.clone())
            .collect();
        let mut nodes = self.nodes;
        for node in &mut nodes {
            if let Node::Branch(branch) = node {
                branch
                    .exemplars
                    .iter_mut()
                    .flatten()
                    .for_each(|row| *row = rows[row]);
            }
        }
        Ok(Grown {
            tree: Tree::new(TreeParts {
                dim,
                vectors,
                nodes,
            })?,
            branches: self.reports,
        })
    }
}

/// For each side, the background that its machine accepts.
fn passing<'a>(
    trained: &TrainedBranch,
    sides: [&[&[f64]]; 2],
    background: &[&'a [f64]],
    accept: f64,
) -> [Vec<&'a [f64]>; 2] {
    let mut passed = [vec![], vec![]];
    for &vector in background {
        let outputs = trained
            .machines
            .outputs(&trained.plane.reduce(sides, vector));
        for side in 0..2 {
            if outputs[side] >= accept {
                passed[side].push(vector);
            }
        }
    }
    passed
}
