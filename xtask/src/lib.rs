//! The Rust of documents that belong to no crate, so that it is compiled.

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
mod readme {}
#[cfg(doctest)]
#[doc = include_str!("../../docs/guide/rust-library.md")]
mod guide {}
