//! Pictures of what other modules compute: they return numbers, and are drawn here.

mod confidence_map;
mod curves;
mod cuts;
mod machines;
mod quality;

#[cfg(test)]
mod tests;

pub use confidence_map::confidence_picture;
pub use curves::channel_chart;
pub use machines::{branch_picture, path_text, tree_picture};
pub use quality::quality_chart;
