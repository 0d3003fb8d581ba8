//! VMC, the protocol in which trackers and avatars tell each other poses: OSC messages over UDP, bone by bone.
//!
//! After the specification V3.1 (sh-akira/VirtualMotionCaptureProtocol). Everything here takes bytes and gives bytes;
//! whoever has a socket feeds it. [`VmcReceiver`] makes frames of packets, [`VmcSender`] packets of frames.

mod clock;
mod message;
mod peers;
mod receiver;
mod rest;
mod sender;
mod skeleton;
#[cfg(test)]
mod tests;

pub use crate::humanoid::{HUMANOID, HUMANOID_BONES, HumanoidBone, bone_of_name};
pub use message::{
    VmcMessage, mirror, position_of_unity, rotation_of_unity, rotation_to_unity, understand,
};
pub use peers::Peer;
pub use receiver::{VmcOptions, VmcReceiver};
pub use rest::is_t_pose;
pub use sender::{Bundling, VmcSender};
