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

/// What a branch must say for one of its sides to be followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Acceptance {
    /// `T`: the side's machine says at least this.
    pub accept: f64,
    /// `t`: on the way of the larger output, the other side's machine says at most this; where none is given, whatever it says.
    pub other: Option<f64>,
    /// The sides that are taken.
    pub descent: Descent,
}

impl Acceptance {
    /// On the way of the larger output, where it is at least `accept` (thesis, §4.6.5).
    pub fn above(accept: f64) -> Self {
        Self {
            accept,
            other: None,
            descent: Descent::Larger,
        }
    }

    /// True if `side` of a branch of these outputs is followed.
    fn follows(&self, outputs: [f64; 2], side: usize) -> bool {
        let rejects = |other: f64| outputs[1 - side] > other;
        let is_open = match self.descent {
            Descent::Both => true,
            Descent::Larger => {
                side == usize::from(outputs[1] > outputs[0]) && !self.other.is_some_and(rejects)
            }
        };
        is_open && outputs[side] >= self.accept
    }
}

/// A class that every branch on the way to it accepted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassCandidate {
    /// The class of the leaf.
    pub class: ClassId,
    /// The least output on the way: at least what was asked for.
    pub output: f64,
    /// The largest output of the machines of other sides on the way.
    pub other: f64,
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
                other: 0.0,
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
    /// The side that is taken; none of a leaf, and where neither is followed.
    pub taken: Option<usize>,
}

impl Tree {
    /// The way of the larger output down the tree (thesis, Fig. 5.2): to a leaf, or to the branch that rejects `vector`
    /// (`n` values).
    pub fn path(&self, vector: &[f64], acceptance: Acceptance) -> Vec<PathStep> {
        let acceptance = Acceptance {
            descent: Descent::Larger,
            ..acceptance
        };
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
            let taken = (0..2).find(|side| acceptance.follows(outputs, *side));
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

    /// The classes that `vector` (`n` values) may be: those that every branch on the way follows (`accept` is 0.92 in the thesis, where
    /// machines are trained towards 1). `out` is emptied first. No allocation; O(size of
    /// the branches on the way).
    pub fn descend(&self, vector: &[f64], acceptance: Acceptance, out: &mut ClassCandidates) {
        out.clear();
        let question = Question { vector, acceptance };
        let most = (f64::INFINITY, f64::NEG_INFINITY);
        self.visit(&self.nodes()[0], most, &question, out);
    }

    /// Goes on below `node`, to which the least output so far was `least`, and the largest of other sides `other`.
    fn visit(
        &self,
        node: &Node,
        (least, other): (f64, f64),
        question: &Question,
        out: &mut ClassCandidates,
    ) {
        let branch = match node {
            Node::Leaf(class) => {
                return out.insert(ClassCandidate {
                    class: *class,
                    output: least,
                    other,
                });
            }
            Node::Branch(branch) => branch,
        };
        let outputs = self.outputs(branch, question.vector);
        for side in 0..2 {
            if question.acceptance.follows(outputs, side) {
                let child = &self.nodes()[branch.children[side] as usize];
                let met = (least.min(outputs[side]), other.max(outputs[1 - side]));
                self.visit(child, met, question, out);
            }
        }
    }
}

struct Question<'a> {
    vector: &'a [f64],
    acceptance: Acceptance,
}
