//! What needs every area of the library: one error over theirs, training and recognition in one call, index files by path. No area
//! uses this module.

mod error;
#[cfg(all(feature = "files", feature = "live"))]
mod index_file;
#[cfg(all(feature = "live", feature = "formats"))]
mod recognize;
#[cfg(feature = "train")]
mod trainer;

pub use error::Error;
#[cfg(feature = "train")]
pub use trainer::Trainer;
