//! Values that a live source delivers: a skeleton, and frames posed in the world.

use crate::clip::{Joint, Skeleton};
use crate::features::{BoneSet, KeyPose};
use crate::kinematics::WorldPose;
use crate::math::{Quat, Vec3};
use crate::roles::{Role, RoleMap};

/// Number of a source's performer, from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct PerformerId(pub u16);

impl PerformerId {
    /// The number as an index into a list of performers.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// The skeleton of a source with its roles. The frames that follow are poses of this skeleton.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rig {
    /// The joints, parents first.
    pub skeleton: Skeleton,
    /// Joint of each role.
    pub roles: RoleMap,
}

impl Rig {
    /// The rig of a source that names joints by role: joint `i` has the role `Role::ALL[i]`, and all joints are roots.
    pub fn of_roles() -> Self {
        let joint = |role: Role| Joint {
            name: role.name().to_owned(),
            parent: None,
            offset: Vec3::zeros(),
            tip: None,
        };
        let skeleton = Skeleton::new(Role::ALL.map(joint).to_vec()).unwrap_or_default();
        let mut roles = RoleMap::default();
        for role in Role::ALL {
            roles.set(role, Some(role.index()));
        }
        Self { skeleton, roles }
    }

    /// The bones of this skeleton in `pose`: those with both ends known and not at the same position.
    pub fn bones(&self, pose: &KeyPose) -> BoneSet {
        BoneSet::of_pose(pose)
    }
}

/// One performer's pose at one instant, on its way from a source to recognition. The same value is reused from frame to frame.
///
/// Right-handed, Y up, any unit of length, the same in all frames. The method svrdm uses the rotations; templates use only
/// [`key_pose`](Frame::key_pose).
#[derive(Debug, Clone, Default)]
pub struct Frame {
    /// Time of the pose on the source's clock, seconds.
    pub time_secs: f64,
    /// When its last part arrived: [`wall_now_secs`](super::wall_now_secs) then.
    pub wall_secs: f64,
    /// The performer of this pose.
    pub actor: PerformerId,
    /// Joints of the rig that was announced last, one position each. A joint that is unknown at this instant has a
    /// position that is not a number. Rotations are empty if the source knows positions only.
    pub pose: WorldPose,
}

impl Frame {
    /// Positions of the joints with roles, as templates compare them.
    pub fn key_pose(&self, rig: &Rig) -> KeyPose {
        let mut key = KeyPose::default();
        for (role, joint) in rig.roles.played() {
            if let Some(position) = self.pose.positions.get(joint) {
                key.set(role, *position);
            }
        }
        key
    }

    /// Position of the joint with this role; `None` if no joint has it.
    pub fn position(&self, rig: &Rig, role: Role) -> Option<Vec3> {
        self.pose.positions.get(rig.roles.joint(role)?).copied()
    }

    /// Sets the frame to a pose by roles: joints as in [`Rig::of_roles`], positions only.
    pub fn set_key_pose(&mut self, pose: &KeyPose) {
        let unknown = Vec3::repeat(f64::NAN);
        self.pose.rotations.clear();
        self.pose.positions.clear();
        self.pose
            .positions
            .extend(Role::ALL.map(|role| pose.get(role).unwrap_or(unknown)));
    }

    /// Resizes the frame to `joints` joints, all unknown and without rotation.
    pub fn clear(&mut self, joints: usize) {
        self.pose.positions.clear();
        self.pose.positions.resize(joints, Vec3::repeat(f64::NAN));
        self.pose.rotations.clear();
        self.pose.rotations.resize(joints, Quat::identity());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_pose_comes_through_a_frame_unchanged() {
        let mut pose = KeyPose::default();
        pose.set(Role::Hips, Vec3::new(1.0, 2.0, 3.0));
        pose.set(Role::LeftHand, Vec3::new(0.5, 0.0, -1.0));
        let mut frame = Frame::default();
        frame.clear(3);
        frame.set_key_pose(&pose);
        assert_eq!(frame.key_pose(&Rig::of_roles()), pose);
    }
}
