//! The method of 2009: Bucur, *Efficient Motion Capture Database Indexing on the Cell Processor* ("the thesis").
//!
//! It needs rows and numbers of classes of [`morec_features`] and nothing else of recognition. `morec` knows it as a pipeline of
//! live recognition, the index as a payload of its own, training as a recipe (`morec::train::thesis`); it passes the modules on as
//! `morec::pivots`, `morec::pca`, `morec::svrdm` and `morec::train::svrdm`.
//!
//! | module | is | thesis |
//! |---|---|---|
//! | [`pivots`] | pose rows of joint rotations | §4.2 |
//! | [`pca`] | principal components in constant memory | §§3.4, 4.2 |
//! | [`svrdm`] | the recogniser: stages from rows to detections | §§3.7, 4.6 |
//! | `train_tree` (feature `train`) | its training: from feature vectors to a tree of machines | §§3.7, 4.5 |
//!
//! # Terms
//!
//! | term | meaning |
//! |---|---|
//! | pivot | a joint whose rotation counts, relative to its parent pivot |
//! | pose row | the pivots' quaternions at one frame of the model's rate, 120 a second |
//! | dimension | a number of a reduced pose row (principal component) |
//! | chunk | 16 rows of a stream at 120 Hz, the step of the recogniser |
//! | window | a run of 4 to 20 chunks that may be a motion |
//! | feature vector | describes a window to the tree: the first eigenvectors (directions) of its `AᵀA`, joined |
//! | motion profile | a window's or sample's rows projected on its first direction (the thesis's "motion vector") |
//! | cell | one window's class and confidence |
//! | branch, side | a node of the tree that separates two sets of classes, its sides; a leaf is one class |
//! | machine | a function that is about 1 at samples of its side and small elsewhere |
//! | exemplar | a training vector on the surface of a side's enclosing sphere |
//!
//! # Notation
//!
//! | sign | is |
//! |---|---|
//! | `p`, `D` | pivots, and values in a pose row: `D = 4 p`, single precision |
//! | `r` | values in a reduced row |
//! | `m`, `n` | samples, and values in a feature vector |
//! | `σ_f`, `σ_r` | width of a branch's kernel over feature vectors, and over its plane |
//! | `T`, `t`, `C` | output asked for of a machine's own samples, of others', and the penalty |
//!
//! Frames are counted at the model's rate (120 Hz); times are seconds, ranges half-open. Training is in double precision. The
//! whole, what it was measured to do, and where it differs from the print: `docs/thesis.md` of the repository.

#![warn(clippy::missing_errors_doc, clippy::missing_panics_doc)]

pub mod pca;
pub mod pivots;
pub mod svrdm;
#[cfg(feature = "train")]
pub mod train_tree;

/// The Rust of README, so that it compiles.
#[cfg(all(doctest, feature = "train"))]
#[doc = include_str!("../README.md")]
mod readme {}
