//! Down the tree: which classes a vector may be.

use morec_features::ClassId;

use super::{Node, Tree};

/// Classes that a descent gives at most (thesis, §4.7.4).
pub const MAX_CANDIDATES: usize = 4;

/// The branch that is taken where both machines accept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Descent {
    /// Both ways, so that several classes may come out (thesis, §4.7.4: at most four).
    #[default]
    Both,
    /// The way of the larger output alone: one class or none (thesis, §4.6.5).
    Larger,
}

/// A class that every branch on the way to it accepted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassCandidate {
    /// The class of the leaf.
    pub class: ClassId,
    /// The least output on the way: at least what was asked for.
    pub output: f64,
}

/// The candidates of one descent, largest output first; of fixed size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassCandidates {
    kept: [ClassCandidate; MAX_CANDIDATES],
    count: usize,
}

impl Default for ClassCandidates {
    fn default() -> Self {
        Self {
            kept: [ClassCandidate {
                class: ClassId(0),
                output: 0.0,
            }; MAX_CANDIDATES],
            count: 0,
        }
    }
}

impl std::ops::Deref for ClassCandidates {
    type Target = [ClassCandidate];

    #[inline]
    fn deref(&self) -> &[ClassCandidate] {
        &self.kept[..self.count]
    }
}

impl ClassCandidates {
    /// None any more.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Puts one in its place; where all places are taken, that with the least output goes. Of equal outputs the
    /// earlier stays in front.
    pub(super) fn insert(&mut self, candidate: ClassCandidate) {
        let at = self
            .iter()
            .position(|c| c.output < candidate.output)
            .unwrap_or(self.count);
        if at == MAX_CANDIDATES {
            return;
        }
        self.count = (self.count + 1).min(MAX_CANDIDATES);
        self.kept[at..self.count].rotate_right(1);
        self.kept[at] = candidate;
    }
}

/// A node on a vector's way down a tree.
#[derive(Debug, Clone, PartialEq)]
pub struct PathStep {
    /// Its place among the nodes.
    pub node: usize,
    /// Outputs of its machines; of a leaf, 0.
    pub outputs: [f64; 2],
    /// The side that is taken; none of a leaf, and where neither machine accepts.
    pub taken: Option<usize>,
}

impl Tree {
    /// The way of the larger output down the tree (thesis, Fig. 5.2): to a leaf, or to the branch that rejects `vector`
    /// (`n` values).
    pub fn path(&self, vector: &[f64], accept: f64) -> Vec<PathStep> {
        let (mut path, mut at) = (vec![], 0);
        loop {
            let Node::Branch(branch) = &self.nodes()[at] else {
                path.push(PathStep {
                    node: at,
                    outputs: [0.0; 2],
                    taken: None,
                });
                return path;
            };
            let outputs = self.outputs(branch, vector);
            let larger = usize::from(outputs[1] > outputs[0]);
            let taken = (outputs[larger] >= accept).then_some(larger);
            path.push(PathStep {
                node: at,
                outputs,
                taken,
            });
            let Some(side) = taken else {
                return path;
            };
            at = branch.children[side] as usize;
        }
    }

    /// The classes that `vector` (`n` values) may be: those that every machine on the way gives at least `accept`
    /// (0.92 in the thesis, where machines are trained towards 1). `out` is emptied first. No allocation; O(size of
    /// the branches on the way).
    pub fn descend(
        &self,
        vector: &[f64],
        accept: f64,
        descent: Descent,
        out: &mut ClassCandidates,
    ) {
        out.clear();
        self.visit(
            &self.nodes()[0],
            f64::INFINITY,
            &Question {
                vector,
                accept,
                descent,
            },
            out,
        );
    }

    /// Goes on below `node`, to which the least output so far was `least`.
    fn visit(&self, node: &Node, least: f64, question: &Question, out: &mut ClassCandidates) {
        let branch = match node {
            Node::Leaf(class) => {
                return out.insert(ClassCandidate {
                    class: *class,
                    output: least,
                });
            }
            Node::Branch(branch) => branch,
        };
        let outputs = self.outputs(branch, question.vector);
        let larger = usize::from(outputs[1] > outputs[0]);
        for side in 0..2 {
            let open = question.descent == Descent::Both || side == larger;
            if open && outputs[side] >= question.accept {
                let child = &self.nodes()[branch.children[side] as usize];
                self.visit(child, least.min(outputs[side]), question, out);
            }
        }
    }
}

struct Question<'a> {
    vector: &'a [f64],
    accept: f64,
    descent: Descent,
}
