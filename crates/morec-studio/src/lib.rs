//! `morec-studio`: a desktop window over the motion database.
//!
//! State, edits and drawing are apart. `state` is everything the window shows, without a widget; `store` sends edits to the
//! thread that owns the database and brings back what it holds; `jobs` is long work on threads of its own; `panels` are
//! functions of the state that emit commands. `screenshot` draws panels without a window.

// What only the window calls is dead without it; lints look at the crate with it.
#![cfg_attr(not(feature = "window"), allow(dead_code))]

mod app;
mod body;
mod dialogs;
mod fonts;
mod format;
mod jobs;
mod keys;
mod lists;
#[cfg(feature = "measure")]
pub mod measure;
mod name_pattern;
mod panels;
mod raster;
mod screenshot;
mod sources;
mod state;
mod store;
mod stretch;
#[cfg(test)]
mod tests;
mod theme;
mod unsaved;
mod video_player;
mod window;

pub use window::{Args, run};
