//! Turns frames into packets. Used by `morec send` and tests.

use super::message::{position_from_unity, rotation_to_unity};
use crate::osc::{Arg, begin_bundle, write_element, write_message};
use morec::humanoid::{HUMANOID, HUMANOID_BONES, joint_of, standard_offset};
use morec::kinematics::WorldPose;
use morec::math::{Quat, Vec3};
use morec::roles::RoleMap;

/// Distribution of a frame's messages over datagrams; all of this is found in the wild.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bundling {
    /// One bundle for all.
    Whole,
    /// Bundles of at most this many bytes (the specification advises 1,500), at least one message each.
    Bytes(usize),
    /// Every message by itself, in no bundle.
    Single,
}

/// Makes VMC packets of posed skeletons.
///
/// Bones are sent as they are in the clip, rotations of its joints and positions in their parents' frames: a receiver
/// that follows the chain of bones arrives at the clip's own positions, whatever the clip's rest pose.
#[derive(Debug)]
pub struct VmcSender {
    bundling: Bundling,
    /// Send all 55 bones, those without a joint unmoved.
    every_bone: bool,
    packets: Vec<Vec<u8>>,
    used: usize,
}

impl VmcSender {
    /// A sender; `every_bone` adds the bones that play no role, unmoved, as avatars have them.
    pub fn new(bundling: Bundling, every_bone: bool) -> Self {
        Self {
            bundling,
            every_bone,
            packets: Vec::new(),
            used: 0,
        }
    }

    /// The packets of one frame: its bones, those of [`HUMANOID`] that `roles` knows
    /// ([with fingers](RoleMap::with_fingers), if they are to be sent), then state and time. `pose` is in metres and Y-up.
    pub fn frame(&mut self, time_secs: f64, pose: &WorldPose, roles: &RoleMap) -> &[Vec<u8>] {
        self.used = 0;
        let mut world: [Option<(Vec3, Quat)>; HUMANOID_BONES] = [None; HUMANOID_BONES];
        self.message(
            "/VMC/Ext/Root/Pos",
            &[Arg::Text("root")],
            Some((Vec3::zeros(), Quat::identity())),
        );
        for bone in 0..HUMANOID_BONES {
            let parent = std::iter::successors(HUMANOID[bone].parent, |&b| HUMANOID[b].parent)
                .find(|&b| world[b].is_some());
            let above = parent.and_then(|parent| world[parent]);
            let joint = joint_of(bone, roles);
            let here = match (joint, above) {
                (Some(joint), _) => Some((pose.positions[joint], pose.rotations[joint])),
                (None, Some((position, rotation))) if self.every_bone => Some((
                    position + rotation * standard_offset(bone, parent),
                    rotation,
                )),
                _ => None,
            };
            world[bone] = here;
            let Some((position, rotation)) = here else {
                continue;
            };
            let local = match above {
                Some((above, turned)) => (
                    turned.inverse_transform_vector(&(position - above)),
                    turned.inverse() * rotation,
                ),
                None => (position, rotation),
            };
            self.message(
                "/VMC/Ext/Bone/Pos",
                &[Arg::Text(HUMANOID[bone].name)],
                Some(local),
            );
        }
        self.message("/VMC/Ext/OK", &[Arg::Int(1)], None);
        self.message("/VMC/Ext/T", &[Arg::Float(time_secs as f32)], None);
        &self.packets[..self.used]
    }

    /// Adds a message: `first`, then a position and a rotation in Unity's axes.
    fn message(&mut self, address: &str, first: &[Arg], pose: Option<(Vec3, Quat)>) {
        let mut args = [Arg::Other; 8];
        args[..first.len()].copy_from_slice(first);
        let mut count = first.len();
        if let Some((position, rotation)) = pose {
            let position = position_from_unity(position).unwrap_or_default();
            let [x, y, z, w] = rotation_to_unity(&rotation);
            for value in [position.x, position.y, position.z, x, y, z, w] {
                args[count] = Arg::Float(value as f32);
                count += 1;
            }
        }
        let args = &args[..count];
        // Nothing that is sent here takes more; a bundle's head and the element's length are 20 of it.
        const LONGEST: usize = 128;
        let room = match self.bundling {
            Bundling::Whole => usize::MAX,
            Bundling::Bytes(most) => most.saturating_sub(LONGEST),
            Bundling::Single => 0,
        };
        if self.used == 0
            || self.packets[self.used - 1].len() > room
            || self.bundling == Bundling::Single
        {
            self.new_packet();
        }
        let packet = &mut self.packets[self.used - 1];
        match self.bundling {
            Bundling::Single => write_message(packet, address, args),
            _ => write_element(packet, |out| write_message(out, address, args)),
        }
    }

    fn new_packet(&mut self) {
        self.used += 1;
        if self.packets.len() < self.used {
            self.packets.push(Vec::new());
        }
        let packet = &mut self.packets[self.used - 1];
        packet.clear();
        if self.bundling != Bundling::Single {
            begin_bundle(packet);
        }
    }
}
