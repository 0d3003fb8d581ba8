//! Turns poses into the bytes of the broadcast. Used by `morec send` and tests.

use super::decoder::{BEGIN, END, HEADER, VERSION, values_of};
use super::{AXIS_BONE_COUNT, AXIS_BONES};
use morec::kinematics::WorldPose;
use morec::math::{Quat, Vec3};
use morec::roles::RoleMap;

/// Makes frames of posed skeletons.
///
/// Bones are sent as they are in the clip: with positions, a receiver that follows the chain of bones arrives at the
/// clip's own positions, whatever the clip's rest pose. Without, it knows rotations only, and those of a clip whose
/// rest pose is not a T-pose look odd on its skeleton.
#[derive(Debug)]
pub struct AxisSender {
    positions: bool,
    avatar: u32,
    name: String,
    number: u32,
    bytes: Vec<u8>,
}

impl AxisSender {
    /// A sender of one avatar, whose name is cut at 31 bytes.
    pub fn new(avatar: u32, name: &str, positions: bool) -> Self {
        Self {
            positions,
            avatar,
            name: name.to_owned(),
            number: 0,
            bytes: Vec::new(),
        }
    }

    /// The bytes of the next frame: a pose in metres, Y-up, whose joints play `roles`. Bones that nothing plays are
    /// unmoved.
    pub fn frame(&mut self, pose: &WorldPose, roles: &RoleMap) -> &[u8] {
        self.header();
        let mut world: [(Vec3, Quat); AXIS_BONE_COUNT] =
            [(Vec3::zeros(), Quat::identity()); AXIS_BONE_COUNT];
        for (b, bone) in AXIS_BONES.iter().enumerate() {
            let offset = Vec3::from(bone.offset_cm) / 100.0;
            let above = bone
                .parent
                .map_or((Vec3::zeros(), Quat::identity()), |parent| world[parent]);
            let joint = bone.role.and_then(|role| roles.joint(role));
            let played = joint.and_then(|j| {
                pose.positions
                    .get(j)
                    .copied()
                    .zip(pose.rotations.get(j).copied())
            });
            world[b] = played.unwrap_or_else(|| (above.0 + above.1 * offset, above.1));
            let place = above.1.inverse_transform_vector(&(world[b].0 - above.0)) * 100.0;
            let turn = angles(&(above.1.inverse() * world[b].1));
            if self.positions || b == 0 {
                place.iter().for_each(|value| self.value(*value));
            }
            turn.into_iter()
                .for_each(|rad| self.value(rad.to_degrees()));
        }
        self.number = self.number.wrapping_add(1);
        &self.bytes
    }

    fn value(&mut self, value: f64) {
        self.bytes.extend_from_slice(&(value as f32).to_le_bytes());
    }

    fn header(&mut self) {
        let bytes = &mut self.bytes;
        bytes.clear();
        bytes.extend_from_slice(&BEGIN.to_le_bytes());
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&(values_of(self.positions, false) as u16).to_le_bytes());
        bytes.extend_from_slice(&[u8::from(self.positions), 0]);
        bytes.extend_from_slice(&self.avatar.to_le_bytes());
        let mut name = [0u8; 32];
        name.iter_mut()
            .take(31)
            .zip(self.name.bytes())
            .for_each(|(to, byte)| *to = byte);
        bytes.extend_from_slice(&name);
        bytes.extend_from_slice(&self.number.to_le_bytes());
        bytes.resize(HEADER - 2, 0);
        bytes.extend_from_slice(&END.to_le_bytes());
    }
}

/// `[y, x, z]` in radians with `R_y · R_x · R_z = rotation`. Where x is a quarter turn only y − z or y + z is given:
/// z is 0 then.
pub(super) fn angles(rotation: &Quat) -> [f64; 3] {
    let matrix = rotation.to_rotation_matrix();
    let m = matrix.matrix();
    let cos_x = m[(1, 0)].hypot(m[(1, 1)]);
    let x = (-m[(1, 2)]).atan2(cos_x);
    if cos_x < 1e-8 {
        return [(-m[(2, 0)]).atan2(m[(0, 0)]), x, 0.0];
    }
    [m[(0, 2)].atan2(m[(2, 2)]), x, m[(1, 0)].atan2(m[(1, 1)])]
}
