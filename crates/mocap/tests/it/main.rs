//! Readers and writers as a whole, on files that are made here, and on real clips where they are there.

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

mod bvh_real;
mod bvh_roundtrip;
mod bvh_traps;
mod for_ever;
#[path = "../../../morec/tests/it/layers.rs"]
mod layers;
mod partial_skeleton;
mod smooth_real;
mod wild;
