//! VMC, the protocol in which trackers and avatars tell each other poses: OSC messages over UDP, bone by bone.
//!
//! After the specification V3.1 (sh-akira/VirtualMotionCaptureProtocol). [`VmcReceiver`] makes frames of packets,
//! [`VmcSender`] packets of frames: both work on bytes, without sockets. [`VmcSource`] is a receiver with a socket.

mod assembly;
mod clock;
mod datagram;
mod message;
mod peers;
mod receiver;
mod receiver_options;
mod rest;
mod sender;
mod skeleton;
mod source;
#[cfg(test)]
mod tests;

pub use message::{
    VmcMessage, mirror, position_from_unity, rotation_from_unity, rotation_to_unity, understand,
};
pub use morec::humanoid::{HUMANOID, HUMANOID_BONES, HumanoidBone, bone_of_name};
pub use peers::Peer;
pub use receiver::VmcReceiver;
pub use receiver_options::VmcOptions;
pub use rest::is_t_pose;
pub use sender::{Bundling, VmcSender};
pub use source::VmcSource;
