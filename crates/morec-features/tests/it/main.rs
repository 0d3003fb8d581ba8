//! What the sources may say.

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used)]

#[path = "../../../morec/tests/it/layers.rs"]
mod layers;
