//! Pictures of results of other modules, which return numbers only.

mod confidence_map;
mod curves;
mod cuts;
mod machines;
mod quality;

#[cfg(test)]
mod tests;

pub use confidence_map::confidence_picture;
pub use curves::channel_chart;
pub use cuts::misfit_chart;
pub use machines::{branch_picture, path_text, tree_picture};
pub use quality::quality_chart;
