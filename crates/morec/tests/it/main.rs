//! Behaviour of the library as a whole, on synthetic people, and on real clips where they are there.

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

mod alike;
mod cases;
mod conformance;
mod custom;
mod cuts;
mod diagnosis;
mod engines;
mod faster_copies;
#[cfg(feature = "fbx")]
mod fbx;
mod fingers;
mod for_ever;
mod golden;
mod hands;
mod index_file;
mod kit;
mod layers;
mod made;
mod parameters;
mod performer_stream;
mod pose_golden;
mod positions;
mod progress;
mod rows;
mod sensitivity;
mod session;
mod stages;
mod strangers;
mod svrdm;
mod thesis;
mod thesis_method;
mod thesis_people;
