//! Live recognition at a terminal: sources and sinks as they are typed, what is said of sessions, takes.

pub mod keep;
pub mod layout;
pub mod network;
pub mod on;
pub mod open;
pub mod sinks;
pub mod status;
pub mod takes;
pub mod wire;
