//! The C library as C sees it: called through its exported functions, and by programs of C and C++.

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used, clippy::print_stderr, clippy::undocumented_unsafe_blocks)]

mod header;
