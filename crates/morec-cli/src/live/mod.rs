//! What has sockets and files: sources of poses for live sessions, and where events go.

pub mod address;
pub mod axis;
pub mod broadcast;
pub mod clip;
pub mod json;
pub mod layout;
pub mod lines;
pub mod loaded;
pub mod memory;
pub mod network;
pub mod osc;
pub mod said;
pub mod sinks;
pub mod status;
pub mod vmc;
pub mod websocket;
pub mod wire;

pub use said::{Said, Sink};
