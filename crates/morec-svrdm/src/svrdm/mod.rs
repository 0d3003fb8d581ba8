//! The recogniser of the thesis (Bucur 2009): support vector machines that may say "none of these", in a binary tree
//! of classes. Live side: nothing here knows of training (`train_tree`).
//!
//! The stages of §4.6, each a struct that can be run alone; [`SvrdmEngine`] runs them all:
//!
//! | stage | takes | gives |
//! |---|---|---|
//! | input assembly: [`Pca`](crate::pca::Pca), [`ChunkAssembly`] | pose rows, `D` values | chunks of 16 rows of `r` values, with their [`Gram`] |
//! | segment assembly: [`SegmentAssembly`] | a chunk's [`Gram`] | the [`Gram`] of each [`Window`] of 4 to 20 chunks that ends with it |
//! | feature vector extraction: [`FeatureExtraction`] | a segment's [`Gram`], its rows | `k · r` values; one value a row, the profile |
//! | classification: [`Tree`] | `k · r` values | at most four classes |
//! | scoring: [`SegmentScoring`] | a class, a profile | a confidence |
//! | tracking: [`SegmentTracking`] | for each chunk, a [`Cell`] for each window that ends with it | [`ChunkDetection`]s |
//!
//! Real-time contract: construction allocates and may fail with a reason; nothing that comes after allocates, locks
//! or fails. Memory does not grow with the stream.

mod classify;
mod compact;
pub mod edr;
mod engine;
mod extraction;
mod gram;
pub mod kernel;
mod leading;
mod map;
mod model;
mod params;
pub mod rows_edr;
mod scoring;
mod segments;
mod stage;
mod tracking;
pub mod tree;
mod vectors;

pub use classify::{Classified, SampleClassifier};
pub use engine::SvrdmEngine;
pub use extraction::FeatureExtraction;
pub use gram::Gram;
pub use map::ConfidenceMap;
pub use model::{ModelError, Profiles, SvrdmModel};
pub use params::{
    Centring, MAX_DIM, MAX_PROFILE_FRAMES, Maxima, Normalisation, Scaling, SegmentDistance,
    SvrdmParams,
};
pub use scoring::{Cell, SegmentScoring, confidence};
pub use segments::{ChunkAssembly, RowRing, SegmentAssembly, Window};
pub use stage::Stage;
pub use tracking::{ChunkDetection, FrameDetection, SegmentTracking};
pub use tree::{
    Acceptance, Branch, ClassCandidate, ClassCandidates, Descent, MAX_CANDIDATES, Node, PathStep,
    Tree, TreeError, TreeParts,
};
pub use vectors::Directions;
