//! What has sockets and files: sources of poses for live sessions, and where events go.

pub mod address;
pub mod advice;
pub mod axis;
pub mod broadcast;
pub mod clip;
pub mod complaints;
pub mod json;
pub mod json_line;
pub mod keep;
pub mod layout;
pub mod lines;
pub mod loaded;
pub mod memory;
pub mod network;
pub mod open;
pub mod osc;
pub mod said;
pub mod sinks;
pub mod status;
pub mod takes;
pub mod vmc;
pub mod websocket;
pub mod wire;

pub use said::{Said, Sink};
