//! The method of 2009 (Bucur's thesis), apart from all else: recognition knows it as a
//! [`Pipeline`](crate::live), the index as a payload of its own, training as a recipe.
//!
//! Its modules are reached by the paths of the steps they belong to: [`crate::pivots`], [`crate::pca`],
//! [`crate::svrdm`], `crate::train::{svrdm, thesis}`, `crate::reproduce`.

pub mod pca;
pub mod pivots;
#[cfg(feature = "report")]
pub mod reproduce;
pub mod svrdm;
#[cfg(feature = "train")]
pub mod train;
#[cfg(feature = "train")]
pub mod train_tree;
