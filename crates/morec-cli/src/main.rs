//! The command `morec`.
fn main() {}
