//! The C library as C sees it: called through its exported functions, and by programs of C and C++.

// What tests share lies outside of test functions, where the lints look for it. Pointers here are those of the tests'
// own values.
#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    clippy::undocumented_unsafe_blocks
)]

mod any_calls;
mod calls;
#[allow(dead_code)]
#[path = "../../../morec/tests/it/cases.rs"]
mod cases;
mod compiled;
mod compilers;
mod conformance;
mod diagnosis;
mod eight;
mod faults;
mod header;
mod joints;
mod kit;
#[allow(dead_code)]
#[path = "../../../morec/tests/it/made.rs"]
mod made;
mod unity;
