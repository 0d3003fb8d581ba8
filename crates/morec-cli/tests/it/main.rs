//! The commands as they are typed: one binary for all of them, a module for each.

mod convert;
mod inspect;
mod kit;
//! The command line, as a person or a script meets it.
mod evaluate;
