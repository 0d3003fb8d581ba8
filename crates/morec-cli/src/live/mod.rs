//! Live recognition in the terminal: sources, sinks, status and takes. Used by `live`, `record` and `teach`.

pub mod keep;
pub mod layout;
pub mod network;
pub mod on;
pub mod open;
pub mod sinks;
pub mod status;
pub mod takes;
pub mod wire;
