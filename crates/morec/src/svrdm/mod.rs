//! The recogniser of the thesis (Bucur 2009): support vector machines that may say "none of these", in a binary tree
//! of classes. Live side: nothing here knows of training (`train::svrdm`).

pub mod kernel;
pub mod tree;

pub use tree::{Branch, Candidate, Candidates, Descent, MAX_CANDIDATES, Node, Parts, Tree, TreeError};
