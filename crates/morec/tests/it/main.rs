//! Behaviour of the library as a whole, on real clips where they are there.

mod golden;
mod kit;
