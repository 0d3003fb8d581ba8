//! Measures and pictures of what is recognised, on synthetic people.

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

mod confidence_map;
mod deviation;
mod living_room;
#[path = "../../../morec/tests/it/made.rs"]
#[allow(dead_code)] // What the tests of recognition need.
mod made;
mod reproduce;
#[path = "../../../morec/tests/it/thesis.rs"]
#[allow(dead_code)]
mod thesis;
#[path = "../../../morec/tests/it/thesis_people.rs"]
#[allow(dead_code)]
mod thesis_people;
