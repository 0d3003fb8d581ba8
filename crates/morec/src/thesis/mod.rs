//! The method of 2009 (Bucur's thesis), which needs nothing else of recognition: recognition knows it as a
//! [`Pipeline`](crate::live), the index as a payload of its own, training as a recipe (`crate::train::thesis`).
//!
//! Its modules are reached by the paths of the steps they belong to: [`crate::pivots`], [`crate::pca`],
//! [`crate::svrdm`], `crate::train::svrdm`.

pub mod pca;
pub mod pivots;
pub mod svrdm;
#[cfg(feature = "train")]
pub mod train_tree;
