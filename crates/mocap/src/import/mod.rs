//! Making clips alike: metres, Y up, the parts of the body found, and what kind of clip it is.
//!
//! Everything is inferred from the motion itself, never from the zero pose, which need not be a pose that anybody
//! ever stood in; and everything inferred can be overridden in [`ImportOptions`].

mod axes;
mod body;
mod normalize;
mod options;
mod points;
mod report;
mod rest;
mod signed_axis;
mod take;
mod travel;
mod units;

pub use normalize::normalize;
pub use options::{ImportOptions, Stated};
pub use report::ImportReport;
pub use rest::rest_frames;
pub use signed_axis::SignedAxis;
pub use take::Take;

#[cfg(test)]
mod tests;
