//! Stages of recognition by name, and their memory (thesis, Table 5.8).

use super::SvrdmModel;
use super::tree::Node;

/// A stage of recognition (thesis, §4.6 and §4.7.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Input assembly: pose rows projected, in chunks.
    InputAssembly,
    /// Segment assembly: `AᵀA` of each window.
    SegmentAssembly,
    /// Feature vector extraction.
    FeatureExtraction,
    /// Segment classification.
    Classification,
    /// Segment scoring.
    Scoring,
    /// Segment tracking.
    Tracking,
}

impl Stage {
    /// All, in the order of the data.
    pub const ALL: [Stage; 6] = [
        Stage::InputAssembly,
        Stage::SegmentAssembly,
        Stage::FeatureExtraction,
        Stage::Classification,
        Stage::Scoring,
        Stage::Tracking,
    ];

    /// Its letters in the thesis.
    pub fn letters(self) -> &'static str {
        match self {
            Stage::InputAssembly => "IA",
            Stage::SegmentAssembly => "SA",
            Stage::FeatureExtraction => "FVE",
            Stage::Classification => "SC",
            Stage::Scoring => "SS",
            Stage::Tracking => "ST",
        }
    }

    /// In words, as in the thesis: `input assembly`.
    pub fn name(self) -> &'static str {
        match self {
            Stage::InputAssembly => "input assembly",
            Stage::SegmentAssembly => "segment assembly",
            Stage::FeatureExtraction => "feature vector extraction",
            Stage::Classification => "segment classification",
            Stage::Scoring => "segment scoring",
            Stage::Tracking => "segment tracking",
        }
    }
}

/// Bytes of the model that classification reads.
pub(super) fn tree_bytes(model: &SvrdmModel) -> usize {
    let parts = model.tree.parts();
    let node = |node: &Node| match node {
        Node::Leaf(_) => 0,
        Node::Branch(branch) => {
            let exemplars = branch.exemplars.iter().map(Vec::len).sum::<usize>();
            // Two coordinates and two weights.
            4 * exemplars + 4 * 8 * branch.points.len() + size_of_val(&**branch)
        }
    };
    8 * parts.vectors.len() + parts.nodes.iter().map(node).sum::<usize>()
}
