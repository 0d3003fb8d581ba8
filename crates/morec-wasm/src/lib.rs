//! morec for JavaScript: the Rust part of the npm package `morec`.
//!
//! `bindings` is what JavaScript sees and is compiled for WebAssembly only; all else is plain Rust and is tested like every
//! other crate. `npm/` has what goes into the package as it is, `build` makes the package.

#[cfg(target_arch = "wasm32")]
mod bindings;
#[cfg(all(target_arch = "wasm32", feature = "train"))]
mod learning;
#[cfg(feature = "train")]
mod material;
mod rows;

#[cfg(feature = "train")]
pub use material::{SampleRow, labels};
pub use rows::{DetectionRow, EventRow};
