//! Effects of commands and of threads' results on the state: methods of [`State`], a file for each area.
//!
//! [`State`]: crate::state::State

mod classes;
mod compare;
mod crossval;
mod cuts;
mod files;
mod groups;
mod label_files;
mod labels;
mod library;
mod lines;
mod live;
mod marks;
mod outcomes;
mod proposals;
mod reports;
mod roles;
mod shelf;
mod shown;
mod similar;
mod study;
mod thesis;
mod train;
mod video;
mod words;
